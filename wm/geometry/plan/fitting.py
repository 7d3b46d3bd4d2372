"""Openings that reach into a corner, past the end of their wall, over two rooms or above a ceiling, made to fit.

An opening fits where both rooms (or one, and the open air) have wall to either side of it: between the inner faces of the walls
that meet its own. One that is drawn up to a corner of the polygon is meant to reach to the face of the wall beside it, and is cut
there. Others are moved along their wall, or narrowed where they are too wide for it, by `plan.repair=true` only.
"""

import dataclasses

import numpy as np
import shapely

from wm.geometry.plan.footprint import interiors
from wm.geometry.plan.openings import describe, opening_ends, place
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan, Opening
from wm.geometry.plan.rules import squeezed
from wm.geometry.plan.walls import SHARED, Behind, Wall, plan_walls

REACH = 0.05  # metres off a wall at which an opening is still taken to lie on it
FARTHEST = 0.5  # metres by which an opening is moved along its wall
_NARROWEST = 0.1  # metres
_FIT = 1e-5  # metres that are no change


def fitted(plan: FloorPlan, *, repair: bool) -> tuple[FloorPlan, tuple[str, ...]]:
    """The plan with its openings made to fit, and a sentence with its size for each change.

    Args:
      plan: rooms with simple polygons that do not overlap.
      repair: whether openings that are not drawn up to a corner are changed too.
    """
    rooms, notes = [], []
    for index, room in enumerate(plan.rooms):
        openings = []
        for k, opening in enumerate(room.openings):
            portal = place(k, opening, plan_walls(plan)[index])
            fits = isinstance(portal, Portal) and squeezed(plan, portal) is None
            fit = opening if fits else _fit(plan, index, opening, repair=repair)
            if fit is not opening:
                notes.append(f"room {room.id}: {describe(opening, k)} {_difference(opening, fit)}")
            openings.append(fit)
        changed = any(a is not b for a, b in zip(openings, room.openings))
        rooms.append(dataclasses.replace(room, openings=tuple(openings)) if changed else room)
    return (dataclasses.replace(plan, rooms=tuple(rooms)) if notes else plan), tuple(notes)


def _difference(before: Opening, after: Opening) -> str:
    """What was done to an opening, in words."""
    told = []
    if abs(after.width - before.width) > _FIT:
        told.append(f"is made {after.width:.3g} m wide, from face to face of the walls beside it")
    else:
        shift = float(np.linalg.norm(opening_ends(after).mean(axis=0) - opening_ends(before).mean(axis=0)))
        if shift > _FIT:
            told.append(f"is moved by {shift:.3g} m along its wall")
    if after.height < before.height:
        told.append(f"is made {after.height:.3g} m high, up to the ceiling")
    return " and ".join(told) or "is put onto its wall"


def _fit(plan: FloorPlan, index: int, opening: Opening, *, repair: bool) -> Opening:
    """The opening itself where it fits, or where nothing near it does."""
    ends = opening_ends(opening)
    wall = _wall(plan_walls(plan)[index], ends, REACH if repair else SHARED)
    if wall is None:
        return opening
    along = (ends - wall.start) @ wall.direction
    low, high = float(along.min()), float(along.max())
    heights = {b.room: plan.rooms[b.room].ceiling_height for b in wall.behind}
    best, rest = None, None
    for low_free, high_free, behind in _free(plan, wall):
        overlap = min(high, high_free) - max(low, low_free)
        if rest is None or overlap > rest:
            best, rest = (low_free, high_free, behind), overlap
    if best is None or rest is None or rest < min(_NARROWEST, opening.width / 2):
        return opening
    ceiling = min(plan.rooms[index].ceiling_height, heights.get(best[2].room, np.inf) if best[2] else np.inf)
    room_above = ceiling - opening.sill_height
    height = min(opening.height, room_above) if repair and room_above > _NARROWEST else opening.height
    length = float(np.linalg.norm(opening.segment[1] - opening.segment[0]))
    lies = np.abs((ends - wall.start) @ wall.normal).max() <= SHARED and opening.position + opening.width <= length + 1e-6
    if low >= best[0] - _FIT and high <= best[1] + _FIT:
        return _placed(wall, opening, low, high, height) if repair and not (lies and height == opening.height) else opening
    cut = _up_to_corners(wall, opening, low, high, best[2])
    if not repair and not cut:
        return opening
    width = high - low
    if width <= best[1] - best[0] and (opening.kind == "door" or not cut):
        low = min(max(low, best[0]), best[1] - width)
        high = low + width
    else:
        low, high = max(low, best[0]), min(high, best[1])
    moved = abs(low + high - float(along.sum())) / 2 - abs(width - (high - low))
    return _placed(wall, opening, low, high, height) if high - low >= _NARROWEST and moved <= FARTHEST else opening


