"""Serves Depth Anything 3 (docs/workers.md). Run by the interpreter of its environment; nothing of wm is imported.

Written from the source of github.com/ByteDance-Seed/Depth-Anything-3 at commit 2c21ea8, and not run with its weights, which were
not at hand. What is relied on:

    depth_anything_3.api.DepthAnything3.from_pretrained(folder or name).to(device)
    .inference([rgb [h, w, 3] uint8], process_res=...).depth    [1, h', w'] float32: depth, larger is farther
    .model_name                                                 of the weights' config, such as "da3metric-large"
    da3metric-*                                                 metres = focal * depth / 300 (README, "Monocular Metric Depth")

The model estimates how far the sky is from pixels drawn at random, so that the seed is set before each image.
Options: checkpoint, resolution, device (cuda where there is one).
"""

import importlib
import importlib.metadata
import os

import numpy as np

FOCAL_OF_UNIT = 300.0
"""Pixels: the focal length for which the metric model's output is in metres."""


SCRIPT = "-1"
"""End of the version: changes when this script answers otherwise."""


def describe(options):
    package = importlib.metadata.version("depth-anything-3")
    return {"model": options["checkpoint"], "version": package + revision(options["checkpoint"]) + SCRIPT}


def load(options):
    torch = importlib.import_module("torch")
    model = importlib.import_module("depth_anything_3.api").DepthAnything3.from_pretrained(options["checkpoint"])
    device = options.get("device") or ("cuda" if torch.cuda.is_available() else "cpu")
    return torch, model.to(device), options["resolution"]


def answer(model, request, arrays):
    torch, network, resolution = model
    torch.manual_seed(0)
    depth = network.inference([arrays["rgb"]], process_res=resolution).depth[0]
    result = {"depth": np.asarray(depth, np.float32)}
    if not np.isfinite(result["depth"]).any():
        return {"refused": "the depth has no value that is a number"}
    return {**result, "focal_of_unit": FOCAL_OF_UNIT} if network.model_name.startswith("da3metric") else result


def revision(checkpoint):
    """What tells weights of the same name apart: the commit of the hub's cache, the size and time of a folder's weights."""
    if os.path.isdir(checkpoint):
        told = os.stat(os.path.join(checkpoint, "model.safetensors"))
        return f"-{told.st_size:x}-{told.st_mtime_ns:x}"
    cache = importlib.import_module("huggingface_hub").constants.HF_HUB_CACHE
    reference = os.path.join(cache, "models--" + checkpoint.replace("/", "--"), "refs", "main")
    if os.path.isfile(reference):
        with open(reference) as file:
            return "-" + file.read().strip()[:12]
    return ""
