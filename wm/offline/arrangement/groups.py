"""Functional groups: pieces that belong together, placed around an anchor.

Each returns its anchor, or None where there was no place for it; companions are added as far as there is room for them.
"""

import math

from wm.geometry.placement.clearances import FLAT
from wm.geometry.placement.upright_box import UprightBox
from wm.offline.arrangement.clutter import place_on
from wm.offline.arrangement.hangings import hang
from wm.offline.arrangement.layout import Placed
from wm.offline.arrangement.room_arrangement import RoomArrangement, beside, local
from wm.offline.furniture import KINDS
from wm.offline.style.finish import PERIOD


def rug_under(room: RoomArrangement, x: float, y: float, yaw: float, w: float, d: float) -> Placed | None:
    """A rug, smaller if need be, centred where a group stands."""
    for factor in (1.0, 0.85, 0.7):
        taken = UprightBox(x, y, 0.0, yaw, w * factor + 0.02, d * factor + 0.02, FLAT).footprint
        piece = room.piece("rug", (w * factor, d * factor, FLAT))
        if all(other.piece.support != "flat" or not other.footprint.intersects(taken) for other in room.layout.placed):
            placed = room.layout.try_at(piece, x, y, yaw)
            if placed is not None:
                return placed
    return None


def sleeping(room: RoomArrangement) -> Placed | None:
    """Bed, nightstands with lamps, chest at its foot, rug, picture above."""
    ornate = room.style.form.ornament > 0.6 and room.layout.site.ceiling > 2.5
    area = room.layout.site.polygon.area
    kinds = ["bed", "single bed"] if area > 8 else ["single bed"]
    if ornate and area > 15:
        kinds = ["four-poster bed", *kinds] if room.rng.random() < 0.65 else kinds
    for kind in kinds:
        placed = room.layout.against_wall(
            room.piece(kind), room.rng, front=KINDS[kind].front, where="centre", mates=frozenset({"blanket chest", "bench"})
        )
        if placed is None:
            continue
        for side in (-1.0, 1.0):
            room.dressed(beside(room, placed, room.piece("nightstand"), side, gap=0.07))
        if room.chance(0.7):
            chest = room.piece("blanket chest" if room.rng.random() < 0.7 else "bench")
            x, y = local(placed, 0.0, -(float(placed.piece.size[1]) + float(chest.size[1])) / 2 - 0.08)
            room.layout.try_at(chest, x, y, placed.yaw)
        w, d = float(placed.piece.size[0]), float(placed.piece.size[1])
        x, y = local(placed, 0.0, -0.35 * d)
        rug_under(room, x, y, placed.yaw, w + 1.1, 0.75 * d)
        return placed
    return None


def hearth(room: RoomArrangement) -> Placed | None:
    """What a sitting room looks at: a fireplace, or a television on its bench."""
    mates = frozenset({"coffee table", "ottoman"})
    if room.style.family in PERIOD or room.rng.random() < 0.35:
        placed = room.layout.against_wall(
            room.piece("fireplace"), room.rng, front=KINDS["fireplace"].front, where="centre", gap=0.008, mates=mates
        )
        return room.dressed(placed)
    placed = room.layout.against_wall(room.piece("media bench"), room.rng, front=0.4, where="centre", mates=mates)
    if placed is not None and place_on(room.layout, placed, room.piece("television"), 0.0, 0.0, placed.piece.tops[0].z) is None:
        room.dressed(placed)
    return placed


def sitting(room: RoomArrangement, focus: Placed | None) -> Placed | None:
    """Sofa before the focus (or at a wall), coffee table, armchairs, side table with lamp, rug."""
    mates = frozenset({"coffee table", "armchair", "ottoman"})
    sofa = room.piece("sofa")
    d = float(sofa.size[1])
    placed = None
    if focus is not None:
        for away in (2.1, 1.9, 2.4, 1.7, 2.8):
            x, y = local(focus, 0.0, -float(focus.piece.size[1]) / 2 - away - d / 2)
            placed = placed or room.layout.try_at(sofa, x, y, focus.yaw + math.pi, front=0.45, mates=mates)
        across = [
            k for k, normal in enumerate(room.layout.site.normals) if normal @ [math.sin(focus.yaw), -math.cos(focus.yaw)] < -0.9
        ]
        if placed is None and across:
            opposite = local(focus, 0.0, -3.0)
            placed = room.layout.against_wall(sofa, room.rng, front=0.45, mates=mates, walls=across, near=opposite)
    placed = placed or room.layout.against_wall(sofa, room.rng, front=0.45, where="centre", mates=mates)
    if placed is None:
        return around_table(room)
    table = room.piece("coffee table")
    x, y = local(placed, 0.0, -(d + float(table.size[1])) / 2 - 0.38)
    low = room.dressed(room.layout.try_at(table, x, y, placed.yaw))
    centre = (x, y) if low is not None else local(placed, 0.0, -d / 2 - 0.6)
    rug_under(room, *centre, placed.yaw, 2.6, 1.8)
    seats = 0
    for side in (1.0, -1.0):
        if room.rng.random() < 0.85:
            chair = room.piece("armchair")
            for reach in (0.35, 0.6):
                x, y = local(
                    placed,
                    side * (float(table.size[0]) / 2 + reach + float(chair.size[1]) / 2),
                    -(d + float(table.size[1])) / 2 - 0.42,
                )
                turn = placed.yaw - side * math.radians(float(room.rng.uniform(72, 100)))
                if room.layout.try_at(chair, x, y, turn):
                    seats += 1
                    break
    side = 1.0 if room.rng.random() < 0.5 else -1.0
    for s in (side, -side):
        if room.dressed(beside(room, placed, room.piece("side table"), s, gap=0.08)):
            break
    if room.chance(0.7):
        beside(room, placed, room.piece("floor lamp"), -side, gap=0.1)
    return placed


