"""The rules of a plan, each with a name; all rules that a plan breaks are reported at once.

Each room is checked on its own first, then all sound rooms together. Where a room is broken or missing, what depends on it
(doors that may lead there, whether everything can be reached) is not judged; nor is whether a room can be reached that overlaps
another, or has a door beside it that is at fault itself.
"""

import dataclasses

import numpy as np
import shapely

from wm.geometry.plan.footprint import interiors
from wm.geometry.plan.openings import describe, place_openings
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan, Room, Violation
from wm.geometry.plan.walls import SHARED, room_polygons

LEAST_DISK = 0.3  # metres: a room must hold a disk of this radius, a little more than a body, to be entered
LEAST_AREA = 0.01  # square metres: a polygon of less counts as having no area
OUTLOOK = 0.3  # metres of open air a window needs before it
NEIGHBOUR = 0.5  # metres between rooms that a door may have been meant to join
_TOO_SMALL = "; make it larger, or leave it out of the plan if nobody enters it"
_ADVICE = "; put one on a wall that it shares"
MOST_OVERLAPS = 256  # more are not listed, and no other rule is checked then

RULES = {
    "file": "The file can be read and is UTF-8 text.",
    "json": "The text is JSON without duplicate keys, NaN or Infinity, and not absurdly long or deep.",
    "type": "Every field is there, where it has no default, and has the right type.",
    "number": "Every number is finite and within its range.",
    "units": "Metres and z up.",
    "no_rooms": "There is at least one room.",
    "too_many": "There are not more rooms than can be meant.",
    "room_id": "Ids are 1 to 64 ASCII letters, digits, _ and -: they become folder names.",
    "duplicate_id": "No two rooms have one id, case aside.",
    "opening_type": "An opening is a door, a window or a passage.",
    "object": "Furniture that the plan lists has a label, stands in a room, and has a size that fits or a mesh file.",
    "self_intersection": "A room's polygon does not cross or touch itself.",
    "zero_area": "A room's polygon has an area.",
    "room_too_small": "Inside its walls a room is one piece that holds a disk of 0.3 m radius.",
    "rooms_overlap": "Rooms touch at most, within 0.01 m.",
    "opening_off_wall": "An opening lies on a wall of its room, between the corners inside and below the ceiling.",
    "openings_overlap": "Openings keep 0.01 m of wall between them; the two entries of one door agree.",
    "door_exterior": "Doors and passages lead into exactly one other room, or doors to the outside.",
    "window_interior": "Windows look outside.",
    "unreachable": "Every room can be reached from every other through doors and passages.",
}


def check_plan(plan: FloorPlan, *, rooms_missing: bool = False, openings_missing: bool = False) -> tuple[Violation, ...]:
    """Every rule that a plan of well-formed records breaks.

    Args:
      plan: rooms as `Reader` makes them: numbers finite and in range, polygons counter-clockwise.
      rooms_missing: whether there are more rooms that could not be read.
      openings_missing: whether rooms have more openings that could not be read.
    """
    violations = _duplicates(plan)
    faults = [_shape_fault(room) for room in plan.rooms]
    violations += [fault for fault in faults if fault is not None]
    unknown = _unknown([room for room, fault in zip(plan.rooms, faults) if fault is not None], everywhere=rooms_missing)
    sound = tuple(room for room, fault in zip(plan.rooms, faults) if fault is None)
    if not sound:
        return tuple(violations)
    plan = dataclasses.replace(plan, rooms=sound)
    overlaps = _overlaps(plan)
    violations += overlaps
    if len(overlaps) >= MOST_OVERLAPS:
        return tuple(violations)
    portals, misplaced = place_openings(plan, unknown)
    of_openings = [*misplaced]
    of_openings += [fault for portal in portals if (fault := _squeezed(plan, portal)) is not None]
    of_openings += _blocked(plan, portals)
    violations += [*_cramped(plan), *of_openings]
    if unknown is None and not openings_missing:
        violations += _unreachable(plan, portals, doubtful=[*overlaps, *of_openings])
    return tuple(violations)


def _duplicates(plan: FloorPlan) -> list[Violation]:
    seen: set[str] = set()
    violations = []
    for room in plan.rooms:
        if room.id.casefold() in seen:
            violations.append(Violation(room.id, "duplicate_id", "an earlier room has this id; case does not tell them apart"))
        seen.add(room.id.casefold())
    return violations


