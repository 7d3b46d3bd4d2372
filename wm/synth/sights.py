"""Describes in words the doors and windows in a view, so that an image model does not mistake a doorway for a picture."""

import numpy as np
import shapely
from jaxtyping import Bool, Float

from wm.geometry.plan.site import Site, WallOpening
from wm.geometry.rays.pinhole import camera_center, project_points
from wm.types import Camera

_ASIDE = 0.35
"""Tangent of the angle from the optical axis beyond which an opening is said to be on the left or the right."""
_NEAR = 0.2
"""Metres. Points nearer to the camera are ignored, such as those of a doorway in which it stands."""
_POINTS = 5
"""Number of sample points along the width of an opening, and along its height."""
_SLACK = 0.02
"""Metres by which a line of sight may leave the room's floor polygon."""


def sights(camera: Camera, site: Site) -> list[str]:
    """One phrase for each opening that lies in the image and is not hidden by a wall of the room. Furniture is not considered."""
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
    """Points that no wall of the room hides; all points if the eye is outside the room, looking in through a doorway."""
    if not shapely.contains_xy(room, *eye):
        return np.ones(len(points), bool)
    lines = shapely.linestrings(np.stack([np.broadcast_to(eye, points.shape), points], axis=1))
    return np.asarray(shapely.covers(room.buffer(_SLACK), lines), bool)
