"""The floor of a room while it is being furnished, and what one more piece on it closes off.

There are three sorts of floor: *open* floor is under no piece; on *ways* the middle of a person walks; in *places* navigation's
slim body fits at all. A floor stays passable while every door lies at the main way, nearly all ways and nearly all of the open
floor hang together, and no more than ALLOWED of the places is closed off.

Open floor and ways are looked up on a grid of 0.1 m: a way must be so wide that it has grid points all along, however it runs.
What is closed off is an area: a strip of floor of a few centimetres has a row of points on one grid and none on another.
"""

import dataclasses

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry
from skimage.measure import label

from wm.geometry.placement.clearances import BODY, in_the_way
from wm.geometry.plan.site import Site
from wm.schema import NavigationSettings

WAY = 0.33
"""Metres around the middle of a way: 0.66 m is what a person leaves open. It is also half a cell of the grid of navigation
(0.15 m) more than the radius of its body (0.25 m), so that along a way that grid has a row of cells. What is moved into a room
afterwards (occupancy.py) need only let that body pass (why: wm.geometry.placement.clearances)."""
STEP_ASIDE = 0.2
"""How far from a way that slim body still counts as standing at it, metres."""
HALF_CELL = NavigationSettings().cell / 2
"""On an unlucky grid of navigation a strip has as many cells as if it were this much wider on every side, metres."""
ALLOWED = (0.05, 0.5)
"""At most this share of the places, and at most this many square metres of them, may be closed off."""
CELL = 0.1
REACHABLE = 0.97
"""Share of the ways that must hang together."""
JOINED = 0.97
"""Share of the open floor that must hang together."""


@dataclasses.dataclass(frozen=True, eq=False)
class Floor:
    """What the pieces that stand in a room leave of its floor."""

    open: np.ndarray  # [gy, gx] bool: grid points of the room under no piece
    standing: np.ndarray  # [gy, gx] bool: grid points on the ways
    ways: BaseGeometry  # WAY away from walls and pieces
    places: BaseGeometry  # BODY away from them

    def closed_off(self) -> float:
        """Square metres of the places that do not lie at the main way, as the unluckiest grid of navigation counts them."""
        main = max(shapely.get_parts(self.ways).tolist(), key=shapely.area, default=shapely.Polygon())
        rest = self.places.difference(main.buffer(STEP_ASIDE, quad_segs=4))
        # A pocket behind a thin thing may lie near the main way and yet not be reached from it.
        pockets = [part for part in shapely.get_parts(self.places).tolist() if not part.intersects(main)]
        rest = shapely.union_all([rest, *pockets])
        return float(rest.buffer(HALF_CELL, join_style="mitre").area)


class BareFloor:
    """The floor of an unfurnished room, and what a furnished one is held to: never to more than the bare room has.

    What stands there already, of the user's own, is no floor of the bare room.
    """

    def __init__(self, site: Site):
        low = np.array(site.polygon.bounds[:2])
        count = np.ceil((np.array(site.polygon.bounds[2:]) - low) / CELL).astype(int) + 1
        xs, ys = (low[a] + CELL * np.arange(count[a]) for a in (0, 1))
        self.grid = np.stack(np.meshgrid(xs, ys), -1)  # [gy, gx, 2]
        own = [taken.outline for taken in site.taken if in_the_way(taken.low, taken.high)]
        bare = site.polygon.difference(shapely.union_all(own)) if own else site.polygon
        ways, places = bare.buffer(-WAY), bare.buffer(-BODY)
        free, standing = (shapely.contains_xy(area, self.grid[..., 0], self.grid[..., 1]) for area in (bare, ways))
        self.floor = Floor(open=free, standing=standing, ways=ways, places=places)
        self.joined = min(JOINED, largest_share(free) - 1e-9)
        self.reachable = min(REACHABLE, largest_share(standing) - 1e-9)
        self.closed_off = self.floor.closed_off() + 1e-9
        near = [np.abs(self.grid - probe).max(-1) <= 0.12 for probe in site.probes]  # about each door's standing place
        self.doors = [door for door in near if standing[door].any()]

    def with_piece(self, floor: Floor, footprint: shapely.Polygon) -> Floor:
        """A floor of this room with one more piece on it."""
        wide, slim = footprint.buffer(WAY), footprint.buffer(BODY)
        return Floor(
            open=self._without(floor.open, footprint),
            standing=self._without(floor.standing, wide),
            ways=floor.ways.difference(wide),
            places=floor.places.difference(slim),
        )

    def _without(self, free: np.ndarray, taken: shapely.Polygon) -> np.ndarray:
        x0, y0, x1, y1 = taken.bounds
        rows = slice(*np.searchsorted(self.grid[:, 0, 1], [y0, y1]))
        columns = slice(*np.searchsorted(self.grid[0, :, 0], [x0, x1]))
        near = self.grid[rows, columns]
        shapely.prepare(taken)
        left = free.copy()
        left[rows, columns] &= ~shapely.contains_xy(taken, near[..., 0], near[..., 1])
        return left

    def passable(self, floor: Floor) -> bool:
        """Whether every door reaches every other, nearly all of a floor is one, and nothing of it is closed off."""
        if not floor.standing.any() or largest_share(floor.open) < self.joined:
            return False
        labels, sizes = parts_of(floor.standing)
        main = int(np.argmax(sizes)) + 1
        if sizes[main - 1] < self.reachable * sizes.sum() or not all((labels[door] == main).any() for door in self.doors):
            return False
        share, area = ALLOWED
        return floor.closed_off() <= max(min(share * floor.places.area, area), self.closed_off)


def parts_of(free: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(label of each point's 4-connected part, 0 where not free; the parts' sizes from label 1 on)."""
    labels = np.asarray(label(free, connectivity=1), np.int32)
    return labels, np.bincount(labels.ravel())[1:]


def largest_share(free: np.ndarray) -> float:
    """Share of the free points in their largest connected part, 0 of none."""
    _, sizes = parts_of(free)
    return float(sizes.max(initial=0)) / max(int(free.sum()), 1)
