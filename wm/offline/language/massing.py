"""Massing: the positions and shapes of the rooms of a programme, as polygons on a 10 cm grid.

A small house is a cluster around its hall, corridor, atrium or living room (cluster.py); a large one has bars (bars.py). Several
sketches are drawn and the one with the best rooms is kept. The rules of floor plans are not checked here but when the proposal
is validated.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Int

from wm.offline.language.bars import node_with_bars
from wm.offline.language.building import Building
from wm.offline.language.cluster import SLENDER, Rooms, cluster
from wm.offline.language.programme import CIRCULATION, PUBLIC, Space, add_space
from wm.offline.language.rows import Cell, is_small, make_cells

SKETCHES = 8
_CAPACITY = {"corridor": 9, "hall": 8}  # cells that one core can serve
_HUBS = ("great hall", "atrium", "hall", "entrance", "gallery", "corridor")  # what leads best to other rooms first
_QUARTER_TURNS = np.array([[[1, 0], [0, 1]], [[0, -1], [1, 0]], [[-1, 0], [0, -1]], [[0, 1], [-1, 0]]])


def draft(
    spaces: Sequence[Space], building: Building, rng: np.random.Generator
) -> tuple[list[Space], list[Int[np.ndarray, "_ 2"]]]:
    """The best of several sketches.

    Returns:
      The spaces, followed by corridors that were added, and the polygon of each: counter-clockwise, in whole centimetres.
    """
    best: tuple[float, list[Space], Rooms] | None = None
    for _ in range(SKETCHES):
        drawn = list(spaces)
        rooms = _sketch(drawn, building, rng)
        flaws = _flaws(rooms, drawn)
        if best is None or flaws < best[0]:
            best = flaws, drawn, rooms
    assert best is not None
    return best[1], _polygons(best[2], rng)


def _sketch(spaces: list[Space], building: Building, rng: np.random.Generator) -> Rooms:
    cores, others = _pick_cores(spaces, building, rng)
    cells = _in_order(make_cells(others, spaces, rng), spaces, rng)
    capacity = _CAPACITY["corridor" if spaces[cores[0]].kind.name == "corridor" else "hall"]
    if len(cells) + len(cores) - 1 > capacity or (len(cores) > 1 and len(cells) >= 4):
        return node_with_bars(cores, cells, spaces, building, rng)
    cells = _in_order([*cells, *(Cell(i) for i in cores[1:])], spaces, rng)
    return cluster(cores[0], cells, spaces, building, rng)


def _pick_cores(spaces: list[Space], building: Building, rng: np.random.Generator) -> tuple[list[int], list[int]]:
    """Indices of the cores (rooms that lead to others), the hub first, and of all other rooms."""
    leading = [i for i, space in enumerate(spaces) if space.kind.zone == CIRCULATION]
    leading.sort(key=lambda i: (_HUBS.index(spaces[i].kind.name), i))
    leading = leading[:1] + [i for i in leading[1:] if spaces[i].kind.name in SLENDER]  # not a second great hall
    rest = [i for i in range(len(spaces)) if i not in leading]
    if not leading and len(rest) > 6:
        leading = [add_space(spaces, "corridor", building, rng)]
    elif not leading:  # a small house without a hall: its most public room is the core
        leading = [min(rest, key=lambda i: (spaces[i].kind.zone != PUBLIC, is_small(spaces[i]), spaces[i].kind.rank, i))]
    return leading, [i for i in rest if i not in leading]


def _in_order(cells: Sequence[Cell], spaces: Sequence[Space], rng: np.random.Generator) -> list[Cell]:
    """The cells in order from the front of the house to its back, with some random variation."""
    noise = rng.uniform(0, 1.2, len(cells))
    order = np.argsort([spaces[cell.host].kind.rank + noise[k] for k, cell in enumerate(cells)], kind="stable")
    return [cells[k] for k in order]


def _flaws(rooms: Rooms, spaces: Sequence[Space]) -> float:
    """The cost of a sketch: for areas other than wanted, for elongated rooms, and for a long outline of the house."""
    flaws = 0.0
    for i, rects in rooms.items():
        x0, y0, x1, y1 = np.array(rects).T
        area = float(np.sum((x1 - x0) * (y1 - y0))) / 1e4
        if spaces[i].kind.name != "corridor":
            low, high = spaces[i].kind.area
            flaws += 4 * max(np.log(area / high), np.log(low / area), 0.0) + abs(np.log(area / spaces[i].area))
            wide, deep = float(x1.max() - x0.min()), float(y1.max() - y0.min())
            flaws += 2 * max(max(wide, deep) / min(wide, deep) - 2.0, 0.0)
    outline = shapely.union_all([shapely.box(*rect) for rects in rooms.values() for rect in rects])
    return flaws / len(rooms) + 0.15 * outline.length / float(np.sqrt(outline.area))


def _polygons(rooms: Rooms, rng: np.random.Generator) -> list[Int[np.ndarray, "_ 2"]]:
    """The polygons of the rooms, turned and mirrored at random and moved to the first quadrant."""
    turn = _QUARTER_TURNS[int(rng.integers(4))]
    if rng.random() < 0.5:
        turn = turn @ np.array([[-1, 0], [0, 1]])
    rings = []
    for i in sorted(rooms):
        shape = shapely.union_all([shapely.box(*rect) for rect in rooms[i]]).normalize()
        ring = np.round(shapely.get_coordinates(shapely.get_exterior_ring(shape))[:-1]).astype(np.int64)
        rings.append(_corners(ring @ turn.T))
    low = np.min([ring.min(axis=0) for ring in rings], axis=0)
    return [ring - low for ring in rings]


def _corners(ring: Int[np.ndarray, "_ 2"]) -> Int[np.ndarray, "_ 2"]:
    """The polygon counter-clockwise and without points in the middle of a side."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    ring = ring[before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]]
    x, y = ring.T
    return ring if np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0 else ring[::-1]
