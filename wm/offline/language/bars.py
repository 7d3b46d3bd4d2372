"""Large houses: a node (a hall or gallery) with bars. A bar is a corridor at a right angle to the node with rooms on both sides.

Neighbouring bars are separated by a court, so that the rooms between them have windows. The houses are long, or shaped like a U,
E or H.
"""

from collections.abc import Sequence

import numpy as np

from wm.offline.language.building import Building
from wm.offline.language.cluster import SLENDER, Rooms, around, passage_width, two_rows
from wm.offline.language.programme import Space, add_space
from wm.offline.language.rows import Cell, Row, cell_area, is_small, lay_row, shift, stretch

BAR_CELLS = 8
COURT = (420, 600)  # width of the court between two bars, cm
NODE_WIDTHS = (260, 600)


def node_with_bars(
    cores: Sequence[int], cells: Sequence[Cell], spaces: list[Space], building: Building, rng: np.random.Generator
) -> Rooms:
    """The rooms of a house of any size: the first core is the node, the others are corridors of bars, missing ones are added."""
    node, *corridors = _node_first(cores, len(cells), spaces, building, rng)
    if node != cores[0] and spaces[cores[0]].kind.name not in SLENDER:  # the hall becomes a room at the end of the gallery
        corridors.remove(cores[0])
        cells = [Cell(cores[0]), *cells]
    plain = [cell for cell in cells if cell.small is None and not is_small(spaces[cell.host])]
    caps = plain[: min(2, max(len(cells) - 3, 0))]  # the most public rooms are put at the ends of the node
    cells = [cell for cell in cells if cell not in caps]
    count = max(1, -(-len(cells) // BAR_CELLS))
    cells += [Cell(i) for i in corridors[count:]]  # halls that are not needed as corridors become ordinary rooms
    corridors = corridors[:count] + [add_space(spaces, "corridor", building, rng) for _ in range(count - len(corridors))]
    slender = spaces[node].kind.name in SLENDER
    one_side = count == 1 or (slender and count < 4 and rng.random() < 0.5)
    direct = min(count, 2) if one_side and len(cells) >= 5 * count else 0  # number of rooms along the side without bars
    row = lay_row(cells[:direct], spaces, rng) if direct else Row(())
    cells = cells[direct:]
    groups = [cells[len(cells) * k // count : len(cells) * (k + 1) // count] for k in range(count)]
    bars = [_bar(corridor, group, spaces, building, rng) for corridor, group in zip(corridors, groups)]
    half = count if one_side else (count + 1) // 2
    north, north_end = _stack(bars[:half], corridors[:half], rng)
    south, south_end = _stack(bars[half:], corridors[half:], rng)
    area = 1e4 * spaces[node].area
    length = max(north_end, south_end, row.length, round(float(np.sqrt(area * 1.4)) / 10) * 10)
    if direct:
        row = stretch(row, length) if row.length >= 0.75 * length else shift(row, round((length - row.length) / 20) * 10)
    slim = [float(np.sqrt(cell_area(cell, spaces) / 1.7)) for cell in caps]  # a cap is as wide as the node
    width = round(min(max(area / length, NODE_WIDTHS[0], *slim), NODE_WIDTHS[1]) / 10) * 10
    rooms: Rooms = {node: [(0, 0, length, width)]}
    for bar, x in north:  # the x axis of the bar becomes y
        rooms |= {i: [(x - y1, width + x0, x - y0, width + x1) for x0, y0, x1, y1 in rects] for i, rects in bar.items()}
    for bar, x in south:
        rooms |= {i: [(x - y1, -x1, x - y0, -x0) for x0, y0, x1, y1 in rects] for i, rects in bar.items()}
    rooms |= {i: [(u0, -v1, u1, -v0) for u0, v0, u1, v1 in rects] for i, rects in row.rooms().items()}
    for cell, at_end in zip(caps, (True, False)):
        deep = round(cell_area(cell, spaces) / width / 10) * 10
        rooms[cell.host] = [(length, 0, length + deep, width) if at_end else (-deep, 0, 0, width)]
    return rooms


def _node_first(cores: Sequence[int], cells: int, spaces: list[Space], building: Building, rng: np.random.Generator) -> list[int]:
    """The cores, the node first: a hall for one or two bars, a gallery or corridor for more bars."""
    if cells <= 2 * BAR_CELLS + 2:
        return list(cores)
    slender = [i for i in cores if spaces[i].kind.name in SLENDER]
    slender = slender or [add_space(spaces, "gallery", building, rng)]
    return [slender[0], *(i for i in cores if i != slender[0])]


def _bar(corridor: int, cells: list[Cell], spaces: Sequence[Space], building: Building, rng: np.random.Generator) -> Rooms:
    """The rooms of a bar: a corridor from (0, 0) along x, rooms north and south of it, and possibly one at its far end."""
    east = cells[-1:] if len(cells) >= 3 and rng.random() < 0.6 else []
    north, south = two_rows(cells[: len(cells) - len(east)], spaces, rng)
    return around(corridor, north, south, east, [], spaces, rng, width=passage_width(spaces[corridor], building, rng))


def _stack(bars: Sequence[Rooms], corridors: Sequence[int], rng: np.random.Generator) -> tuple[list[tuple[Rooms, int]], int]:
    """Places bars side by side along the node.

    Returns:
      Each bar with the x, in the frame of the node, of its own y = 0; and the length of the node.
    """
    placed, end, cursor = [], 0, None
    for bar, corridor in zip(bars, corridors):
        low = min(rect[1] for rects in bar.values() for rect in rects)
        high = max(rect[3] for rects in bar.values() for rect in rects)
        margin = int(rng.integers(0, 8)) * 10
        x = bar[corridor][0][3] + margin if cursor is None else cursor + high
        placed.append((bar, x))
        end = x + margin
        cursor = x - low + round(rng.uniform(*COURT) / 10) * 10
    return placed, end
