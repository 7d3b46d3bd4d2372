"""An equirectangular panorama of each room, for methods that start from one: colours, and distances from the place.

    panorama/ROOM.png        [h, 2h] sRGB. The middle column looks along +x; columns to its right turn clockwise seen from above;
                             the first row looks straight up
    panorama/ROOM.depth.png  distances along the rays, not z-depths, 16 bits of millimetres; 0 where nothing is
    panorama/ROOM.json       the place [3] in the house, metres, z up

The gaussians are rendered on six faces of a cube, whose pixels are looked up bilinearly; a face is a little wider than a quarter,
so that no look-up reaches beyond it. DreamScene360 and LayerPano3D take the same layout of columns and rows.
"""

import pathlib

import numpy as np
from jaxtyping import Float

from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import json_text
from wm.codecs import encode_png
from wm.color import to_bytes
from wm.compare.bilinear import bilinear
from wm.compare.drawing import Drawer
from wm.compare.inputs.spatialgen import millimetres
from wm.compare.inputs.standing import standing_place
from wm.finished import FinishedRun
from wm.geometry.rays.pinhole import camera_rays, camera_rotation, make_camera

HEIGHT = 1024
_FACES = ((1, 0, 0), (0, -1, 0), (-1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1))
_MARGIN = 1.03  # width of a face over that of a quarter


def write_panorama(run: FinishedRun, draw: Drawer, folder: pathlib.Path, *, height: int = HEIGHT) -> list[pathlib.Path]:
    """Writes the panorama of every room; returns the pictures. Raises: InputError where a room has no free place."""
    pictures = []
    for room, name in enumerate(run.rooms):
        eye = standing_place(run, room)
        rgb, distance = panorama(draw, eye, height)
        write_atomically(folder / f"{name}.png", encode_png(to_bytes(rgb)))
        write_atomically(folder / f"{name}.depth.png", millimetres(distance))
        write_atomically(folder / f"{name}.json", json_text({"eye": eye.round(6).tolist(), "units": "meters", "up": "z"}))
        pictures.append(folder / f"{name}.png")
    return pictures


def panorama(draw: Drawer, eye: Float[np.ndarray, "3"], height: int) -> tuple[np.ndarray, np.ndarray]:
    """Colours [h, 2h, 3] and distances [h, 2h] all round a place."""
    side = max(16, height // 2)
    rays = directions(height)
    forward = np.argmax(rays @ np.array(_FACES, np.float64).T, axis=-1)
    rgb, distance = np.zeros((*forward.shape, 3), np.float32), np.zeros(forward.shape, np.float32)
    fov = float(np.degrees(2 * np.arctan(_MARGIN)))
    for index, ahead in enumerate(_FACES):
        camera = make_camera(eye, eye + np.array(ahead, np.float64), width=side, height=side, fov_deg=fov)
        seen = draw(camera)
        length = np.linalg.norm(camera_rays(camera), axis=1).reshape(side, side)
        values = np.concatenate([np.asarray(seen.rgb), (np.asarray(seen.depth) * length)[..., None]], axis=-1)
        own = forward == index
        local = rays[own] @ camera_rotation(camera).T
        found = bilinear(values, local[:, :2] / local[:, 2:] * camera.focal + camera.principal)
        rgb[own], distance[own] = found[:, :3], found[:, 3]
    return rgb, distance


def directions(height: int) -> Float[np.ndarray, "h w 3"]:
    """Unit rays through the pixels' centres."""
    elevation = np.pi / 2 - (np.arange(height) + 0.5) * np.pi / height
    azimuth = np.pi - (np.arange(2 * height) + 0.5) * np.pi / height
    across, up = np.cos(elevation)[:, None], np.sin(elevation)[:, None]
    return np.stack(np.broadcast_arrays(across * np.cos(azimuth), across * np.sin(azimuth), up), axis=-1)
