"""WorldExplorer: `splat.ply`, nerfstudio's export of splatfacto-big trained with `rasterize_mode antialiased`.

Nerfstudio turns the poses so that z points up, centres them and scales them into a box, so the unit is not the metre. The file
says nothing of antialiasing; it must be drawn with it, or small gaussians come out too bright. `splat_rotated.ply` beside it is
the same scene turned for viewers (a quarter about x, half about y), its harmonics not turned with it: `splat.ply` is to be given.
"""

import pathlib

import numpy as np

from wm.compare.adapters.files import check_some, one_file, reading
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene, Source, System
from wm.splat import load_ply

SYSTEM = System(
    name="WorldExplorer",
    file="splat.ply",
    up="+z",
    scale="poses scaled into a box",
    colors="degree 3",
    activations="exp, sigmoid",
    antialias=True,
    source="mschneider456/worldexplorer: model/scene_expansion.py, model/rotate_ply.py",
    commit="e661fcc71fb6cf087bcd9cc676345e30e11aa6b2",
)
_EXPECTED = "WorldExplorer's exports/splat/splat.ply (INRIA's columns)"


def files(source: Source) -> list[pathlib.Path]:
    """The files whose content decides what is drawn. Raises: CompareError."""
    file = one_file(source, _EXPECTED, "splat.ply")
    if file.name == "splat_rotated.ply":
        raise CompareError(
            f"{source.method}: {file} has its rotations turned and its harmonics not; give the splat.ply beside it"
        )
    return [file]


def read(source: Source) -> ComparedScene:
    """The scene, seen from the middle of its poses. Raises: CompareError."""
    (file,) = files(source)
    gaussians = reading(source, file, _EXPECTED, load_ply)
    check_some(source, file, len(gaussians.means), _EXPECTED)
    return ComparedScene(method=source.method, gaussians=gaussians, antialias=True, eye=np.zeros(3))
