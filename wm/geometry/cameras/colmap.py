"""Cameras and points as COLMAP's sparse model in text, which most trainers of gaussians read.

A model is three files: `cameras.txt` (PINHOLE: width, height, fx, fy, cx, cy), `images.txt` (world to camera as quaternion wxyz
and translation, OpenCV axes, and an empty line of 2D points), `points3D.txt` (place, colour, error 0, no track).

Source: COLMAP's documentation, "Output format".
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float, UInt8
from scipy.spatial.transform import Rotation

from wm.types import View


def save_colmap(
    folder: str | Path,
    views: Sequence[View],
    points: Float[np.ndarray, "n 3"],
    colors: UInt8[np.ndarray, "n 3"],
    *,
    suffix: str = ".png",
) -> None:
    """Write a sparse model of views and coloured points into a folder, which is made if need be; equal views give equal bytes.

    Args:
        folder: usually `sparse/0` beside the images.
        views: each becomes an image of its name and the suffix, with a camera of its own.
        points: metres, world.
        colors: sRGB, 8 bits.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    cameras, images = [], []
    for k, view in enumerate(views, 1):
        camera = view.camera
        intrinsics = [*np.asarray(camera.focal, np.float64), *np.asarray(camera.principal, np.float64)]
        cameras.append(f"{k} PINHOLE {camera.width} {camera.height} {_numbers(intrinsics)}")
        T = np.asarray(camera.T_cam_world, np.float64)
        quaternion = Rotation.from_matrix(T[:3, :3]).as_quat(canonical=True)[[3, 0, 1, 2]]
        images.append(f"{k} {_numbers([*quaternion, *T[:3, 3]])} {k} {view.name}{suffix}\n")
    cloud = [f"{k} {_numbers(p)} {c[0]} {c[1]} {c[2]} 0" for k, (p, c) in enumerate(zip(points, colors), 1)]
    for name, lines in (("cameras", cameras), ("images", images), ("points3D", cloud)):
        (folder / f"{name}.txt").write_text("".join(f"{line}\n" for line in lines), encoding="utf-8", newline="\n")


def _numbers(values: Sequence[float] | np.ndarray) -> str:
    return " ".join(f"{float(value):.10g}" for value in values)
