"""A cluster: one core rectangle with a corner at (0, 0), rows of rooms along its sides, and rooms at its ends.

The rows in the north and south never extend beyond the ends of the core, so that they cannot overlap the rooms at the ends.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from wm.offline.language.building import Building, draw
from wm.offline.language.programme import CIRCULATION, Space
from wm.offline.language.rows import LIMB, Cell, Rect, Row, cell_area, is_small, lay_row, shift, stretch

CONTACT = 180  # length of shared wall that a door with its jambs needs, cm
SLENDER = ("corridor", "gallery")
CORE_WIDTHS = (320, 680)  # smallest and largest width, cm, of a core other than a corridor
Rooms = dict[int, list[Rect]]
"""The rectangles that form each room, by the index of its space."""

# Numbers of cells west, north, east and south of a core other than a corridor, by the total number of cells.
_PATTERNS: dict[int, tuple[str, ...]] = {
    0: ("0000",),
    1: ("0100", "0010"),
    2: ("0101", "0110", "0200"),
    3: ("0210", "0201", "0111", "1110"),
    4: ("0202", "0211", "1210", "1111", "0121"),
    5: ("0212", "1211", "1121", "2111"),
    6: ("1212", "2121", "1221", "2211"),
    7: ("1312", "2212", "1222", "2131"),
    8: ("1313", "2222", "2213"),
}


def cluster(core: int, cells: Sequence[Cell], spaces: Sequence[Space], building: Building, rng: np.random.Generator) -> Rooms:
    """The rooms of a core with its cells, which are given in order from the front of the house to its back.

    There are at most 9 cells around a corridor and 8 around any other core.
    """
    if spaces[core].kind.name == "corridor" and len(cells) >= 2:
        ends = int(rng.integers(0, 3)) if len(cells) >= 4 else 0
        west, east = cells[: int(ends > 0)], cells[len(cells) - int(ends == 2) :]
        north, south = two_rows(cells[len(west) : len(cells) - len(east)], spaces, rng)
        return around(core, north, south, east, west, spaces, rng, width=passage_width(spaces[core], building, rng))
    patterns = _PATTERNS[len(cells)]
    if spaces[core].kind.zone != CIRCULATION:  # a living room keeps one end free for windows
        patterns = tuple(p for p in patterns if p[0] == "0" or p[3] == "0") or patterns
    counts = [int(digit) for digit in patterns[int(rng.integers(len(patterns)))]]
    ends = np.cumsum(counts).tolist()
    west, north, east, south = (cells[end - count : end] for count, end in zip(counts, ends))
    rows = [lay_row(side, spaces, rng) if side else Row(()) for side in (north, south[::-1])]
    return around(core, rows[0], rows[1], east, west[::-1], spaces, rng, width=None)


def two_rows(cells: Sequence[Cell], spaces: Sequence[Space], rng: np.random.Generator) -> tuple[Row, Row]:
    """Divides cells into a north and a south row of similar area, each in order from front to back."""
    sides: tuple[list[Cell], list[Cell]] = ([], [])
    areas = [0.0, float(rng.uniform(-1, 1))]
    for cell in cells:
        side = int(areas[0] > areas[1])
        sides[side].append(cell)
        areas[side] += cell_area(cell, spaces)
    north, south = (lay_row(side, spaces, rng) if side else Row(()) for side in sides)
    return north, south


def passage_width(space: Space, building: Building, rng: np.random.Generator) -> int:
    """Width, in cm, of a corridor or of a gallery that serves as one."""
    width = round(10 * draw(building.corridor, rng)) * 10
    return width if space.kind.name == "corridor" else width + LIMB // 2


def around(
    core: int,
    north: Row,
    south: Row,
    east: Sequence[Cell],
    west: Sequence[Cell],
    spaces: Sequence[Space],
    rng: np.random.Generator,
    *,
    width: int | None,
) -> Rooms:
    """The core and the rooms around it. The core is as long as its rows. If `width` is None, its area decides its width."""
    area = 1e4 * spaces[core].area
    alone = round(float(np.sqrt(area * rng.uniform(1.0, 1.6))) / 10) * 10
    length = _common_length(*(0 if _all_small(row, spaces) else row.length for row in (north, south))) or alone
    length = max(length, north.shortest, south.shortest)
    if width is None:
        length = max(length, 400)
        width = round(min(max(area / length, CORE_WIDTHS[0]), CORE_WIDTHS[1]) / 10) * 10
    north, south = (_fit(row, length, spaces, rng) for row in (north, south))
    rooms: Rooms = {core: [(0, 0, length, width)]}
    rooms |= {i: [(u0, width + v0, u1, width + v1) for u0, v0, u1, v1 in rects] for i, rects in north.rooms().items()}
    rooms |= {i: [(u0, -v1, u1, -v0) for u0, v0, u1, v1 in rects] for i, rects in south.rooms().items()}
    for cells, at_end in ((east, True), (west, False)):
        if cells:
            high, low = _reach(north, length, at_end), _reach(south, length, at_end)
            row = _end_row(cells, spaces, width, high, low, rng)
            for i, rects in row.rooms().items():
                rooms[i] = [(length + v0, u0, length + v1, u1) if at_end else (-v1, u0, -v0, u1) for u0, v0, u1, v1 in rects]
    return rooms


def _all_small(row: Row, spaces: Sequence[Space]) -> bool:
    return all(is_small(spaces[slot.cell.host]) for slot in row.slots)


def _common_length(a: int, b: int) -> int:
    """The length of a core between rows of these lengths. If they are similar, both rows are adapted to one length."""
    short, long = sorted((a, b))
    if short >= 0.8 * long or short == 0:
        return long
    return round((short * long) ** 0.5 / 10) * 10 if short >= 0.62 * long else long


def _fit(row: Row, length: int, spaces: Sequence[Space], rng: np.random.Generator) -> Row:
    """The row stretched to the length of the core. A much shorter row, or one of small rooms only, is put at one of its ends."""
    if not row.slots or row.length == length:
        return row
    if row.length > length or (row.length >= 0.78 * length and not _all_small(row, spaces)):
        return stretch(row, length)
    return shift(row, 0 if rng.random() < 0.5 else length - row.length)


def _reach(row: Row, length: int, at_end: bool) -> int:
    """Depth of the last room of a row at an end of the core; 0 if the row does not extend to that end."""
    if not row.slots:
        return 0
    slot = row.slots[-1 if at_end else 0]
    return slot.depth if (slot.u + slot.width == length if at_end else slot.u == 0) else 0


def _end_row(cells: Sequence[Cell], spaces: Sequence[Space], width: int, high: int, low: int, rng: np.random.Generator) -> Row:
    """A row of cells across an end of the core, aligned with walls of the core or of its rows if that gives good rooms.

    `high` and `low` are the depths of the north and south rows at this end. The u of the row is the y of the core.
    """
    area = sum(cell_area(cell, spaces) for cell in cells)
    spans = [(y0, y1) for y0 in sorted({0, -low}) for y1 in sorted({width, width + high})]
    fitting = []
    for y0, y1 in spans:
        if not is_small(spaces[cells[0].host]) and 0.55 <= area * len(cells) / max(y1 - y0, 1) ** 2 <= 1.8:
            row = _end_cells(cells, spaces, area / (y1 - y0), rng)
            row = shift(stretch(row, max(y1 - y0, row.shortest)), y0)
            if row.length == y1 - y0 and _in_contact(row, width):
                fitting.append(row)
    if fitting:
        return fitting[int(rng.integers(len(fitting)))]
    row = _end_cells(cells, spaces, float(np.sqrt(area / len(cells))), rng)
    if len(cells) > 1:  # the wall between two cells meets the middle of the core's end
        return shift(row, round(width / 20) * 10 - row.slots[1].u)
    room = width - row.length
    return shift(row, min(room, 0) if rng.random() < 0.5 else max(room, 0))


def _end_cells(cells: Sequence[Cell], spaces: Sequence[Space], depth: float, rng: np.random.Generator) -> Row:
    """A row of cells of one common depth."""
    deep = max(round(depth / 10) * 10, LIMB)
    row = lay_row(cells, spaces, rng, depth=deep)
    fixed = (slot.corner is not None or is_small(spaces[slot.cell.host]) for slot in row.slots)
    return Row(tuple(slot if keep else dataclasses.replace(slot, depth=deep) for slot, keep in zip(row.slots, fixed)))


def _in_contact(row: Row, width: int) -> bool:
    """Whether each cell shares enough wall for a door with the end of the core, which extends from 0 to `width`."""
    need = min(CONTACT, width)
    return all(min(slot.u + slot.width, width) - max(slot.u, 0) >= need for slot in row.slots)
