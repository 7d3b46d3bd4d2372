"""Massing: where the rooms of a programme lie, as polygons on a 10 cm grid.

Every house has a core (hall, corridor, atrium, or the living room of a small one) with rows of rooms along its sides. Large
houses have a node with bars: corridors with rooms on both sides that leave it at right angles, apart enough for windows
between them. Nothing is checked here; a draft that went wrong is the validator's to refuse.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely

from wm.synth.language.building import Building, draw
from wm.synth.language.programme import CIRCULATION, PUBLIC, Space, add_space
from wm.synth.language.rows import LIMB, Cell, Rect, Row, cell_area, is_small, lay_row, make_cells, shift, stretch

CONTACT = 180  # cm of wall that a door with its jambs needs between two rooms
CORE_CELLS = {"corridor": 9, "hall": 8}  # cells that one core can serve
BAR_CELLS = 8
COURT = (420, 600)  # cm between two bars of one side
_CORE_ORDER = ("great hall", "atrium", "hall", "gallery", "corridor")

Rooms = dict[int, list[Rect]]


def draft(spaces: list[Space], building: Building, rng: np.random.Generator) -> list[np.ndarray]:
    """A polygon for every space, and for the corridors it appends to `spaces` where the programme has too few.

    Returns:
      one [k, 2] int64 array a space, centimetres, counter-clockwise.
    """
    cores, others = _pick_cores(spaces, building, rng)
    cells = _in_order(make_cells(others, spaces, rng), spaces, rng)
    core = cores[0]
    capacity = CORE_CELLS["corridor" if spaces[core].kind.name == "corridor" else "hall"]
    if len(cells) > capacity or (len(cores) > 1 and len(cells) >= 4):
        rooms = _node_with_bars(cores, cells, spaces, building, rng)
    else:
        others = [*others, *cores[1:]]
        cells = _in_order(make_cells(others, spaces, rng), spaces, rng)
        rooms = _cluster(core, cells, spaces, building, rng)
    return _polygons(rooms, rng)


def _pick_cores(spaces: list[Space], building: Building, rng: np.random.Generator) -> tuple[list[int], list[int]]:
    """The rooms that lead to others, hub first, and the rest."""
    leading = [i for i, space in enumerate(spaces) if space.kind.zone == CIRCULATION]
    leading.sort(key=lambda i: (_CORE_ORDER.index(spaces[i].kind.name), i))
    rest = [i for i in range(len(spaces)) if i not in leading]
    if not leading and len(rest) > 6:
        leading = [add_space(spaces, "corridor", building, rng)]
    elif not leading:
        # A small house without a hall: its most public room leads to the others.
        hub = min(rest, key=lambda i: (spaces[i].kind.zone != PUBLIC, is_small(spaces[i]), spaces[i].kind.rank, i))
        leading = [hub]
    return leading, [i for i in rest if i not in leading]


def _in_order(cells: list[Cell], spaces: Sequence[Space], rng: np.random.Generator) -> list[Cell]:
    """From the front of the house to its back, with a little chance."""
    noise = rng.uniform(0, 1.2, len(cells))
    order = np.argsort([spaces[cell.host].kind.rank + noise[k] for k, cell in enumerate(cells)], kind="stable")
    return [cells[k] for k in order]


def _cluster(core: int, cells: list[Cell], spaces: Sequence[Space], building: Building, rng: np.random.Generator) -> Rooms:
    """One core from (0, 0) with rooms along its north and south sides and at its ends."""
    if spaces[core].kind.name == "corridor" and len(cells) >= 2:
        ends = min(int(rng.integers(0, 3)), len(cells) - 2) if len(cells) >= 3 else 0
        west, east = cells[:1] if ends else [], cells[-1:] if ends == 2 else []
        middle = cells[len(west) : len(cells) - len(east)]
        width = round(100 * draw(building.corridor, rng) / 10) * 10
        return _around(core, *_two_rows(middle, spaces, rng), east, west, spaces, rng, width=width)
    sides = _share_out(len(cells), spaces[core].kind.zone == CIRCULATION, rng)
    ring, start = [], 0
    for count in sides:
        ring.append(cells[start : start + count])
        start += count
    west, north, east, south = ring
    rows = [lay_row(side, spaces, rng) if side else Row(()) for side in (north, south[::-1])]
    return _around(core, rows[0], rows[1], east, west, spaces, rng, width=None)


def _share_out(count: int, hall: bool, rng: np.random.Generator) -> tuple[int, int, int, int]:
    """How many cells go west, north, east and south of a hall-like core; ends take one at most."""
    patterns = {
        0: ["0000"], 1: ["0100", "0010"], 2: ["0101", "0110", "0200"], 3: ["0210", "0201", "0111", "1110"],
        4: ["0202", "0211", "1210"], 5: ["0212", "1211"], 6: ["1212", "0312", "1311"], 7: ["1312", "0313"], 8: ["1313"],
    }[count]  # fmt: skip
    if not hall:
        patterns = [p for p in patterns if p[0] == "0" or p[3] == "0"] or patterns  # a living room keeps an open side
    west, north, east, south = (int(digit) for digit in patterns[int(rng.integers(len(patterns)))])
    return west, north, east, south


def _two_rows(cells: list[Cell], spaces: Sequence[Space], rng: np.random.Generator) -> tuple[Row, Row]:
    """Cells dealt to two rows so that both grow alike, each in order from front to back."""
    sides: tuple[list[Cell], list[Cell]] = ([], [])
    areas = [0.0, float(rng.uniform(-1, 1))]
    for cell in cells:
        side = int(areas[0] > areas[1])
        sides[side].append(cell)
        areas[side] += cell_area(cell, spaces)
    north, south = (lay_row(side, spaces, rng) if side else Row(()) for side in sides)
    return north, south


def _around(
    core: int, north: Row, south: Row, east: list[Cell], west: list[Cell], spaces: Sequence[Space], rng: np.random.Generator, *,
    width: int | None,
) -> Rooms:  # fmt: skip
    """Core and rooms; the core is as long as its rows, and as wide as its area asks for unless `width` says."""
    area = 1e4 * spaces[core].area
    alone = round(float(np.sqrt(area * rng.uniform(1.0, 1.6))) / 10) * 10
    length = _common_length(north.length, south.length) or alone
    if width is None:
        length = max(length, 450 if spaces[core].kind.zone == CIRCULATION else 400)
        width = int(min(max(round(area / length / 10) * 10, 320), 650))
    north, south = (_fit(row, length, rng) for row in (north, south))
    rooms: Rooms = {core: [(0, 0, length, width)]}
    rooms |= _mapped(north, lambda u0, v0, u1, v1: (u0, width + v0, u1, width + v1))
    rooms |= _mapped(south, lambda u0, v0, u1, v1: (u0, -v1, u1, -v0))
    for cells, at_end in ((east, True), (west, False)):
        if cells:
            high, low = _reach(north, length, at_end), _reach(south, length, at_end)
            span, row = _end_row(cells[0], spaces, width, high, low, rng)
            if at_end:
                rooms |= _mapped(row, lambda u0, v0, u1, v1, y=span[0]: (length + v0, y + u0, length + v1, y + u1))
            else:
                rooms |= _mapped(row, lambda u0, v0, u1, v1, y=span[0]: (-v1, y + u0, -v0, y + u1))
    return rooms


def _common_length(a: int, b: int) -> int:
    """The length of a core whose rows want to be this long: one row gives way where they nearly agree."""
    short, long = sorted((a, b))
    if short >= 0.8 * long or short == 0:
        return long
    return round((short * long) ** 0.5 / 10) * 10 if short >= 0.62 * long else long


def _fit(row: Row, length: int, rng: np.random.Generator) -> Row:
    """The row stretched to the core's length, or put at one end of it where it is much shorter."""
    if not row.slots or row.length == length:
        return row
    if row.length >= 0.62 * length and row.length + 220 > length or row.length >= 0.78 * length:
        return stretch(row, length)
    return shift(row, 0 if rng.random() < 0.5 else length - row.length)


