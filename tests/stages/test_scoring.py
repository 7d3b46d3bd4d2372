"""The pictures of held-out views are scored where there are weights, and nothing else changes. Needs the extra `quality`."""

import numpy as np
import pytest

from tests.quality import tiny
from wm import codecs
from wm.artifacts.digests import identity
from wm.artifacts.run_folder import open_run_folder
from wm.meter import StageMeter
from wm.run import load_config
from wm.schema import EvaluateConfig, RunConfig
from wm.stages.run_context import RunContext
from wm.stages.scoring import scores_of

numpy_files = pytest.importorskip("safetensors.numpy", reason="extra `quality`")


def saved(folder, **files):
    folder.mkdir(exist_ok=True)
    for name, arrays in files.items():
        numpy_files.save_file({key: np.array(array) for key, array in arrays.items()}, folder / f"{name}.safetensors")
    return folder


@pytest.fixture
def pictures(tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    for k in range(2):
        (folder / f"{k}.png").write_bytes(codecs.encode_png(tiny.picture(48, 64, seed=k)))
    return folder


def scored(folder, weights, names=("0.png", "1.png"), key="made"):
    """What the part gives, and how many entries it made and found."""
    config = RunConfig(evaluate=EvaluateConfig(quality=None if weights is None else str(weights)))
    with open_run_folder(folder, {"seed": 0}, overwrite=True) as store:
        context = RunContext(config=config, folder=store, meter=StageMeter({}))
        return scores_of(context, names, key), store.recorded, store.found


def test_the_scores_are_means_over_the_pictures_and_are_kept(pictures, tmp_path):
    weights = saved(tmp_path / "weights", clip_rn50=tiny.rn50(), clip_iqa_prompts=tiny.prompts())
    first, made, _ = scored(pictures, weights)
    assert set(first) == {"clip_iqa"} and 0 < first["clip_iqa"] < 1 and made == 1
    single = [scored(pictures, weights, [name], key=name)[0]["clip_iqa"] for name in ("0.png", "1.png")]
    np.testing.assert_allclose(first["clip_iqa"], np.mean(single))
    assert scored(pictures, weights)[0] == first
    again, made, found = scored(pictures, weights)
    assert (again, made, found) == (first, 0, 1)


def test_other_weights_or_pictures_are_scored_anew_and_no_weights_make_nothing(pictures, tmp_path):
    weights = saved(tmp_path / "weights", clip_vit_l14=tiny.vit_l14(), aesthetic_head=tiny.head())
    first, _, _ = scored(pictures, weights)
    assert set(first) == {"aesthetic"}
    saved(weights, aesthetic_head=tiny.head(seed=9))
    second, made, _ = scored(pictures, weights)
    assert second != first and made == 1
    assert scored(pictures, weights, key="made again")[1] == 1
    assert scored(pictures, None) == ({}, 0, 0)


def test_weights_do_not_make_another_run_of_it():
    named = load_config(["+scene=gothic", "evaluate.quality=somewhere"])
    assert identity(named) == identity(load_config(["+scene=gothic"])) and named.evaluate.quality == "somewhere"
