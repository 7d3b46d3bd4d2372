"""Gaussians in the world become ellipses on the image: EWA splatting, one elementwise pass over (., n) rows.

Notation: p = R x + t (camera axes), (a, b) = p_xy / p_z, S = diag(exp(log_scales)), Q = rotation of the unit quaternion.

    mean2d = focal * (a, b) + principal
    M = J R Q S (2 x 3),  J = [[fx / z, 0, -fx a' / z], [0, fy / z, -fy b' / z]],  a', b' clamped near the frustum
    Sigma = M M^T + blur I = [[xx, xy], [xy, yy]],  det = sum of squared 2 x 2 minors of M + blur trace(M M^T) + blur^2
    q = 1/2 d^T Sigma^-1 d = 1/2 ((l0 dx + l1 dy)^2 + (l2 dy)^2),  l = (sqrt(yy / det), -xy / sqrt(det yy), 1 / sqrt(yy))
    slope = Sigma^-1 M m,  m = third row of R Q S: E[z | x, y] = z + slope . d of the (blurred) gaussian
    o = sigmoid(opacity_logits), times c = sqrt(max(det M M^T / det, COMPENSATION_FLOOR)) with `antialias`

The determinant as a sum of squares (Cauchy-Binet) and q as a sum of squares (l is the Cholesky factor of the conic) keep their
digits for needles, where xx yy - xy^2 and the expanded form cancel. A gaussian is culled unless every comparison that keeps it
holds, so NaN culls; culled ones have opacity and extent 0 and no gradient.
Work: once per view, O(n).
"""

import dataclasses
import functools
from typing import Any

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from wm.numerics import safe_div, safe_sqrt
from wm.schema import RasterSettings
from wm.splat.rasterizer._axes import clamped, compensation, cross, depth_slope, dot, has_slope, rotations
from wm.splat.rasterizer._pose import from_centre, to_camera
from wm.splat.rasterizer._vjp import ellipses_vjp
from wm.splat.rasterizer.checks import DEGREES, check_types
from wm.splat.rasterizer.harmonics import harmonics
from wm.splat.xla.blocks import in_blocks
from wm.types import Camera, Gaussians, record

DEFAULTS = RasterSettings()
"""The rasterizer's constants when a caller names none; one record for all, since settings are static under jit."""

FARTHEST = 1e9
"""Ellipses whose centre or size exceeds this many pixels are culled: float32 has no digits left there, and q stays finite."""

FLATTEST = -60.0
"""Log scales below this count as this one, 1e-26 m, so that those of discs (-inf) meet no 0 * inf; the scale of a disc then has
no gradient beyond rounding."""


@record
class Projected:
    """Gaussians on the image plane, on the device, channel-first. Culled ones have opacity 0 and extent 0.

    Attributes:
        mean2d: [2, n] pixels
        root: [3, n] l, the Cholesky factor of the conic, px^-1: q = 1/2 ((l0 dx + l1 dy)^2 + (l2 dy)^2)
        opacity: [n] o, compensated with `antialias`
        color: [3, n] sRGB-encoded, seen from this camera
        depth: [n] z-depth of the centre, metres
        slope: [2, n] growth of depth per pixel to the right and down, metres; 0 unless `depth` and `slanted`
        extent: [2, n] half width and half height of the ellipse where alpha falls to `alpha_min`, px; no gradient
    """

    mean2d: Any
    root: Any
    opacity: Any
    color: Any
    depth: Any
    slope: Any
    extent: Any


def project(gaussians: Gaussians, camera: Camera, settings: RasterSettings = DEFAULTS) -> Projected:
    """Gaussians as the camera sees them; differentiable once, in reverse mode, in the gaussians and in the camera's arrays.

    Args:
        gaussians: n gaussians in world space, NumPy or JAX.
        camera: where they are seen from; its arrays may be NumPy.
        settings: blur, near, alpha_min, frustum_margin, antialias, depth and slanted are read here.

    Returns:
        The ellipses, in the order of the gaussians.

    Raises:
        TypeError, ValueError: a dtype or a shape is wrong, while tracing.

    Source: Zwicker et al., "EWA Splatting" (2002); the clamp, blur and cut follow Kerbl et al. (2023), the clamp made aware
    of the principal point. The bounding ellipse is exact for the alpha cut, not 3 sigma. `antialias` is the 2D filter of
    Yu et al., "Mip-Splatting" (2024), section 5.2. The slope is the conditional mean of depth in the ray space of Zwicker et al.,
    close to the plane of Zhang et al., "RaDe-GS" (2024), without its normalisation by the ray.
    """
    check_types(gaussians, camera, settings)
    to_float32 = functools.partial(jax.tree.map, lambda x: jnp.asarray(x, jnp.float32))
    return _project(to_float32(gaussians), to_float32(camera), settings)


