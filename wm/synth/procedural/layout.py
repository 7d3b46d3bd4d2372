"""A room while it is being furnished: what stands where, and whether one more piece may stand there too.

A piece may stand where its footprint lies inside the room, clear of the zones before doors, of every piece whose height
interval it shares, and of what other pieces need before them; and only if afterwards a person still gets from every door to
every other and to nearly all of the free floor (0.1 m grid), and no pocket of floor is walled in.
"""

import dataclasses
import math

import numpy as np
import shapely
from scipy import ndimage

from wm.geometry.navigation import BODY
from wm.geometry.site import Site, rectangle, wall_yaw
from wm.synth.procedural.furniture import Piece

WAY = 0.33
"""Metres around the middle of a way: 0.66 m is what a person leaves open. It is also half a cell of the grid of navigation
(0.15 m) more than the radius of its body (0.25 m), so that along a way that grid has a row of cells. What is moved into a room
afterwards (occupancy.py) need only let that body pass: it takes what it is given, and here is where ways are made."""
STEP_ASIDE = 0.2
"""How far from a way that slim body still counts as standing at it, metres."""
CELL = 0.1
CLEARANCE = 0.015
"""Metres between two pieces, and between a piece and a wall."""
LIFT = 0.002
"""Metres by which things stay off the surface they stand on, so that no two faces share a plane."""
HEADROOM = 1.9
"""Metres below which a hanging or standing thing is in the way of a door: 0.1 m more than navigation counts."""
REACHABLE = 0.97
"""Share of the ways that must hang together."""
BESIDE = 0.96
"""Share of the places where a slim body could stand that must lie at them: the rest is closed off."""
JOINED = 0.97
"""Share of the open floor that must hang together."""


def parts_of(free: np.ndarray) -> tuple[np.ndarray, int]:
    """(label of each cell's 4-connected part, 0 where not free; how many parts)."""
    labels = np.zeros(free.shape, np.int32)
    return labels, int(ndimage.label(free, output=labels))  # pyright: ignore[reportArgumentType]


@dataclasses.dataclass(frozen=True, eq=False)
class Placed:
    """A piece with its place."""

    piece: Piece
    x: float
    y: float
    z: float  # of its lowest point
    yaw: float
    footprint: shapely.Polygon

    @property
    def top(self) -> float:
        return self.z + float(self.piece.size[2])


