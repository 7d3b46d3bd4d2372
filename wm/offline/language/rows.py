"""Rows of rooms: cells side by side along a straight front.

A row has its own frame: u along the front, v away from it, in whole centimetres on a 10 cm grid. A cell is one room, or a room
with a small room in one of its corners, which makes the larger room L-shaped.
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from wm.offline.language.programme import SERVICE, WET, Space

LIMB = 240  # smallest width of a part of a room, cm between wall centre lines: a little more than 2 m is left inside
NARROWEST = 290  # smallest width along the front of a room that is not small, cm
DEEPEST, SHALLOWEST = 640, 290
STEP = 80  # smallest difference in depth between neighbours that is kept, cm

Rect = tuple[int, int, int, int]
"""x0, y0, x1, y1 in cm."""


@dataclasses.dataclass(frozen=True)
class Cell:
    host: int  # index of the space
    small: int | None = None  # index of the space in its corner


@dataclasses.dataclass(frozen=True)
class Slot:
    """A cell with its place in a row."""

    cell: Cell
    u: int
    width: int
    depth: int
    corner: Rect | None  # the small room, in the frame of the row


@dataclasses.dataclass(frozen=True)
class Row:
    slots: tuple[Slot, ...]

    @property
    def length(self) -> int:
        return self.slots[-1].u + self.slots[-1].width - self.slots[0].u if self.slots else 0

    @property
    def shortest(self) -> int:
        return sum(_least_width(slot) for slot in self.slots)

    def rooms(self) -> dict[int, list[Rect]]:
        """The rectangles that form each room, in the frame of the row."""
        rooms: dict[int, list[Rect]] = {}
        for slot in self.slots:
            whole = (slot.u, 0, slot.u + slot.width, slot.depth)
            if slot.corner is None or slot.cell.small is None:
                rooms[slot.cell.host] = [whole]
            else:
                rooms[slot.cell.small] = [slot.corner]
                rooms[slot.cell.host] = _without_corner(whole, slot.corner)
        return rooms


def is_small(space: Space) -> bool:
    return space.kind.zone in (WET, SERVICE)


def make_cells(indices: Sequence[int], spaces: Sequence[Space], rng: np.random.Generator) -> list[Cell]:
    """Cells of these rooms. About two thirds of the small rooms are put into the corner of a suitable room."""
    hosts = [i for i in indices if not is_small(spaces[i])]
    cells = {i: Cell(i) for i in hosts}
    alone: list[Cell] = []
    for small in (i for i in indices if is_small(spaces[i])):
        likes = ("bedroom", "study") if spaces[small].kind.zone == WET else ("kitchen", "bedroom", "living")
        free = [i for i in hosts if cells[i].small is None and spaces[i].kind.name in likes]
        if free and rng.random() < 0.67:
            host = min(free, key=lambda i: (likes.index(spaces[i].kind.name), i))
            cells[host] = Cell(host, small)
        else:
            alone.append(Cell(small))
    return [*cells.values(), *alone]


def cell_area(cell: Cell, spaces: Sequence[Space]) -> float:
    """Wanted area of a cell in square centimetres."""
    return 1e4 * (spaces[cell.host].area + (spaces[cell.small].area if cell.small is not None else 0.0))


def lay_row(cells: Sequence[Cell], spaces: Sequence[Space], rng: np.random.Generator, *, depth: int | None = None) -> Row:
    """A row of these cells from u = 0, with about their wanted areas.

    Args:
      depth: depth of the row in cm; None selects a depth that gives rooms good proportions.
    """
    large = [cell_area(cell, spaces) for cell in cells if not is_small(spaces[cell.host])]
    if depth is None:
        mean = float(np.mean(large)) if large else cell_area(cells[0], spaces)
        depth = _clip(math.sqrt(mean * rng.uniform(0.8, 1.15)), SHALLOWEST if large else LIMB, DEEPEST)
    slots, u = [], 0
    for cell in cells:
        slot = _lay_cell(cell, spaces, u, depth, rng)
        slots.append(slot)
        u += slot.width
    for k in [*range(1, len(slots)), *range(len(slots) - 2, -1, -1)]:  # forwards and backwards
        beside = slots[k - 1 : k] + slots[k + 1 : k + 2]
        near = [other.depth for other in beside if 0 < abs(other.depth - slots[k].depth) < STEP]
        if near and slots[k].corner is None:  # small steps in the outer wall are removed
            slots[k] = dataclasses.replace(slots[k], depth=near[-1])
    return Row(tuple(slots))


def stretch(row: Row, length: int) -> Row:
    """The row with this length, at least `row.shortest`. Small rooms keep their size; the others share the difference."""
    widths = [slot.width for slot in row.slots]
    slack = length - sum(widths)
    if slack > 0:
        weights = [width if width >= NARROWEST else 0.25 * width for width in widths]
    else:  # by how much each can shrink
        weights = [slot.width - _least_width(slot) for slot in row.slots]
    ends = np.round(np.cumsum(weights) / max(sum(weights), 1) * slack / 10).astype(int) * 10
    slots, u = [], 0
    for slot, width, gain in zip(row.slots, widths, np.diff(ends, prepend=0).tolist()):
        corner = slot.corner
        if corner is not None:
            right = corner[0] > slot.u
            x0 = u + width + gain - (corner[2] - corner[0]) if right else u
            corner = (x0, corner[1], x0 + corner[2] - corner[0], corner[3])
        slots.append(dataclasses.replace(slot, u=u, width=width + gain, corner=corner))
        u += width + gain
    return Row(tuple(slots))


def shift(row: Row, du: int) -> Row:
    """The row moved along its front by `du`."""
    moved = []
    for slot in row.slots:
        corner = slot.corner
        if corner is not None:
            corner = (corner[0] + du, corner[1], corner[2] + du, corner[3])
        moved.append(dataclasses.replace(slot, u=slot.u + du, corner=corner))
    return Row(tuple(moved))


def _least_width(slot: Slot) -> int:
    if slot.corner is not None:
        return min(slot.width, slot.corner[2] - slot.corner[0] + LIMB)
    return min(slot.width, NARROWEST)


def _lay_cell(cell: Cell, spaces: Sequence[Space], u: int, depth: int, rng: np.random.Generator) -> Slot:
    area = cell_area(cell, spaces)
    if is_small(spaces[cell.host]):
        width = _clip(math.sqrt(area) * rng.uniform(0.9, 1.05), LIMB, 320)
        return Slot(cell, u, width, _clip(area / width, LIMB, depth), None)
    if cell.small is not None:
        depth = max(depth, 2 * LIMB)
        small = 1e4 * spaces[cell.small].area
        deep = _clip(math.sqrt(small) * rng.uniform(0.95, 1.15), LIMB, depth - LIMB)
        wide = _clip(small / deep, LIMB, 360)
        width = max(_clip((area - small + wide * deep) / depth, NARROWEST, 1200), wide + LIMB)
        x0 = u if rng.random() < 0.5 else u + width - wide
        y0 = 0 if rng.random() < 0.6 else depth - deep  # at the front, or at the back as an en suite
        return Slot(cell, u, width, depth, (x0, y0, x0 + wide, y0 + deep))
    if rng.random() < 0.3:
        depth = _clip(depth + rng.choice([-1, 1]) * rng.uniform(80, 150), SHALLOWEST, DEEPEST + 100)  # a projection or a recess
    depth = _clip(depth, math.sqrt(area / 2.0), math.sqrt(area * 1.7))  # between twice as wide as deep and 1.7 times as deep
    return Slot(cell, u, _clip(area / depth, NARROWEST, 1600), depth, None)


def _without_corner(whole: Rect, corner: Rect) -> list[Rect]:
    x0, y0, x1, y1 = whole
    a0, b0, a1, b1 = corner
    beside = (a1, b0, x1, b1) if a0 == x0 else (x0, b0, a0, b1)
    beyond = (x0, b1, x1, y1) if b0 == y0 else (x0, y0, x1, b0)
    return [beside, beyond]


def _clip(value: int | float, low: int | float, high: int | float) -> int:
    """The value clipped to the limits and rounded to whole decimetres, in cm."""
    return round(float(min(max(value, low), max(low, high))) / 10) * 10
