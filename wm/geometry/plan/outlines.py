"""Rings of points as files give them, made what the records hold."""

import numpy as np
import shapely

from wm.geometry.plan.walls import distinct

_DUST = 1e-4  # square metres by which an outline with holes may differ from the ring it was read from


def counter_clockwise(points: np.ndarray) -> np.ndarray:
    """The ring without repeated neighbouring points, counter-clockwise; clockwise ones are reversed."""
    points = distinct(points)
    return points[::-1].copy() if _area(points) < 0 else points


def keyhole(points: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """An outline and its holes (clockwise), of one ring that runs along a slit into each hole and back.

    Args:
      points: [k, 2] counter-clockwise. A ring without such slits is returned as it is.
    """
    if len(points) < 8 or len(np.unique(points.round(6), axis=0)) == len(points):
        return points, ()
    whole = shapely.Polygon(points).buffer(0)
    if not isinstance(whole, shapely.Polygon) or not whole.interiors or abs(whole.area - _area(points)) > _DUST:
        return points, ()
    whole = shapely.orient_polygons(whole)
    outline, *holes = (np.asarray(ring.coords)[:-1] for ring in (whole.exterior, *whole.interiors))
    return outline, tuple(holes)


def _area(points: np.ndarray) -> float:
    """The area within a ring, negative where it is clockwise."""
    x, y = points.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2
