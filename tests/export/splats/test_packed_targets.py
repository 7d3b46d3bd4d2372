"""SPZ and SOG come back from gaussforge within the steps that their targets allow, and no further."""

import jax
import numpy as np
import pytest

from tests.splat.formats.test_formats import scene
from wm.export.records import ExportError
from wm.export.splats import sog, spz
from wm.export.splats.comparing import deviations, read_back, require_within
from wm.splat.formats import load_splats
from wm.splat.ply.standard import packable

pytest.importorskip("gaussforge", reason="needs the extra splats")


def in_file_order(copy, gaussians):
    return gaussians if copy.order is None else jax.tree.map(lambda leaf: leaf[copy.order(gaussians)], gaussians)


@pytest.mark.parametrize("copy", [sog.COPY, spz.COPY], ids=["sog", "spz"])
def test_a_file_comes_back_within_its_steps_and_one_that_was_moved_does_not(tmp_path, copy):
    gaussians = packable(scene(1, 3000))
    gaussians.log_scales[:] = np.clip(gaussians.log_scales - 4, -9, 1)
    gaussians = in_file_order(copy, gaussians)
    copy.save(tmp_path / copy.file, gaussians)
    steps = copy.steps(gaussians)
    found = read_back(copy.target, tmp_path / copy.file, gaussians, steps)
    require_within(copy.target, tmp_path / copy.file, found)
    moved = gaussians.replace(means=gaussians.means + np.float32(0.005))
    bad = deviations(load_splats(tmp_path / copy.file), moved, steps)
    with pytest.raises(ExportError, match="came back otherwise than it was written: means by"):
        require_within(copy.target, tmp_path / copy.file, bad)


@pytest.mark.parametrize("copy", [sog.COPY, spz.COPY], ids=["sog", "spz"])
def test_another_number_of_gaussians_is_named(tmp_path, copy):
    copy.save(tmp_path / copy.file, packable(scene(1, 20)))
    fewer = packable(scene(1, 19))
    with pytest.raises(ExportError, match="holds 20 gaussians; 19 were written"):
        read_back(copy.target, tmp_path / copy.file, fewer, copy.steps(fewer))
