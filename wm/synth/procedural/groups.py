"""Functional groups: pieces that belong together, placed around an anchor. Each returns its anchor, or None where it found no place.

A group's anchor decides whether there is a group at all; its companions come as far as there is room for them.
"""

import dataclasses
import math

import numpy as np

from wm.synth.procedural.clutter import PERIOD, dress, place_on
from wm.synth.procedural.finish import Style
from wm.synth.procedural.furniture import Piece, make_piece
from wm.synth.procedural.furniture.catalog import KINDS
from wm.synth.procedural.layout import LIFT, Layout, Placed
from wm.synth.procedural.site import rectangle


@dataclasses.dataclass(frozen=True, eq=False)
class Desk:
    """What every group needs at hand: the room, the style, the dice."""

    layout: Layout
    style: Style
    rng: np.random.Generator
    density: float

    def piece(self, kind: str, size: tuple[float, float, float] | None = None) -> Piece:
        return make_piece(kind, self.style, self.rng, size=size)

    def dressed(self, placed: Placed | None) -> Placed | None:
        if placed is not None:
            dress(self.layout, placed, self.style, self.rng, density=self.density)
        return placed

    def at_wall(self, kind: str, *, where: str = "any", mates: frozenset[str] = frozenset(), size: tuple[float, float, float] | None = None) -> Placed | None:  # fmt: skip
        """A piece of a kind with its back to a wall, its surfaces dressed."""
        piece = self.piece(kind, size)
        return self.dressed(self.layout.against_wall(piece, self.rng, front=KINDS[kind].front, where=where, mates=mates))

    def chance(self, share: float) -> bool:
        """A draw that density makes less likely; the dice are thrown either way."""
        return bool(self.rng.random() < share * self.density)


def local(placed: Placed, dx: float, dy: float) -> tuple[float, float]:
    """World (x, y) of a point of a placed piece's frame."""
    c, s = math.cos(placed.yaw), math.sin(placed.yaw)
    return placed.x + c * dx - s * dy, placed.y + s * dx + c * dy


def beside(desk: Desk, placed: Placed, piece: Piece, side: float, *, gap: float = 0.06, flush: str = "back", turned: float = 0.0) -> Placed | None:
    """A piece next to another, on its right (side 1) or left (-1), backs or fronts in line."""
    w, d = float(placed.piece.size[0]), float(placed.piece.size[1])
    dy = (d - float(piece.size[1])) / 2 * (1.0 if flush == "back" else -1.0)
    x, y = local(placed, side * (w / 2 + gap + float(piece.size[0]) / 2), dy)
    return desk.layout.try_at(piece, x, y, placed.yaw + turned)


def rug_under(desk: Desk, x: float, y: float, yaw: float, w: float, d: float) -> Placed | None:
    """A rug, smaller if need be, centred where a group stands."""
    for factor in (1.0, 0.85, 0.7):
        piece = desk.piece("rug", (w * factor, d * factor, 0.008))
        if all(other.piece.support != "flat" or not other.footprint.intersects(rectangle(x, y, yaw, w * factor + 0.02, d * factor + 0.02)) for other in desk.layout.placed):  # fmt: skip
            placed = desk.layout.try_at(piece, x, y, yaw)
            if placed is not None:
                return placed
    return None


def sleeping(desk: Desk) -> Placed | None:
    """Bed, nightstands with lamps, chest at its foot, rug, picture above."""
    ornate = desk.style.form.ornament > 0.6 and desk.layout.site.ceiling > 2.5
    area = desk.layout.site.polygon.area
    kinds = ["bed", "single bed"] if area > 8 else ["single bed"]
    if ornate and area > 15:
        kinds = ["four-poster bed", *kinds] if desk.rng.random() < 0.65 else kinds
    for kind in kinds:
        placed = desk.layout.against_wall(desk.piece(kind), desk.rng, front=KINDS[kind].front, where="centre", mates=frozenset({"blanket chest", "bench"}))
        if placed is None:
            continue
        for side in (-1.0, 1.0):
            desk.dressed(beside(desk, placed, desk.piece("nightstand"), side, gap=0.07))
        if desk.chance(0.7):
            chest = desk.piece("blanket chest" if desk.rng.random() < 0.7 else "bench")
            x, y = local(placed, 0.0, -(float(placed.piece.size[1]) + float(chest.size[1])) / 2 - 0.08)
            desk.layout.try_at(chest, x, y, placed.yaw)
        w, d = float(placed.piece.size[0]), float(placed.piece.size[1])
        x, y = local(placed, 0.0, -0.35 * d)
        rug_under(desk, x, y, placed.yaw, w + 1.1, 0.75 * d)
        return placed
    return None


