"""The vector-Jacobian product of the projection with respect to the gaussians, written out: a few passes over rows of n, with
fusion barriers between them.

With M = J R Q S (projection.py), B = J R Q, N = M_0 x M_1, det = N . N + blur trace(M M^T) + blur^2 and the cotangents g of
l = (sqrt(yy / det), -xy / sqrt(det yy), 1 / sqrt(yy)):

    dL/d det = -(g0 l0 + g1 l1) / 2 det,   dL/d xy = -g1 / sqrt(det yy),   dL/d yy = (g0 l0 - g1 l1 - g2 l2) / 2 yy,
    dL/d M_0 = 2 dL/d det (M_1 x N + blur M_0) + dL/d xy M_1,
    dL/d M_1 = 2 dL/d det (N x M_0 + blur M_1) + dL/d xy M_0 + 2 dL/d yy M_1.

A log scale moves its column of M along itself. A turn by w in the gaussian's own axes moves B by B x w, so the torque is
t = sum_i (dL/d B_i) x B_i, and dL/dq = 2 q (0, t) / |q|^2 as quaternions. The mean acts through mean2d, depth, the scale f / z of
J and its slopes, as far as those are not clamped. Nothing is divided by a difference, so needles keep their digits.

The slope of depth has s_0 det = N . (M_2 x M_1) + blur M_0 . M_2 and s_1 det = N . (M_0 x M_2) + blur M_1 . M_2, so with
h = g_slope / det and G = h_0 M_2 x M_1 + h_1 M_0 x M_2 it adds -h . s to dL/d det, and

    dL/d M_0 += M_1 x G + h_1 M_2 x N + h_0 blur M_2,   dL/d M_1 += G x M_0 + h_0 N x M_2 + h_1 blur M_2,
    dL/d M_2 = h_0 (M_1 x N + blur M_0) + h_1 (N x M_0 + blur M_1).

With `antialias` the opacity is o c, c^2 = N . N / det above its floor. Its cotangent g_o adds -h / det to dL/d det, and
h / (N . N) to the derivative with respect to N . N alone, h = g_o o c / 2.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool

from wm.numerics import safe_div
from wm.schema import RasterSettings
from wm.splat.rasterizer._axes import by_largest, clamped, compensation, cross, depth_slope, dot, has_slope, rotations
from wm.splat.rasterizer._pose import to_camera
from wm.splat.xla.fusion_barrier import fusion_barrier
from wm.types import Camera


def ellipses_vjp(
    means, quats, log_scales, opacity_logits, camera: Camera, settings: RasterSettings, visible: Bool[Array, " n"], cotangent
):
    """Cotangents of means [3], quats [4], log_scales [3] (rows of n) and opacity_logits, from those of the projection but the
    colour.

    Args:
        means, quats, log_scales, opacity_logits: rows of n, finite.
        camera: float32 arrays.
        settings: blur, frustum_margin and antialias are read.
        visible: where False, all results are 0.
        cotangent: `Projected` whose mean2d, root, opacity, depth and slope are 0 where not visible.
    """
    never = jnp.max(means[0], initial=0.0) == jnp.inf  # not of the camera, which may be a constant that XLA folds
    R, f = camera.T_cam_world, camera.focal

    def place(means):
        x, y, z = to_camera(means, R)
        inverse = 1 / jnp.where(visible, z, 1.0)
        return jnp.where(visible, x, 0.0) * inverse, jnp.where(visible, y, 0.0) * inverse, inverse

    def axes(means, quats):
        """B [2][3], and the third row of R Q."""
        a, b, inverse = place(means)
        Q = rotations(quats)
        RQ = [[sum(R[i, k] * Q[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
        slopes = [clamped(s, i, camera, settings)[0] for i, s in enumerate((a, b))]
        return [[f[i] * inverse * (RQ[i][j] - slopes[i] * RQ[2][j]) for j in range(3)] for i in range(2)], RQ[2]

    def compensation_vjp(B, log_scales, opacity, g_opacity):
        """c, and its terms of dL/d det and of dL/d (N . N)."""
        M = _scaled(B, log_scales)
        N = cross(*M)
        sharp = dot(N, N)
        det = sharp + settings.blur * (dot(M[0], M[0]) + dot(M[1], M[1])) + settings.blur**2
        scale, free = compensation(sharp, det)
        h = jnp.where(free, 0.5 * g_opacity * opacity * scale, 0.0)
        return scale, -h / det, h / jnp.where(free, sharp, 1.0)

    def covariance_vjp(B, log_scales, g):
        """dL/d det, dL/d xy, dL/d yy."""
        M = _scaled(B, log_scales)
        N = cross(*M)
        xx, xy, yy = dot(M[0], M[0]), dot(M[0], M[1]), dot(M[1], M[1])
        det = dot(N, N) + settings.blur * (xx + yy) + settings.blur**2
        yy = yy + settings.blur
        root = 1 / jnp.sqrt(det * yy)
        g0, g1, g2 = g[0] * yy * root, -g[1] * xy * root, g[2] / jnp.sqrt(yy)  # g_k l_k
        return -0.5 * (g0 + g1) / det, -g[1] * root, 0.5 * (g0 - g1 - g2) / yy

    def slope_vjp(B, third, log_scales, g):
        """The terms of the slope in dL/d det and in dL/d B, [3][3] with the third row of R Q."""
        M = _scaled([*B, third], log_scales)
        N = cross(M[0], M[1])
        det = dot(N, N) + settings.blur * (dot(M[0], M[0]) + dot(M[1], M[1])) + settings.blur**2
        slope = depth_slope(M, N, det, settings)
        h = [g[0] / det, g[1] / det]
        P, Q, away, toward = cross(M[2], M[1]), cross(M[0], M[2]), cross(N, M[0]), cross(M[1], N)
        G = [h[0] * p + h[1] * q for p, q in zip(P, Q)]
        g_N = cross(M[1], G), cross(G, M[0])
        sideways = cross(M[2], N)
        g_M = [
            [g_N[0][j] + h[1] * sideways[j] + h[0] * settings.blur * M[2][j] for j in range(3)],
            [g_N[1][j] - h[0] * sideways[j] + h[1] * settings.blur * M[2][j] for j in range(3)],
            [h[0] * (toward[j] + settings.blur * M[0][j]) + h[1] * (away[j] + settings.blur * M[1][j]) for j in range(3)],
        ]
        return -(h[0] * slope[0] + h[1] * slope[1]), _scaled(g_M, log_scales)

    def axes_vjp(B, log_scales, g_det, g_xy, g_yy, g_sharp=None):
        """dL/d M times the lengths, which is dL/d B, [2][3]."""
        M = _scaled(B, log_scales)
        N = cross(*M)
        lengths = [jnp.exp(row) for row in log_scales]
        toward, away = cross(M[1], N), cross(N, M[0])
        first = [2 * g_det * (toward[j] + settings.blur * M[0][j]) + g_xy * M[1][j] for j in range(3)]
        second = [2 * g_det * (away[j] + settings.blur * M[1][j]) + g_xy * M[0][j] + 2 * g_yy * M[1][j] for j in range(3)]
        if g_sharp is not None:
            first, second = ([x + 2 * g_sharp * y for x, y in zip(*rows)] for rows in ((first, toward), (second, away)))
        return [[row[j] * lengths[j] for j in range(3)] for row in (first, second)]

    def shape_vjp(B, g_B):
        """Cotangents of the log scales, and the torque."""
        turns = [cross(*rows) for rows in zip(g_B, B)]
        stretch = [sum(g[j] * b[j] for g, b in zip(g_B, B)) for j in range(3)]
        return stretch, [sum(turn[j] for turn in turns) for j in range(3)]

    def quats_vjp(quats, torque):
        (w, x, y, z), largest = by_largest(quats)
        scale = safe_div(jnp.full_like(w, 2.0), (w * w + x * x + y * y + z * z) * largest)
        u, v, t = (scale * row for row in torque)
        return [-(x * u + y * v + z * t), w * u + y * t - z * v, w * v + z * u - x * t, w * t + x * v - y * u]

    def means_vjp(means, third, B, g_B, g_mean2d, g_depth):
        a, b, inverse = place(means)
        through = []
        for i, slope in enumerate((a, b)):
            free = clamped(slope, i, camera, settings)[1]
            through.append(f[i] * g_mean2d[i] - jnp.where(free, f[i] * inverse * dot(g_B[i], third), 0.0))
        x, y = (row * inverse for row in through)
        z = g_depth - a * x - b * y - inverse * (dot(g_B[0], B[0]) + dot(g_B[1], B[1]))
        return [jnp.where(visible, R[0, k] * x + R[1, k] * y + R[2, k] * z, 0.0) for k in range(3)]

    B, third = fusion_barrier(never, axes, means, quats)
    g_det, g_xy, g_yy = fusion_barrier(never, covariance_vjp, B, log_scales, list(cotangent.root))
    opacity, g_sharp = jax.nn.sigmoid(opacity_logits), None
    g_logits = cotangent.opacity * opacity * (1 - opacity)
    if settings.antialias:
        scale, more, g_sharp = fusion_barrier(never, compensation_vjp, B, log_scales, opacity, cotangent.opacity)
        g_logits, g_det = g_logits * scale, g_det + more
    slope_part = None
    if has_slope(settings):
        more, slope_part = fusion_barrier(never, slope_vjp, B, third, log_scales, list(cotangent.slope))
        g_det = g_det + more
    g_B = fusion_barrier(never, axes_vjp, B, log_scales, g_det, g_xy, g_yy, g_sharp)
    if slope_part is None:
        g_scales, torque = fusion_barrier(never, shape_vjp, B, g_B)
    else:
        g_B = [[x + y for x, y in zip(*rows)] for rows in zip(g_B, slope_part)]
        g_scales, torque = fusion_barrier(never, shape_vjp, [*B, third], [*g_B, slope_part[2]])
    g_quats = fusion_barrier(never, quats_vjp, quats, torque)
    g_means = fusion_barrier(never, means_vjp, means, third, B, g_B, list(cotangent.mean2d), cotangent.depth)
    return g_means, g_quats, g_scales, g_logits


def _scaled(B, log_scales):
    """M = B S."""
    lengths = [jnp.exp(row) for row in log_scales]
    return [[row[j] * lengths[j] for j in range(3)] for row in B]