def _shape_fault(room: Room) -> Violation | None:
    """What is wrong with the polygon of one room on its own."""
    if len(room.polygon) < 3 or shapely.MultiPoint(room.polygon).convex_hull.area < LEAST_AREA:
        return Violation(room.id, "zero_area", f"floor_polygon covers less than {LEAST_AREA:g} m^2")
    polygon = shapely.Polygon(room.polygon)
    if not polygon.is_valid:
        return Violation(room.id, "self_intersection", f"floor_polygon is not simple: {shapely.is_valid_reason(polygon)}")
    if polygon.area < LEAST_AREA:
        return Violation(room.id, "zero_area", f"floor_polygon covers less than {LEAST_AREA:g} m^2")
    if polygon.buffer(-LEAST_DISK).is_empty:
        return Violation(room.id, "room_too_small", f"no disk of {LEAST_DISK:g} m radius fits into floor_polygon{_TOO_SMALL}")
    return None


def _unknown(broken: list[Room], *, everywhere: bool) -> shapely.Geometry | None:
    """Where there are rooms whose shape is not known; None where there are no such rooms."""
    if everywhere:
        return shapely.box(-1e6, -1e6, 1e6, 1e6)
    if not broken:
        return None
    return shapely.union_all([shapely.MultiPoint(room.polygon).convex_hull.buffer(0.05) for room in broken])


def _overlaps(plan: FloorPlan) -> list[Violation]:
    polygons = room_polygons(plan)
    # Moved in by half the tolerance, rooms that only touch within it have nothing in common.
    cores = shapely.buffer(polygons, -SHARED / 2 - 1e-6, join_style="mitre")
    tree = shapely.STRtree(cores)
    violations = []
    for a, core in enumerate(cores):
        for b in np.sort(tree.query(core, predicate="intersects")).tolist():
            if b > a:
                violations.append(Violation(plan.rooms[a].id, "rooms_overlap", _overlap(plan, a, b, polygons)))
            if len(violations) == MOST_OVERLAPS:
                return violations
    return violations


def _overlap(plan: FloorPlan, a: int, b: int, polygons: np.ndarray) -> str:
    """By how much two rooms overlap, and what would be right."""
    area = polygons[a].intersection(polygons[b]).area
    small, large = sorted((polygons[a].area, polygons[b].area))
    inner, outer = (a, b) if polygons[a].area <= polygons[b].area else (b, a)
    advice = "; move the wall between them"
    if area > 0.99 * large:
        advice = "; a plan has one storey: give each its own plan"
    elif area > 0.99 * small:
        advice = f"; cut {plan.rooms[inner].id} out of the floor_polygon of {plan.rooms[outer].id}, which may need two rooms"
    return f"overlaps {plan.rooms[b].id} by {area:.3g} m^2{advice}"


def _cramped(plan: FloorPlan) -> list[Violation]:
    violations = []
    for room, floor in zip(plan.rooms, interiors(plan)):
        if floor is None:
            violations.append(Violation(room.id, "room_too_small", "its walls leave no floor in one piece"))
        elif floor.buffer(-LEAST_DISK).is_empty:
            violations.append(
                Violation(room.id, "room_too_small", f"no disk of {LEAST_DISK:g} m radius fits between its walls{_TOO_SMALL}")
            )
    return violations


def _squeezed(plan: FloorPlan, portal: Portal) -> Violation | None:
    """An opening that reaches into a ceiling or into the wall of a corner, on either side."""
    listing = portal.wall.room
    room = plan.rooms[listing]
    name = describe(portal.opening, portal.index)
    for side in (listing,) if portal.behind is None else (listing, portal.behind.room):
        other = plan.rooms[side]
        if portal.head > other.ceiling_height + 1e-9:
            message = f"{name} reaches {portal.head:g} m high; the ceiling of {other.id} is at {other.ceiling_height:g} m"
            return Violation(room.id, "opening_off_wall", message)
        floor = interiors(plan)[side]
        # The edge of a floor may be off by SHARED where walls are not quite parallel, so look one to two SHARED beyond.
        face = portal.wall.thickness if side == listing else -portal.wall.thickness - portal.gap
        away = 1.0 if side == listing else -1.0
        before = _strip(portal, face + away * SHARED, face + away * 2 * SHARED)
        if floor is not None and before.difference(floor).area > 1e-6:
            message = f"{name} reaches into a corner of {other.id}; {_free_stretch(portal, floor, face + 1.5 * away * SHARED)}"
            return Violation(room.id, "opening_off_wall", message)
    return None


