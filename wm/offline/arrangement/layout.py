"""A room while it is being designed: what stands where, and whether one more piece may stand there too.

A piece may stand where its footprint lies inside the room, clear of the zones before doors, of every piece whose height
interval it shares, and of what other pieces need before them; and only if the floor stays passable (floor.py). Why placement
answers the same question by other rules for things that stand somewhere already: wm.geometry.placement.clearances.
"""

import dataclasses
import functools
import math

import numpy as np
import shapely
from scipy import ndimage

from wm.geometry.placement.clearances import LIFT
from wm.geometry.placement.upright_box import UprightBox
from wm.geometry.plan.site import Site, wall_yaw
from wm.offline.arrangement.floor import CELL, BareFloor, Floor
from wm.offline.furniture import Piece

CLEARANCE = 0.015
"""Metres between two pieces: more than placement leaves between things that it moved apart (occupancy.CLEARANCE), because a
piece of a room that is being designed can as well stand elsewhere."""
DOOR_HEADROOM = 1.9
"""Metres below which a hanging or standing thing is in the way before a door: 0.1 m more than clearances.HEADROOM, for the same
reason."""


@dataclasses.dataclass(frozen=True, eq=False)
class Placed:
    """A piece with its place."""

    piece: Piece
    box: UprightBox  # of the piece's size

    @property
    def x(self) -> float:
        return self.box.x

    @property
    def y(self) -> float:
        return self.box.y

    @property
    def yaw(self) -> float:
        return self.box.yaw

    @property
    def z(self) -> float:
        return self.box.z

    @property
    def top(self) -> float:
        return self.box.top

    @functools.cached_property
    def footprint(self) -> shapely.Polygon:
        return self.box.footprint


class Layout:
    """The pieces placed so far in a site."""

    def __init__(self, site: Site):
        self.site = site
        self.placed: list[Placed] = []
        self.reserved: list[tuple[shapely.Polygon, frozenset[str]]] = []  # floor that pieces want before them, who may share it
        self.room = site.polygon.buffer(-0.001)
        shapely.prepare(self.room)
        self.bare = BareFloor(site)
        self.floor = self.bare.floor

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
        placed = Placed(piece, UprightBox(x, y, z, yaw, w, d, h))
        footprint = placed.footprint
        if not self.room.contains(footprint) or z < 0.0 or placed.top > self.site.ceiling - 0.001:
            return None
        if piece.support != "flat" and z < DOOR_HEADROOM and any(zone.intersects(footprint) for zone in self.site.keep):
            return None
        if piece.support != "flat" and self.clashes(footprint, z, placed.top):
            return None
        zone = None
        if piece.support == "floor":
            if any(area.intersects(footprint) and piece.label not in who for area, who in self.reserved):
                return None
            if front > 0.0:
                away = (d + front) / 2
                ahead = UprightBox(x + math.sin(yaw) * away, y - math.cos(yaw) * away, z, yaw, 0.8 * w, front, h)
                zone = ahead.footprint
                if not self.room.contains(zone) or self.clashes(zone, 0.05, 1.0, who=mates):
                    return None
        if piece.support == "floor":
            floor = self.bare.with_piece(self.floor, footprint)
            if not self.bare.passable(floor):
                return None
            self.floor = floor
        if zone is not None:
            self.reserved.append((zone, mates))
        self.placed.append(placed)
        return placed

    def mark(self) -> tuple[int, int, Floor]:
        """The state now, for `back_to`."""
        return len(self.placed), len(self.reserved), self.floor

    def back_to(self, mark: tuple[int, int, Floor]) -> None:
        """Takes away everything placed since the mark."""
        placed, reserved, self.floor = mark
        del self.placed[placed:], self.reserved[reserved:]

    def emptiest(self) -> tuple[float, float, float]:
        """(x, y, metres to the nearest thing) of the open floor's middle."""
        far = np.asarray(ndimage.distance_transform_edt(np.pad(self.floor.open, 1)))[1:-1, 1:-1]
        k = int(np.argmax(far))
        x, y = self.bare.grid.reshape(-1, 2)[k].tolist()
        return x, y, float(far.ravel()[k]) * CELL

    def clashes(self, footprint: shapely.Polygon, z: float, top: float, who: frozenset[str] = frozenset()) -> bool:
        """Whether something already stands within the clearance of a footprint in its height interval."""
        if any(own.low < top and own.high > z and own.outline.distance(footprint) < CLEARANCE for own in self.site.taken):
            return True
        return any(
            other.piece.support != "flat"
            and other.piece.label not in who
            and other.z < top
            and other.top > z
            and other.footprint.distance(footprint) < CLEARANCE
            for other in self.placed
        )

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
            opening.low - 0.06 < high and opening.high + 0.06 > low and opening.sill - 0.02 < top and opening.head + 0.02 > z
            for k, opening in self.site.openings
            if k == wall
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
        steps = self.bare.grid[::2, ::2][self.floor.open[::2, ::2]]
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
