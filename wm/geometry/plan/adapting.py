"""What a plan says in a form that the building does not have, in the form that is the same to look at. Each change is told.

    a hole in a room with nothing in it and no space for a courtyard   a column
    a room that nothing opens into and that is too small to enter      solid wall: a shaft
    a window between two rooms                                         a hatch: what is seen through it is the other room
    a passage or a hatch to the outside                                a door, which is closed
    a hole that belongs to a room of its own, and a courtyard          as they are

And what is as the plan says but may not be meant: doors that nobody gets through, rooms that cannot be reached.
"""

import dataclasses
from collections.abc import Sequence

import shapely

from wm.geometry.plan.connected import connected_parts, entrances
from wm.geometry.plan.footprint import ENTERED, interiors
from wm.geometry.plan.openings import describe, place, portals
from wm.geometry.plan.portal import STEP, WAY, Portal
from wm.geometry.plan.records import FloorPlan, Opening, Room
from wm.geometry.plan.walls import Wall, plan_walls, room_polygon

COURTYARD = 1.0  # square metres of open air that a hole without a room must have
UPRIGHT = 1.7  # metres of a door that one passes without stooping
_MOST_NAMED = 8


def columns_for_holes(rooms: Sequence[Room]) -> tuple[tuple[Room, ...], tuple[str, ...]]:
    """The rooms with each small hole that no room lies in made a column."""
    insides = [shapely.Polygon(room.polygon).representative_point() for room in rooms]
    result, notes = [], []
    for room in rooms:
        holes, columns = [], list(room.columns)
        for hole in room.holes:
            area = shapely.Polygon(hole)
            if area.is_valid and area.area < COURTYARD and not shapely.covers(area, insides).any():
                columns.append(hole[::-1].copy())
                notes.append(f"room {room.id}: a hole of {area.area:.3g} m^2 with no room in it is a column")
            else:
                holes.append(hole)
        same = len(holes) == len(room.holes)
        result.append(room if same else dataclasses.replace(room, holes=tuple(holes), columns=tuple(columns)))
    return tuple(result), tuple(notes)


def adapted(plan: FloorPlan) -> tuple[FloorPlan, tuple[str, ...]]:
    """A plan of rooms with simple polygons that do not overlap, its openings and shafts as above."""
    rooms, notes = [], []
    for room, walls in zip(plan.rooms, plan_walls(plan)):
        openings = []
        for k, opening in enumerate(room.openings):
            openings.append(_adapted_opening(k, opening, walls))
            if openings[-1] is not opening:
                notes.append(f"room {room.id}: {describe(opening, k)} {_TOLD[openings[-1].kind]}")
        changed = any(a is not b for a, b in zip(openings, room.openings))
        rooms.append(dataclasses.replace(room, openings=tuple(openings)) if changed else room)
    plan = dataclasses.replace(plan, rooms=tuple(rooms)) if notes else plan
    plan, told = _filled(plan)
    return plan, (*notes, *told)


_TOLD = {
    "hatch": "is carried as an open hatch: it leads into another room, and is a window or above the floor",
    "door": "is carried as a door, closed: it leads outside",
}


def _adapted_opening(k: int, opening: Opening, walls: tuple[Wall, ...]) -> Opening:
    if opening.kind == "window":
        portal = place(k, dataclasses.replace(opening, kind="hatch"), walls)
        return portal.opening if isinstance(portal, Portal) and portal.behind is not None else opening
    portal = place(k, dataclasses.replace(opening, kind="door"), walls)
    if not isinstance(portal, Portal):
        return opening
    if portal.behind is None:
        return opening if opening.kind == "door" else portal.opening
    return dataclasses.replace(opening, kind="hatch") if opening.kind != "hatch" and opening.sill_height > STEP else opening


def _filled(plan: FloorPlan) -> tuple[FloorPlan, tuple[str, ...]]:
    """The plan with the rooms that nobody enters and nothing opens into as solid parts of the building."""
    opened = _opened(plan)
    shafts = [k for k, floor in enumerate(interiors(plan)) if k not in opened and _is_tiny(plan, k, floor)]
    if not shafts or len(shafts) == len(plan.rooms):
        return plan, ()
    notes = []
    for k in shafts:
        room = plan.rooms[k]
        notes.append(f"room {room.id} ({room_polygon(room).area:.3g} m^2): nothing opens into it, and it is built as solid wall")
    rooms = tuple(room for k, room in enumerate(plan.rooms) if k not in shafts)
    solids = (*plan.solids, *(plan.rooms[k].polygon for k in shafts))
    return dataclasses.replace(plan, rooms=rooms, solids=solids), tuple(notes)


def _opened(plan: FloorPlan) -> set[int]:
    """The rooms that an opening of theirs or of a neighbour's opens into, or may be meant to."""
    opened = {k for k, room in enumerate(plan.rooms) if room.openings}
    for room, walls in zip(plan.rooms, plan_walls(plan)):
        for k, opening in enumerate(room.openings):
            portal = place(k, opening, walls)
            if isinstance(portal, Portal) and portal.behind is not None:
                opened.add(portal.behind.room)
    return opened


def _is_tiny(plan: FloorPlan, index: int, floor: shapely.Polygon | None) -> bool:
    """Whether nobody enters a room."""
    if floor is None:
        return bool(room_polygon(plan.rooms[index]).buffer(-ENTERED - plan.wall_thickness).is_empty)
    return bool(floor.buffer(-ENTERED).is_empty)


def doubts(plan: FloorPlan) -> tuple[str, ...]:
    """What of a plan that keeps the rules may not be meant, a sentence each."""
    notes = []
    for portal in portals(plan):
        room, opening = plan.rooms[portal.wall.room], portal.opening
        name = f"room {room.id}: {describe(opening, portal.index)}"
        if portal.kind in ("door", "passage") and not (portal.is_way or portal.is_entrance):
            notes.append(
                f"{name} is {opening.width:g} x {opening.height:g} m: nobody gets through, a body needs {WAY[0]:g} x {WAY[1]:g}"
            )
        elif portal.kind in ("door", "passage") and opening.height < UPRIGHT:
            notes.append(f"{name} is {opening.height:g} m high: people stoop to get through")
    return (*notes, *_apart(plan))


def _apart(plan: FloorPlan) -> list[str]:
    """One sentence for each part of the plan that no way leads to from its largest."""
    main, *others = connected_parts(plan)
    doors = {portal.wall.room for portal in entrances(plan)}
    notes = []
    for part in others:
        names = ", ".join(plan.rooms[room].id for room in part[:_MOST_NAMED]) + (" ..." if len(part) > _MOST_NAMED else "")
        way = f"no doors or passages lead there from {plan.rooms[main[0]].id}"
        refused = " (plan.unreachable=refuse refuses that)"
        notes.append(
            f"room {names}: {way}; {'it has an entrance of its own' if doors & set(part) else f'nobody gets in{refused}'}"
        )
    return notes