def hearth(desk: Desk) -> Placed | None:
    """What a sitting room looks at: a fireplace, or a television on its bench."""
    mates = frozenset({"coffee table", "ottoman"})
    if desk.style.family in PERIOD or desk.rng.random() < 0.35:
        placed = desk.layout.against_wall(desk.piece("fireplace"), desk.rng, front=KINDS["fireplace"].front, where="centre", gap=0.008, mates=mates)
        return desk.dressed(placed)
    placed = desk.layout.against_wall(desk.piece("media bench"), desk.rng, front=0.4, where="centre", mates=mates)
    if placed is not None and place_on(desk.layout, placed, desk.piece("television"), 0.0, 0.0, placed.piece.tops[0].z) is None:
        desk.dressed(placed)
    return placed


def sitting(desk: Desk, focus: Placed | None) -> Placed | None:
    """Sofa before the focus (or at a wall), coffee table, armchairs, side table with lamp, rug."""
    mates = frozenset({"coffee table", "armchair", "ottoman"})
    sofa = desk.piece("sofa")
    d = float(sofa.size[1])
    placed = None
    if focus is not None:
        for away in (2.1, 1.9, 2.4, 1.7, 2.8):
            x, y = local(focus, 0.0, -float(focus.piece.size[1]) / 2 - away - d / 2)
            placed = placed or desk.layout.try_at(sofa, x, y, focus.yaw + math.pi, front=0.45, mates=mates)
    placed = placed or desk.layout.against_wall(sofa, desk.rng, front=0.45, where="centre", mates=mates)
    if placed is None:
        return around_table(desk)
    table = desk.piece("coffee table")
    x, y = local(placed, 0.0, -(d + float(table.size[1])) / 2 - 0.38)
    low = desk.dressed(desk.layout.try_at(table, x, y, placed.yaw))
    centre = (x, y) if low is not None else local(placed, 0.0, -d / 2 - 0.6)
    rug_under(desk, *centre, placed.yaw, 2.6, 1.8)
    seats = 0
    for side in (1.0, -1.0):
        if desk.rng.random() < 0.85:
            chair = desk.piece("armchair")
            for reach in (0.35, 0.6):
                x, y = local(placed, side * (float(table.size[0]) / 2 + reach + float(chair.size[1]) / 2), -(d + float(table.size[1])) / 2 - 0.42)
                turn = placed.yaw - side * math.radians(float(desk.rng.uniform(72, 100)))
                if desk.layout.try_at(chair, x, y, turn):
                    seats += 1
                    break
    side = 1.0 if desk.rng.random() < 0.5 else -1.0
    for s in (side, -side):
        if desk.dressed(beside(desk, placed, desk.piece("side table"), s, gap=0.08)):
            break
    if desk.chance(0.7):
        beside(desk, placed, desk.piece("floor lamp"), -side, gap=0.1)
    return placed


def around_table(desk: Desk) -> Placed | None:
    """Where no sofa fits: two armchairs with a small table between them."""
    table = desk.dressed(desk.layout.on_floor(desk.piece("side table"), desk.rng, desk.layout.site.centre, yaw=0.0, radius=2.0))
    if table is None:
        return None
    start = float(desk.rng.uniform(0, 2 * math.pi))
    for k in range(2):
        chair = desk.piece("armchair")
        for step in range(8):
            a = start + k * math.pi + (step + 1) // 2 * (-1) ** step * 0.5
            r = float(table.piece.size[0]) / 2 + float(chair.size[1]) / 2 + 0.2
            if desk.layout.try_at(chair, table.x + r * math.cos(a), table.y + r * math.sin(a), a - math.pi / 2):
                break
    return table


