"""The rules of a plan, each with a name; all rules that a plan breaks are reported at once.

Each room is checked on its own first, then all sound rooms together. Where a room is broken or missing, what depends on it
(doors that may lead there, whether everything can be reached) is not judged; nor is whether a room can be reached that overlaps
another, or has a door beside it that is at fault itself.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely

from wm.geometry.plan.connected import joined_rooms
from wm.geometry.plan.footprint import interiors
from wm.geometry.plan.openings import MENDS, describe, place_openings
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan, Room, Violation
from wm.geometry.plan.walls import SHARED, room_polygon, room_polygons

LEAST_DISK = 0.1  # metres: a room must hold a disk of this radius, so that a view can look into it
LEAST_AREA = 0.01  # square metres: a polygon of less counts as having no area
OUTLOOK = {"window": 0.3}  # metres of open air that an opening to the outside needs before it
DOORSTEP = 0.55  # the same of every other opening: more than any gap that stands for a wall (wm.geometry.plan.repair.WIDEST)
NEIGHBOUR = 0.5  # metres between rooms that a door may have been meant to join
_TOO_SMALL = "; make it larger, or take away what opens into it: a shaft that nothing opens into is built as solid wall"
_ADVICE = "; put one on a wall that it shares, or give it a door to the outside"
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
    "opening_type": "An opening is a door, a window, a passage or a hatch.",
    "object": "Furniture that the plan lists has a label, stands in a room, and has a size that fits or a mesh file.",
    "self_intersection": "A room's polygon does not cross or touch itself; holes and columns are simple too, and lie within it.",
    "zero_area": "A room's polygon has an area.",
    "room_too_small": "Inside its walls a room is one piece, and holds a disk of 0.1 m radius.",
    "rooms_overlap": "Rooms touch at most, within 0.01 m.",
    "opening_off_wall": "An opening lies on a wall of its room, between the corners inside and below the ceiling.",
    "openings_overlap": "Openings keep 0.01 m of wall between them; the two entries of one door agree.",
    "door_exterior": "Doors, passages and hatches lead into exactly one other room, or to the outside.",
    "window_interior": "Windows look outside, or into one other room.",
    "unreachable": "Every room can be reached from most others, or from outside (plan.unreachable=refuse).",
}


def check_plan(
    plan: FloorPlan, *, rooms_missing: bool = False, openings_missing: bool = False, unreachable: bool = True
) -> tuple[Violation, ...]:
    """Every rule that a plan of well-formed records breaks.

    Args:
      plan: rooms as `Reader` makes them: numbers finite and in range, polygons counter-clockwise.
      rooms_missing: whether there are more rooms that could not be read.
      openings_missing: whether rooms have more openings that could not be read.
      unreachable: whether rooms that cannot be reached break a rule.
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
    of_openings += [fault for portal in portals if (fault := squeezed(plan, portal)) is not None]
    of_openings += _blocked(plan, portals)
    violations += [*_cramped(plan), *of_openings]
    if unreachable and unknown is None and not openings_missing:
        violations += _unreachable(plan, portals, doubtful=[*overlaps, *of_openings])
    return tuple(violations)


def is_sound(rooms: Sequence[Room]) -> bool:
    """Whether the shape of every room, on its own, keeps the rules."""
    return all(_shape_fault(room) is None for room in rooms)


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
    for name, rings in (("holes", room.holes), ("columns", room.columns)):
        for k, ring in enumerate(rings):
            if not shapely.Polygon(ring).is_valid or not polygon.buffer(SHARED).covers(shapely.Polygon(ring)):
                return Violation(room.id, "self_intersection", f"{name}[{k}] is not a simple polygon within floor_polygon")
    if not room_polygon(room).is_valid:
        return Violation(room.id, "self_intersection", "holes overlap or touch each other or the floor_polygon")
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
    advice = "; move the wall between them (plan.repair=true does, where the overlap is a strip of up to 0.1 m)"
    if area > 0.99 * large:
        advice = "; a plan has one storey: give each its own plan"
    elif area > 0.99 * small:
        advice = f"; cut {plan.rooms[inner].id} out of {plan.rooms[outer].id}, as one of its holes (plan.repair=true does)"
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