def _reach(row: Row, length: int, at_end: bool) -> int:
    """How deep the room at the end of a row is, 0 where the row does not come to that end."""
    if not row.slots:
        return 0
    slot = row.slots[-1 if at_end else 0]
    return slot.depth if (slot.u + slot.width == length if at_end else slot.u == 0) else 0


def _end_row(
    cell: Cell, spaces: Sequence[Space], width: int, high: int, low: int, rng: np.random.Generator
) -> tuple[tuple[int, int], Row]:
    """One cell across the end of a core, its sides in line with the core's or with the rows' outer walls."""
    area = cell_area(cell, spaces)
    least = 2 * LIMB if cell.small is not None else LIMB if is_small(spaces[cell.host]) else 300
    spans = [(y0, y1) for y0 in {0, -low} for y1 in {width, width + high} if y1 - y0 >= least]
    good = [span for span in spans if 0.55 <= area / (span[1] - span[0]) ** 2 <= 1.9]
    if not good:  # no wall to align with: as wide as it likes to be, over the middle of the core's end
        wide = max(round(float(np.sqrt(area)) / 10) * 10, least, width)
        y0 = -round((wide - width) / 20) * 10
        good = [(y0, y0 + wide)]
    span = sorted(good)[int(rng.integers(len(good)))]
    depth = max(round(area / (span[1] - span[0]) / 10) * 10, LIMB)
    slot = stretch(lay_row([cell], spaces, rng, depth=depth), span[1] - span[0]).slots[0]
    return span, Row((slot if cell.small is not None else dataclasses.replace(slot, depth=depth),))


