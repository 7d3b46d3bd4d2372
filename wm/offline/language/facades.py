"""The walls of a drafted plan: the stretches that two rooms share, and those that face the open air. In whole centimetres."""

import dataclasses
from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from jaxtyping import Int


@dataclasses.dataclass(frozen=True)
class Side:
    """One side of the polygon of a room, on the line on which the coordinate `axis` is `at`."""

    room: int
    start: tuple[int, int]
    end: tuple[int, int]

    @property
    def axis(self) -> int:
        return 0 if self.start[0] == self.end[0] else 1

    @property
    def at(self) -> int:
        return self.start[self.axis]

    @property
    def low(self) -> int:
        return min(self.start[1 - self.axis], self.end[1 - self.axis])

    @property
    def high(self) -> int:
        return max(self.start[1 - self.axis], self.end[1 - self.axis])

    @property
    def outward(self) -> int:
        """Sign of the outward normal along `axis`: a counter-clockwise polygon has its outside on the right."""
        along = self.end[1 - self.axis] > self.start[1 - self.axis]
        return (1 if along else -1) * (1 if self.axis == 0 else -1)


@dataclasses.dataclass(frozen=True)
class Stretch:
    """A part of a side with either a side of one other room behind it, or the open air (None)."""

    side: Side
    behind: Side | None
    low: int
    high: int


def sides_of(polygons: Sequence[Int[np.ndarray, "_ 2"]]) -> list[Side]:
    """All sides of all polygons, which are counter-clockwise and axis-aligned."""
    sides = []
    for room, polygon in enumerate(polygons):
        ring = [(int(x), int(y)) for x, y in polygon]
        sides += [Side(room, a, b) for a, b in zip(ring, [*ring[1:], ring[0]])]
    return sides


def stretches_of(sides: Sequence[Side]) -> list[Stretch]:
    """Shared stretches (each once, as part of the room with the lower index) and outer ones, in a deterministic order."""
    lines: defaultdict[tuple[int, int], list[Side]] = defaultdict(list)
    for side in sides:
        lines[side.axis, side.at].append(side)
    stretches: list[Stretch] = []
    for side in sides:
        cursor = side.low
        against = [other for other in lines[side.axis, side.at] if other.outward != side.outward and other.room != side.room]
        for other in sorted(against, key=lambda other: other.low):
            low, high = max(side.low, other.low), min(side.high, other.high)
            if low >= high:
                continue
            if low > cursor:
                stretches.append(Stretch(side, None, cursor, low))
            if side.room < other.room:
                stretches.append(Stretch(side, other, low, high))
            cursor = max(cursor, high)
        if cursor < side.high:
            stretches.append(Stretch(side, None, cursor, side.high))
    return stretches