def _up_to_corners(wall: Wall, opening: Opening, low: float, high: float, behind: Behind | None) -> bool:
    """Whether an opening is meant to reach a wall beside it: it is drawn up to the corner, and a door over the whole wall."""
    corners = [0.0, wall.length, *((behind.low, behind.high) if behind else ())]
    first, last = (any(abs(end - corner) <= SHARED for corner in corners) for end in (low, high))
    return first and last if opening.kind == "door" else first or last


def _placed(wall: Wall, opening: Opening, low: float, high: float, height: float) -> Opening:
    ends = wall.start + np.array([[low], [high]]) * wall.direction
    return dataclasses.replace(opening, segment=ends, position=0.0, width=float(high - low), height=float(height))


def _wall(walls: tuple[Wall, ...], ends: np.ndarray, reach: float) -> Wall | None:
    """The wall that most of an opening lies on."""
    span = ends[1] - ends[0]
    width = float(np.linalg.norm(span))
    best, most = None, width / 3
    for wall in walls:
        offset = ends - wall.start
        along, across = offset @ wall.direction, offset @ wall.normal
        overlap = min(float(along.max()), wall.length) - max(float(along.min()), 0.0)
        if np.abs(across).max() <= reach and overlap > most:
            best, most = wall, overlap
    return best


def _free(plan: FloorPlan, wall: Wall) -> list[tuple[float, float, Behind | None]]:
    """Stretches of a wall, metres along it, where an opening has wall to either side, and what is behind each."""
    mine = _faces(plan, wall, wall.room, wall.thickness, 1.0)
    result: list[tuple[float, float, Behind | None]] = []
    for behind in wall.behind:
        middle = behind.gap((behind.low + behind.high) / 2)
        theirs = _faces(plan, wall, behind.room, -behind.thickness - middle, -1.0)
        for a, b in mine:
            for c, d in theirs:
                low, high = max(a, c, behind.low), min(b, d, behind.high)
                if high > low:
                    result.append((low, high, behind))
    taken = shapely.MultiLineString([[(b.low, 0.0), (b.high, 0.0)] for b in wall.behind])
    for a, b in mine:
        outside = shapely.LineString([(a, 0.0), (b, 0.0)]).difference(taken)
        for part in shapely.get_parts(outside):
            if part.length > SHARED:
                result.append((part.bounds[0], part.bounds[2], None))
    return result


def _faces(plan: FloorPlan, wall: Wall, room: int, face: float, away: float) -> list[tuple[float, float]]:
    """The stretches, metres along a wall, where a room has free floor before the wall's face at `face` metres inside its line."""
    floor = interiors(plan)[room]
    if floor is None:
        return []
    free = None
    for depth in (SHARED, 2 * SHARED):
        ends = wall.start + np.array([[0.0], [wall.length]]) * wall.direction + (face + away * depth) * wall.normal
        parts = shapely.get_parts(floor.intersection(shapely.LineString(ends)))
        spans = [
            sorted(((np.asarray(part.coords) - wall.start) @ wall.direction)[[0, -1]].tolist()) for part in parts if part.length
        ]
        line = shapely.MultiLineString([[(a, 0.0), (b, 0.0)] for a, b in spans])
        free = line if free is None else free.intersection(line)
    merged = shapely.line_merge(free) if free is not None and not free.is_empty else shapely.MultiLineString()
    return [(part.bounds[0], part.bounds[2]) for part in shapely.get_parts(merged) if part.length > 0]
