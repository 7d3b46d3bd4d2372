"""The straight walls of a plan and which rooms stand behind them.

A wall is a maximal straight run of a room's polygon: points in the middle of a straight edge change nothing. Two walls are
shared where they run against each other within SHARED metres, in part or in full; a wall that is shared at least in part is
a shared wall, half as thick on either side as an exterior one (paper, section "Floor Plan Generation"). Pairs come from an
STRtree, so that the cost is linear in the number of rooms.
"""

import dataclasses
import functools

import numpy as np
import shapely

from wm.geometry.plan.records import FloorPlan, Room

SHARED = 0.01  # metres within which walls are one: the paper's tolerance
_BATCH = 1024  # walls per query of the tree
_STRAIGHT = 1e-6  # metres a point may lie off the line of its neighbours and still be on one wall
_ONE_PLACE = 1e-6  # metres within which neighbouring corners are one


@dataclasses.dataclass(frozen=True)
class Behind:
    """A stretch of a wall with another room on its other side."""

    room: int
    low: float  # metres along the wall
    high: float
    gap_low: float  # signed distance of the other wall outside this one at `low`, within +-SHARED
    gap_high: float  # and at `high`
    thickness: float  # metres from the other room's edge to its inner face

    @property
    def slope(self) -> float:
        """Metres by which the gap grows over a metre of wall."""
        return (self.gap_high - self.gap_low) / (self.high - self.low)

    def gap(self, along: float) -> float:
        """The signed distance of the other wall outside this one, metres along it."""
        return self.gap_low + self.slope * (along - self.low)


@dataclasses.dataclass(frozen=True, eq=False)
class Wall:
    """One straight wall of one room, its interior on the left of start -> end."""

    room: int
    start: np.ndarray  # [2]
    direction: np.ndarray  # [2] unit, counter-clockwise around the room
    normal: np.ndarray  # [2] unit, into the room
    length: float
    thickness: float  # metres from the polygon's edge to the inner face
    behind: tuple[Behind, ...]  # by increasing `low`; none: an exterior wall
    ring: int = 0  # of the room's outline (0) or of the hole (1, 2 ...) that the wall is part of


def distinct(points: np.ndarray) -> np.ndarray:
    """The points [k, 2] of a ring less those at the place of the one before them."""
    apart = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1) > _ONE_PLACE
    return points[apart] if apart.any() else points[:1]


def straight_ring(polygon: np.ndarray) -> np.ndarray:
    """The corners of a simple polygon: its points [k, 2] less those in the middle of a straight edge."""
    ring = polygon
    while len(ring) > 3:
        before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
        chord = after - before
        length = np.maximum(np.linalg.norm(chord, axis=1), np.finfo(float).tiny)
        off = np.abs(_cross(chord, ring - before)) / length
        straight = (off <= _STRAIGHT) & (np.sum((ring - before) * (after - ring), axis=1) > 0)
        # Of two neighbouring candidates only one is removed per pass: the distance of the other has to be measured again.
        straight &= ~np.roll(straight, 1) | (np.arange(len(ring)) % 2 == 0)
        if not straight.any():
            break
        ring = ring[~straight]
    return ring


def room_polygons(plan: FloorPlan) -> np.ndarray:
    """[rooms] shapely polygons with their holes, for its vectorised functions."""
    return np.array([room_polygon(room) for room in plan.rooms], dtype=object)


def room_polygon(room: Room) -> shapely.Polygon:
    """A room from above up to the lines of its walls; columns are part of it."""
    return shapely.Polygon(room.polygon, room.holes)


@functools.lru_cache(maxsize=4)
def plan_walls(plan: FloorPlan) -> tuple[tuple[Wall, ...], ...]:
    """The walls of every room, counter-clockwise, with the rooms behind them. Polygons must be simple.

    They are computed once per plan: plans are read-only and compared by identity.
    """
    owned = [(k, number, _ring(room, ring)) for k, room in enumerate(plan.rooms) for number, ring in enumerate(_rings(room))]
    rings = [ring for _, _, ring in owned]
    sizes = [len(ring) for ring in rings]
    room, number = np.repeat([k for k, _, _ in owned], sizes), np.repeat([number for _, number, _ in owned], sizes)
    start = np.concatenate(rings)
    span = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings]) - start
    length = np.linalg.norm(span, axis=1)
    direction = span / length[:, None]
    said = _said(plan, room, start, direction, length)
    behind = _shared_stretches(room, start, direction, length, said, plan.wall_thickness)
    walls: list[list[Wall]] = [[] for _ in plan.rooms]
    for k in range(len(room)):
        walls[room[k]].append(
            Wall(
                room=int(room[k]),
                start=start[k],
                direction=direction[k],
                normal=np.array([-direction[k, 1], direction[k, 0]]),
                length=float(length[k]),
                thickness=float(behind.thickness[k]),
                behind=tuple(sorted(behind.stretches[k], key=lambda stretch: (stretch.low, stretch.room))),
                ring=int(number[k]),
            )
        )
    return tuple(tuple(of_room) for of_room in walls)


