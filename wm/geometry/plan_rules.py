"""The rules a plan keeps, each with a name; all that are broken are named at once.

Of a room that breaks a rule of its own the rest of the plan is not asked: doors to it are neither right nor wrong.
"""

import dataclasses

import numpy as np
import shapely

from wm.geometry.footprint import interiors, walls_of
from wm.geometry.openings import Place, describe, place_openings
from wm.geometry.plan_records import FloorPlan, Room, Violation
from wm.geometry.walls import SHARED, room_polygons

BODY = 0.3  # metres: a room must hold a disk of this radius to be entered
LEAST_AREA = 0.01  # square metres; less is no area
OUTLOOK = 0.3  # metres of open air a window needs before it

RULES = {
    "json": "The text is JSON without duplicate keys, NaN or Infinity, and not absurdly long or deep.",
    "type": "Every field is there, where it has no default, and has the right type.",
    "number": "Every number is finite and within its range.",
    "units": "Metres and z up.",
    "no_rooms": "There is at least one room.",
    "too_many": "There are not more rooms than can be meant.",
    "room_id": "Ids are 1 to 64 ASCII letters, digits, _ and -: they become folder names.",
    "duplicate_id": "No two rooms have one id, case aside.",
    "opening_type": "An opening is a door, a window or a passage.",
    "self_intersection": "A room's polygon does not cross or touch itself.",
    "zero_area": "A room's polygon has an area.",
    "room_too_small": "Inside its walls a room is one piece that holds a disk of 0.3 m radius.",
    "rooms_overlap": "Rooms touch at most, within 0.01 m.",
    "opening_off_wall": "An opening lies on a wall of its room, between the corners inside and below the ceiling.",
    "openings_overlap": "Openings do not overlap; the two entries of one door agree.",
    "door_exterior": "Doors and passages lead into exactly one other room.",
    "window_interior": "Windows look outside.",
    "unreachable": "Every room can be reached from every other through doors and passages.",
}


def check_plan(plan: FloorPlan, *, complete: bool = True) -> tuple[Violation, ...]:
    """Every rule that a plan of well-formed records breaks.

    Args:
      plan: rooms as `Reader` makes them: finite numbers in range, polygons counter-clockwise.
      complete: False where rooms of the plan could not be read, so that nothing is said of doors that may lead there.
    """
    violations = _duplicates(plan)
    broken = [_shape_fault(room) for room in plan.rooms]
    violations += [fault for fault in broken if fault is not None]
    sound = tuple(room for room, fault in zip(plan.rooms, broken) if fault is None)
    if not sound:
        return tuple(violations)
    complete = complete and len(sound) == len(plan.rooms)
    plan = dataclasses.replace(plan, rooms=sound)
    overlaps = _overlaps(plan)
    small = [
        Violation(room.id, "room_too_small", f"inside its walls no disk of {BODY:g} m radius fits, or the floor is in pieces")
        for room, roomy in zip(plan.rooms, _roomy(plan))
        if not roomy
    ]
    places, misplaced = place_openings(plan, walls_of(plan))
    if not complete:
        misplaced = tuple(violation for violation in misplaced if violation.rule != "door_exterior")
    squeezed = [fault for place in places if (fault := _squeezed(plan, place)) is not None]
    blind = _blind_windows(plan, places)
    violations += [*overlaps, *small, *misplaced, *squeezed, *blind]
    if complete:
        violations += _unreachable(plan, places)
    return tuple(violations)


def _duplicates(plan: FloorPlan) -> list[Violation]:
    seen: dict[str, str] = {}
    violations = []
    for room in plan.rooms:
        other = seen.setdefault(room.id.casefold(), room.id)
        if other is not room.id or (violations and other == violations[-1].room):
            violations.append(
                Violation(room.id, "duplicate_id", f"another room is called {other!r}; case does not tell rooms apart")
            )
    return violations


def _shape_fault(room: Room) -> Violation | None:
    """What is wrong with the shape of one room on its own."""
    if len(room.polygon) < 3:
        return Violation(room.id, "zero_area", "floor_polygon has fewer than 3 different points")
    polygon = shapely.Polygon(room.polygon)
    if not polygon.is_valid:
        reason = shapely.is_valid_reason(polygon)
        if abs(polygon.area) < LEAST_AREA and "Self-intersection" not in reason:
            return Violation(room.id, "zero_area", f"floor_polygon has an area of {polygon.area:g} m^2")
        return Violation(room.id, "self_intersection", f"floor_polygon is not simple: {reason}")
    if polygon.area < LEAST_AREA:
        return Violation(room.id, "zero_area", f"floor_polygon has an area of {polygon.area:g} m^2")
    return None


