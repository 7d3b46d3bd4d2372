"""Where the openings of a plan lie on its walls, and what is wrong with those that do not lie on one."""

import functools
import math

import numpy as np
import shapely

from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan, Opening, PlanError, Violation
from wm.geometry.plan.walls import SHARED, Wall, plan_walls

MENDS = " (plan.repair=true moves or narrows it)"
_SAME = 0.02  # metres by which the two entries of one door may differ, one in each room's list
APART = 0.01  # metres of wall at least between two openings: of less the carving leaves films, or sheets of no thickness


@functools.lru_cache(maxsize=4)
def portals(plan: FloorPlan) -> tuple[Portal, ...]:
    """Every opening of the plan once, in the order in which rooms list them.

    Raises:
      PlanError: an opening is not on its wall, a door leads along several rooms, or a window looks into a room.
    """
    placed, violations = place_openings(plan)
    if violations:
        raise PlanError(violations)
    return placed


def place_openings(plan: FloorPlan, unknown: shapely.Geometry | None = None) -> tuple[tuple[Portal, ...], tuple[Violation, ...]]:
    """Every opening once, on its wall, and the violations of those that cannot be placed.

    Args:
      plan: rooms with simple polygons.
      unknown: where rooms may lie that could not be read; doors that lead there are left out without a violation.

    Returns:
      portals: one for each opening in the order of the plan, less the second entry of doors that both rooms list.
      violations: opening_off_wall, door_exterior, window_interior, openings_overlap.
    """
    placed: list[Portal] = []
    violations: list[Violation] = []
    for room, walls in zip(plan.rooms, plan_walls(plan)):
        for k, opening in enumerate(room.openings):
            portal = place(k, opening, walls)
            if isinstance(portal, Portal):
                placed.append(portal)
                continue
            doubtful = unknown is not None and shapely.intersects(unknown, shapely.LineString(opening_ends(opening)))
            if portal[0] != "door_exterior" or not doubtful:
                violations.append(Violation(room.id, *portal))
    kept, clashes = _once(plan, placed)
    return kept, (*violations, *clashes)


def describe(opening: Opening, k: int) -> str:
    """How a message names an opening: 'openings[2] (door at 1.55 m)'."""
    return f"openings[{k}] ({opening.kind} at {opening.position:g} m, {opening.width:g} m wide)"


def opening_ends(opening: Opening) -> np.ndarray:
    """[2, 2]: the opening's ends on its segment."""
    start, end = opening.segment
    direction = (end - start) / np.linalg.norm(end - start)
    return start + np.array([[opening.position], [opening.position + opening.width]]) * direction


def place(k: int, opening: Opening, walls: tuple[Wall, ...]) -> Portal | tuple[str, str]:
    """One opening of a room on one of that room's walls, or the rule that it breaks and how."""
    name = describe(opening, k)
    length = float(np.linalg.norm(opening.segment[1] - opening.segment[0]))
    if opening.position < -1e-9 or opening.position + opening.width > length + 1e-6:
        return "opening_off_wall", f"{name} does not fit on its wall_segment of {length:g} m{MENDS}"
    ends = opening_ends(opening)
    for wall in walls:
        offset = ends - wall.start
        along, across = offset @ wall.direction, offset @ wall.normal
        low, high = float(along.min()), float(along.max())
        if np.abs(across).max() <= SHARED and low >= -SHARED and high <= wall.length + SHARED:
            break
    else:
        return "opening_off_wall", f"{name} is not on a wall of the room: its ends are {_point(ends[0])} and {_point(ends[1])}"
    behind = next((b for b in wall.behind if b.low - SHARED <= low and high <= b.high + SHARED), None)
    touched = any(b.low + SHARED < high and low + SHARED < b.high for b in wall.behind)
    if opening.kind == "window":
        if touched:
            return "window_interior", f"{name} looks into another room; windows belong on exterior walls"
        behind = None
    elif behind is None and touched:
        return "door_exterior", f"{name} does not lead into one other room; keep it within the wall shared with one{MENDS}"
    elif behind is None and opening.kind == "passage":
        return "door_exterior", f"{name} leads outside; make it a door, which is closed, or put it on a wall shared with a room"
    return Portal(opening=opening, index=k, wall=wall, low=low, high=high, behind=behind)


def _once(plan: FloorPlan, placed: list[Portal]) -> tuple[tuple[Portal, ...], list[Violation]]:
    """Drops the second entry of a door listed by both rooms; names openings that overlap or nearly touch."""
    groups: dict[tuple, list[Portal]] = {}
    violations: list[Violation] = []
    kept = []
    for portal in placed:
        # Doors of one pair of rooms meet in one group whichever room lists them; windows stay with their wall.
        pair = (id(portal.wall),) if portal.behind is None else portal.rooms
        group = groups.setdefault(pair, [])
        rivals = [other for other in group if _apart(other, portal) < APART - 1e-6]
        if not rivals:
            group.append(portal)
            kept.append(portal)
        elif not any(_same(rival, portal) for rival in rivals):
            violations.append(_clash(plan, portal, rivals[0]))
    return tuple(kept), violations


def _clash(plan: FloorPlan, portal: Portal, rival: Portal) -> Violation:
    mine, theirs = plan.rooms[portal.wall.room], plan.rooms[rival.wall.room]
    if _apart(rival, portal) < -1e-6:
        how, advice = "overlaps", ""
    else:
        how, advice = "touches or nearly touches", f"; make them one opening or keep {APART:g} m of wall between them"
    if mine is not theirs:
        advice = "; the two entries of one door must agree"
    message = f"{describe(portal.opening, portal.index)} {how} {describe(rival.opening, rival.index)} of room {theirs.id}{advice}"
    return Violation(mine.id, "openings_overlap", message)


def _offset(portal: Portal, wall: Wall) -> np.ndarray:
    """[2, 2] from the start of a wall to the ends of a portal on the line of its own wall."""
    return portal.wall.start + portal.span - wall.start


def _apart(a: Portal, b: Portal) -> float:
    """Metres of wall between two openings of one pair of rooms, or of one exterior wall: beside or above, whichever is more.

    Negative where they overlap, infinite where they do not lie on one line.
    """
    offset = _offset(b, a.wall)
    along, across = offset @ a.wall.direction, offset @ a.wall.normal
    if np.abs(across).max() > 2 * SHARED:
        return math.inf
    beside = max(float(along.min()) - a.high, a.low - float(along.max()))
    return max(beside, _above(a.opening, b.opening), _above(b.opening, a.opening))


def _above(lower: Opening, upper: Opening) -> float:
    """Metres from the head of one opening up to the sill of another."""
    return upper.sill_height - lower.sill_height - lower.height


def _same(a: Portal, b: Portal) -> bool:
    """Whether two entries, one in each room's list, describe one door."""
    along = np.sort(_offset(b, a.wall) @ a.wall.direction)
    return (
        a.wall.room != b.wall.room
        and a.kind == b.kind
        and bool(np.abs(along - [a.low, a.high]).max() <= _SAME)
        and abs(a.opening.height - b.opening.height) <= _SAME
        and abs(a.sill - b.sill) <= _SAME
    )


def _point(p: np.ndarray) -> str:
    return f"({p[0]:g}, {p[1]:g})"
