"""FlexWorld: `<name>_gs_final_2.ply`, INRIA's columns without normals, whose f_dc are logits of the colours.

`save_ply` turns the positions half about z to suit a viewer and leaves the rotations as they were: the file's gaussians lie
wrongly until the positions are turned back. What is read here is the scene as FlexWorld draws it: axes of OpenGL (y up, the first
camera at the origin looks along -z), in the unit of a monocular reconstruction.
"""

import dataclasses
import pathlib

import numpy as np

from wm.compare.adapters.files import check_some, one_file, reading
from wm.compare.axes import UP, upright
from wm.compare.records import ComparedScene, Source, System
from wm.splat import load_ply
from wm.splat.rasterizer.harmonics import SH_C0

SYSTEM = System(
    name="FlexWorld",
    file="*_gs_final_2.ply",
    up="+y, after its positions are turned half about z",
    scale="of a monocular reconstruction",
    colors="logits of sRGB in f_dc, no harmonics",
    activations="exp, sigmoid, and sigmoid for colours",
    antialias=False,
    source="ML-GSAI/FlexWorld: ops/gs/base.py, main_3dgs.py",
    commit="f198109b42bd139ccca0588a6ae74be06a8f8cbd",
)
_EXPECTED = "FlexWorld's PLY (x y z f_dc opacity scale rot, f_dc as logits)"


def files(source: Source) -> list[pathlib.Path]:
    """The files whose content decides what is drawn. Raises: CompareError."""
    return [one_file(source, _EXPECTED, "*_gs_final_2.ply", "*.ply")]


def read(source: Source) -> ComparedScene:
    """The scene, seen from the origin. Raises: CompareError."""
    (file,) = files(source)
    stored = reading(source, file, _EXPECTED, load_ply)
    check_some(source, file, len(stored.means), _EXPECTED)
    color = 1 / (1 + np.exp(-stored.sh[:, :1].astype(np.float64)))
    gaussians = dataclasses.replace(
        stored, means=stored.means * np.array([-1, -1, 1], np.float32), sh=((color - 0.5) / SH_C0).astype(np.float32)
    )
    return ComparedScene(method=source.method, gaussians=gaussians, R_world_file=upright(UP["y"]), eye=np.zeros(3))
