"""Functions that the projection and its vector-Jacobian product share: rotations of quaternions, the clamp of slopes near the
frustum, the compensation of opacity for the blur, and the slope of depth over an ellipse with its limit."""

import functools

import jax
import jax.numpy as jnp

from wm.numerics import safe_div, safe_sqrt
from wm.schema import RasterSettings
from wm.types import Camera

COMPENSATION_FLOOR = 0.005**2
"""Opacities are reduced to the root of this at most (gsplat's bound): the square root has no derivative at 0, and a gaussian that
faint is below or near the alpha cut in any case."""


def rotations(quats):
    """Rotation matrices [3][3] of quaternions [4] of any length; the zero quaternion is the identity with zero gradient.

    The rotation does not depend on the length, so dividing by the largest component needs no derivative.
    """
    (w, x, y, z), _ = by_largest(quats)
    s = safe_div(jnp.full_like(w, 2.0), w * w + x * x + y * y + z * z)
    return [
        [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
    ]


def by_largest(quats):
    """Quaternions [4] divided by the size of their largest component, so that squares cannot overflow, and that size. Zero stays
    zero."""
    largest = jax.lax.stop_gradient(functools.reduce(jnp.maximum, map(jnp.abs, quats)))
    return [row / jnp.where(largest == 0, 1.0, largest) for row in quats], largest


def clamped(slope, axis: int, camera: Camera, settings: RasterSettings):
    """A slope x / z (axis 0) or y / z (1) held within the margin around the frustum, and where it is free.

    Farther out the linearised projection means nothing.
    """
    focal, centre, size = camera.focal[axis], camera.principal[axis], (camera.width, camera.height)[axis]
    margin = (settings.frustum_margin - 1) * 0.5 * size / focal
    low, high = -centre / focal - margin, (size - centre) / focal + margin
    return jnp.clip(slope, low, high), (slope > low) & (slope < high)


def compensation(sharp, blurred):
    """sqrt(max(sharp / blurred, COMPENSATION_FLOOR)) of the determinants without and with blur, and where it is not floored."""
    ratio = sharp / blurred
    return jnp.sqrt(jnp.maximum(ratio, COMPENSATION_FLOOR)), ratio > COMPENSATION_FLOOR


def has_slope(settings: RasterSettings) -> bool:
    """Whether depth is rendered, and not as that of the centres."""
    return settings.depth and settings.slanted


def depth_slope(M, N, det, settings: RasterSettings):
    """Sigma^-1 (M_0 . M_2, M_1 . M_2), metres per pixel; by products of minors (Binet-Cauchy), so that needles keep their digits.

    Args:
        M: [3][3] rows of n; N: M_0 x M_1; det: of Sigma, blurred.
    """
    right = dot(N, cross(M[2], M[1])) + settings.blur * dot(M[0], M[2])
    down = dot(N, cross(M[0], M[2])) + settings.blur * dot(M[1], M[2])
    return right / det, down / det


def limited_slope(slope, root, opacity, depth, settings: RasterSettings):
    """The slope of depth, reduced where depth would otherwise fall below `near` somewhere on the ellipse that is drawn.

    The slope belongs to a plane under the affine approximation of perspective, which means nothing far from the centre of a
    gaussian that is large beside its distance: a floor seen from knee height would have negative depths.

    Args:
        slope: [2] rows of n; root: [3] rows, the Cholesky factor of the conic; opacity: 0 where culled; depth: of the centre.
    """
    drawn = opacity > settings.alpha_min
    l0, l1, l2 = (jnp.where(drawn, row, 1.0) for row in root)
    # s . d = h . e with e = (l0 dx + l1 dy, l2 dy), whose length is at most sqrt(2 ln(o / alpha_min)) where alpha is not cut
    h0 = slope[0] / l0
    h1 = (slope[1] - l1 * h0) / l2
    farthest = 2 * jnp.log(jnp.where(drawn, opacity, settings.alpha_min) / settings.alpha_min)
    reach = safe_sqrt(farthest * (h0 * h0 + h1 * h1))
    room = depth - settings.near
    limited = drawn & (reach > room)
    scale = jnp.where(limited, room / jnp.where(limited, reach, 1.0), 1.0)
    return [row * scale for row in slope]


def dot(p, q):
    """Of two vectors [3] of rows."""
    return sum(x * y for x, y in zip(p, q))


def cross(p, q):
    """Of two vectors [3] of rows."""
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
