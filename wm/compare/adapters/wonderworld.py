"""WonderWorld: the .splat that `yield_splat_data` writes beside its PLY.

Colours and opacities are trained as clip(0.51 tanh(x), -0.5, 0.5) + 0.5, and the PLY holds the x of that, which others read as
something else. The .splat holds them activated. Both are read here.
World axes are PyTorch3D's (y up, the first camera looks along +z), in 1000ths of the unit of a monocular depth.
"""

import dataclasses
import pathlib

import numpy as np

from wm.compare.adapters.files import check_some, one_file, reading
from wm.compare.axes import UP, upright
from wm.compare.records import ComparedScene, Source, System
from wm.splat import load_ply
from wm.splat.formats import load_splats
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

SYSTEM = System(
    name="WonderWorld",
    file="*_finished_3dgs.splat, or finished_3dgs.ply",
    up="+y",
    scale="of a monocular depth, times 1000",
    colors="plain, no harmonics",
    activations="0.51 tanh + 0.5 for colours and opacities in the PLY; applied in the .splat",
    antialias=False,
    source="KovenYu/WonderWorld: scene/gaussian_model.py, util/utils.py",
    commit="e9f68db94f92e72c44fc50d4cdf6da865160af4d",
)
_EXPECTED = "WonderWorld's .splat (32 bytes a gaussian) or its finished_3dgs.ply (f_dc, opacity before tanh)"
_HIGHEST = 0.9999
"""Opacities of 1, which have no logit, are taken to be this; the rasterizer clamps them at 0.99 anyway."""


def files(source: Source) -> list[pathlib.Path]:
    """The files whose content decides what is drawn. Raises: CompareError."""
    return [one_file(source, _EXPECTED, "*_finished_3dgs.splat", "*.splat", "finished_3dgs.ply")]


def read(source: Source) -> ComparedScene:
    """The scene, seen from the origin. Raises: CompareError."""
    (file,) = files(source)
    if file.suffix == ".ply":
        gaussians = activated(reading(source, file, _EXPECTED, load_ply))
    else:
        gaussians = reading(source, file, _EXPECTED, load_splats)
    check_some(source, file, len(gaussians.means), _EXPECTED)
    return ComparedScene(method=source.method, gaussians=gaussians, R_world_file=upright(UP["y"]), eye=np.zeros(3))


def activated(gaussians: Gaussians) -> Gaussians:
    """Gaussians as everyone reads them, from the values before WonderWorld's activation."""

    def unit(x: np.ndarray) -> np.ndarray:
        return np.clip(0.51 * np.tanh(x.astype(np.float64)), -0.5, 0.5) + 0.5

    opacity = np.clip(unit(gaussians.opacity_logits), 1e-9, _HIGHEST)
    return dataclasses.replace(
        gaussians,
        opacity_logits=np.log(opacity / (1 - opacity)).astype(np.float32),
        sh=((unit(gaussians.sh) - 0.5) / SH_C0).astype(np.float32),
    )
