"""The slow twin of `render`: float64, every pixel against every gaussian, no tiles, no custom derivative.

It follows the equations as design.md section 5 writes them (covariance, its inverse by determinant, cut, clamp, stop) and not the
forms that the fast path rearranges them into. Differentiate it with `jax.grad`. Memory is O(pixels x gaussians).
"""

from typing import Any

import jax
import jax.numpy as jnp

from wm.schema import RasterSettings
from wm.splat.rasterizer._axes import COMPENSATION_FLOOR
from wm.splat.rasterizer.harmonics import harmonics
from wm.splat.rasterizer.projection import DEFAULTS
from wm.types import Background, Camera, Gaussians, Render, record


@record
class Distance:
    """Per pixel, the smallest relative distance of any of its values from a threshold that it was compared with, [h, w]."""

    alpha: Any  # of an alpha from alpha_min or alpha_max
    transmittance: Any  # of a transmittance from transmittance_min


@record
class _Layers:
    """Every gaussian at every pixel, front to back."""

    unclamped: Any  # [h, w, n] opacity exp(-q), 0 behind the camera
    alpha: Any  # [h, w, n] the same, cut and clamped
    transmittance: Any  # [h, w, n] in front of it
    color: Any  # [n, 3]
    depth: Any  # [h, w, n]


def render_reference(
    gaussians: Gaussians,
    camera: Camera,
    *,
    background: Background | None = None,
    settings: RasterSettings = DEFAULTS,
) -> Render:
    """What `render` promises, in float64; call it, and differentiate it, under `with jax.enable_x64(True)`.

    Raises:
        RuntimeError: float64 is not enabled.
    """
    layers = _layers(gaussians, camera, settings)
    alpha, T = layers.alpha, layers.transmittance
    w = jnp.where(settings.transmittance_min <= T, T * alpha, 0.0)
    total = w.sum(-1)
    seen = total > 0
    depth = jnp.where(seen, (w * layers.depth).sum(-1) / jnp.where(seen, total, 1.0), 0.0)
    behind = jnp.zeros(3) if background is None else jnp.asarray(background, jnp.float64)
    return Render(
        rgb=w @ layers.color + (1 - total)[..., None] * behind,
        depth=depth if settings.depth else jnp.zeros_like(depth),
        alpha=total,
    )


def distance_to_thresholds(gaussians: Gaussians, camera: Camera, *, settings: RasterSettings = DEFAULTS) -> Distance:
    """How close each pixel of `render_reference` came to deciding otherwise; under x64 as well.

    Only what the pixel still looked at counts: behind the gaussian that finished it, nothing does.
    """
    layers = _layers(gaussians, camera, settings)
    stop = settings.transmittance_min
    # a pixel whose transmittance is just below the stop may go on in other arithmetic: that is the distance of its stop
    open_ = layers.transmittance >= stop

    def smallest(distance):
        return jnp.min(jnp.where(open_, distance, jnp.inf), axis=-1, initial=jnp.inf)

    cuts = [jnp.abs(layers.unclamped / threshold - 1) for threshold in (settings.alpha_min, settings.alpha_max)]
    after = layers.transmittance * (1 - layers.alpha)
    stops = jnp.abs(after / stop - 1) if stop > 0 else jnp.full_like(after, jnp.inf)
    return Distance(alpha=smallest(jnp.minimum(*cuts)), transmittance=smallest(stops))