def around_table(room: RoomArrangement, near: tuple[float, float] | None = None) -> Placed | None:
    """Two armchairs with a small table between them, in the middle of the room or near a point."""
    centre = near or room.layout.site.centre
    table = room.dressed(room.layout.on_floor(room.piece("side table"), room.rng, centre, yaw=0.0, radius=2.0))
    if table is None:
        return None
    start = float(room.rng.uniform(0, 2 * math.pi))
    for k in range(2):
        chair = room.piece("armchair")
        for step in range(8):
            a = start + k * math.pi + (step + 1) // 2 * (-1) ** step * 0.5
            r = float(table.piece.size[0]) / 2 + float(chair.size[1]) / 2 + 0.2
            if room.layout.try_at(chair, table.x + r * math.cos(a), table.y + r * math.sin(a), a - math.pi / 2):
                break
    return table


def middle_piece(room: RoomArrangement, kind: str) -> Placed | None:
    """Something for a large empty floor: two chairs and a table, a round table with flowers, or a bench, on a rug."""
    x, y, free = room.layout.emptiest()
    if free < 1.25:
        return None
    reading = kind in ("living", "library", "study", "bedroom", "other") or room.rng.random() < 0.4
    if reading:
        placed = around_table(room, (x, y))
    else:
        placed = room.dressed(room.layout.on_floor(room.piece("round table"), room.rng, (x, y), yaw=0.0, radius=0.6, spread=0.1))
    if placed is not None and free > 1.4:
        side = min(2 * free - 0.9, 2.2)
        size = (side, side, FLAT)
        if not any(
            other.piece.support == "flat" and other.footprint.distance(placed.footprint) < side / 2
            for other in room.layout.placed
        ):
            room.layout.try_at(room.piece("round rug", size), placed.x, placed.y, 0.0)
    return placed


def dining_group(room: RoomArrangement, *, kitchen: bool = False) -> Placed | None:
    """Table with chairs on all sides, lamp above, rug below, dressed."""
    site = room.layout.site
    spread = site.polygon.buffer(-1.35)
    long = 0.0 if spread.is_empty else max(spread.bounds[2] - spread.bounds[0], spread.bounds[3] - spread.bounds[1])
    across = not spread.is_empty and spread.bounds[2] - spread.bounds[0] < spread.bounds[3] - spread.bounds[1]
    yaw = math.pi / 2 if across else 0.0
    sizes = []
    if long > 0.4 and not kitchen:
        sizes = [(w, float(room.rng.uniform(0.88, 0.98)), 0.75) for w in (2.1, 1.75, 1.4) if w < long + 1.0]
    for size in [*sizes, None]:
        piece = room.piece("dining table", size) if size else room.piece("round table", (0.95, 0.95, 0.75))
        for turn in (yaw, yaw + math.pi / 2):
            mark = room.layout.mark()
            placed = room.layout.on_floor(piece, room.rng, site.centre, yaw=turn, radius=1.6 if kitchen else 0.9, spread=0.1)
            if placed is None:
                continue
            if seat_around(room, placed, round_=size is None) < 2:
                room.layout.back_to(mark)
                continue
            if not kitchen:
                rug_under(room, placed.x, placed.y, placed.yaw, float(piece.size[0]) + 1.2, float(piece.size[1]) + 1.3)
            hang(room, placed.x, placed.y, low=placed.top + 0.75)
            return room.dressed(placed)
    return None


def seat_around(room: RoomArrangement, table: Placed, *, round_: bool) -> int:
    """Chairs around a table, their fronts a hand's breadth off its edge; how many found room."""
    w, d = float(table.piece.size[0]), float(table.piece.size[1])
    chair = room.piece("chair")
    cd = float(chair.size[1])
    spots: list[tuple[float, float, float]] = []
    if round_:
        reach = w / 2 + cd / 2 + 0.03
        for k in range(4):
            a = math.pi / 2 * k
            spots.append((reach * math.cos(a), reach * math.sin(a), a - math.pi / 2))
    else:
        count = max(int((w - 0.2) / 0.58), 1)
        for k in range(count):
            x = (k + 0.5 - count / 2) * (w - 0.1) / count
            spots += [(x, -(d / 2 + cd / 2 + 0.03), math.pi), (x, d / 2 + cd / 2 + 0.03, 0.0)]
        spots += [(w / 2 + cd / 2 + 0.03, 0.0, -math.pi / 2), (-(w / 2 + cd / 2 + 0.03), 0.0, math.pi / 2)]
    seats = 0
    for x, y, turn in spots:
        if room.rng.random() < 0.5 + 0.5 * room.density:
            at = local(table, x, y)
            seats += room.layout.try_at(chair, *at, table.yaw + turn + math.radians(float(room.rng.uniform(-2, 2)))) is not None
    return seats
