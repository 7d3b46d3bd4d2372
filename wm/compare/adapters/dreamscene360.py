"""DreamScene360: `point_cloud/iteration_<n>/point_cloud.ply`, INRIA's columns of degree 3.

The panorama's middle is the origin, z points up, and the farthest point lies at 1 / 0.7, so the unit is not the metre.
"""

import pathlib
import re

import numpy as np

from wm.compare.adapters.files import check_some, reading
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene, Source, System
from wm.splat import load_ply

SYSTEM = System(
    name="DreamScene360",
    file="point_cloud/iteration_<n>/point_cloud.ply, the highest n",
    up="+z",
    scale="the farthest point at 1.43",
    colors="degree 3",
    activations="exp, sigmoid",
    antialias=False,
    source="ShijieZhou-UCLA/DreamScene360: scene/gaussian_model.py, scene/__init__.py, utils/camera_utils.py",
    commit="5ae26fb09e4a1dcb5026f9f3556393ce995b7e7f",
)
_EXPECTED = "DreamScene360's point_cloud.ply (INRIA's columns with 45 f_rest), or the output folder that holds it"
_DEGREE_3 = 16


def files(source: Source) -> list[pathlib.Path]:
    """The file of the last iteration. Raises: CompareError."""
    if source.path.is_file():
        return [source.path]
    found = {
        int(match[1]): file
        for file in source.path.rglob("point_cloud.ply")
        if (match := re.fullmatch(r"iteration_(\d+)", file.parent.name))
    }
    if not found:
        raise CompareError(f"{source.method}: {source.path} holds no iteration_<n>/point_cloud.ply; expected {_EXPECTED}")
    return [found[max(found)]]


def read(source: Source) -> ComparedScene:
    """The scene, seen from the origin. Raises: CompareError."""
    (file,) = files(source)
    gaussians = reading(source, file, _EXPECTED, load_ply)
    check_some(source, file, len(gaussians.means), _EXPECTED)
    if gaussians.sh.shape[1] != _DEGREE_3:
        rest = 3 * (gaussians.sh.shape[1] - 1)
        raise CompareError(f"{source.method}: {file}: {rest} f_rest_* properties; expected {_EXPECTED}")
    return ComparedScene(method=source.method, gaussians=gaussians, eye=np.zeros(3))
