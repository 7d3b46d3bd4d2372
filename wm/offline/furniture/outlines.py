"""Plane outlines of furniture: arches, rounded rectangles, frames and waves, as shapely polygons in (x, z), in metres."""

import math

import numpy as np
import shapely

from wm.offline.furniture.solids import Real


def rectangle(width: Real, height: Real, *, at: tuple[Real, Real] = (0.0, 0.0)) -> shapely.Polygon:
    """A rectangle, centred horizontally, whose lower edge is at the height `at`."""
    x, z = at
    return shapely.box(x - width / 2, z, x + width / 2, z + height)


def rounded(width: Real, height: Real, radius: Real, *, at: tuple[Real, Real] = (0.0, 0.0)) -> shapely.Polygon:
    """A rectangle with round corners, centred horizontally, whose lower edge is at the height `at`."""
    radius = min(radius, 0.49 * width, 0.49 * height)
    return rectangle(width, height, at=at).buffer(-radius).buffer(radius, quad_segs=5)


def arch(kind: str, width: Real, height: Real, *, at: tuple[Real, Real] = (0.0, 0.0), steps: int = 7) -> shapely.Polygon:
    """A panel whose top is "pointed" (two arcs that meet), "round", "wave" (a flat S) or, for any other name, straight.

    The arch is at most 0.6 of the height of the panel; a higher one is compressed.
    """
    x, z = at
    half = width / 2
    rise = min({"pointed": 0.87 * width, "round": half, "wave": 0.35 * width}.get(kind, 0.0), 0.6 * height)
    if rise == 0.0:
        return rectangle(width, height, at=at)
    if kind == "pointed":
        # two arcs of radius w about the opposite springing points, squeezed to the rise
        t = np.linspace(0, math.pi / 3, steps)
        right = np.stack([-half + width * np.cos(t), width * np.sin(t) * rise / (0.8660254 * width)], -1)
        curve = np.concatenate([right, right[-2::-1] * [-1, 1]])
    elif kind == "round":
        t = np.linspace(0, math.pi, 2 * steps)
        curve = np.stack([half * np.cos(t), rise * np.sin(t)], -1)
    else:
        u = np.linspace(1, -1, 2 * steps)
        curve = np.stack([half * u, rise * (0.45 + 0.55 * np.sin(2.4 * u + 0.5) * np.sqrt(np.maximum(1 - u**6, 0)))], -1)
    top = curve + np.array([x, z + height - curve[:, 1].max()])
    panel = shapely.Polygon([(x - half, z), (x + half, z), *((float(a), float(b)) for a, b in top)]).buffer(0)
    return panel if isinstance(panel, shapely.Polygon) else rectangle(width, height, at=at)


def frame(outline: shapely.Polygon, border: Real) -> shapely.Polygon:
    """The border of an outline with a given width: the outline without its inside."""
    cut = outline.difference(outline.buffer(-border, join_style="mitre"))
    return cut if isinstance(cut, shapely.Polygon) else outline


def circle(radius: Real, *, at: tuple[Real, Real] = (0.0, 0.0), segments: int = 24) -> shapely.Polygon:
    t = np.arange(segments) * 2 * math.pi / segments
    return shapely.Polygon(np.stack([at[0] + radius * np.cos(t), at[1] + radius * np.sin(t)], -1))


def gear(
    radius: Real, teeth: int, *, turned: Real = 0.0, at: tuple[Real, Real] = (0.0, 0.0), spokes: int = 5, tooth: Real = 0.0
) -> shapely.Polygon:
    """A gear wheel with spokes and a hub.

    Args:
      radius: radius of the pitch circle. Two wheels mesh if the distance of their centres is the sum of their radii.
      turned: angle from the x axis to the middle of the first tooth, radians.
      spokes: number of openings between rim and hub; 0 for a solid disc.
      tooth: height of a tooth, half of it outside the pitch circle; if 0, it follows from `radius` and `teeth`.
    """
    pitch = 2 * math.pi / teeth
    high = tooth or 3.8 * radius / teeth
    shares, reaches = np.array([-0.27, -0.13, 0.13, 0.27]), np.array([-0.5, 0.45, 0.45, -0.5])
    angle = (turned + pitch * (np.arange(teeth)[:, None] + shares)).ravel()
    reach = np.tile(radius + high * reaches, teeth)
    wheel = shapely.Polygon(np.stack([at[0] + reach * np.cos(angle), at[1] + reach * np.sin(angle)], -1))
    rim, hub = radius - 0.5 * high - 0.13 * radius, 0.26 * radius
    if spokes and rim > hub + 0.1 * radius:
        ring = circle(rim, at=at, segments=40).difference(circle(hub, at=at, segments=20))
        bars = [
            shapely.LineString([at, (at[0] + radius * math.cos(a), at[1] + radius * math.sin(a))]).buffer(0.055 * radius)
            for a in turned + 0.3 + 2 * math.pi * np.arange(spokes) / spokes
        ]
        wheel = wheel.difference(ring.difference(shapely.union_all(bars)))
    # The spokes of a very small wheel might not be connected to it.
    return wheel if isinstance(wheel, shapely.Polygon) else circle(radius, at=at)


def meshed(turned: Real, teeth: int, other: int, towards: Real) -> float:
    """`turned` of a wheel with `other` teeth that meshes with one of `teeth` teeth and lies in direction `towards` (radians)."""
    return towards + math.pi - (turned - towards) * teeth / other + math.pi / other