def dining(desk: Desk, *, kitchen: bool = False) -> Placed | None:
    """Table with chairs on all sides, lamp above, rug below, dressed."""
    site = desk.layout.site
    spread = site.polygon.buffer(-1.35)
    long = 0.0 if spread.is_empty else max(spread.bounds[2] - spread.bounds[0], spread.bounds[3] - spread.bounds[1])
    across = not spread.is_empty and spread.bounds[2] - spread.bounds[0] < spread.bounds[3] - spread.bounds[1]
    yaw = math.pi / 2 if across else 0.0
    sizes = []
    if long > 0.4 and not kitchen:
        sizes = [(w, float(desk.rng.uniform(0.88, 0.98)), 0.75) for w in (2.1, 1.75, 1.4) if w < long + 1.0]
    for size in [*sizes, None]:
        piece = desk.piece("dining table", size) if size else desk.piece("round table", (0.95, 0.95, 0.75))
        for turn in (yaw, yaw + math.pi / 2):
            placed = desk.layout.on_floor(piece, desk.rng, site.centre, yaw=turn, radius=1.6 if kitchen else 0.9, spread=0.1)
            if placed is None:
                continue
            if seat_around(desk, placed, round_=size is None) < 2:
                continue
            if not kitchen:
                rug_under(desk, placed.x, placed.y, placed.yaw, float(piece.size[0]) + 1.2, float(piece.size[1]) + 1.3)
            hang_over(desk, placed)
            return desk.dressed(placed)
    return None


def seat_around(desk: Desk, table: Placed, *, round_: bool) -> int:
    """Chairs around a table, their fronts a hand's breadth off its edge; how many found room."""
    w, d = float(table.piece.size[0]), float(table.piece.size[1])
    chair = desk.piece("chair")
    cd = float(chair.size[1])
    spots: list[tuple[float, float, float]] = []
    if round_:
        r = w / 2 + 0.03 + cd / 2
        start = float(desk.rng.uniform(0, math.pi / 2))
        count = 4
        spots = [((w / 2 + cd / 2 + 0.03) * c, (d / 2 + cd / 2 + 0.03) * s, a) for a, c, s in ((math.pi / 2 * k - math.pi / 2, math.cos(math.pi / 2 * k), math.sin(math.pi / 2 * k)) for k in range(count))]
        del r, start
    else:
        count = max(int((w - 0.2) / 0.58), 1)
        for k in range(count):
            x = (k + 0.5 - count / 2) * (w - 0.1) / count
            spots += [(x, -(d / 2 + cd / 2 + 0.03), math.pi), (x, d / 2 + cd / 2 + 0.03, 0.0)]
        spots += [(w / 2 + cd / 2 + 0.03, 0.0, -math.pi / 2), (-(w / 2 + cd / 2 + 0.03), 0.0, math.pi / 2)]
    seats = 0
    for x, y, turn in spots:
        if desk.rng.random() < 0.5 + 0.5 * desk.density:
            at = local(table, x, y)
            seats += desk.layout.try_at(chair_like(desk, chair), *at, table.yaw + turn + math.radians(float(desk.rng.uniform(-2, 2)))) is not None
    return seats


def chair_like(desk: Desk, chair: Piece) -> Piece:
    """Another chair of the same set: the same piece."""
    return chair


def hang_over(desk: Desk, table: Placed) -> Placed | None:
    return hang(desk, table.x, table.y, low=table.top + 0.75)


