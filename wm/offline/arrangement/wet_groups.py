"""Kitchens and bathrooms: units in a run along a wall; tub, basin and toilet."""

from wm.offline.arrangement.hangings import above, on_wall, wall_piece
from wm.offline.arrangement.layout import Placed
from wm.offline.arrangement.room_arrangement import RoomArrangement, local
from wm.offline.furniture import KINDS


def cooking(room: RoomArrangement) -> Placed | None:
    """A run of units along one wall: fridge, counter, sink, stove under its hood, cupboards above."""
    site = room.layout.site
    order = sorted(range(len(site.lengths)), key=lambda k: -float(site.lengths[k]) + float(room.rng.uniform(0, 1.2)))
    options = [(wall, low, high) for wall in order[:4] for low, high in stretches(site, wall) if high - low > 1.9]
    run: list[Placed] = []
    for least in (4, 3, 2):  # the first wall that takes most of the units
        for option in options if not run else []:
            mark = room.layout.mark()
            run = kitchen_run(room, *option)
            if len(run) >= least:
                break
            room.layout.back_to(mark)
            run = []
    have = {placed.piece.label for placed in run}
    for kind in ("sink counter", "stove", "fridge", "kitchen counter"):
        if kind not in have:
            placed = room.at_wall(kind, where="corner")
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


def kitchen_run(room: RoomArrangement, wall: int, low: float, high: float) -> list[Placed]:
    """Units side by side along a stretch of wall, and what hangs above them."""
    wanted = [("fridge", 0.68), ("kitchen counter", 0.9), ("sink counter", 1.1), ("stove", 0.62), ("kitchen counter", 1.1)]
    usable = high - low - 0.04
    while sum(w for _, w in wanted) + 0.02 * len(wanted) > usable and len(wanted) > 2:
        wanted.pop({5: 1, 4: 3, 3: 0}[len(wanted)])
    spare = usable - sum(w for _, w in wanted) - 0.02 * len(wanted)
    if room.rng.random() < 0.5:
        wanted.reverse()
    at = low + 0.02 + max(spare, 0.0) * (0.0 if room.rng.random() < 0.5 else 1.0)
    placed: list[Placed] = []
    for kind, w in wanted:
        low_size = KINDS[kind].low
        piece = room.piece(kind, (w, low_size[1] + 0.01, low_size[2] + (0.15 if kind == "fridge" else 0.005)))
        span = (at, at + float(piece.size[0]) + 0.025)
        at += float(piece.size[0]) + 0.021
        unit = room.layout.against_wall(piece, room.rng, front=0.6, gap=0.02, walls=[wall], span=span)
        if unit is None:
            continue
        placed.append(unit)
        room.dressed(unit)
        middle = 0.5 * (span[0] + span[1])
        if kind == "stove":
            above(room, "range hood", wall, middle, 1.62, float(piece.size[0]))
        elif kind == "kitchen counter":
            above(room, "wall cupboard", wall, middle, 1.42, float(piece.size[0]) - 0.02)
    return placed


def bathing(room: RoomArrangement) -> Placed | None:
    """Bathtub (a shower where none fits, both in a large room), toilet, washbasin under a mirror, towel rail, mat."""
    area = room.layout.site.polygon.area
    bath = room.at_wall("bathtub", where="corner") if area > 4.5 else None
    if bath is None or area > 9:
        shower = room.at_wall("shower", where="corner")
        bath = bath or shower
    room.at_wall("toilet", where="corner")
    basin = room.at_wall("washbasin", where="centre", size=None if area > 4 else (0.54, 0.45, 0.86))
    if basin is not None:
        on_wall(room, "mirror", basin, z=basin.z + 1.12, size=(0.55, 0.04, 0.75))
    if bath is not None:
        mat = room.piece("bath mat")
        x, y = local(bath, 0.0, -(float(bath.piece.size[1]) + float(mat.size[1])) / 2 - 0.06)
        room.layout.try_at(mat, x, y, bath.yaw)
    wall_piece(room, "towel rail", 0.95)
    return bath or basin


def lavatory(room: RoomArrangement) -> Placed | None:
    """A toilet, a small washbasin under a mirror, a towel rail."""
    toilet = room.at_wall("toilet", where="corner")
    basin = room.at_wall("washbasin", size=(0.54, 0.45, 0.86))
    if basin is not None:
        on_wall(room, "mirror", basin, z=basin.z + 1.12, size=(0.5, 0.04, 0.7))
    wall_piece(room, "towel rail", 0.95)
    return toilet


def island(room: RoomArrangement) -> Placed | None:
    """A kitchen island in the middle of the floor, with stools at its back."""
    site = room.layout.site
    placed = room.dressed(room.layout.on_floor(room.piece("kitchen island"), room.rng, site.centre, yaw=0.0, radius=0.4))
    if placed is not None:
        stool = room.piece("stool", (0.36, 0.36, 0.62))
        for share in (-0.28, 0.28):
            back = (float(placed.piece.size[1]) + float(stool.size[1])) / 2 + 0.08
            x, y = local(placed, share * float(placed.piece.size[0]), back)
            room.layout.try_at(stool, x, y, placed.yaw)
    return placed
