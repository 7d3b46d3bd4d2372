"""The script that serves Depth Anything 3, with a package whose `DepthAnything3` has the real one's calls and answers."""

import contextlib
import textwrap

import numpy as np
import pytest

from tests.models.depth.test_depth_anything_3 import CAMERA, QUICK, picture
from tests.models.worker.scripts import PYTHON
from wm.models.depth.depth_anything_3 import Settings
from wm.services.services import Services
from wm.synth.registry import make_backend

pytest.importorskip("torch")

API = """
    import types
    import numpy as np
    import torch


    class DepthAnything3(torch.nn.Module):
        def __init__(self, model_name):
            super().__init__()
            self.model_name = model_name

        @classmethod
        def from_pretrained(cls, name):
            return cls(name.rpartition("/")[2].lower())

        def inference(self, image, process_res=504):
            assert process_res == 28
            (rgb,) = image
            assert rgb.dtype == np.uint8 and rgb.ndim == 3
            depth = 1.0 + torch.from_numpy(rgb[::2, ::2, 1].copy()).float() / 255
            return types.SimpleNamespace(depth=depth[None].numpy())
"""


@pytest.fixture
def python(tmp_path):
    """An interpreter with the package."""
    package, told = tmp_path / "site/depth_anything_3", tmp_path / "site/depth_anything_3-0.1.1.dist-info"
    for folder in (package, told):
        folder.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "api.py").write_text(textwrap.dedent(API))
    (told / "METADATA").write_text("Metadata-Version: 2.1\nName: depth-anything-3\nVersion: 0.1.1\n")
    launcher = tmp_path / "python"
    launcher.write_text(f'#!/bin/sh\nPYTHONPATH={tmp_path / "site"} exec {PYTHON} "$@"\n')
    launcher.chmod(0o755)
    return str(launcher)


def estimate(python, name, tmp_path):
    weights = tmp_path / name
    weights.mkdir()
    (weights / "model.safetensors").touch()
    settings = Settings(python=python, checkpoint=str(weights), resolution=28)
    with contextlib.closing(make_backend("depth", settings, None, Services(retries=QUICK))) as model:
        return model.estimate(picture(), camera=CAMERA, seed=0)


def test_its_depth_is_taken_as_it_is_and_in_metres_from_the_metric_model(python, tmp_path):
    relative, metres = (estimate(python, name, tmp_path) for name in ("DA3MONO-LARGE", "DA3METRIC-LARGE"))
    np.testing.assert_allclose(relative[:, 1:-1], np.broadcast_to(1 + np.linspace(0, 1, 60), (40, 60))[:, 1:-1], atol=0.02)
    np.testing.assert_allclose(metres, relative * CAMERA.focal[0] / 2 / 300, rtol=1e-5)