@functools.partial(jax.custom_vjp, nondiff_argnums=(2,))
def _project(gaussians: Gaussians, camera: Camera, settings: RasterSettings) -> Projected:
    return _project_fwd(gaussians, camera, settings)[0]


def _project_fwd(gaussians: Gaussians, camera: Camera, settings: RasterSettings):
    def shown(gaussians: Gaussians) -> Projected:
        raw, covariance = _ellipses(_rows(gaussians), camera, settings)
        visible = _is_visible(raw, covariance, settings)
        # alpha falls to alpha_min on the ellipse d^T Sigma^-1 d = 2 ln(o / alpha_min), whose box is radius * sqrt(diagonal)
        ratio = jnp.where(visible, raw.opacity, settings.alpha_min) / settings.alpha_min
        extent = jnp.sqrt(2 * jnp.log(ratio)[None] * _or_zero(visible, covariance))
        return dataclasses.replace(jax.tree.map(functools.partial(_or_zero, visible), raw), extent=extent)

    def opaque(gaussians: Gaussians) -> Bool[Array, ""]:
        return (jnp.exp(gaussians.opacity_logits) >= settings.alpha_min).any()  # more than the opacity, so nothing is missed

    projected = in_blocks(shown, opaque, [gaussians], [0], out_axis=-1)
    return projected, (gaussians, camera, projected)


def _project_bwd(settings: RasterSettings, residuals, cotangent: Projected):
    gaussians, camera, projected = residuals
    visible = projected.opacity > 0
    # with respect to the camera: JAX's derivative, sums over all gaussians; compiled only where a caller asks for it
    rows, masked = _visible_rows(gaussians, visible, cotangent)
    _, camera_vjp = jax.vjp(lambda camera: _ellipses(rows, camera, settings, visible)[0], camera)
    return project_vjp(gaussians, camera, projected, cotangent, settings), camera_vjp(masked)[0]


def project_vjp(
    gaussians: Gaussians, camera: Camera, projected: Projected, cotangent: Projected, settings: RasterSettings = DEFAULTS
) -> Gaussians:
    """The vector-Jacobian product of `project` with respect to the gaussians, given its result (`jax.vjp` computes it again).

    Args:
        gaussians, camera, settings: what `project` was called with; float32 arrays.
        projected: what it returned.
        cotangent: of its leaves; that of the extent is ignored.
    """

    def vjp(gaussians: Gaussians, visible, cotangent: Projected) -> Gaussians:
        rows, masked = _visible_rows(gaussians, visible, cotangent)
        means, quats, log_scales, opacity_logits, sh = rows
        g_means, g_quats, g_scales, g_logits = ellipses_vjp(
            means, quats, log_scales, opacity_logits, camera, settings, visible, masked
        )
        _, colors_vjp = jax.vjp(lambda sh, means: _colors(sh, means, camera.T_cam_world), sh, means)
        g_sh, g_direction = colors_vjp(masked.color)
        return Gaussians(
            means=jnp.stack([shift + turn for shift, turn in zip(g_means, g_direction)], 1),
            quats=jnp.stack(g_quats, 1),
            log_scales=jnp.stack(g_scales, 1),
            opacity_logits=g_logits,
            sh=jnp.stack([band.T for band in g_sh], 1),
        )

    parts = [gaussians, projected.opacity > 0, cotangent]
    return in_blocks(vjp, lambda _, visible, __: visible.any(), parts, [0, 0, -1], out_axis=0)


def _visible_rows(gaussians: Gaussians, visible, cotangent: Projected):
    """Rows of the gaussians and their cotangents without the extent's, zero where culled.

    So culled gaussians are replaced by one that is safe to differentiate before the pass is run again: a NaN of theirs would
    reach the camera's gradient, which sums over all.
    """
    rows = jax.tree.map(functools.partial(_or_zero, visible), _rows(gaussians))
    no_extent = dataclasses.replace(cotangent, extent=jnp.zeros_like(cotangent.extent))
    return rows, jax.tree.map(functools.partial(_or_zero, visible), no_extent)


_project.defvjp(_project_fwd, _project_bwd)


def _rows(gaussians: Gaussians):
    """Means [3], quats [4], log_scales [3] as rows (n), opacity_logits, and sh [k] as (3, n); no log scale below FLATTEST.

    The transpose is a product with the identity: XLA on a CPU would fuse a plain one with all arithmetic that follows.
    """

    def split(x):
        columns = jnp.matmul(jnp.eye(x.shape[1], dtype=x.dtype), x.T, precision="highest")
        return [columns[i] for i in range(x.shape[1])]

    sh = [gaussians.sh[:, k].T for k in range(gaussians.sh.shape[1])]
    log_scales = jnp.maximum(gaussians.log_scales, FLATTEST)
    return split(gaussians.means), split(gaussians.quats), split(log_scales), gaussians.opacity_logits, sh