def _overlaps(plan: FloorPlan) -> list[Violation]:
    polygons = room_polygons(plan)
    # Moved in by half the tolerance, rooms that only touch within it have nothing in common.
    cores = shapely.buffer(polygons, -SHARED / 2 - 1e-6, join_style="mitre")
    first, second = shapely.STRtree(cores).query(cores, predicate="intersects")
    pairs = sorted({(int(a), int(b)) for a, b in zip(first, second) if a < b})
    violations = []
    for a, b in pairs:
        area = polygons[a].intersection(polygons[b]).area
        violations.append(Violation(plan.rooms[a].id, "rooms_overlap", f"overlaps room {plan.rooms[b].id} by {area:.3g} m^2"))
    return violations


def _roomy(plan: FloorPlan) -> list[bool]:
    floors = np.array([floor if floor is not None else shapely.Polygon() for floor in interiors(plan)])
    return list(~shapely.is_empty(shapely.buffer(floors, -BODY)))


def _squeezed(plan: FloorPlan, place: Place) -> Violation | None:
    """An opening that reaches into a corner's wall or into a ceiling, on either side."""
    room = plan.rooms[place.room]
    opening = room.openings[place.opening]
    name = describe(opening, place.opening)
    head = opening.sill_height + opening.height
    sides = [place.room] if place.behind is None else [place.room, place.behind.room]
    for side in sides:
        other = plan.rooms[side]
        if head > other.ceiling_height + 1e-9:
            message = f"{name} reaches {head:g} m high; the ceiling of room {other.id} is at {other.ceiling_height:g} m"
            return Violation(room.id, "opening_off_wall", message)
    for side in sides:
        if not _before_face(plan, place, side):
            corner = f"a corner of room {plan.rooms[side].id}"
            message = f"{name} reaches into {corner}; keep it between the inner faces of the walls beside it"
            return Violation(room.id, "opening_off_wall", message)
    return None


def _before_face(plan: FloorPlan, place: Place, side: int) -> bool:
    """Whether the floor just inside the opening belongs to the interior of the room on that side."""
    floor = interiors(plan)[side]
    if floor is None:
        return True  # said already: room_too_small
    wall = place.wall
    if side == place.room:
        low, high = wall.thickness, wall.thickness + SHARED
    else:
        gap = place.behind.gap if place.behind is not None else 0.0
        low, high = -wall.thickness - gap - SHARED, -wall.thickness - gap
    strip = _strip(place, low, high)
    return bool(strip.difference(floor).area <= 1e-6 * strip.area + SHARED * SHARED / 2 * (place.behind is not None))


def _blind_windows(plan: FloorPlan, places: tuple[Place, ...]) -> list[Violation]:
    windows = [place for place in places if place.behind is None]
    if not windows:
        return []
    polygons = room_polygons(plan)
    views = np.array([_strip(place, -OUTLOOK, -SHARED) for place in windows])
    window, blocked = shapely.STRtree(polygons).query(views, predicate="intersects")
    violations = []
    for k in sorted(set(window.tolist())):
        room = plan.rooms[windows[k].room]
        others = sorted({plan.rooms[b].id for b in blocked[window == k]})
        name = describe(room.openings[windows[k].opening], windows[k].opening)
        message = f"{name} looks at room {', '.join(others)} less than {OUTLOOK:g} m away; windows look outside"
        violations.append(Violation(room.id, "window_interior", message))
    return violations


def _strip(place: Place, low: float, high: float) -> shapely.Polygon:
    """The rectangle over an opening from `low` to `high` metres inside its wall's line."""
    wall = place.wall
    start, end = wall.start + place.low * wall.direction, wall.start + place.high * wall.direction
    return shapely.Polygon(
        [start + low * wall.normal, end + low * wall.normal, end + high * wall.normal, start + high * wall.normal]
    )


def _unreachable(plan: FloorPlan, places: tuple[Place, ...]) -> list[Violation]:
    ways: list[list[int]] = [[] for _ in plan.rooms]
    for place in places:
        if place.behind is not None:
            ways[place.room].append(place.behind.room)
            ways[place.behind.room].append(place.room)
    component = [-1] * len(plan.rooms)
    for seed in range(len(plan.rooms)):
        queue = [seed] if component[seed] < 0 else []
        while queue:
            room = queue.pop()
            if component[room] < 0:
                component[room] = seed
                queue.extend(ways[room])
    main = max(sorted(set(component)), key=component.count)
    return [
        Violation(room.id, "unreachable", f"no doors or passages lead to it from room {plan.rooms[main].id}")
        for room, part in zip(plan.rooms, component)
        if part != main
    ]
