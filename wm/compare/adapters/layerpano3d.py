"""LayerPano3D: `gsplat_layer<k>.ply`, INRIA's columns of degree 3 with zeros for all higher coefficients.

Each file holds the gaussians of its layer and of all layers below it (`LayerGaussian.save_ply` writes the static ones too, and
its own videos draw one file), so that the last layer is the scene: to merge the files would draw everything twice.
The panorama's middle is the origin; y points down, and depths are a network's, times 200 or not.
"""

import pathlib
import re

import numpy as np

from wm.compare.adapters.files import check_some, reading
from wm.compare.axes import UP, upright
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene, Source, System
from wm.splat import load_ply

SYSTEM = System(
    name="LayerPano3D",
    file="gsplat_layer<k>.ply, the highest k",
    up="-y",
    scale="of a monocular depth",
    colors="degree 3, higher coefficients 0",
    activations="exp, sigmoid",
    antialias=False,
    source="3DTopia/LayerPano3D: LayerPano.py, scene/layer_gaussian_model.py, rendering/render_video_360.py",
    commit="05d3bb50ce2dca90b50b49977a7dc48c3d3036db",
)
_EXPECTED = "LayerPano3D's gsplat_layer<k>.ply, or the folder that holds them"
_LAYER = re.compile(r"gsplat_layer(\d+)\.ply")


def files(source: Source) -> list[pathlib.Path]:
    """The last layer's file. Raises: CompareError."""
    if source.path.is_file():
        return [source.path]
    layers = {int(match[1]): file for file in source.path.rglob("*.ply") if (match := _LAYER.fullmatch(file.name))}
    if not layers:
        raise CompareError(f"{source.method}: {source.path} holds no gsplat_layer<k>.ply; expected {_EXPECTED}")
    missing = sorted(set(range(max(layers))) - set(layers))
    if missing:
        raise CompareError(f"{source.method}: {source.path} lacks gsplat_layer{missing[0]}.ply of {max(layers) + 1} layers")
    return [layers[max(layers)]]


def read(source: Source) -> ComparedScene:
    """The scene, seen from the origin. Raises: CompareError."""
    (file,) = files(source)
    gaussians = reading(source, file, _EXPECTED, load_ply)
    check_some(source, file, len(gaussians.means), _EXPECTED)
    return ComparedScene(method=source.method, gaussians=gaussians, R_world_file=upright(UP["-y"]), eye=np.zeros(3))
