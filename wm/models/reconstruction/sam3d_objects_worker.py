"""Serves SAM-3D-Objects (docs/workers.md). Run by the interpreter of its environment; nothing of wm is imported.

Written from the source of github.com/facebookresearch/sam-3d-objects at commit cf06676, and not run with its weights: neither
they nor a device were at hand. What is relied on:

    notebook/inference.py   Inference(config_file, compile=False)(image [h, w, 3] uint8, mask [h, w], seed=, pointmap=) -> dict;
                            importing it reads the variable CONDA_PREFIX
    pointmap                tensor [h, w, 3] in PyTorch3D's camera axes (x left, y up, z forward); NaN is let through
    "glb"                   a trimesh.Trimesh with vertex colours (sRGB), z-up vertices turned to y up: p_glb = UP^T p
    "scale"                 [1, 3], "rotation" [1, 4] wxyz, "translation" [1, 3]: PyTorch3D multiplies rows, so that
                            p_camera = R(rotation)^T (scale * p) + translation
    seed                    torch.manual_seed

Options: repository (the clone), checkpoint (pipeline.yaml; empty: checkpoints/hf/pipeline.yaml of the clone), compile.
"""

import importlib
import importlib.metadata
import os
import subprocess
import sys

import numpy as np

UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From the axes of the GLB (y up) to those of the model (z up)."""
PYTORCH3D = np.diag([-1.0, -1.0, 1.0])
"""From PyTorch3D's camera axes to OpenCV's, and back."""


SCRIPT = "-1"
"""End of the version: changes when this script answers otherwise."""


def describe(options):
    """The commit of the clone is the version: the package's own number has not changed since its release."""
    repository = options["repository"]
    if not os.path.isfile(os.path.join(repository, "notebook", "inference.py")):
        raise FileNotFoundError(f"repository={repository} must be a clone of sam-3d-objects, with notebook/inference.py")
    named = subprocess.run(["git", "-C", repository, "rev-parse", "HEAD"], capture_output=True, text=True, check=False)
    commit = named.stdout.strip()[:12] if named.returncode == 0 else importlib.metadata.version("sam3d_objects")
    return {"model": "sam-3d-objects", "version": commit + SCRIPT}


def load(options):
    os.environ.setdefault("CONDA_PREFIX", sys.prefix)
    repository = options["repository"]
    sys.path.insert(0, os.path.join(repository, "notebook"))
    config = options["checkpoint"] or os.path.join(repository, "checkpoints", "hf", "pipeline.yaml")
    if not os.path.isfile(config):
        raise FileNotFoundError(f"checkpoint={config} must be the pipeline.yaml of the weights (doc/setup.md of sam-3d-objects)")
    return importlib.import_module("inference").Inference(config, compile=bool(options.get("compile", False)))


def answer(model, request, arrays):
    if not arrays["mask"].any():
        return {"refused": "an empty mask"}
    torch = importlib.import_module("torch")
    pointmap = torch.from_numpy(np.ascontiguousarray(arrays["points"] @ PYTORCH3D.astype(np.float32)))
    output = model(arrays["rgb"], arrays["mask"], seed=int(request["seed"]), pointmap=pointmap)
    if output.get("glb") is None:
        return {"refused": "the model decoded no mesh"}
    scale, quaternion, translation = (
        output[name].detach().cpu().numpy().astype(np.float64).reshape(-1) for name in ("scale", "rotation", "translation")
    )
    return {"mesh.glb": output["glb"].export(file_type="glb"), **pose_of_glb(scale, quaternion, translation)}


def pose_of_glb(scale, quaternion, translation):
    """Where the points of the GLB lie in OpenCV's camera: rotation @ (scale * p) + translation.

    Args:
      scale: [3] along the model's axes.
      quaternion: [4] wxyz.
      translation: [3] in PyTorch3D's camera.
    """
    rotation = PYTORCH3D @ matrix_of(quaternion).T @ UP
    return {"scale": np.abs(UP.T) @ scale, "rotation": rotation, "translation": PYTORCH3D @ translation}


def matrix_of(quaternion):
    """[3, 3] the rotation of a quaternion wxyz, which need not be unit: v -> R v."""
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
