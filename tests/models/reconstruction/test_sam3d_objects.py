"""The script that serves SAM-3D-Objects, with a clone whose `Inference` has the real one's arguments, axes and answers.

It computes with torch, and puts a box around the points in place of what the weights would make of them.
"""

import contextlib
import math
import subprocess
import textwrap

import numpy as np
import pytest

from tests.models.worker.scripts import PYTHON
from tests.synth.lifting.scenes import bare, observations, piece, site
from wm.geometry.placement.upright import transformed
from wm.geometry.placement.upright_box import box_iou, box_of
from wm.models.reconstruction import image_to_3d, sam3d_objects
from wm.services.faults import ServiceError
from wm.services.retries import RetryPolicy
from wm.services.services import Services
from wm.synth.registry import make_backend

pytest.importorskip("torch")

INFERENCE = """
    import os
    import numpy as np
    import torch
    import trimesh

    PREFIX = os.environ["CONDA_PREFIX"]  # the real one reads it when it is imported
    Z_UP_TO_Y_UP = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])


    class Inference:
        def __init__(self, config_file, compile=False):
            print("loading", config_file)
            assert os.path.isfile(config_file) and compile is False

        def __call__(self, image, mask, seed=None, pointmap=None):
            assert image.dtype == np.uint8 and image.shape == (*mask.shape, 3) and pointmap.shape == image.shape
            torch.manual_seed(seed)
            points = pointmap[torch.from_numpy(mask)]
            points = points[torch.isfinite(points).all(dim=1)].double()
            low, high = points.quantile(0.002, dim=0), points.quantile(0.998, dim=0)
            wide, tall, deep = (high - low).numpy()  # x left, y up, z forward
            scale = float(tall)
            model = trimesh.creation.box(extents=np.array([wide, deep, tall]) / scale)  # z up
            colors = np.tile(image[mask].mean(axis=0) / 255, (8, 1))
            glb = trimesh.Trimesh(model.vertices @ Z_UP_TO_Y_UP, model.faces, process=False)
            glb.visual.vertex_colors = colors
            half = 0.5**0.5  # rows times this rotation: x to the right, y forward, z up
            return {
                "glb": glb, "scale": torch.full((1, 3), scale), "rotation": torch.tensor([[0.0, 0.0, half, half]]),
                "translation": ((low + high) / 2)[None].float(), "gs": None,
            }
"""


@pytest.fixture
def clone(tmp_path):
    """A repository with a commit, in which the weights' configuration lies where the setup puts it."""
    for name, text in {"notebook/inference.py": INFERENCE, "checkpoints/hf/pipeline.yaml": "seed: 1\n"}.items():
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text(textwrap.dedent(text))
    git = ["git", "-C", str(tmp_path), "-c", "user.name=wm", "-c", "user.email=wm@localhost"]
    for command in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "A clone"]):
        subprocess.run([*git, *command], check=True)
    return tmp_path


def backend(clone, log=""):
    settings = sam3d_objects.Settings(python=PYTHON, repository=str(clone), log=str(log))
    return make_backend("reconstruction", settings, bare(), Services(retries=RetryPolicy(first=0.01, longest=0.01)))


def test_a_thing_comes_to_stand_where_the_model_says(clone, tmp_path, monkeypatch):
    monkeypatch.setattr(image_to_3d, "fitted", lambda *_: pytest.fail("the pose of the model was not used"))
    wardrobe = piece("wardrobe", 2.6, 0.35, math.pi, (1.3, 0.6, 2.0))
    seen = observations([wardrobe], 0)
    with contextlib.closing(backend(clone, tmp_path / "log.txt")) as model:
        result = model.reconstruct("oak wardrobe", seen, site(), 0, seed=2**32 - 1)
    assert result is not None and result.residual < 0.12
    thing = transformed(result.thing, np.linalg.inv(np.asarray(seen[0].camera.T_cam_world)))
    assert box_iou(box_of(thing), box_of(wardrobe)) > 0.3 and abs(box_of(thing).height - 2.0) < 0.2
    np.testing.assert_allclose(thing.slot_colors[0], [0.6, 0.3, 0.2], atol=1.5 / 255)
    assert f"loading {clone}/checkpoints/hf/pipeline.yaml" in (tmp_path / "log.txt").read_text()


def test_weights_that_are_not_there_are_named(clone):
    (clone / "checkpoints/hf/pipeline.yaml").unlink()
    with (
        contextlib.closing(backend(clone)) as model,
        pytest.raises(ServiceError, match=r"checkpoint=.*hf/pipeline\.yaml must be"),
    ):
        model.reconstruct(
            "wardrobe", observations([piece("wardrobe", 2.6, 0.35, math.pi, (1.3, 0.6, 2.0))], 0), site(), 0, seed=3
        )
