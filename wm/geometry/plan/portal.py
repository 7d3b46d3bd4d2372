"""One opening where it lies in the building: the record that everything else about an opening is read from.

A plan's `Opening` is what the file says, in the list of one room or of two. A `Portal` is that opening on its wall. What follows
from the wall (the rooms on both sides, the ends on the centre line, the depths to both faces) is derived here and nowhere else.
"""

import dataclasses
import functools

import numpy as np

from wm.geometry.plan.records import Opening
from wm.geometry.plan.walls import Behind, Wall
from wm.types import OUTSIDE

WAY = (0.5, 1.2)
"""Metres of width and height of the smallest door that people get through: a body of 0.25 m radius, stooping."""
STEP = 0.05
"""Metres of threshold that people step over; a hole that begins higher is a hatch."""


@dataclasses.dataclass(frozen=True, eq=False)
class Portal:
    """One opening of the building, once, whether one room lists it or both.

    Room a is the one of lower index, so that `ends`, `normal` and `half_depths` do not depend on which room lists the opening.
    """

    opening: Opening  # as the room that lists it describes it, the first of two
    index: int  # of the opening in that room's list
    wall: Wall  # of that room
    low: float  # metres along that wall
    high: float
    behind: Behind | None  # the stretch of shared wall that holds the opening; None where it leads outside

    @property
    def kind(self) -> str:
        """door | window | passage | hatch"""
        return self.opening.kind

    @property
    def is_way(self) -> bool:
        """Whether people get through it from one room into another.

        They do not through windows and hatches, doors narrower or lower than a body, and entrances: doors in exterior walls,
        which are closed.
        """
        return self.is_open and self.kind != "hatch" and self.sill <= STEP and self._fits_people

    @property
    def is_open(self) -> bool:
        """Whether it is a hole from one room into another: a way, a hatch, or a door too small for people."""
        return self.behind is not None

    @property
    def is_entrance(self) -> bool:
        """Whether it is a door to the outside that people get through."""
        return self.behind is None and self.kind == "door" and self._fits_people

    @property
    def _fits_people(self) -> bool:
        return self.opening.width >= WAY[0] - 1e-6 and self.opening.height >= WAY[1] - 1e-6

    @property
    def sill(self) -> float:
        """Metres above the floor."""
        return self.opening.sill_height

    @property
    def head(self) -> float:
        """Metres above the floor."""
        return self.opening.sill_height + self.opening.height

    @functools.cached_property
    def rooms(self) -> tuple[int, int]:
        """(a, b) indices into the plan's rooms, a < b; b is OUTSIDE for a window or an entrance."""
        if self.behind is None:
            return self.wall.room, OUTSIDE
        return min(self.wall.room, self.behind.room), max(self.wall.room, self.behind.room)

    @functools.cached_property
    def ends(self) -> np.ndarray:
        """[2, 2] float64 on the wall's centre line; room a is on the left of ends[0] -> ends[1]."""
        ends = self.wall.start + self._centre * self.wall.normal + self.span
        return ends if self.rooms[0] == self.wall.room else ends[::-1]

    @functools.cached_property
    def normal(self) -> np.ndarray:
        """[2] float64 unit, from a to b."""
        outward = -self.wall.normal
        return outward if self.rooms[0] == self.wall.room else -outward

    @functools.cached_property
    def half_depths(self) -> tuple[float, float]:
        """Metres from the centre line to the wall's face in a and in b (or outside)."""
        depth = self.wall.thickness - self._centre
        return depth, depth

    @functools.cached_property
    def depths(self) -> np.ndarray:
        """[2, 2] metres along `normal` from the centre line to the wall's face: in a and in b, at each of `ends`.

        The two lines of a shared wall may run askew within SHARED; the depth behind then differs from end to end, and
        `half_depths` is its mean.
        """
        mine = np.full(2, self.half_depths[0])
        if self.behind is None:
            return np.stack([mine, mine])
        reach = self.behind.thickness * np.hypot(1.0, self.behind.slope)  # to the other face, along the normal of this one
        theirs = np.array([self._centre + self.behind.gap(along) + reach for along in (self.low, self.high)])
        return np.stack([mine, theirs]) if self.rooms[0] == self.wall.room else np.stack([theirs[::-1], mine])

    @functools.cached_property
    def width(self) -> float:
        """Metres."""
        return float(np.linalg.norm(self.ends[1] - self.ends[0]))

    @property
    def span(self) -> np.ndarray:
        """[2, 2] from the start of `wall` to both ends of the opening, along that wall's line."""
        return np.array([[self.low], [self.high]]) * self.wall.direction

    @property
    def gap(self) -> float:
        """Metres between the two lines of a shared wall, at the opening's middle; 0 on an exterior wall."""
        return 0.0 if self.behind is None else self.behind.gap((self.low + self.high) / 2)

    @property
    def _centre(self) -> float:
        """Metres inside the line of `wall` at which the opening's centre line runs."""
        if self.behind is None:
            return self.wall.thickness / 2
        return (self.wall.thickness - self.behind.thickness - self.gap) / 2