def _or_zero(visible: Bool[Array, " n"], x: Float[Array, "*rows n"]) -> Float[Array, "*rows n"]:
    return jnp.where(jnp.broadcast_to(visible, x.shape), x, 0.0)


def _ellipses(
    rows, camera: Camera, settings: RasterSettings, visible: Bool[Array, " n"] | None = None
) -> tuple[Projected, Float[Array, "2 n"]]:
    """The equations above, nothing culled, and the diagonal of Sigma; where `visible` is False a harmless gaussian stands in."""
    means, quats, log_scales, opacity_logits, sh = rows
    T = camera.T_cam_world
    px, py, pz = to_camera(means, T)
    if visible is not None:
        px, py, pz = jnp.where(visible, px, 0.0), jnp.where(visible, py, 0.0), jnp.where(visible, pz, 1.0)
    a, b = px / pz, py / pz
    fx, fy = camera.focal
    slopes = [clamped(slope, axis, camera, settings)[0] for axis, slope in enumerate((a, b))]
    M = _image_axes(quats, log_scales, T, (fx / pz, fy / pz), slopes)
    xx, xy, yy = (sum(p * q for p, q in zip(M[i], M[j])) for i, j in ((0, 0), (0, 1), (1, 1)))
    minors = cross(M[0], M[1])
    sharp = dot(minors, minors)
    det = sharp + settings.blur * (xx + yy) + settings.blur**2
    opacity = jax.nn.sigmoid(opacity_logits)
    if settings.antialias:
        opacity = opacity * compensation(sharp, det)[0]
    xx, yy = xx + settings.blur, yy + settings.blur
    mean2d = jnp.stack([fx * a + camera.principal[0], fy * b + camera.principal[1]])
    projected = Projected(
        mean2d=mean2d,
        root=jnp.stack([jnp.sqrt(yy / det), -xy / jnp.sqrt(det * yy), 1 / jnp.sqrt(yy)]),
        opacity=opacity,
        color=_colors(sh, means, T),
        depth=pz,
        slope=jnp.stack(depth_slope(M, minors, det, settings)) if has_slope(settings) else jnp.zeros_like(mean2d),
        extent=jnp.zeros_like(mean2d),
    )
    return projected, jnp.stack([xx, yy])


def _image_axes(quats, log_scales, T, scale, slope):
    """M = J R Q S: where a gaussian's axes, one standard deviation long, go on the image and in depth; [3][3] rows of n."""
    Q = rotations(quats)
    lengths = [jnp.exp(row) for row in log_scales]
    # J R row by row first: rows of three instead of a 3 x 3 product
    JR = [[scale[i] * (T[i, k] - slope[i] * T[2, k]) for k in range(3)] for i in range(2)]
    JR.append([T[2, k] for k in range(3)])
    return [[sum(JR[i][k] * Q[k][j] for k in range(3)) * lengths[j] for j in range(3)] for i in range(3)]


def _colors(sh, x_world, T):
    """max(0, 0.5 + sum_k sh_k Y_k(direction from the camera)), (3, n). With one coefficient no direction is computed.

    As in Kerbl et al. (2023), a channel below 0 is 0 and its coefficients have no gradient there.
    """
    degree = DEGREES[len(sh)]
    if degree == 0:
        color = 0.5 + harmonics(None, 0)[0] * sh[0]
    else:
        x, y, z = from_centre(x_world, T)
        length = safe_sqrt(x * x + y * y + z * z)
        direction = jnp.stack([safe_div(x, length), safe_div(y, length), safe_div(z, length)])
        constant, *basis = harmonics(direction, degree)
        color = 0.5 + sum((Y[None] * band for Y, band in zip(basis, sh[1:])), constant * sh[0])
    return jnp.where((color < 0) & (color > -jnp.inf), 0.0, color)  # -inf stays, and is culled


def _is_visible(raw: Projected, covariance, settings: RasterSettings) -> Bool[Array, " n"]:
    in_front = raw.depth > settings.near
    opaque = raw.opacity > settings.alpha_min
    near_enough = (jnp.abs(raw.mean2d) < FARTHEST).all(0) & (raw.depth < FARTHEST) & (covariance < FARTHEST**2).all(0)
    finite = (jnp.abs(raw.root) < FARTHEST).all(0) & (raw.root[0] > 0) & (jnp.abs(raw.color) < FARTHEST).all(0)
    return in_front & opaque & near_enough & finite & (jnp.abs(raw.slope) < FARTHEST).all(0)
