"""Closed solids of which furniture is built: boxes, and turned, extruded, swept and cushioned shapes.

All lengths are metres. Each function returns a closed Solid wound outwards (its signed volume is positive). Parts are combined
without boolean operations: they may interpenetrate, but no two faces may lie in one plane.

trimesh.creation has two of them: `revolve` agrees with `lathe` where the profile begins and ends on the axis (144 triangles, the
same volume) and leaves every other profile open, and `extrude_polygon` agrees with `extrude`. Both number vertices differently,
which would change the bytes of every scene and add no shape, so they are not used (experiments/library_peers).
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry

Real = float | int
"""A float or an integer, since run-time checks of types refuse an integer such as 0 for a float."""

Point3 = tuple[Real, Real, Real]


@dataclasses.dataclass(frozen=True, eq=False)
class Solid:
    """A closed triangle mesh."""

    vertices: np.ndarray  # [v, 3] float64
    faces: np.ndarray  # [f, 3] int32, counter-clockwise from outside


def volume(solid: Solid) -> float:
    """Signed volume: positive if the faces are wound outwards."""
    a, b, c = (solid.vertices[solid.faces[:, k]] for k in range(3))
    return float(np.einsum("fi,fi->", a, np.cross(b, c)) / 6.0)


def closed(vertices: Float[np.ndarray, "v 3"], faces: Sequence[Sequence[int]] | np.ndarray) -> Solid:
    """A Solid of consistently wound faces, which are reversed if they are wound inwards."""
    solid = Solid(np.asarray(vertices, np.float64), np.asarray(faces, np.int32))
    return solid if volume(solid) > 0 else Solid(solid.vertices, solid.faces[:, ::-1].copy())


def shift(solid: Solid, offset: Point3) -> Solid:
    return Solid(solid.vertices + np.asarray(offset, np.float64), solid.faces)


def turn(solid: Solid, axis: str, degrees: Real, about: Point3 = (0.0, 0.0, 0.0)) -> Solid:
    """The solid turned counter-clockwise about an axis ("x", "y" or "z") through a point."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    rotation = np.eye(3)
    rotation[i, i], rotation[i, j], rotation[j, i], rotation[j, j] = c, -s, s, c
    centre = np.asarray(about, np.float64)
    return Solid((solid.vertices - centre) @ rotation.T + centre, solid.faces)


def stretch(solid: Solid, factors: Point3) -> Solid:
    """The solid scaled along the axes about the origin; a negative factor mirrors it."""
    return closed(solid.vertices * np.asarray(factors, np.float64), solid.faces)


