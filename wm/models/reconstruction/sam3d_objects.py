"""Reconstruction by SAM-3D-Objects, in the interpreter of its own environment (its setup asks for Linux and 32 GB on the device).

The script that serves it was written from its source (commit cf06676) and has not been run with its weights: neither they nor a
device were at hand. What wm does with its answers is tested with other workers.
Source: Meta, "SAM 3D: 3Dfy Anything in Images", 2025; github.com/facebookresearch/sam-3d-objects, SAM License.
"""

import dataclasses
import os
import pathlib

from wm.bounds import setting
from wm.models.reconstruction.image_to_3d import ImageTo3D, ImageTo3DSettings
from wm.models.worker.asking import WorkerModel
from wm.synth.backends import SceneContext

VERSION = "1"
SERVED = True
_SCRIPT = pathlib.Path(__file__).with_name("sam3d_objects_worker.py")


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(ImageTo3DSettings):
    """Reconstruction by SAM-3D-Objects."""

    backend: str = setting(__name__, "SAM-3D-Objects in its own interpreter.")
    repository: str = setting("", "Folder of the clone of sam-3d-objects, whose notebook/inference.py is used.")


def make(settings: Settings, context: SceneContext | None = None) -> ImageTo3D:
    """The backend. `checkpoint` is a pipeline.yaml; empty: checkpoints/hf/pipeline.yaml of the repository."""
    options = {"checkpoint": settings.checkpoint, "repository": os.path.expanduser(settings.repository)}
    return ImageTo3D(settings, WorkerModel(settings, options, _SCRIPT))