def _free_stretch(portal: Portal, floor: shapely.Polygon, inside: float) -> str:
    """Where on its segment an opening could lie: the free stretch of the wall's face that it overlaps most."""
    wall, opening = portal.wall, portal.opening
    ends = wall.start + np.array([[0.0], [wall.length]]) * wall.direction + inside * wall.normal
    free = shapely.get_parts(floor.intersection(shapely.LineString(ends)))
    parts = [np.asarray(part.coords) for part in free if part.length > 0]
    along = (opening.segment[1] - opening.segment[0]) / np.linalg.norm(opening.segment[1] - opening.segment[0])
    spans = [sorted(((part - opening.segment[0]) @ along).tolist()) for part in parts]
    if not spans:
        return "no part of that wall's face is free"
    here, there = opening.position, opening.position + opening.width
    low, high = max(spans, key=lambda span: min(span[1], there) - max(span[0], here))
    return f"between the inner faces of the walls beside it there is room from {low:.3g} to {high:.3g} m of its wall_segment"


def _blocked(plan: FloorPlan, portals: tuple[Portal, ...]) -> list[Violation]:
    """Windows and entrances with a room close before them."""
    tree = shapely.STRtree(room_polygons(plan))
    violations = []
    for portal in portals:
        if portal.is_way:
            continue
        room = plan.rooms[portal.wall.room]
        view = _strip(portal, -OUTLOOK, -SHARED).buffer(-SHARED / 4, join_style="mitre")
        blocking = sorted(plan.rooms[k].id for k in tree.query(view, predicate="intersects"))
        if blocking:
            message = f"{describe(portal.opening, portal.index)} has {', '.join(blocking)} less than {OUTLOOK:g} m before it; "
            if portal.kind == "window":
                violations.append(Violation(room.id, "window_interior", message + "windows look outside"))
            else:
                advice = "rooms that a door joins share one line, the middle of the wall: close the gap between their polygons"
                violations.append(Violation(room.id, "door_exterior", message + advice))
    return violations


def _strip(portal: Portal, first: float, second: float) -> shapely.Polygon:
    """The rectangle over an opening between two distances inside its wall's line, metres."""
    wall = portal.wall
    start, end = (wall.start + along * wall.direction for along in (portal.low, portal.high))
    return shapely.Polygon(
        [p + inside * wall.normal for inside, ps in ((first, (start, end)), (second, (end, start))) for p in ps]
    )


def _unreachable(plan: FloorPlan, portals: tuple[Portal, ...], doubtful: list[Violation]) -> list[Violation]:
    ways: list[list[int]] = [[] for _ in plan.rooms]
    joined = [portal.rooms for portal in portals if portal.is_way]
    for a, b in (*joined, *_perhaps(plan, doubtful)):
        ways[a].append(b)
        ways[b].append(a)
    component = [-1] * len(plan.rooms)
    for seed in range(len(plan.rooms)):
        queue = [seed] if component[seed] < 0 else []
        while queue:
            room = queue.pop()
            if component[room] < 0:
                component[room] = seed
                queue.extend(ways[room])
    sizes = np.bincount(component, minlength=len(plan.rooms))
    main = int(np.argmax(sizes))
    return [
        Violation(room.id, "unreachable", f"no doors or passages lead to it from {plan.rooms[main].id}{_ADVICE}")
        for room, part in zip(plan.rooms, component)
        if part != main
    ]


def _perhaps(plan: FloorPlan, faults: list[Violation]) -> list[tuple[int, int]]:
    """Pairs of neighbours of which one breaks a rule that, once kept, may join them."""
    blamed = {fault.room for fault in faults if fault.rule != "window_interior"}
    rooms = np.array([k for k, room in enumerate(plan.rooms) if room.id in blamed], dtype=int)
    polygons = room_polygons(plan)
    i, j = shapely.STRtree(polygons).query(polygons[rooms], predicate="dwithin", distance=NEIGHBOUR)
    return list(zip(rooms[i].tolist(), j.tolist()))