def _node_with_bars(cores: list[int], cells: list[Cell], spaces: list[Space], building: Building, rng: np.random.Generator) -> Rooms:
    """A hall or gallery with corridors leaving it at right angles, rooms along both sides of each."""
    node, corridors = cores[0], cores[1:]
    caps = [cell for cell in cells if cell.small is None and not is_small(spaces[cell.host])][: min(2, max(len(cells) - 3, 0))]
    cells = [cell for cell in cells if cell not in caps]  # caps: the most public rooms, at the node's ends
    count = max(1, -(-len(cells) // BAR_CELLS))
    surplus = corridors[count:]  # more halls than are needed to reach the rooms are rooms themselves
    cells += [Cell(i) for i in surplus]
    corridors = corridors[:count] + [add_space(spaces, "corridor", building, rng) for _ in range(count - len(corridors))]
    direct: list[Cell] = []
    if count <= 2 and len(cells) >= 5 * count:
        direct = [cells.pop(0) for _ in range(count)]  # rooms along the side of the node that has no bars
    groups = [cells[len(cells) * k // count : len(cells) * (k + 1) // count] for k in range(count)]
    bars = [_bar(corridor, group, spaces, building, rng) for corridor, group in zip(corridors, groups)]
    both = not direct and count >= 2 and rng.random() < 0.6 or count >= 4
    sides = (bars[: (count + 1) // 2], bars[(count + 1) // 2 :]) if both else (bars, [])
    placed, ends = [], []
    for side in sides:
        positions, end = _stack(side, rng)
        placed.append(positions)
        ends.append(end)
    area = 1e4 * spaces[node].area
    length = max(*ends, round(float(np.sqrt(area * 1.4)) / 10) * 10)
    row = Row(())
    if direct:
        row = lay_row(direct, spaces, rng)
        length = max(length, row.length)
        row = stretch(row, length) if row.length >= 0.6 * length else shift(row, (length - row.length) // 20 * 10)
    slim = [float(np.sqrt(cell_area(cell, spaces) / 1.7)) for cell in caps]  # a cap is as wide as the node, and no tunnel
    width = round(min(max(area / length, 260, *slim), 600) / 10) * 10
    rooms: Rooms = {node: [(0, 0, length, width)]}
    for bar_rooms, x in placed[0]:  # north: the bar's x axis turns to y
        for i, rects in bar_rooms.items():
            rooms[i] = [(x - y1, width + x0, x - y0, width + x1) for x0, y0, x1, y1 in rects]
    for bar_rooms, x in placed[1]:
        for i, rects in bar_rooms.items():
            rooms[i] = [(x - y1, -x1, x - y0, -x0) for x0, y0, x1, y1 in rects]
    rooms |= _mapped(row, lambda u0, v0, u1, v1: (u0, -v1, u1, -v0))
    for cell, at_end in zip(caps, (True, False)):
        x0 = length if at_end else -round(cell_area(cell, spaces) / width / 10) * 10
        rooms[cell.host] = [(x0, 0, x0 + round(cell_area(cell, spaces) / width / 10) * 10, width)]
    return rooms


def _bar(corridor: int, cells: list[Cell], spaces: Sequence[Space], building: Building, rng: np.random.Generator) -> Rooms:
    """A corridor from (0, 0) along x with rooms north and south of it and perhaps one at its far end."""
    east = cells[-1:] if len(cells) >= 3 and rng.random() < 0.6 else []
    middle = cells[: len(cells) - len(east)]
    width = round(100 * draw(building.corridor, rng) / 10) * 10
    return _around(corridor, *_two_rows(middle, spaces, rng), east, [], spaces, rng, width=width)


def _stack(bars: list[Rooms], rng: np.random.Generator) -> tuple[list[tuple[Rooms, int]], int]:
    """Bars beside each other with courts between: each with the coordinate its own y = 0 turns to, and the node's length."""
    placed, end, cursor = [], 0, None
    for bar in bars:
        low = min(rect[1] for rects in bar.values() for rect in rects)
        high = max(rect[3] for rects in bar.values() for rect in rects)
        corridor = next(iter(bar.values()))[0]
        margin = int(rng.integers(0, 8)) * 10
        x = corridor[3] + margin if cursor is None else cursor + high
        placed.append((bar, x))
        end = x - corridor[1] + margin
        cursor = x - low + round(rng.uniform(*COURT) / 10) * 10
    return placed, end


def _mapped(row: Row, turn) -> Rooms:
    return {i: [turn(*rect) for rect in rects] for i, rects in row.rooms().items()}


def _polygons(rooms: Rooms, rng: np.random.Generator) -> list[np.ndarray]:
    """Rectangles joined, turned and mirrored by chance, moved to the first quadrant."""
    turn = np.array([[[1, 0], [0, 1]], [[0, -1], [1, 0]], [[-1, 0], [0, -1]], [[0, 1], [-1, 0]]][int(rng.integers(4))])
    if rng.random() < 0.5:
        turn = turn @ np.array([[-1, 0], [0, 1]])
    rings = []
    for i in sorted(rooms):
        shape = shapely.union_all([shapely.box(*rect) for rect in rooms[i]]).normalize()
        ring = np.round(shapely.get_coordinates(shape.exterior)[:-1]).astype(np.int64)
        ring = ring[::-1]  # shapely normalises exterior rings to clockwise
        rings.append(_corners(ring @ turn.T))
    low = np.min([ring.min(axis=0) for ring in rings], axis=0)
    return [ring - low for ring in rings]


def _corners(ring: np.ndarray) -> np.ndarray:
    """Counter-clockwise, without points in the middle of a side."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    ring = ring[before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]]
    x, y = ring[:, 0], ring[:, 1]
    doubled = int(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return ring if doubled > 0 else ring[::-1]
