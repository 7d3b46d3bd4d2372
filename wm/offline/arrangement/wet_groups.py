"""Kitchens and bathrooms: units in a run along a wall; tub, basin and toilet."""

from wm.offline.arrangement.hangings import above, on_wall, wall_piece
from wm.offline.arrangement.job import Job, local
from wm.offline.arrangement.layout import Placed
from wm.offline.furniture import KINDS


def cooking(job: Job) -> Placed | None:
    """A run of units along one wall: fridge, counter, sink, stove under its hood, cupboards above."""
    site = job.layout.site
    order = sorted(range(len(site.lengths)), key=lambda k: -float(site.lengths[k]) + float(job.rng.uniform(0, 1.2)))
    options = [(wall, low, high) for wall in order[:4] for low, high in stretches(site, wall) if high - low > 1.9]
    run: list[Placed] = []
    for least in (4, 3, 2):  # the first wall that takes most of the units
        for option in options if not run else []:
            mark = job.layout.mark()
            run = kitchen_run(job, *option)
            if len(run) >= least:
                break
            job.layout.back_to(mark)
            run = []
    have = {placed.piece.label for placed in run}
    for kind in ("sink counter", "stove", "fridge", "kitchen counter"):
        if kind not in have:
            placed = job.at_wall(kind, where="corner")
            run += [placed] if placed is not None else []
    return run[0] if run else None


def stretches(site, wall: int) -> list[tuple[float, float]]:
    """Parts of a wall between its doors and passages, longest first; windows do not interrupt low units."""
    cuts = sorted((way.low - 0.08, way.high + 0.08) for k, way in site.openings if k == wall and way.kind != "window")
    edges, at = [], 0.0
    for low, high in cuts:
        edges.append((at, low))
        at = high
    edges.append((at, float(site.lengths[wall])))
    return sorted(edges, key=lambda e: e[0] - e[1])


def kitchen_run(job: Job, wall: int, low: float, high: float) -> list[Placed]:
    """Units side by side along a stretch of wall, and what hangs above them."""
    wanted = [("fridge", 0.68), ("kitchen counter", 0.9), ("sink counter", 1.1), ("stove", 0.62), ("kitchen counter", 1.1)]
    room = high - low - 0.04
    while sum(w for _, w in wanted) + 0.02 * len(wanted) > room and len(wanted) > 2:
        wanted.pop({5: 1, 4: 3, 3: 0}[len(wanted)])
    spare = room - sum(w for _, w in wanted) - 0.02 * len(wanted)
    if job.rng.random() < 0.5:
        wanted.reverse()
    at = low + 0.02 + max(spare, 0.0) * (0.0 if job.rng.random() < 0.5 else 1.0)
    placed: list[Placed] = []
    for kind, w in wanted:
        low_size = KINDS[kind].low
        piece = job.piece(kind, (w, low_size[1] + 0.01, low_size[2] + (0.15 if kind == "fridge" else 0.005)))
        span = (at, at + float(piece.size[0]) + 0.025)
        at += float(piece.size[0]) + 0.021
        unit = job.layout.against_wall(piece, job.rng, front=0.6, gap=0.02, walls=[wall], span=span)
        if unit is None:
            continue
        placed.append(unit)
        job.dressed(unit)
        middle = 0.5 * (span[0] + span[1])
        if kind == "stove":
            above(job, "range hood", wall, middle, 1.62, float(piece.size[0]))
        elif kind == "kitchen counter":
            above(job, "wall cupboard", wall, middle, 1.42, float(piece.size[0]) - 0.02)
    return placed


def bathing(job: Job) -> Placed | None:
    """Bathtub (a shower where none fits, both in a large room), toilet, washbasin under a mirror, towel rail, mat."""
    area = job.layout.site.polygon.area
    bath = job.at_wall("bathtub", where="corner") if area > 4.5 else None
    if bath is None or area > 9:
        shower = job.at_wall("shower", where="corner")
        bath = bath or shower
    job.at_wall("toilet", where="corner")
    basin = job.at_wall("washbasin", where="centre", size=None if area > 4 else (0.54, 0.45, 0.86))
    if basin is not None:
        on_wall(job, "mirror", basin, z=basin.z + 1.12, size=(0.55, 0.04, 0.75))
    if bath is not None:
        mat = job.piece("bath mat")
        x, y = local(bath, 0.0, -(float(bath.piece.size[1]) + float(mat.size[1])) / 2 - 0.06)
        job.layout.try_at(mat, x, y, bath.yaw)
    wall_piece(job, "towel rail", 0.95)
    return bath or basin


def island(job: Job) -> Placed | None:
    """A kitchen island in the middle of the floor, with stools at its back."""
    site = job.layout.site
    placed = job.dressed(job.layout.on_floor(job.piece("kitchen island"), job.rng, site.centre, yaw=0.0, radius=0.4))
    if placed is not None:
        stool = job.piece("stool", (0.36, 0.36, 0.62))
        for share in (-0.28, 0.28):
            back = (float(placed.piece.size[1]) + float(stool.size[1])) / 2 + 0.08
            x, y = local(placed, share * float(placed.piece.size[0]), back)
            job.layout.try_at(stool, x, y, placed.yaw)
    return placed
