"""Any file of gaussians: PLY of INRIA, 2DGS, nerfstudio and PlayCanvas, point clouds, .splat, SPZ, SOG, GLB with gaussians.

Which way is up is `METHOD.up`, or what its cameras hold for up, or z. Antialiasing is `METHOD.antialias`, or what a PLY says.
"""

import pathlib

from wm.compare.adapters.files import check_some, one_file, reading
from wm.compare.adapters.own_cameras import own_cameras
from wm.compare.records import ComparedScene, Source, System
from wm.splat import splat_render_mode
from wm.splat.formats import load_splats

SUFFIXES = (".ply", ".splat", ".spz", ".sog")
SYSTEM = System(
    name="any gaussians",
    file=", ".join(SUFFIXES),
    up="METHOD.up, else by its cameras, else +z",
    scale="not known",
    colors="as the format has them",
    activations="exp, sigmoid",
    antialias=False,
    source="docs/comparison.md",
    commit="",
    options=("up", "antialias", "cameras"),
)
_EXPECTED = f"a file of gaussians ({', '.join(SUFFIXES)})"


def files(source: Source) -> list[pathlib.Path]:
    """The files whose content decides what is drawn. Raises: CompareError."""
    file = one_file(source, _EXPECTED, *(f"*{suffix}" for suffix in SUFFIXES))
    cameras = own_cameras(source, file).file
    return [file] if cameras is None else [file, cameras]


def read(source: Source) -> ComparedScene:
    """The scene, with the cameras of the transforms.json beside it. Raises: CompareError."""
    file = files(source)[0]
    gaussians = reading(source, file, _EXPECTED, load_splats)
    check_some(source, file, len(gaussians.means), _EXPECTED)
    told = file.suffix.lower() == ".ply" and splat_render_mode(file) == "mip"
    own = own_cameras(source, file, up="y" if file.suffix.lower() == ".glb" else "z")
    return ComparedScene(
        method=source.method,
        gaussians=gaussians,
        R_world_file=own.R_world_file,
        antialias=told if source.antialias is None else source.antialias,
        cameras=own.cameras,
    )
