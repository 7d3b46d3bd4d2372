"""Functional groups: pieces that belong together, placed around an anchor.

Each returns its anchor, or None where it found no place; companions come as far as there is room for them.
"""

import math

from wm.geometry.plan.site import rectangle
from wm.offline.arrangement.clutter import place_on
from wm.offline.arrangement.hangings import hang
from wm.offline.arrangement.job import Job, beside, local
from wm.offline.arrangement.layout import Placed
from wm.offline.furniture import KINDS
from wm.offline.style.finish import PERIOD


def rug_under(job: Job, x: float, y: float, yaw: float, w: float, d: float) -> Placed | None:
    """A rug, smaller if need be, centred where a group stands."""
    for factor in (1.0, 0.85, 0.7):
        piece = job.piece("rug", (w * factor, d * factor, 0.008))
        if all(
            other.piece.support != "flat"
            or not other.footprint.intersects(rectangle(x, y, yaw, w * factor + 0.02, d * factor + 0.02))
            for other in job.layout.placed
        ):
            placed = job.layout.try_at(piece, x, y, yaw)
            if placed is not None:
                return placed
    return None


def sleeping(job: Job) -> Placed | None:
    """Bed, nightstands with lamps, chest at its foot, rug, picture above."""
    ornate = job.style.form.ornament > 0.6 and job.layout.site.ceiling > 2.5
    area = job.layout.site.polygon.area
    kinds = ["bed", "single bed"] if area > 8 else ["single bed"]
    if ornate and area > 15:
        kinds = ["four-poster bed", *kinds] if job.rng.random() < 0.65 else kinds
    for kind in kinds:
        placed = job.layout.against_wall(
            job.piece(kind), job.rng, front=KINDS[kind].front, where="centre", mates=frozenset({"blanket chest", "bench"})
        )
        if placed is None:
            continue
        for side in (-1.0, 1.0):
            job.dressed(beside(job, placed, job.piece("nightstand"), side, gap=0.07))
        if job.chance(0.7):
            chest = job.piece("blanket chest" if job.rng.random() < 0.7 else "bench")
            x, y = local(placed, 0.0, -(float(placed.piece.size[1]) + float(chest.size[1])) / 2 - 0.08)
            job.layout.try_at(chest, x, y, placed.yaw)
        w, d = float(placed.piece.size[0]), float(placed.piece.size[1])
        x, y = local(placed, 0.0, -0.35 * d)
        rug_under(job, x, y, placed.yaw, w + 1.1, 0.75 * d)
        return placed
    return None


def hearth(job: Job) -> Placed | None:
    """What a sitting room looks at: a fireplace, or a television on its bench."""
    mates = frozenset({"coffee table", "ottoman"})
    if job.style.family in PERIOD or job.rng.random() < 0.35:
        placed = job.layout.against_wall(
            job.piece("fireplace"), job.rng, front=KINDS["fireplace"].front, where="centre", gap=0.008, mates=mates
        )
        return job.dressed(placed)
    placed = job.layout.against_wall(job.piece("media bench"), job.rng, front=0.4, where="centre", mates=mates)
    if placed is not None and place_on(job.layout, placed, job.piece("television"), 0.0, 0.0, placed.piece.tops[0].z) is None:
        job.dressed(placed)
    return placed


def sitting(job: Job, focus: Placed | None) -> Placed | None:
    """Sofa before the focus (or at a wall), coffee table, armchairs, side table with lamp, rug."""
    mates = frozenset({"coffee table", "armchair", "ottoman"})
    sofa = job.piece("sofa")
    d = float(sofa.size[1])
    placed = None
    if focus is not None:
        for away in (2.1, 1.9, 2.4, 1.7, 2.8):
            x, y = local(focus, 0.0, -float(focus.piece.size[1]) / 2 - away - d / 2)
            placed = placed or job.layout.try_at(sofa, x, y, focus.yaw + math.pi, front=0.45, mates=mates)
        across = [
            k for k, normal in enumerate(job.layout.site.normals) if normal @ [math.sin(focus.yaw), -math.cos(focus.yaw)] < -0.9
        ]
        if placed is None and across:
            opposite = local(focus, 0.0, -3.0)
            placed = job.layout.against_wall(sofa, job.rng, front=0.45, mates=mates, walls=across, near=opposite)
    placed = placed or job.layout.against_wall(sofa, job.rng, front=0.45, where="centre", mates=mates)
    if placed is None:
        return around_table(job)
    table = job.piece("coffee table")
    x, y = local(placed, 0.0, -(d + float(table.size[1])) / 2 - 0.38)
    low = job.dressed(job.layout.try_at(table, x, y, placed.yaw))
    centre = (x, y) if low is not None else local(placed, 0.0, -d / 2 - 0.6)
    rug_under(job, *centre, placed.yaw, 2.6, 1.8)
    seats = 0
    for side in (1.0, -1.0):
        if job.rng.random() < 0.85:
            chair = job.piece("armchair")
            for reach in (0.35, 0.6):
                x, y = local(
                    placed,
                    side * (float(table.size[0]) / 2 + reach + float(chair.size[1]) / 2),
                    -(d + float(table.size[1])) / 2 - 0.42,
                )
                turn = placed.yaw - side * math.radians(float(job.rng.uniform(72, 100)))
                if job.layout.try_at(chair, x, y, turn):
                    seats += 1
                    break
    side = 1.0 if job.rng.random() < 0.5 else -1.0
    for s in (side, -side):
        if job.dressed(beside(job, placed, job.piece("side table"), s, gap=0.08)):
            break
    if job.chance(0.7):
        beside(job, placed, job.piece("floor lamp"), -side, gap=0.1)
    return placed


