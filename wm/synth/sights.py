"""What a view shows of a room's doors and windows, in words: so that no image model takes a doorway for a picture."""

import numpy as np
import shapely
from jaxtyping import Bool, Float

from wm.geometry.plan.site import Site, WallOpening
from wm.geometry.rays.pinhole import camera_center, project_points
from wm.types import Camera

_ASIDE = 0.35
"""Tangent of the angle from the middle of the image beyond which something is on one side."""
_NEAR = 0.2
"""Metres: what is nearer in front of the camera, such as the doorway it stands in, is not looked at."""
_POINTS = 5
"""Of an opening that are looked for, along it and up it."""
_SLACK = 0.02
"""Metres by which a line of sight may graze a wall."""


def sights(camera: Camera, site: Site) -> list[str]:
    """One phrase for each opening that lies in the image and is not behind a corner of the room; furniture may yet hide it."""
    found = []
    for wall, opening in site.openings:
        points = _points(opening, wall, site)
        pixels, depth = project_points(camera, points)
        framed = (depth > _NEAR) & (pixels >= 0).all(axis=1) & (pixels <= [camera.width, camera.height]).all(axis=1)
        seen = framed & _clear(camera_center(camera)[:2], points[:, :2], site.polygon)
        if seen.any():
            across = float(np.mean(pixels[seen, 0] - camera.principal[0]) / camera.focal[0])
            side = "on the left" if across < -_ASIDE else "on the right" if across > _ASIDE else "straight ahead"
            found.append(f"a {'doorway' if opening.kind == 'door' else opening.kind} {side}")
    return found


def _points(opening: WallOpening, wall: int, site: Site) -> Float[np.ndarray, "n 3"]:
    along, up = np.linspace(opening.low, opening.high, _POINTS), np.linspace(opening.sill, opening.head, _POINTS)
    floor = site.starts[wall] + along[:, None] * site.directions[wall]
    return np.concatenate([np.repeat(floor, _POINTS, axis=0), np.tile(up, _POINTS)[:, None]], axis=1)


def _clear(eye: Float[np.ndarray, "2"], points: Float[np.ndarray, "n 2"], room: shapely.Polygon) -> Bool[np.ndarray, "n"]:
    """Points to which no wall of the room bars the way; all of them for an eye outside it, which looks in through a doorway."""
    if not shapely.contains_xy(room, *eye):
        return np.ones(len(points), bool)
    lines = shapely.linestrings(np.stack([np.broadcast_to(eye, points.shape), points], axis=1))
    return np.asarray(shapely.covers(room.buffer(_SLACK), lines), bool)
