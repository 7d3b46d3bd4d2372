"""What of a room is taken: whether one more measured box may stand somewhere, and whether people can still pass the doors.

A box may stand where it is inside the room, clear of every other box whose height it shares, out of the floor before doors and
passages if a body could run into it, and where a body (clearances.BODY) still gets from every door to every other that it could
reach in the empty room. Why rooms that are designed have an engine of their own, with stricter rules: clearances.py.
"""

import math

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from wm.geometry.placement.clearances import BODY, in_the_way
from wm.geometry.placement.upright_box import UprightBox, overlap_height, penetration
from wm.geometry.plan.site import Site

TOLERANCE = 0.004
"""Metres that a thing may reach into another or into a wall and still stay where it is: less than the centimetre that is
allowed, more than rounding."""
CLEARANCE = 0.01
"""Metres between things that had to be moved apart, and between a thing that was moved and a wall."""
_NEAR = 0.3
"""Metres within which a body must be able to come to the standing place before a door."""


class Occupancy:
    """The boxes placed so far in a site."""

    def __init__(self, site: Site):
        self.site = site
        self.boxes: list[UprightBox] = []
        self._room = site.polygon.buffer(TOLERANCE, join_style="mitre")
        self._inner = site.polygon.buffer(-CLEARANCE, join_style="mitre")
        shapely.prepare(self._room)
        shapely.prepare(self._inner)
        own = [taken.outline for taken in site.taken if in_the_way(taken.low, taken.high)]
        bare = site.polygon.difference(shapely.union_all(own)) if own else site.polygon
        self._standing = bare.buffer(-BODY)
        self._together = _reached(self._standing, site.probes)

    def add(self, box: UprightBox) -> None:
        """Marks the place of a box as taken; the caller has asked `allows` before."""
        self.boxes.append(box)
        if in_the_way(box.z, box.top):
            self._standing = self._standing.difference(box.footprint.buffer(BODY))

    def allows(self, box: UprightBox, *, exactly: bool = False) -> bool:
        """Whether a box may stand where it is.

        Args:
          exactly: whether to judge the box where it came from, with TOLERANCE; a new place is judged with CLEARANCE to
          everything.
        """
        corners = shapely.points(box.corners)
        if not bool(shapely.covers(self._room if exactly else self._inner, corners).all()):
            return False
        footprint = box.footprint
        if box.z < -TOLERANCE or box.top > self.site.ceiling + TOLERANCE or not self._room.covers(footprint):
            return False
        if any(own.low < box.top and own.high > box.z and own.outline.intersects(footprint) for own in self.site.taken):
            return False
        if len(self.blockers(box, TOLERANCE if exactly else -CLEARANCE)):
            return False
        return not in_the_way(box.z, box.top) or (self._off_doors(footprint) and self._passable(footprint))

    def blockers(self, box: UprightBox, reach: float = TOLERANCE) -> list[UprightBox]:
        """The placed boxes that a box reaches into by more than `reach` metres."""
        sharing = overlap_height(box, self.boxes) > TOLERANCE
        hit = sharing & (penetration(box, self.boxes) > reach)
        return [self.boxes[k] for k in np.flatnonzero(hit)]

    def _off_doors(self, footprint: shapely.Polygon) -> bool:
        return not any(zone.buffer(-TOLERANCE).intersects(footprint) for zone in self.site.keep)

    def _passable(self, footprint: shapely.Polygon) -> bool:
        standing = self._standing.difference(footprint.buffer(BODY))
        now = _reached(standing, self.site.probes)
        return all(any(wanted <= group for group in now) for wanted in self._together)


def _reached(standing: BaseGeometry, probes: np.ndarray) -> list[frozenset[int]]:
    """For each part of where a body may stand, which doors can be reached from it; parts without doors left out."""
    points = [shapely.Point(probe) for probe in probes]
    parts = [part for part in shapely.get_parts(standing) if part.area > 0.01]
    groups = [frozenset(k for k, point in enumerate(points) if part.distance(point) < _NEAR) for part in parts]
    return [group for group in groups if group]


def distance_to_wall(site: Site, point: np.ndarray) -> tuple[float, np.ndarray]:
    """(metres to the nearest wall, unit direction towards it)."""
    along = np.clip(((point - site.starts) * site.directions).sum(axis=1), 0.0, site.lengths)
    foot = site.starts + along[:, None] * site.directions
    away = foot - point
    lengths = np.linalg.norm(away, axis=1)
    k = int(np.argmin(lengths))
    distance = float(lengths[k])
    return distance, away[k] / distance if distance > 1e-9 else -site.normals[k]


def circle_points(radius: float, count: int = 24) -> np.ndarray:
    """[count, 2] points evenly around a circle."""
    angle = 2 * math.pi * np.arange(count) / count
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
