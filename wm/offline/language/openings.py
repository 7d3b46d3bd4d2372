"""Doors, passages and windows for a massing. Every room can be reached, and the house has one door to the outside.

Doors lie near a corner, so that the rest of the wall is free for furniture; passages lie in the middle of their wall. Lengths are
whole centimetres along the line of a wall.
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Int

from wm.offline.language.building import Building, draw
from wm.offline.language.facades import Side, Stretch, sides_of, stretches_of
from wm.offline.language.programme import CIRCULATION, PRIVATE, PUBLIC, WET, Space

JAMB = 38  # cm from the centre line of a crossing wall to a door, which leaves 0.3 m of wall
TIGHT = 24  # the same, cm, if the wall is too short for JAMB
APART = 30  # cm of wall between two openings: many times the minimum of a plan (wm.geometry.plan.openings.APART)
CORNER = 50  # cm from a window to the end of its wall
OUTLOOK = 120  # cm of open air in front of a window: four times the minimum of a plan (wm.geometry.plan.rules)

# Pairs of kinds that may have a further door between them if they share a wall.
_FRIENDS = {
    frozenset(pair)
    for pair in (
        ("kitchen", "dining"), ("kitchen", "living"), ("living", "dining"), ("living", "conservatory"), ("living", "library"),
        ("dining", "conservatory"), ("dining", "great hall"), ("library", "study"), ("living", "leisure"), ("living", "ballroom"),
        ("hall", "living"),
    )
}  # fmt: skip
_JOINED = 0.7  # probability of that door


@dataclasses.dataclass(frozen=True)
class Hole:
    """An opening that the grammar has drawn, from `low` to `high` along the line of its side.

    It is another record than the plan's `Opening` (wm.geometry.plan.records) because it exists before there is a plan: it lies on
    a side of the massing, in whole centimetres. grammar.py writes it as an opening of the plan's JSON.
    """

    kind: str
    side: Side
    behind: Side | None
    low: int
    high: int
    height: int
    sill: int


def draw_openings(
    polygons: Sequence[Int[np.ndarray, "_ 2"]],
    spaces: Sequence[Space],
    ceilings: Sequence[int],
    building: Building,
    rng: np.random.Generator,
) -> list[Hole]:
    """Openings for all rooms: first doors and passages, then windows, at last the entrance.

    Args:
      polygons: [k, 2] polygon of each room, cm, counter-clockwise, axis-aligned.
      spaces: the rooms of the programme.
      ceilings: ceiling height of each room, cm.
    """
    stretches = stretches_of(sides_of(polygons))
    shared = [stretch for stretch in stretches if stretch.behind is not None]
    holes: list[Hole] = []
    tree = _tree(shared, spaces, rng)
    for stretch in tree:
        holes.append(_door(stretch, spaces, ceilings, building, holes, rng))
    joined = {_rooms(stretch) for stretch in tree}
    for stretch in shared:
        friends = frozenset(spaces[room].kind.name for room in _rooms(stretch)) in _FRIENDS
        if friends and _rooms(stretch) not in joined and _usable(stretch, JAMB) >= 90 and rng.random() < _JOINED:
            joined.add(_rooms(stretch))
            holes.append(_door(stretch, spaces, ceilings, building, holes, rng))
    shapes = np.array([shapely.Polygon(polygon) for polygon in polygons])
    outer = [stretch for stretch in stretches if stretch.behind is None]
    for room in range(len(spaces)):
        holes += _windows([s for s in outer if s.side.room == room], shapes, spaces[room], ceilings[room], building, rng)
    return _with_entrance(holes, [s for s in outer if _open_air(s, shapes)], spaces, ceilings, building)


def _with_entrance(
    holes: list[Hole], outer: Sequence[Stretch], spaces: Sequence[Space], ceilings: Sequence[int], building: Building
) -> list[Hole]:
    """The openings and an entrance: in a hall where one has an outer wall, else in the first room that has.

    It stands beside the windows, or else in the place of one. Nothing is drawn at random here, so that the house stays as it was.
    """
    width = round(100 * building.door[0])
    order = sorted(range(len(spaces)), key=lambda k: (spaces[k].kind.zone != CIRCULATION, spaces[k].kind.name == "corridor", k))
    for room in order:
        height = min(round(100 * building.door[1]), ceilings[room] - 20)
        walls = sorted((s for s in outer if s.side.room == room), key=lambda s: (s.low - s.high, s.side.start))
        for stretch in walls:
            for low in range(stretch.low + JAMB, stretch.high - JAMB - width + 1, 5):
                door = Hole("door", stretch.side, None, low, low + width, height, 0)
                if not any(_conflicts(door, hole) for hole in holes):
                    return [*holes, door]
        door = _in_place_of_a_window(holes, room, width, height, spaces[room].kind.zone == CIRCULATION)
        if door is not None:
            return [hole for hole in holes if not _conflicts(door, hole)] + [door]
    return holes


def _in_place_of_a_window(holes: Sequence[Hole], room: int, width: int, height: int, last: bool) -> Hole | None:
    """An entrance where a window of the room is wide enough for it; its last window is taken only where `last` says so."""
    windows = [hole for hole in holes if hole.side.room == room and hole.kind == "window" and hole.high - hole.low >= width]
    if not windows or (not last and sum(hole.side.room == room and hole.kind == "window" for hole in holes) < 2):
        return None
    low = (windows[0].low + windows[0].high - width) // 2
    return Hole("door", windows[0].side, None, low, low + width, height, 0)


def _conflicts(a: Hole, b: Hole) -> bool:
    """Whether two openings lie in one wall with less than APART between them."""
    return a.side.axis == b.side.axis and a.side.at == b.side.at and a.low < b.high + APART and b.low < a.high + APART


def _rooms(stretch: Stretch) -> frozenset[int]:
    assert stretch.behind is not None
    return frozenset((stretch.side.room, stretch.behind.room))


def _usable(stretch: Stretch, margin: int) -> int:
    return stretch.high - stretch.low - 2 * margin


def _tree(shared: Sequence[Stretch], spaces: Sequence[Space], rng: np.random.Generator) -> list[Stretch]:
    """The shared walls with doors that connect all rooms to the hub: a spanning tree of least cost (Prim's algorithm)."""
    hub = min(range(len(spaces)), key=lambda i: (spaces[i].kind.zone != CIRCULATION, spaces[i].kind.rank, i))
    costs = [_awkward(stretch, spaces, hub) + 0.5 * rng.random() for stretch in shared]
    reached, tree = {hub}, []
    while True:
        ways = [k for k, way in enumerate(shared) if len(_rooms(way) & reached) == 1 and _usable(way, TIGHT) >= 90]
        if not ways:
            return tree
        best = shared[min(ways, key=costs.__getitem__)]
        tree.append(best)
        reached |= _rooms(best)


def _awkward(stretch: Stretch, spaces: Sequence[Space], hub: int) -> float:
    """The cost of a door in this wall: low if it leads to a hall, a corridor or the hub, high between unrelated rooms."""
    a, b = (spaces[room].kind for room in sorted(_rooms(stretch)))
    zones = {a.zone, b.zone}
    tight = 1.0 if _usable(stretch, JAMB) < 90 else 0.0
    if CIRCULATION in zones or hub in _rooms(stretch):
        return tight
    if zones == {PUBLIC}:
        return 2.0 + tight
    if zones == {PRIVATE, WET} or ({a.name, b.name} & {"service", "pantry"} and "kitchen" in (a.name, b.name)):
        return 3.0 + tight
    return (6.0 if PUBLIC in zones else 9.0) + tight


def _door(
    stretch: Stretch,
    spaces: Sequence[Space],
    ceilings: Sequence[int],
    building: Building,
    holes: Sequence[Hole],
    rng: np.random.Generator,
) -> Hole:
    """A door or passage in this wall, at the position that conflicts least with other openings."""
    a, b = (spaces[room].kind for room in sorted(_rooms(stretch)))
    ceiling = min(ceilings[room] for room in _rooms(stretch))
    both_lead = a.zone == b.zone == CIRCULATION
    may_open = {a.zone, b.zone} <= {CIRCULATION, PUBLIC}
    margin = JAMB if _usable(stretch, JAMB) >= 90 else TIGHT
    usable = _usable(stretch, margin)
    width, height = (round(100 * value) for value in building.door)
    kind = "door"
    if both_lead or (may_open and usable >= 150 and rng.random() < building.openness):
        kind = "passage"
        width = min(usable, 240 if both_lead else round(usable * rng.uniform(0.4, 0.7) / 5) * 5, 320)
        width, height = max(width, min(usable, 140)), height + 20
    width = min(width, usable)
    low, high = stretch.low + margin, stretch.high - margin - width
    corners = [low, high] if kind == "door" else [(low + high) // 10 * 5, low, high]
    spare = [low + (high - low) * k // 40 * 5 for k in range(1, 8)]
    tries = [*corners, *[min(max(at, low), high) for at in spare]]
    costs = [
        _disturbs(stretch, at, at + width, holes) + (0.0 if k < len(corners) else 0.6) + 0.3 * float(rng.random())
        for k, at in enumerate(tries)
    ]
    at = tries[int(np.argmin(costs))]
    return Hole(kind, stretch.side, stretch.behind, at, at + width, min(height, ceiling - 20), 0)


def _disturbs(stretch: Stretch, low: int, high: int, holes: Sequence[Hole]) -> float:
    """The cost of an opening here: it overlaps another one, partly faces one, or lies around the corner from one."""
    cost, side = 0.0, stretch.side
    rooms = _rooms(stretch)
    for hole in holes:
        near = hole.behind is not None and bool(rooms & {hole.side.room, hole.behind.room})
        if hole.side.axis == side.axis and hole.side.at == side.at:
            if low < hole.high + APART and hole.low < high + APART:
                cost += 100.0
        elif near and hole.side.axis == side.axis and abs(hole.side.at - side.at) <= 300:
            overlap = min(high, hole.high) - max(low, hole.low)
            aligned = abs(low + high - hole.low - hole.high) <= 10
            cost += 2.0 if overlap > 0 and not aligned else 0.0
        elif near and hole.side.axis != side.axis:
            along = max(low - hole.side.at, hole.side.at - high, 0)
            across = max(hole.low - side.at, side.at - hole.high, 0)
            cost += 1.5 if math.hypot(along, across) < 110 else 0.0
    return cost


def _windows(
    outer: Sequence[Stretch],
    shapes: np.ndarray,
    space: Space,
    ceiling: int,
    building: Building,
    rng: np.random.Generator,
) -> list[Hole]:
    """Evenly spaced windows in the longest outer walls. Their number depends on the floor area."""
    zone = space.kind.zone
    width = round(100 * draw(building.window, rng))
    sill, head = round(100 * building.sill), min(round(100 * building.head), ceiling - 25)
    if zone == WET:
        width, sill = min(width, 80), min(140, head - 60)  # small and above eye level for those who sit
    elif space.kind.name in ("kitchen", "service", "pantry"):
        width, sill = min(width, 150), max(sill, 100)  # above the worktop
    wanted = 1 if zone == WET else max(1, math.ceil(space.area / 7))
    holes: list[Hole] = []
    for stretch in sorted(outer, key=lambda s: (s.low - s.high, s.side.start)):
        clear = stretch.high - stretch.low - 2 * CORNER
        fitting = int((clear + 100 * building.spacing) // (width + 100 * building.spacing))
        each = width
        if fitting == 0 and clear >= 60 and not holes:
            fitting, each = 1, clear // 5 * 5  # a narrow window is better than none
        count = min(fitting, wanted - len(holes), 3)
        if count <= 0 or not _open_air(stretch, shapes):
            continue
        pitch = (stretch.high - stretch.low) / count
        for k in range(count):
            low = round((stretch.low + (k + 0.5) * pitch - each / 2) / 5) * 5
            holes.append(Hole("window", stretch.side, None, low, low + each, head - sill, sill))
    return holes


def _open_air(stretch: Stretch, shapes: np.ndarray) -> bool:
    """Whether there is open air in front of this stretch of outer wall, for at least OUTLOOK."""
    side = stretch.side
    near, far = sorted((side.at + side.outward, side.at + side.outward * OUTLOOK))
    low, high = (near, stretch.low + 1), (far, stretch.high - 1)
    if side.axis == 1:
        low, high = low[::-1], high[::-1]
    before = shapely.box(low[0], low[1], high[0], high[1])
    return not shapely.intersects(shapes, before).any()
