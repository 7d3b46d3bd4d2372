"""Where the openings of a plan lie on its walls, and what is wrong with those that do not."""

import dataclasses
import math

import numpy as np
import shapely

from wm.geometry.plan.records import FloorPlan, Opening, Violation
from wm.geometry.plan.walls import SHARED, Behind, Wall

_SAME = 0.02  # metres by which the two entries of one door may differ, one in each room's list
APART = 0.01  # metres of wall at least between two openings: of less the carving leaves films, or sheets of no thickness


@dataclasses.dataclass(frozen=True)
class Place:
    """An opening on a wall of the room that lists it."""

    room: int
    opening: int  # index into that room's openings
    wall: Wall
    low: float  # metres along the wall
    high: float
    behind: Behind | None  # the stretch of shared wall that holds it; None on an exterior wall

    @property
    def gap(self) -> float:
        """Metres between the two lines of a shared wall, at the opening's middle; 0 on an exterior wall."""
        return 0.0 if self.behind is None else self.behind.gap((self.low + self.high) / 2)


def place_openings(
    plan: FloorPlan, walls: tuple[tuple[Wall, ...], ...], unknown: shapely.Geometry | None = None
) -> tuple[tuple[Place, ...], tuple[Violation, ...]]:
    """Every opening once, on its wall, and the violations of those that cannot be placed.

    Args:
      plan: rooms with simple polygons.
      walls: of the plan (`plan_walls`).
      unknown: where rooms may be that the plan should hold and does not; doors there are left out in silence.

    Returns:
      places: one for each opening in the order of the plan, less the second entry of doors that both rooms list.
      violations: opening_off_wall, door_exterior, window_interior, openings_overlap.
    """
    places: list[Place] = []
    violations: list[Violation] = []
    for index, room in enumerate(plan.rooms):
        for k, opening in enumerate(room.openings):
            place = _place(index, k, opening, walls[index])
            if isinstance(place, Place):
                places.append(place)
                continue
            doubtful = unknown is not None and shapely.intersects(unknown, shapely.LineString(opening_ends(opening)))
            if place[0] != "door_exterior" or not doubtful:
                violations.append(Violation(room.id, *place))
    kept, clashes = _once(plan, places)
    return kept, (*violations, *clashes)


def describe(opening: Opening, k: int) -> str:
    """How a message names an opening: 'openings[2] (door at 1.55 m)'."""
    return f"openings[{k}] ({opening.kind} at {opening.position:g} m, {opening.width:g} m wide)"


def opening_ends(opening: Opening) -> np.ndarray:
    """[2, 2]: the opening's ends on its segment."""
    start, end = opening.segment
    direction = (end - start) / np.linalg.norm(end - start)
    return start + np.array([[opening.position], [opening.position + opening.width]]) * direction


def _place(room: int, k: int, opening: Opening, walls: tuple[Wall, ...]) -> Place | tuple[str, str]:
    """The place of one opening, or the rule it breaks and how."""
    name = describe(opening, k)
    length = float(np.linalg.norm(opening.segment[1] - opening.segment[0]))
    if opening.position < -1e-9 or opening.position + opening.width > length + 1e-6:
        return "opening_off_wall", f"{name} does not fit on its wall_segment of {length:g} m"
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
    if opening.kind == "window":
        touched = next((b for b in wall.behind if b.low + SHARED < high and low + SHARED < b.high), None)
        if touched is not None:
            return "window_interior", f"{name} looks into another room; windows belong on exterior walls"
    elif behind is None:
        return "door_exterior", f"{name} does not lead into one other room; it must lie on a wall shared with one"
    return Place(room=room, opening=k, wall=wall, low=low, high=high, behind=behind if opening.kind != "window" else None)


def _once(plan: FloorPlan, places: list[Place]) -> tuple[tuple[Place, ...], list[Violation]]:
    """Drops the second entry of a door listed by both rooms; names openings that overlap or nearly touch."""
    groups: dict[tuple, list[Place]] = {}
    violations: list[Violation] = []
    kept = []
    for place in places:
        # Doors of one pair of rooms meet in one group whichever room lists them; windows stay with their wall.
        pair = (id(place.wall),) if place.behind is None else tuple(sorted((place.room, place.behind.room)))
        group = groups.setdefault(pair, [])
        rivals = [other for other in group if _apart(plan, other, place) < APART - 1e-6]
        if not rivals:
            group.append(place)
            kept.append(place)
        elif not any(_same(plan, rival, place) for rival in rivals):
            violations.append(_clash(plan, place, rivals[0]))
    return tuple(kept), violations


def _clash(plan: FloorPlan, place: Place, rival: Place) -> Violation:
    mine, theirs = plan.rooms[place.room], plan.rooms[rival.room]
    if _apart(plan, rival, place) < -1e-6:
        how, advice = "overlaps", ""
    else:
        how, advice = "touches or nearly touches", f"; make them one opening or keep {APART:g} m of wall between them"
    if place.room != rival.room:
        advice = "; the two entries of one door must agree"
    message = (
        f"{describe(mine.openings[place.opening], place.opening)} {how} "
        f"{describe(theirs.openings[rival.opening], rival.opening)} of room {theirs.id}{advice}"
    )
    return Violation(mine.id, "openings_overlap", message)


def _ends(place: Place) -> np.ndarray:
    return place.wall.start + np.array([[place.low], [place.high]]) * place.wall.direction


def _apart(plan: FloorPlan, a: Place, b: Place) -> float:
    """Metres of wall between two openings of one pair of rooms, or of one exterior wall: beside or above, whichever is more.

    Negative where they overlap, infinite where they do not lie on one line.
    """
    first, second = plan.rooms[a.room].openings[a.opening], plan.rooms[b.room].openings[b.opening]
    offset = _ends(b) - a.wall.start
    along, across = offset @ a.wall.direction, offset @ a.wall.normal
    if np.abs(across).max() > 2 * SHARED:
        return math.inf
    beside = max(float(along.min()) - a.high, a.low - float(along.max()))
    above = max(second.sill_height - first.sill_height - first.height, first.sill_height - second.sill_height - second.height)
    return max(beside, above)


def _same(plan: FloorPlan, a: Place, b: Place) -> bool:
    """Whether two entries, one in each room's list, describe one door."""
    first, second = plan.rooms[a.room].openings[a.opening], plan.rooms[b.room].openings[b.opening]
    along = np.sort((_ends(b) - a.wall.start) @ a.wall.direction)
    return (
        a.room != b.room
        and first.kind == second.kind
        and bool(np.abs(along - [a.low, a.high]).max() <= _SAME)
        and abs(first.height - second.height) <= _SAME
        and abs(first.sill_height - second.sill_height) <= _SAME
    )


def _point(p: np.ndarray) -> str:
    return f"({p[0]:g}, {p[1]:g})"