def around_table(job: Job, near: tuple[float, float] | None = None) -> Placed | None:
    """Two armchairs with a small table between them, in the middle of the room or near a point."""
    centre = near or job.layout.site.centre
    table = job.dressed(job.layout.on_floor(job.piece("side table"), job.rng, centre, yaw=0.0, radius=2.0))
    if table is None:
        return None
    start = float(job.rng.uniform(0, 2 * math.pi))
    for k in range(2):
        chair = job.piece("armchair")
        for step in range(8):
            a = start + k * math.pi + (step + 1) // 2 * (-1) ** step * 0.5
            r = float(table.piece.size[0]) / 2 + float(chair.size[1]) / 2 + 0.2
            if job.layout.try_at(chair, table.x + r * math.cos(a), table.y + r * math.sin(a), a - math.pi / 2):
                break
    return table


def middle_piece(job: Job, kind: str) -> Placed | None:
    """Something for a large empty floor: two chairs and a table, a round table with flowers, or a bench, on a rug."""
    x, y, free = job.layout.emptiest()
    if free < 1.25:
        return None
    reading = kind in ("living", "library", "study", "bedroom", "other") or job.rng.random() < 0.4
    if reading:
        placed = around_table(job, (x, y))
    else:
        placed = job.dressed(job.layout.on_floor(job.piece("round table"), job.rng, (x, y), yaw=0.0, radius=0.6, spread=0.1))
    if placed is not None and free > 1.4:
        side = min(2 * free - 0.9, 2.2)
        size = (side, side, 0.008)
        if not any(
            other.piece.support == "flat" and other.footprint.distance(placed.footprint) < side / 2 for other in job.layout.placed
        ):
            job.layout.try_at(job.piece("round rug", size), placed.x, placed.y, 0.0)
    return placed


def dining_group(job: Job, *, kitchen: bool = False) -> Placed | None:
    """Table with chairs on all sides, lamp above, rug below, dressed."""
    site = job.layout.site
    spread = site.polygon.buffer(-1.35)
    long = 0.0 if spread.is_empty else max(spread.bounds[2] - spread.bounds[0], spread.bounds[3] - spread.bounds[1])
    across = not spread.is_empty and spread.bounds[2] - spread.bounds[0] < spread.bounds[3] - spread.bounds[1]
    yaw = math.pi / 2 if across else 0.0
    sizes = []
    if long > 0.4 and not kitchen:
        sizes = [(w, float(job.rng.uniform(0.88, 0.98)), 0.75) for w in (2.1, 1.75, 1.4) if w < long + 1.0]
    for size in [*sizes, None]:
        piece = job.piece("dining table", size) if size else job.piece("round table", (0.95, 0.95, 0.75))
        for turn in (yaw, yaw + math.pi / 2):
            mark = job.layout.mark()
            placed = job.layout.on_floor(piece, job.rng, site.centre, yaw=turn, radius=1.6 if kitchen else 0.9, spread=0.1)
            if placed is None:
                continue
            if seat_around(job, placed, round_=size is None) < 2:
                job.layout.back_to(mark)
                continue
            if not kitchen:
                rug_under(job, placed.x, placed.y, placed.yaw, float(piece.size[0]) + 1.2, float(piece.size[1]) + 1.3)
            hang(job, placed.x, placed.y, low=placed.top + 0.75)
            return job.dressed(placed)
    return None


def seat_around(job: Job, table: Placed, *, round_: bool) -> int:
    """Chairs around a table, their fronts a hand's breadth off its edge; how many found room."""
    w, d = float(table.piece.size[0]), float(table.piece.size[1])
    chair = job.piece("chair")
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
        if job.rng.random() < 0.5 + 0.5 * job.density:
            at = local(table, x, y)
            seats += job.layout.try_at(chair, *at, table.yaw + turn + math.radians(float(job.rng.uniform(-2, 2)))) is not None
    return seats