def box(lo: Point3, hi: Point3, bevel: Real = 0.004) -> Solid:
    """A box between two corners with its edges chamfered by `bevel` (44 triangles; 12 without a bevel)."""
    low, high = np.minimum(lo, hi).astype(np.float64), np.maximum(lo, hi).astype(np.float64)
    half, centre = (high - low) / 2, (high + low) / 2
    bevel = min(bevel, 0.4 * float(half.min()))
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)  # [8, 3]
    if bevel <= 0:
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        return closed(centre + signs * half, _triangles(quads))
    # vertex 3 k + a: corner k moved inward along every axis but a, so that it lies on the face of axis a
    vertices = np.concatenate([centre + s * (half - bevel * (1 - np.eye(3)[a]))[None] for s in signs for a in range(3)])
    index = {tuple(s): 3 * k for k, s in enumerate(signs.astype(int).tolist())}
    faces: list[Sequence[int]] = []
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        for s in (-1, 1):
            ring = [index[_signs(a, s, b, u, c, v)] + a for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            faces += _triangles([ring if s > 0 else ring[::-1]])
        for u in (-1, 1):
            for v in (-1, 1):  # the edge along a, between the faces of b (sign u) and c (sign v)
                ends = [index[_signs(a, s, b, u, c, v)] for s in (-1, 1)]
                ring = [ends[0] + b, ends[1] + b, ends[1] + c, ends[0] + c]
                faces += _triangles([ring if u * v < 0 else ring[::-1]])
    for s, k in index.items():
        ring = [k, k + 1, k + 2]
        faces.append(ring if s[0] * s[1] * s[2] > 0 else ring[::-1])
    return closed(vertices, faces)


def _signs(a: int, s: int, b: int, u: int, c: int, v: int) -> tuple[int, ...]:
    corner = [0, 0, 0]
    corner[a], corner[b], corner[c] = s, u, v
    return tuple(corner)


def _triangles(quads: Sequence[Sequence[int]]) -> list[Sequence[int]]:
    return [tri for a, b, c, d in quads for tri in ((a, b, c), (a, c, d))]


def rounded_box(lo: Point3, hi: Point3, radius: Real, segments: int = 2) -> Solid:
    """A box with edges and corners rounded: 12 (2 segments + 1)^2 triangles."""
    low, high = np.minimum(lo, hi).astype(np.float64), np.maximum(lo, hi).astype(np.float64)
    half, centre = (high - low) / 2, (high + low) / 2
    radius = min(radius, 0.98 * float(half.min()))
    steps = 2 * segments + 2
    ramp = np.tan(np.pi / 4 * (1 - np.arange(segments + 1) / segments))
    slope = np.concatenate([-ramp, ramp[::-1]])  # direction component of each lattice line: 0 on both sides of the flat
    side = np.where(np.arange(steps) <= segments, -1.0, 1.0)
    lattice: dict[tuple[int, ...], int] = {}
    faces: list[Sequence[int]] = []
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        for end in (0, steps - 1):
            for i in range(steps - 1):
                for j in range(steps - 1):
                    ring = []
                    for u, v in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        key = [0, 0, 0]
                        key[a], key[b], key[c] = end, u, v
                        ring.append(lattice.setdefault(tuple(key), len(lattice)))
                    faces += _triangles([ring if end else ring[::-1]])
    key = np.array(list(lattice))
    direction = slope[key]
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return closed(centre + side[key] * (half - radius) + radius * direction, faces)


def puff(lo: Point3, hi: Point3, *, square: Real = 0.35, flat: Real = 0.8, around: int = 20, along: int = 8) -> Solid:
    """A cushion: a superellipsoid between two corners, squarish seen along z, thin at its seam.

    Args:
      square: exponent of the outline; 1 is an ellipse, towards 0 a rectangle.
      flat: exponent of the height; 1 is round, below 1 boxier, above 1 more pinched at the seam.
    """
    low, high = np.minimum(lo, hi).astype(np.float64), np.maximum(lo, hi).astype(np.float64)
    half, centre = (high - low) / 2, (high + low) / 2
    u = np.linspace(-np.pi / 2, np.pi / 2, along + 1)[1:-1]
    v = (np.arange(around) + 0.5) * 2 * np.pi / around

    def power(x: np.ndarray, e: Real) -> np.ndarray:
        return np.sign(x) * np.abs(x) ** e

    ring = np.stack([power(np.cos(v), square), power(np.sin(v), square)], -1)
    reach = power(np.cos(u), 0.5)
    points = [np.concatenate([ring * r, np.full((around, 1), z)], 1) for r, z in zip(reach, power(np.sin(u), flat))]
    stack = np.concatenate([[[0.0, 0.0, -1.0]], *points, [[0.0, 0.0, 1.0]]])
    solid = _stack_of_rings(stack, len(u), around, poles=True)
    extent = np.abs(solid.vertices).max(0)
    return Solid(solid.vertices / extent * half + centre, solid.faces)


def _stack_of_rings(vertices: np.ndarray, rings: int, around: int, *, poles: bool) -> Solid:
    """A Solid of rings of `around` vertices, closed by one pole vertex at each end (the first and the last of `vertices`)."""
    start = 1 if poles else 0
    k = np.arange(around)
    after = (k + 1) % around
    faces = [np.stack([np.zeros_like(k), start + after, start + k], 1)] if poles else []
    for r in range(rings - 1):
        a, b = start + r * around, start + (r + 1) * around
        faces += [np.stack([a + k, a + after, b + after], 1), np.stack([a + k, b + after, b + k], 1)]
    if poles:
        top = start + (rings - 1) * around
        faces.append(np.stack([top + k, top + after, np.full_like(k, len(vertices) - 1)], 1))
    return closed(vertices, np.concatenate(faces))


def lathe(profile: Sequence[tuple[Real, Real]], segments: int = 24, *, at: Point3 = (0.0, 0.0, 0.0), smooth: int = 0) -> Solid:
    """A solid of revolution about the vertical axis through `at`.

    Args:
      profile: (radius, height) from one end to the other; ends off the axis are closed by flat caps.
      smooth: number of points of a Catmull-Rom curve between two points of the profile (0 keeps its corners).
    """
    curve = np.asarray(profile, np.float64)
    if smooth:
        curve = catmull_rom(curve, smooth)
        curve[:, 0] = np.maximum(curve[:, 0], 0.0)
    inner = curve[curve[:, 0] > 1e-9]
    ends = [[0.0, 0.0, curve[0, 1]], [0.0, 0.0, curve[-1, 1]]]
    angle = np.arange(segments) * 2 * np.pi / segments
    circle = np.stack([np.cos(angle), np.sin(angle)], -1)
    rings = [np.concatenate([circle * r, np.full((segments, 1), z)], 1) for r, z in inner]
    return shift(_stack_of_rings(np.concatenate([ends[:1], *rings, ends[1:]]), len(inner), segments, poles=True), at)


def shell(profile: Sequence[tuple[Real, Real]], thickness: Real, segments: int = 28, *, at: Point3 = (0.0, 0.0, 0.0)) -> Solid:
    """A wall of revolution, open above and below. The (radius, height) profile is its outside; it is `thickness` thick."""
    loop = [*profile, *((r - thickness, h) for r, h in reversed(profile))]
    angle = np.arange(segments) * 2 * np.pi / segments
    rings = [np.stack([r * np.cos(angle), r * np.sin(angle), np.full(segments, h)], -1) for r, h in loop]
    k = np.arange(segments)
    after = (k + 1) % segments
    faces = []
    for i in range(len(loop)):
        a, b = i * segments, ((i + 1) % len(loop)) * segments
        faces += [np.stack([a + k, a + after, b + after], 1), np.stack([a + k, b + after, b + k], 1)]
    return shift(closed(np.concatenate(rings), np.concatenate(faces)), at)


def catmull_rom(points: Float[np.ndarray, "k d"], between: int) -> Float[np.ndarray, "m d"]:
    """The points with `between` additional points of a Catmull-Rom curve between each two."""
    padded = np.concatenate([2 * points[:1] - points[1:2], points, 2 * points[-1:] - points[-2:-1]])
    t = np.linspace(0, 1, between + 2)[:-1, None]
    pieces = []
    for p0, p1, p2, p3 in zip(padded[:-3], padded[1:-2], padded[2:-1], padded[3:]):
        pieces.append(
            0.5 * (2 * p1 + (p2 - p0) * t + (2 * p0 - 5 * p1 + 4 * p2 - p3) * t**2 + (3 * p1 - p0 - 3 * p2 + p3) * t**3)
        )
    return np.concatenate([*pieces, points[-1:]])


def tube(
    path: Sequence[Point3] | np.ndarray,
    radius: Real | Sequence[float],
    segments: int = 8,
    *,
    flatten: Real = 1.0,
    smooth: int = 0,
) -> Solid:
    """A rod along a path, closed at its ends.

    Args:
      radius: one radius, or one per point of the path.
      flatten: ratio of the thickness across to that along the first normal; below 1 for a strap or a leaf.
      smooth: number of points of a Catmull-Rom curve between two points of the path.
    """
    points = np.asarray(path, np.float64)
    radii = np.broadcast_to(np.asarray(radius, np.float64), (len(points),))
    if smooth:
        both = catmull_rom(np.concatenate([points, radii[:, None]], 1), smooth)
        points, radii = both[:, :3], np.maximum(both[:, 3], 1e-3)
    tangent = np.gradient(points, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    axis = np.eye(3)[np.argmin(np.abs(tangent[0]))]
    angle = (np.arange(segments) + 0.5) * 2 * np.pi / segments
    rings = []
    for p, t, r in zip(points, tangent, radii):
        first = axis - t * (axis @ t)
        first /= np.linalg.norm(first)
        axis = first  # transported along the path, so that the section does not twist
        second = np.cross(t, first)
        rings.append(p + r * (np.cos(angle)[:, None] * second + flatten * np.sin(angle)[:, None] * first))
    return _stack_of_rings(np.concatenate([points[:1], *rings, points[-1:]]), len(points), segments, poles=True)


def extrude(outline: BaseGeometry | Sequence[tuple[Real, Real]], lo: Real, hi: Real, axis: str = "y") -> Solid:
    """A prism: an outline (with the holes of a polygon) extruded from `lo` to `hi` along an axis.

    The outline lies in (x, z) for axis "y", in (y, z) for "x" and in (x, y) for "z".

    Raises:
      ValueError: the outline is not a single polygon.
    """
    shape = outline if isinstance(outline, BaseGeometry) else shapely.Polygon(outline)
    if not isinstance(shape, shapely.Polygon) or shape.is_empty:
        raise ValueError(f"extrude takes one polygon, not {shape.geom_type} of area {shape.area:.4f}")
    polygon = shapely.orient_polygons(shape)
    loops = [np.asarray(ring.coords)[:-1] for ring in (polygon.exterior, *polygon.interiors)]
    flat = np.concatenate(loops)
    index = {tuple(p): k for k, p in enumerate(flat.tolist())}
    caps = [
        [index[p] for p in triangle.exterior.coords[:3]]
        for triangle in shapely.get_parts(shapely.orient_polygons(shapely.constrained_delaunay_triangles(polygon)))
    ]
    n = len(flat)
    faces: list[Sequence[int]] = [(c, b, a) for a, b, c in caps]
    faces += [(a + n, b + n, c + n) for a, b, c in caps]
    start = 0
    for loop in loops:
        k = start + np.arange(len(loop))
        for a, b in zip(k.tolist(), np.roll(k, -1).tolist()):
            faces += _triangles([(a, b, b + n, a + n)])
        start += len(loop)
    planes = [np.concatenate([flat, np.full((n, 1), h)], 1) for h in (min(lo, hi), max(lo, hi))]
    order = {"z": [0, 1, 2], "x": [2, 0, 1], "y": [0, 2, 1]}[axis]
    return closed(np.concatenate(planes)[:, order], faces)


def rod(start: Point3, end: Point3, radius: Real, segments: int = 8) -> Solid:
    """A straight round bar."""
    return tube([start, end], radius, segments)


def ball(centre: Point3, radius: Real, segments: int = 12) -> Solid:
    """A sphere."""
    t = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)
    profile = [(max(radius * math.cos(a), 0.0), radius * math.sin(a)) for a in t]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    return lathe(profile, segments, at=centre)
