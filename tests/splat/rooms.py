"""A tiny scene with analytic images: boxes in a row, seen from inside, for the tests of the cloud and of the fits."""

import numpy as np

from wm.geometry.rays.pinhole import camera_center, camera_rays, make_camera
from wm.splat.optimization.training import TrainingView

SIZE = (4.0, 3.0, 2.5)
"""Every room of the row, metres; neighbours share a wall that is not there (an opening as large as the room)."""


def look(eye, target, *, room=0, rooms=1, width=40, height=24):
    """What a camera sees of the inside of a row of rooms along x."""
    camera = make_camera(np.array(eye, float), np.array(target, float), width=width, height=height, fov_deg=60.0)
    origin, rays = camera_center(camera), camera_rays(camera)
    high = np.array([SIZE[0] * rooms, SIZE[1], SIZE[2]])
    with np.errstate(divide="ignore"):
        t = np.where(rays > 0, (high - origin) / rays, np.where(rays < 0, -origin / rays, np.inf))
    axis = t.argmin(axis=1)
    depth = t.min(axis=1)
    points = origin + depth[:, None] * rays
    normal = -np.sign(rays) * (np.arange(3) == axis[:, None])
    shade = 0.5 + 0.2 * np.sin(3 * points + np.array([0.0, 1.0, 2.0])) + 0.1 * normal.sum(-1, keepdims=True)
    shape = (height, width)
    return TrainingView(
        camera=camera,
        rgb=(shade * 255 + 0.5).astype(np.uint8).reshape(*shape, 3),
        depth=depth.astype(np.float32).reshape(shape),
        mask=np.ones(shape, bool),
        room=room,
        own=(np.clip(np.floor(points[:, 0] / SIZE[0]), 0, rooms - 1) == room).reshape(shape),
        normal=normal.astype(np.float32).reshape(*shape, 3),
        sees=tuple(other for other in range(rooms) if other != room),
    )


def views_of(room=0, rooms=1, count=4, turn=0.0, **size):
    """Views from around the middle of a room."""
    centre = np.array([SIZE[0] * (room + 0.5), SIZE[1] / 2, 1.3])
    angles = 2 * np.pi * np.arange(count) / count + 0.2 + turn
    directions = np.stack([np.cos(angles), np.sin(angles), -0.2 + 0 * angles], axis=1)
    return [look(centre - 0.8 * d, centre + d, room=room, rooms=rooms, **size) for d in directions]