def _layers(gaussians: Gaussians, camera: Camera, settings: RasterSettings) -> _Layers:
    if jnp.zeros(()).dtype != jnp.float64:
        raise RuntimeError("the twin computes in float64: call it under `with jax.enable_x64(True)`")
    gaussians, camera = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), (gaussians, camera))
    R, t = camera.T_cam_world[:3, :3], camera.T_cam_world[:3, 3]
    p = gaussians.means @ R.T + t
    front = p[:, 2] > settings.near
    p = jnp.where(front[:, None], p, jnp.array([0.0, 0.0, 1.0]))
    z = p[:, 2]
    M, m = _image_axes(gaussians, R, p, camera, settings)
    sharp = M @ M.transpose(0, 2, 1)
    sigma = sharp + settings.blur * jnp.eye(2)
    inverse = jnp.linalg.inv(sigma)
    mean2d = p[:, :2] / z[:, None] * camera.focal + camera.principal
    opacity = jax.nn.sigmoid(gaussians.opacity_logits)
    if settings.antialias:
        ratio = jnp.linalg.det(sharp) / jnp.linalg.det(sigma)
        opacity = opacity * jnp.sqrt(jnp.maximum(ratio, COMPENSATION_FLOOR))
    color = _color(gaussians, -R.T @ t)

    j, i = jnp.meshgrid(jnp.arange(camera.height) + 0.5, jnp.arange(camera.width) + 0.5, indexing="ij")
    d = jnp.stack([i, j], -1)[:, :, None] - mean2d  # [h, w, n, 2]
    q = 0.5 * jnp.einsum("hwni,nij,hwnj->hwn", d, inverse, d)
    depth = jnp.broadcast_to(z, q.shape)
    if settings.slanted:
        slope = _limited(jnp.einsum("nij,njk,nk->ni", inverse, M, m), sigma, opacity, z, settings)
        depth = depth + jnp.einsum("hwni,ni->hwn", d, slope)  # E[z | x, y] of the blurred gaussian
    order = jnp.argsort(z, stable=True)
    unclamped = jnp.where(front, opacity * jnp.exp(-q), 0.0)[..., order]
    alpha = jnp.where(unclamped >= settings.alpha_min, jnp.minimum(settings.alpha_max, unclamped), 0.0)
    passed = jnp.cumprod(1 - alpha, axis=-1)
    T = jnp.concatenate([jnp.ones_like(passed[..., :1]), passed[..., :-1]], -1)
    return _Layers(unclamped=unclamped, alpha=alpha, transmittance=T, color=color[order], depth=depth[..., order])


def _limited(slope, sigma, opacity, z, settings: RasterSettings):
    """Slopes of depth [n, 2], reduced so that z is at least `near` where d^T Sigma^-1 d <= 2 ln(o / alpha_min)."""
    drawn = opacity > settings.alpha_min
    radius = 2 * jnp.log(jnp.where(drawn, opacity, settings.alpha_min) / settings.alpha_min)
    reach = radius * jnp.einsum("ni,nij,nj->n", slope, sigma, slope)  # squared
    limited = reach > (z - settings.near) ** 2
    scale = jnp.where(limited, (z - settings.near) / jnp.sqrt(jnp.where(limited, reach, 1.0)), 1.0)
    return slope * scale[:, None]


def _image_axes(gaussians: Gaussians, R, p, camera: Camera, settings: RasterSettings):
    """J R Q S [n, 2, 3], and the third row of R Q S [n, 3]."""
    zero = jnp.all(gaussians.quats == 0, axis=1, keepdims=True)
    q = jnp.where(zero, jnp.array([1.0, 0.0, 0.0, 0.0]), gaussians.quats)
    w, x, y, z = (q / jnp.linalg.norm(q, axis=1, keepdims=True)).T
    Q = jnp.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    ).transpose(2, 0, 1)
    size = jnp.array([camera.width, camera.height])
    margin = (settings.frustum_margin - 1) * size / (2 * camera.focal)
    low, high = -camera.principal / camera.focal - margin, (size - camera.principal) / camera.focal + margin
    slope = jnp.clip(p[:, :2] / p[:, 2:], low, high)
    scale = camera.focal / p[:, 2:]
    J = jnp.concatenate([scale[:, :, None] * jnp.eye(2), (-scale * slope)[:, :, None]], -1)
    axes = R @ Q @ jax.vmap(jnp.diag)(jnp.exp(gaussians.log_scales))
    return J @ axes, axes[:, 2]


def _color(gaussians: Gaussians, centre):
    degree = round(gaussians.sh.shape[1] ** 0.5) - 1
    away = gaussians.means - centre
    # at the camera's centre there is no direction; such gaussians are culled, only a finite number is wanted here
    away = jnp.where(jnp.any(away != 0, axis=1, keepdims=True), away, 1.0)
    basis = harmonics((away / jnp.linalg.norm(away, axis=1, keepdims=True)).T, degree)
    parts = (jnp.broadcast_to(Y, away.shape[:1])[:, None] * gaussians.sh[:, k] for k, Y in enumerate(basis))
    color = sum(parts, jnp.full(3, 0.5))
    return jnp.where(color < 0, 0.0, color)
