"""Where a room's cameras would stand if it were empty: along its walls, and at the middles of its short sides."""

import numpy as np
import shapely
from jaxtyping import Float

from wm.geometry.cameras.air import RoomAir


def walk_line(air: RoomAir, start: Float[np.ndarray, "2"], count: int, phase: float) -> Float[np.ndarray, "n 2"]:
    """`count` points along the walls, `air.offset` inside them, evenly by arc length, the first `phase` steps after `start`."""
    walk = air.floor.buffer(-air.offset, join_style="mitre")
    rings = list(shapely.get_exterior_ring(shapely.get_parts(walk))) or [air.floor.representative_point()]
    longest = max(rings, key=lambda ring: ring.length)
    rings = [longest, *(ring for ring in rings if ring is not longest)]
    ends = np.cumsum([ring.length for ring in rings])
    first = shapely.line_locate_point(longest, shapely.Point(start)) if longest.length else 0.0
    along = (np.arange(count) + phase) * ends[-1] / max(count, 1)
    points = []
    for distance in along:
        ring = min(int(np.searchsorted(ends, distance, side="right")), len(rings) - 1)
        local = distance - (ends[ring] - rings[ring].length)
        if ring == 0 and longest.length:
            local = (local + first) % longest.length
        points.append(rings[ring].interpolate(local).coords[0] if rings[ring].length else rings[ring].coords[0])
    return np.array(points).reshape(-1, 2)


def short_sides(air: RoomAir) -> Float[np.ndarray, "2 2"]:
    """The middles of the two short sides of the room, `air.offset` inside.

    The sides are those of the floor's smallest rectangle; of a side that is only partly wall, the longest piece counts.
    """
    corners = shapely.get_coordinates(shapely.oriented_envelope(air.floor))[:4]
    if np.linalg.norm(corners[1] - corners[0]) > np.linalg.norm(corners[2] - corners[1]) + 1e-9:
        corners = np.roll(corners, -1, axis=0)
    across = corners[1] - corners[0]
    along = corners[2] - corners[1]
    inward = along / np.linalg.norm(along) * min(air.offset, np.linalg.norm(along) / 2)
    middles = []
    for corner, step in ((corners[0], inward), (corners[3], -inward)):
        line = shapely.LineString([corner + step, corner + step + across])
        pieces = [piece for piece in shapely.get_parts(line.intersection(air.floor)) if piece.length > 0]
        piece = max(pieces, key=lambda part: part.length) if pieces else line
        middles.append(np.mean(np.asarray(piece.coords), axis=0))
    return np.array(middles)