def squeezed(plan: FloorPlan, portal: Portal) -> Violation | None:
    """An opening that reaches into a ceiling or into the wall of a corner, on either side."""
    listing = portal.wall.room
    room = plan.rooms[listing]
    name = describe(portal.opening, portal.index)
    for side in (listing,) if portal.behind is None else (listing, portal.behind.room):
        other = plan.rooms[side]
        if portal.head > other.ceiling_height + 1e-9:
            message = f"{name} reaches {portal.head:g} m high; the ceiling of {other.id} is at {other.ceiling_height:g} m{MENDS}"
            return Violation(room.id, "opening_off_wall", message)
        floor = interiors(plan)[side]
        # The edge of a floor may be off by SHARED where walls are not quite parallel, so look one to two SHARED beyond.
        behind = portal.wall.thickness if portal.behind is None else portal.behind.thickness
        face = portal.wall.thickness if side == listing else -behind - portal.gap
        away = 1.0 if side == listing else -1.0
        before = _strip(portal, face + away * SHARED, face + away * 2 * SHARED)
        if floor is not None and before.difference(floor).area > 1e-6:
            free = _free_stretch(portal, floor, face + 1.5 * away * SHARED)
            message = f"{name} reaches into a corner of {other.id}; {free}{MENDS}"
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
        if portal.is_open:
            continue
        room, outlook = plan.rooms[portal.wall.room], OUTLOOK.get(portal.kind, DOORSTEP)
        view = _strip(portal, -outlook, -SHARED).buffer(-SHARED / 4, join_style="mitre")
        blocking = sorted(tree.query(view, predicate="intersects").tolist(), key=lambda k: plan.rooms[k].id)
        if blocking:
            names = ", ".join(plan.rooms[k].id for k in blocking)
            message = f"{describe(portal.opening, portal.index)} has {names} less than {outlook:g} m before it; "
            gap = room_polygon(room).distance(room_polygon(plan.rooms[blocking[0]]))
            advice = "rooms that an opening joins share one line, the middle of the wall"
            mends = f" (plan.repair=true closes the gap of {gap:.3g} m between {room.id} and {plan.rooms[blocking[0]].id})"
            rule = "window_interior" if portal.kind == "window" else "door_exterior"
            violations.append(Violation(room.id, rule, message + advice + mends))
    return violations


def _strip(portal: Portal, first: float, second: float) -> shapely.Polygon:
    """The rectangle over an opening between two distances inside its wall's line, metres."""
    wall = portal.wall
    start, end = (wall.start + along * wall.direction for along in (portal.low, portal.high))
    return shapely.Polygon(
        [p + inside * wall.normal for inside, ps in ((first, (start, end)), (second, (end, start))) for p in ps]
    )


def _unreachable(plan: FloorPlan, portals: tuple[Portal, ...], doubtful: list[Violation]) -> list[Violation]:
    """Rooms of parts that have no door to the outside, less the largest part."""
    joined = [portal.rooms for portal in portals if portal.is_way]
    main, *others = joined_rooms(len(plan.rooms), [*joined, *_perhaps(plan, doubtful)])
    outside = {portal.wall.room for portal in portals if portal.is_entrance}
    cut_off = sorted(room for part in others if not outside & set(part) for room in part)
    message = f"no doors or passages lead to it from {plan.rooms[main[0]].id}{_ADVICE}"
    return [Violation(plan.rooms[room].id, "unreachable", message) for room in cut_off]


def _perhaps(plan: FloorPlan, faults: list[Violation]) -> list[tuple[int, int]]:
    """Pairs of neighbours of which one breaks a rule that, once kept, may join them."""
    blamed = {fault.room for fault in faults if fault.rule != "window_interior"}
    rooms = np.array([k for k, room in enumerate(plan.rooms) if room.id in blamed], dtype=int)
    polygons = room_polygons(plan)
    i, j = shapely.STRtree(polygons).query(polygons[rooms], predicate="dwithin", distance=NEIGHBOUR)
    return list(zip(rooms[i].tolist(), j.tolist()))
