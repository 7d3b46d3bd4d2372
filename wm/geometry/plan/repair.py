"""Walls drawn as gaps, overlaps or askew, made one line each: `plan.repair=true`.

Plans of editors and surveys often give the clear space of each room, so that rooms lie a wall's thickness apart. Edges of two
rooms face each other where they run in opposite directions within TURN of each other, at most WIDEST apart (or overlapping by
OVERLAP) with no other room between. Edges that face one another, from pair to pair, are one wall. All edges of a wall are put on
one line: half-way between its outermost edges, in the direction of its longest. The corners of a room are where its lines then
meet, so that the room stays closed whatever the gaps around it; its openings keep their places along the wall.

A room that lies within another, as editors draw closets, is cut out of it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely

from wm.geometry.plan.connected import joined_rooms
from wm.geometry.plan.openings import opening_ends
from wm.geometry.plan.records import Opening, Room, ThickWall
from wm.geometry.plan.snapping import EXACT
from wm.geometry.plan.walls import distinct, room_polygon, straight_ring

WIDEST = 0.505  # metres between two rooms that one wall may stand for
OVERLAP = 0.1  # metres by which two rooms may overlap along a wall
TURN = 1.5  # degrees between the two sides of one wall
_ALONG = 0.05  # metres of wall at least along which two edges face each other
_WITHIN = 0.98  # share of a room's area that lies in another from which it is a room in a room
_DUST = 1e-4  # square metres of a room that count as nothing
_FREE = 0.05  # share of the gap between two edges that another room may reach into


@dataclasses.dataclass(frozen=True, eq=False)
class _Edges:
    """The straight edges of all rooms, interior on the left."""

    room: np.ndarray  # [e]
    ring: np.ndarray  # [e] number of the ring over all rooms
    start: np.ndarray  # [e, 2]
    end: np.ndarray  # [e, 2]

    @property
    def length(self) -> np.ndarray:
        return np.linalg.norm(self.end - self.start, axis=1)

    @property
    def direction(self) -> np.ndarray:
        return (self.end - self.start) / self.length[:, None]


def repaired(rooms: Sequence[Room]) -> tuple[tuple[Room, ...], tuple[str, ...]]:
    """The rooms with their walls closed onto common lines, and a sentence with its size for each change.

    Rooms must have simple polygons. Where a room would not be simple afterwards, no wall is moved.
    """
    cut, notes = _cut_out(rooms)
    edges = _edges(cut)
    pairs, gaps = _facing(cut, edges)
    moved = _moved(cut, edges, _lines(edges, pairs))
    if moved is None:
        return cut, notes
    return moved, (*notes, *_told(cut, moved, edges, pairs, gaps))


def _cut_out(rooms: Sequence[Room]) -> tuple[tuple[Room, ...], tuple[str, ...]]:
    """Rooms that lie within others, cut out of them; not those of the same outline, which are storeys."""
    result, notes = list(rooms), []
    for inner in sorted(range(len(rooms)), key=lambda k: shapely.Polygon(rooms[k].polygon).area):
        hole = shapely.Polygon(rooms[inner].polygon)
        for outer, room in enumerate(result):
            around = room_polygon(room)
            within = around.intersection(hole).area
            if outer == inner or around.area * _WITHIN < hole.area or within < _WITHIN * hole.area:
                continue
            parts = [part for part in shapely.get_parts(around.difference(hole)) if part.area > _DUST]
            if len(parts) == 1:
                outline, *holes = (np.asarray(ring.coords)[:-1] for ring in _rings_of(parts[0]))
                result[outer] = dataclasses.replace(room, polygon=outline, holes=tuple(holes))
                notes.append(f"room {room.id}: {rooms[inner].id}, which lies in it, is cut out of it ({within:.3g} m^2)")
    return tuple(result), tuple(notes)


def _rings_of(polygon: shapely.Polygon) -> list[shapely.LinearRing]:
    """Outline counter-clockwise, holes clockwise."""
    polygon = shapely.simplify(shapely.orient_polygons(polygon), 2 * EXACT)
    return [polygon.exterior, *polygon.interiors]


def _edges(rooms: Sequence[Room]) -> _Edges:
    room, ring, start, end, count = [], [], [], [], 0
    for k, one in enumerate(rooms):
        for points in (one.polygon, *one.holes):
            corners = straight_ring(points)
            room += [k] * len(corners)
            ring += [count] * len(corners)
            start.append(corners)
            end.append(np.roll(corners, -1, axis=0))
            count += 1
    return _Edges(np.array(room), np.array(ring), np.concatenate(start), np.concatenate(end))


def _facing(rooms: Sequence[Room], edges: _Edges) -> tuple[np.ndarray, np.ndarray]:
    """[p, 2] pairs of edges that are the two sides of one wall, and the gap [p] between them, negative where they overlap."""
    lines = np.asarray(shapely.linestrings(np.stack([edges.start, edges.end], axis=1)))
    i, j = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=WIDEST)
    direction, length = edges.direction, edges.length
    turned = np.sum(direction[i] * direction[j], axis=1) < -np.cos(np.radians(TURN))
    later = (i < j) & (edges.room[i] != edges.room[j]) & turned
    polygons = [room_polygon(room) for room in rooms]
    tree = shapely.STRtree(polygons)
    pairs, gaps = [], []
    for a, b in zip(i[later].tolist(), j[later].tolist()):
        offsets = np.stack([edges.end[b], edges.start[b]]) - edges.start[a]
        low, high = (float(x) for x in np.clip(offsets @ direction[a], 0.0, length[a]))
        outward = np.array([direction[a, 1], -direction[a, 0]])
        apart = float(np.mean(offsets @ outward))
        if high - low < _ALONG or not -OVERLAP <= apart <= WIDEST:
            continue
        if apart > EXACT and _is_occupied(edges, (a, b), (low, high), outward, polygons, tree):
            continue
        pairs.append((a, b))
        gaps.append(apart)
    return np.array(pairs, dtype=int).reshape(-1, 2), np.array(gaps)


def _is_occupied(edges: _Edges, pair: tuple[int, int], span: tuple[float, float], outward: np.ndarray, polygons, tree) -> bool:
    """Whether a room lies between the two sides of what may be a wall."""
    a, b = pair
    near = edges.start[a] + np.array([[span[0]], [span[1]]]) * edges.direction[a]
    depth = (np.array([edges.start[b], edges.end[b]]) - edges.start[a]) @ outward
    gap = shapely.Polygon([*near, near[1] + depth.mean() * outward, near[0] + depth.mean() * outward])
    taken = sum(polygons[k].intersection(gap).area for k in tree.query(gap).tolist())
    return taken > _FREE * gap.area + OVERLAP * EXACT


def _lines(edges: _Edges, pairs: np.ndarray) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """For each edge that moves, a point and the direction of its new line."""
    groups = joined_rooms(len(edges.room), [(int(a), int(b)) for a, b in pairs])
    lines: dict[int, tuple[np.ndarray, np.ndarray]] = {}
    for group in groups:
        members = np.array(group)
        longest = int(members[np.argmax(edges.length[members])])
        direction = edges.direction[longest]
        normal = np.array([-direction[1], direction[0]])
        origin = edges.start[longest]
        ends = np.stack([edges.start[members], edges.end[members]], axis=1)
        offsets = (ends - origin) @ normal
        if np.ptp(offsets) <= EXACT or np.ptp(offsets) > 2 * WIDEST:
            continue
        middles = offsets.mean(axis=1)
        point = origin + (middles.min() + middles.max()) / 2 * normal
        lines |= {int(k): (point, direction) for k in members}
    return lines


def _moved(rooms: Sequence[Room], edges: _Edges, lines: dict[int, tuple[np.ndarray, np.ndarray]]) -> tuple[Room, ...] | None:
    """The rooms with their edges on their new lines; None where that leaves a room that is not simple."""
    if not lines:
        return None
    result, ring = [], 0
    for room in rooms:
        rings = []
        for _ in (room.polygon, *room.holes):
            mine = np.flatnonzero(edges.ring == ring)
            rings.append(_ring(edges, mine, lines) if any(int(k) in lines for k in mine) else edges.start[mine])
            ring += 1
        before = np.flatnonzero(edges.room == len(result))
        if not any(int(k) in lines for k in before):
            result.append(room)
            continue
        polygon = shapely.Polygon(rings[0], rings[1:]) if all(len(one) >= 3 for one in rings) else shapely.Polygon()
        if not polygon.is_valid or not 0.5 < polygon.area / room_polygon(room).area < 2.0:
            return None
        carried = _Carried(edges, before, lines)
        result.append(
            dataclasses.replace(
                room,
                polygon=rings[0],
                holes=tuple(rings[1:]),
                openings=tuple(carried.opening(opening) for opening in room.openings),
                walls=tuple(ThickWall(carried.segment(wall.segment), wall.thickness) for wall in room.walls),
            )
        )
    return tuple(result)


def _ring(edges: _Edges, mine: np.ndarray, lines: dict[int, tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """The corners at which the edges of one ring meet on their new lines."""
    corners = []
    for before, after in zip(np.roll(mine, 1).tolist(), mine.tolist()):
        corner = edges.start[after]
        (p, u), (q, v) = (lines.get(k, (edges.start[k], edges.direction[k])) for k in (before, after))
        cross = u[0] * v[1] - u[1] * v[0]
        if before not in lines and after not in lines:
            corners.append(corner)
        elif abs(cross) < np.sin(np.radians(2 * TURN)):  # nearly one line: there is no corner between them to compute
            moving = (p, u) if before in lines else (q, v)
            corners.append(moving[0] + (corner - moving[0]) @ moving[1] * moving[1])
        else:
            along = ((q - p)[0] * v[1] - (q - p)[1] * v[0]) / cross
            corners.append(p + along * u)
    return distinct(np.array(corners))


@dataclasses.dataclass(frozen=True, eq=False)
class _Carried:
    """What lies on the edges of one room goes with them, straight across."""

    edges: _Edges
    mine: np.ndarray
    lines: dict[int, tuple[np.ndarray, np.ndarray]]

    def segment(self, ends: np.ndarray) -> np.ndarray:
        """[2, 2] on the new line of the edge it lies nearest to."""
        middle = ends.mean(axis=0)
        start, direction = self.edges.start[self.mine], self.edges.direction[self.mine]
        along = np.clip(np.sum((middle - start) * direction, axis=1), 0.0, self.edges.length[self.mine])
        away = np.linalg.norm(start + along[:, None] * direction - middle, axis=1)
        span = ends[1] - ends[0]
        skew = np.abs(direction @ np.array([-span[1], span[0]])) / max(float(np.linalg.norm(span)), EXACT)
        nearest = int(self.mine[np.argmin(away + skew)])
        if nearest not in self.lines:
            return ends
        point, onward = self.lines[nearest]
        return point + ((ends - point) @ onward)[:, None] * onward

    def opening(self, opening: Opening) -> Opening:
        """The opening at the same place along its wall, as wide as it was."""
        before = opening_ends(opening)
        after = self.segment(before)
        if np.abs(after - before).max() <= EXACT:
            return opening
        span = after[1] - after[0]
        half = opening.width / 2 * span / np.linalg.norm(span)
        return dataclasses.replace(opening, segment=after.mean(axis=0) + np.stack([-half, half]), position=0.0)


def _told(before: Sequence[Room], after: Sequence[Room], edges: _Edges, pairs: np.ndarray, gaps: np.ndarray) -> list[str]:
    """One sentence for each pair of rooms whose wall was closed, and one for each other room whose walls went with it."""
    widest: dict[tuple[int, int], float] = {}
    for (a, b), gap in zip(pairs.tolist(), gaps.tolist()):
        key = (int(edges.room[a]), int(edges.room[b]))
        if abs(gap) > 10 * EXACT and abs(gap) > abs(widest.get(key, 0.0)):
            widest[key] = gap
    notes = []
    for (a, b), gap in sorted(widest.items()):
        what = "gap" if gap > 0 else "overlap"
        notes.append(f"the {what} of {abs(gap):.3g} m between {before[a].id} and {before[b].id} is closed")
    named = {room for pair in widest for room in pair}
    for k, (old, new) in enumerate(zip(before, after)):
        if old is not new and k not in named:
            notes.append(f"room {old.id}: its walls follow those of its neighbours")
    return notes