def hang(desk: Desk, x: float, y: float, *, low: float = 2.05) -> Placed | None:
    """A chandelier or pendant from the ceiling, its foot no lower than `low`."""
    ceiling = desk.layout.site.ceiling
    kind = "chandelier" if desk.style.form.lamp in ("candle", "tripod", "cone") or desk.style.family == "rustic" else "pendant lamp"
    room = ceiling - 2 * LIFT - low
    w = float(desk.rng.uniform(0.7, 0.95)) if kind == "chandelier" else float(desk.rng.uniform(0.34, 0.48))
    tall = min(room, float(desk.rng.uniform(0.75, 1.0)) if low < 2.0 else float(desk.rng.uniform(0.6, 0.8)))
    least = 0.5 if kind == "chandelier" else (1.3 if desk.style.form.lamp == "globe" else 1.0) * w
    if tall < least:
        kind, w = "pendant lamp", max(min(0.34, 0.7 * room), 0.2)
        tall = room
    if tall < 0.22:
        return None
    piece = desk.piece(kind, (w, w, tall))
    return desk.layout.try_at(piece, x, y, float(desk.rng.uniform(0, math.pi)), z=ceiling - LIFT - float(piece.size[2]))


def cooking(desk: Desk) -> Placed | None:
    """A run of units along one wall: fridge, counter, sink, stove under its hood, cupboards above."""
    site = desk.layout.site
    order = sorted(range(len(site.lengths)), key=lambda k: -float(site.lengths[k]) + float(desk.rng.uniform(0, 1.2)))
    best: list[Placed] = []
    for wall in order[:4]:
        for low, high in stretches(site, wall):
            if high - low < 1.9:
                continue
            run = kitchen_run(desk, wall, low, high)
            if run:
                best = run
                break
        if best:
            break
    if not best:
        for kind in ("sink counter", "stove", "fridge", "kitchen counter"):
            placed = desk.at_wall(kind, where="corner")
            if placed is not None:
                best.append(placed)
    return best[0] if best else None


def stretches(site, wall: int) -> list[tuple[float, float]]:
    """Parts of a wall between its doors and passages, longest first; windows do not interrupt low units."""
    cuts = sorted((gap.low - 0.08, gap.high + 0.08) for gap in site.gaps if gap.wall == wall and gap.kind != "window")
    edges, at = [], 0.0
    for low, high in cuts:
        edges.append((at, low))
        at = high
    edges.append((at, float(site.lengths[wall])))
    return sorted(edges, key=lambda e: e[0] - e[1])


def kitchen_run(desk: Desk, wall: int, low: float, high: float) -> list[Placed]:
    """Units side by side along a stretch of wall, and what hangs above them."""
    wanted = [("fridge", 0.68), ("kitchen counter", 0.9), ("sink counter", 1.1), ("stove", 0.62), ("kitchen counter", 1.1)]
    room = high - low - 0.04
    while sum(w for _, w in wanted) + 0.02 * len(wanted) > room and len(wanted) > 2:
        wanted.pop({5: 1, 4: 3, 3: 0}[len(wanted)])
    spare = room - sum(w for _, w in wanted) - 0.02 * len(wanted)
    if desk.rng.random() < 0.5:
        wanted.reverse()
    at = low + 0.02 + max(spare, 0.0) * (0.0 if desk.rng.random() < 0.5 else 1.0)
    placed: list[Placed] = []
    for kind, w in wanted:
        low_size = KINDS[kind].low
        piece = desk.piece(kind, (w, low_size[1] + 0.01, low_size[2] + (0.15 if kind == "fridge" else 0.005)))
        span = (at, at + float(piece.size[0]) + 0.025)
        at += float(piece.size[0]) + 0.021
        unit = desk.layout.against_wall(piece, desk.rng, front=0.6, gap=0.02, walls=[wall], span=span)
        if unit is None:
            continue
        placed.append(unit)
        desk.dressed(unit)
        middle = 0.5 * (span[0] + span[1])
        if kind == "stove":
            above(desk, "range hood", wall, middle, 1.62, float(piece.size[0]))
        elif kind == "kitchen counter":
            above(desk, "wall cupboard", wall, middle, 1.42, float(piece.size[0]) - 0.02)
    return placed


def above(desk: Desk, kind: str, wall: int, middle: float, z: float, w: float) -> Placed | None:
    """A wall piece over a unit."""
    low = KINDS[kind].low
    piece = desk.piece(kind, (w, low[1], min(low[2] + 0.05, desk.layout.site.ceiling - z - 0.05)))
    half = float(piece.size[0]) / 2 + 0.011
    return desk.layout.against_wall(piece, desk.rng, gap=0.005, z=z, walls=[wall], span=(middle - half, middle + half))