class Layout:
    """The pieces placed so far in a site."""

    def __init__(self, site: Site):
        self.site = site
        self.placed: list[Placed] = []
        self.reserved: list[tuple[shapely.Polygon, frozenset[str]]] = []  # floor that pieces want before them, who may share it
        low = np.array(site.polygon.bounds[:2])
        count = np.ceil((np.array(site.polygon.bounds[2:]) - low) / CELL).astype(int) + 1
        xs, ys = (low[a] + CELL * np.arange(count[a]) for a in (0, 1))
        self.grid = np.stack(np.meshgrid(xs, ys), -1)  # [gy, gx, 2]
        self.inside = shapely.contains_xy(site.polygon, self.grid[..., 0], self.grid[..., 1])
        self.standing = shapely.contains_xy(site.polygon.buffer(-WAY), self.grid[..., 0], self.grid[..., 1])
        self.slim = shapely.contains_xy(site.polygon.buffer(-BODY), self.grid[..., 0], self.grid[..., 1])
        self.room = site.polygon.buffer(-0.001)
        shapely.prepare(self.room)
        self.empty = self.standing  # where a body may stand in the bare room
        self.reach = min(REACHABLE, self.shares(self.standing).max(initial=0.0) - 1e-9)
        self.joined = min(JOINED, self.shares(self.inside).max(initial=0.0) - 1e-9)
        self.beside = min(BESIDE, self.share_beside(self.standing, self.slim) - 1e-9)

    def try_at(
        self,
        piece: Piece,
        x: float,
        y: float,
        yaw: float,
        *,
        z: float = LIFT,
        front: float = 0.0,
        mates: frozenset[str] = frozenset(),
    ) -> Placed | None:
        """The piece placed at (x, y), or None where it may not stand.

        Args:
          front: metres of floor before the piece that later pieces leave alone.
          mates: labels of the pieces that may use that floor all the same.
        """
        w, d, h = piece.size.tolist()
        footprint = rectangle(x, y, yaw, w, d)
        top = z + h
        if not self.room.contains(footprint) or top > self.site.ceiling - 0.001:
            return None
        if piece.support != "flat" and z < HEADROOM and any(zone.intersects(footprint) for zone in self.site.keep):
            return None
        if piece.support != "flat" and self.clashes(footprint, z, top):
            return None
        zone = None
        if piece.support == "floor":
            if any(area.intersects(footprint) and piece.label not in who for area, who in self.reserved):
                return None
            if front > 0.0:
                zone = rectangle(x + math.sin(yaw) * (d + front) / 2, y - math.cos(yaw) * (d + front) / 2, yaw, 0.8 * w, front)
                if not self.room.contains(zone) or self.clashes(zone, 0.05, 1.0, who=mates):
                    return None
        masks = self.masks(footprint) if piece.support == "floor" else None
        if masks is not None and not self.passable(*masks):
            return None
        if masks is not None:
            self.standing, self.slim, self.inside = masks
        if zone is not None:
            self.reserved.append((zone, mates))
        placed = Placed(piece, x, y, z, yaw, footprint)
        self.placed.append(placed)
        return placed

    def mark(self) -> tuple[int, int, np.ndarray, np.ndarray, np.ndarray]:
        """The state now, for `back_to`."""
        return len(self.placed), len(self.reserved), self.standing, self.slim, self.inside

    def back_to(self, mark: tuple[int, int, np.ndarray, np.ndarray, np.ndarray]) -> None:
        """Takes away everything placed since the mark."""
        placed, reserved, self.standing, self.slim, self.inside = mark
        del self.placed[placed:], self.reserved[reserved:]

    def emptiest(self) -> tuple[float, float, float]:
        """(x, y, metres to the nearest thing) of the open floor's middle."""
        far = np.asarray(ndimage.distance_transform_edt(np.pad(self.inside, 1)))[1:-1, 1:-1]
        k = int(np.argmax(far))
        x, y = self.grid.reshape(-1, 2)[k].tolist()
        return x, y, float(far.ravel()[k]) * CELL

    def clashes(self, footprint: shapely.Polygon, z: float, top: float, who: frozenset[str] = frozenset()) -> bool:
        """Whether something already stands within the clearance of a footprint in its height interval."""
        return any(
            other.piece.support != "flat"
            and other.piece.label not in who
            and other.z < top
            and other.top > z
            and other.footprint.distance(footprint) < CLEARANCE
            for other in self.placed
        )

    def masks(self, footprint: shapely.Polygon) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(ways, where a slim body may stand, open floor) with one more piece on the floor."""
        x0, y0, x1, y1 = footprint.buffer(WAY).bounds
        rows = slice(*np.searchsorted(self.grid[:, 0, 1], [y0, y1]))
        columns = slice(*np.searchsorted(self.grid[0, :, 0], [x0, x1]))
        near = self.grid[rows, columns]
        with_it = []
        for mask, radius in ((self.standing, WAY), (self.slim, BODY), (self.inside, 0.0)):
            taken = footprint.buffer(radius) if radius else footprint
            shapely.prepare(taken)
            with_it.append(mask.copy())
            with_it[-1][rows, columns] &= ~shapely.contains_xy(taken, near[..., 0], near[..., 1])
        return with_it[0], with_it[1], with_it[2]

    def passable(self, standing: np.ndarray, slim: np.ndarray, inside: np.ndarray) -> bool:
        """Whether every door reaches every other, nearly all of the floor is one, and nothing of it is closed off."""
        if not standing.any() or self.shares(inside).max() < self.joined or self.share_beside(standing, slim) < self.beside:
            return False
        labels, _ = parts_of(standing)
        sizes = np.bincount(labels.ravel())[1:]
        main = int(np.argmax(sizes)) + 1
        if sizes[main - 1] < self.reach * sizes.sum():
            return False
        for probe in self.site.probes:  # some cell of the main part lies about each door's standing place
            near = np.abs(self.grid - probe).max(-1) <= 0.12
            if self.empty[near].any() and not (labels[near] == main).any():
                return False
        return True

    @staticmethod
    def share_beside(standing: np.ndarray, slim: np.ndarray) -> float:
        """Share of the places of a slim body that lie at the largest connected part of the ways."""
        labels, count = parts_of(standing)
        if not count:
            return 0.0
        main = labels == 1 + int(np.argmax(np.bincount(labels.ravel())[1:]))
        reached = ndimage.binary_dilation(main, iterations=round(STEP_ASIDE / CELL), mask=slim)
        return float(reached[slim].mean())

    @staticmethod
    def shares(free: np.ndarray) -> np.ndarray:
        """Share of the free cells in each of their connected parts."""
        labels, count = parts_of(free)
        return np.bincount(labels.ravel(), minlength=count + 1)[1:] / max(int(free.sum()), 1)

    def against_wall(
        self,
        piece: Piece,
        rng: np.random.Generator,
        *,
        front: float = 0.0,
        where: str = "any",
        gap: float | None = None,
        z: float = LIFT,
        mates: frozenset[str] = frozenset(),
        walls: list[int] | None = None,
        span: tuple[float, float] | None = None,
        near: tuple[float, float] | None = None,
    ) -> Placed | None:
        """The piece with its back to some wall, at the best place that takes it; None where none does.

        Args:
          where: "centre" of a wall, "corner", or "any".
          gap: metres between its back and the wall; drawn from 2 to 5 cm where None.
          near: a point; places are then tried by their distance from it.
          walls: only these; span: only this stretch (metres from the wall's start) of the one wall given.
        """
        w, d, _ = piece.size.tolist()
        gap = float(rng.uniform(0.02, 0.05)) if gap is None else gap
        candidates = []
        for k in range(len(self.site.lengths)) if walls is None else walls:
            low, high = span if span is not None else (0.0, float(self.site.lengths[k]))
            slack = high - low - w - 0.02
            if slack < 0:
                continue
            steps = max(int(slack / 0.15), 1)
            for share in np.linspace(0.0, 1.0, steps + 1) if slack > 0.02 else [0.5]:
                s = low + w / 2 + 0.01 + share * slack
                off = abs(share - 0.5) * slack
                score = {"centre": off, "corner": min(share, 1 - share) * slack}.get(where, 0.0) + float(rng.uniform(0.0, 0.6))
                if where == "centre":
                    score -= 0.15 * min(float(self.site.lengths[k]), 5.0)
                if near is not None:
                    score = float(np.linalg.norm(self.site.starts[k] + s * self.site.directions[k] - np.array(near)))
                candidates.append((score, k, s))
        for _, k, s in sorted(candidates):
            if self.over_opening(k, s - w / 2, s + w / 2, z, z + float(piece.size[2])):
                continue
            x, y = (self.site.starts[k] + s * self.site.directions[k] + (gap + d / 2) * self.site.normals[k]).tolist()
            placed = self.try_at(piece, x, y, wall_yaw(self.site.normals[k]), z=z, front=front, mates=mates)
            if placed is not None:
                return placed
        return None

    def over_opening(self, wall: int, low: float, high: float, z: float, top: float) -> bool:
        """Whether a thing on a wall's stretch would stand before a window's glass or a doorway."""
        return any(
            gap.wall == wall and gap.low - 0.06 < high and gap.high + 0.06 > low and gap.sill - 0.02 < top and gap.head + 0.02 > z
            for gap in self.site.gaps
        )

    def on_floor(
        self,
        piece: Piece,
        rng: np.random.Generator,
        near: tuple[float, float],
        *,
        yaw: float,
        radius: float = 9.0,
        spread: float = 0.3,
    ) -> Placed | None:
        """The piece free on the floor, as near to a point as it may stand; None where it may nowhere."""
        steps = self.grid[::2, ::2][self.inside[::2, ::2]]
        points = np.concatenate([np.array([near]), steps])
        distance = np.linalg.norm(points - np.array(near), axis=1) + rng.uniform(0.0, spread, len(points))
        distance[0] = 0.0
        for k in np.argsort(distance, kind="stable"):
            if distance[k] > radius:
                return None
            placed = self.try_at(piece, float(points[k, 0]), float(points[k, 1]), yaw)
            if placed is not None:
                return placed
        return None