def _rings(room: Room) -> tuple[np.ndarray, ...]:
    return (room.polygon, *room.holes)


def _ring(room: Room, ring: np.ndarray) -> np.ndarray:
    """The corners of one ring, and the points at which a wall of another thickness begins."""
    corners = straight_ring(ring)
    if not room.walls:
        return corners
    after = np.roll(corners, -1, axis=0)
    points = []
    for start, end in zip(corners, after):
        span = end - start
        length = float(np.linalg.norm(span))
        ends = np.concatenate([wall.segment for wall in room.walls])
        along, off = (ends - start) @ span / length, np.abs(_cross(ends - start, span[None] / length))
        inside = (off <= SHARED) & (along > SHARED) & (along < length - SHARED)
        points += [start, *(start + s * span / length for s in sorted(set(along[inside].round(9).tolist())))]
    return np.array(points)


def _said(plan: FloorPlan, room, start, direction, length) -> np.ndarray:
    """[walls] metres of thickness that a room says of a wall; NaN where it says nothing."""
    said = np.full(len(room), np.nan)
    middle = start + direction * length[:, None] / 2
    for k, index in enumerate(room.tolist()):
        for wall in plan.rooms[index].walls:
            if shapely.LineString(wall.segment).distance(shapely.Point(middle[k])) <= SHARED:
                said[k] = wall.thickness
    return said


@dataclasses.dataclass(frozen=True, eq=False)
class _Shared:
    stretches: list[list[Behind]]
    thickness: np.ndarray  # [walls] metres, on the room's own side


def _shared_stretches(room, start, direction, length, said, usual: float) -> _Shared:
    """For each wall, the stretches along which a wall of another room runs against it, and how thick it is.

    A shared wall is as thick as either room says, the thicker of the two; half of it is on either side.
    """
    end = start + direction * length[:, None]
    lines = np.asarray(shapely.linestrings(np.stack([start, end], axis=1)))
    i, j = _facing(room, direction, lines)
    # Wall j in the frame of wall i: along it from `near` to `far` (it runs the other way), and how far outside it lies.
    near = np.sum((end[j] - start[i]) * direction[i], axis=1)
    far = np.sum((start[j] - start[i]) * direction[i], axis=1)
    near_gap = _cross(end[j] - start[i], direction[i])
    far_gap = _cross(start[j] - start[i], direction[i])
    low, high = np.maximum(near, 0), np.minimum(far, length[i])
    slope = (far_gap - near_gap) / (far - near)
    low_gap, high_gap = near_gap + slope * (low - near), near_gap + slope * (high - near)
    tolerance = SHARED + 1e-9
    shared = (high - low > SHARED) & (np.abs(low_gap) <= tolerance) & (np.abs(high_gap) <= tolerance)
    pairs = np.flatnonzero(shared)
    whole = said.copy()
    np.fmax.at(whole, i[pairs], said[j[pairs]])
    whole = np.where(np.isnan(whole), usual, whole)
    inner = np.isin(np.arange(len(room)), i[pairs])
    thickness = np.where(inner, whole / 2, whole)
    behind: list[list[Behind]] = [[] for _ in room]
    for k in pairs:
        gaps = float(low_gap[k]), float(high_gap[k])
        behind[i[k]].append(Behind(int(room[j[k]]), float(low[k]), float(high[k]), *gaps, float(thickness[j[k]])))
    return _Shared(behind, thickness)


def _facing(room: np.ndarray, direction: np.ndarray, lines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of walls of different rooms that run in opposite directions within SHARED of each other."""
    tree = shapely.STRtree(lines)
    pairs = []
    for first in range(0, len(lines), _BATCH):  # bounds the memory that a hostile plan can ask for
        i, j = tree.query(lines[first : first + _BATCH], predicate="dwithin", distance=SHARED)
        i = i + first
        apart = (room[i] != room[j]) & (np.sum(direction[i] * direction[j], axis=1) < -0.5)
        pairs.append((i[apart], j[apart]))
    return np.concatenate([i for i, _ in pairs]), np.concatenate([j for _, j in pairs])


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The z component of a x b for [n, 2] arrays."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