def bathing(desk: Desk) -> Placed | None:
    """Bathtub or shower, washbasin under a mirror, toilet, towel rail, mat."""
    area = desk.layout.site.polygon.area
    first = desk.at_wall("washbasin", where="centre", size=None if area > 4 else (0.54, 0.45, 0.86))
    if first is not None:
        on_wall(desk, "mirror", first, z=first.z + 1.12, size=(0.55, 0.04, 0.75))
    desk.at_wall("toilet", where="corner")
    tub = desk.at_wall("bathtub", where="corner", mates=frozenset()) if area > 4.5 else None
    if tub is None or area > 9:
        shower = desk.at_wall("shower", where="corner")
        tub = tub or shower
    if tub is not None:
        mat = desk.piece("bath mat")
        x, y = local(tub, 0.0, -(float(tub.piece.size[1]) + float(mat.size[1])) / 2 - 0.06)
        desk.layout.try_at(mat, x, y, tub.yaw)
    wall_piece(desk, "towel rail", 0.95)
    return first or tub


def on_wall(desk: Desk, kind: str, below: Placed, *, z: float, size: tuple[float, float, float] | None = None) -> Placed | None:
    """A wall piece centred over a piece that stands with its back to a wall."""
    site = desk.layout.site
    point = np.array([below.x, below.y])
    offset = ((point - site.starts) * site.normals).sum(-1)
    facing = site.normals @ np.array([math.sin(below.yaw), -math.cos(below.yaw)])
    along = ((point - site.starts) * site.directions).sum(-1)
    ok = (facing > 0.99) & (offset > 0) & (offset < float(below.piece.size[1]) / 2 + 0.12) & (along > 0) & (along < site.lengths)
    if not ok.any():
        return None
    wall = int(np.argmax(ok))
    piece = desk.piece(kind, size)
    half = float(piece.size[0]) / 2 + 0.011
    span = (float(along[wall]) - half, float(along[wall]) + half)
    return desk.layout.against_wall(piece, desk.rng, gap=0.005, z=max(z, below.top + 0.08), walls=[wall], span=span)


def wall_piece(desk: Desk, kind: str, middle: float, *, size: tuple[float, float, float] | None = None) -> Placed | None:
    """A wall piece with its centre at a height, on any wall that has room for it."""
    piece = desk.piece(kind, size)
    z = min(middle, desk.layout.site.ceiling - 0.08 - float(piece.size[2]) / 2) - float(piece.size[2]) / 2
    return desk.layout.against_wall(piece, desk.rng, gap=0.005, z=z, where="centre" if desk.rng.random() < 0.6 else "any")


def curtain_pairs(desk: Desk) -> int:
    """Curtains at the windows, to the floor or just below the sill; how many windows got them."""
    site = desk.layout.site
    long = desk.rng.random() < 0.6
    hung = 0
    for gap in site.gaps:
        if gap.kind != "window" or gap.head - gap.sill < 0.5:
            continue
        top = min(gap.head + 0.16, site.ceiling - 0.04)
        for overhang, low in ((0.3, 0.02 if long else gap.sill - 0.12), (0.18, gap.sill - 0.12)):
            low = max(low, 0.02)
            span = (gap.low - overhang, gap.high + overhang)
            if span[0] < 0.0 or span[1] > float(site.lengths[gap.wall]):
                continue
            piece = desk.piece("curtains", (span[1] - span[0] - 0.024, 0.09, top - low))
            k = gap.wall
            middle = 0.5 * (span[0] + span[1])
            x, y = (site.starts[k] + middle * site.directions[k] + (0.005 + float(piece.size[1]) / 2) * site.normals[k]).tolist()
            if desk.layout.try_at(piece, x, y, math.atan2(float(site.normals[k, 0]), -float(site.normals[k, 1])), z=low):
                hung += 1
                break
    return hung
