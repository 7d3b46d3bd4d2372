"""Alpha compositing over tiles, front to back, and its derivative.

Per pixel, over its tile's list: q = (l0 dx + l1 dy)^2 + (l2 dy)^2 (l of project.py over sqrt 2), alpha = min(alpha_max, o exp(-q)), dropped below alpha_min;
w_i = T_i alpha_i, T_{i+1} = T_i - w_i; features F = sum w_i f_i (colour, depth). A pixel is finished once T < transmittance_min:
the gaussian that took it there still counts, later ones do not. Which tile, block or chunk a pixel falls in changes nothing.

Backward, with g = dL/dF and g_T = dL/dT_final: the part of the loss still to come S_i = g . F + g_T T_final - sum_{j<=i} w_j g . f_j
falls to 0 along the list, so it is walked front to back again and

    dL/d alpha_i = T_i g . f_i - S_i / (1 - alpha_i),   dL/d f_i = sum over pixels of w_i g,
    dL/dq_i = -alpha_i dL/d alpha_i  (0 where alpha is clamped or cut).

Sums over a tile's pixels are one product with the basis {1, u, v, u^2, uv, v^2}, (u, v) from the tile's centre; the derivatives
by mean and conic follow from those six moments. Tiers: a block of tiles advances together, a chunk of gaussians at a time, so
the overhead of one loop iteration is paid once for block x tile^2 x chunk pairs.
"""

import functools

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from wm.numerics import safe_div
from wm.schema import RasterSettings
from wm.splat.project import Projected
from wm.splat.tiles import TilePlan
from wm.types import Render

GEOMETRY = 6
"""Columns of the table before the features: mean x, y, root l0, l1, l2 over sqrt 2, opacity."""


def rasterize(
    projected: Projected,
    plan: TilePlan,
    width: int,
    height: int,
    settings: RasterSettings = RasterSettings(),
    background: Float[Array, "3"] | Float[Array, "h w 3"] | None = None,
) -> Render:
    """The image of projected gaussians; pure, jittable, differentiable in `projected` and `background`.

    Args:
        projected: what `project` returned.
        plan: what `plan_tiles` returned for the same width, height and settings.
        width, height: of the image, pixels.
        settings: alpha_min, alpha_max, transmittance_min, tile, chunk and depth are read here.
        background: colour behind everything; None is black.

    Returns:
        The image. With `settings.depth` False its depth is 0 everywhere and costs nothing.
    """
    features = [projected.color, projected.depth[None]] if settings.depth else [projected.color]
    rows = jnp.concatenate([projected.mean2d, projected.root * np.sqrt(0.5), projected.opacity[None], *features])
    table = jnp.pad(rows.T, ((0, 1), (0, 0)))  # the padding of the plan points at the last row, which has opacity 0
    T, F = _composite(table, plan, -(-width // settings.tile), settings)
    T = _image(T, plan, width, height, settings.tile)
    F = _image(F, plan, width, height, settings.tile)
    behind = jnp.zeros(3) if background is None else jnp.asarray(background, jnp.float32)
    alpha = 1 - T
    depth = safe_div(F[..., 3], alpha) if settings.depth else jnp.zeros_like(alpha)
    return Render(rgb=F[..., :3] + T[..., None] * behind, depth=depth, alpha=alpha)


def _image(x, plan: TilePlan, width: int, height: int, tile: int):
    """Lanes [blocks, (channels,) lanes, pixels] to an image [h, w(, channels)]."""
    channels = x.shape[1:-2]
    x = jnp.moveaxis(x.reshape(x.shape[0], -1, *x.shape[-2:]), 1, -1).reshape(-1, tile, tile, *channels)[plan.slot]
    columns, rows = -(-width // tile), -(-height // tile)
    x = jnp.swapaxes(x.reshape(rows, columns, tile, tile, *channels), 1, 2)
    return x.reshape(rows * tile, columns * tile, *channels)[:height, :width]


@functools.partial(jax.custom_vjp, nondiff_argnums=(2, 3))
def _composite(table, plan: TilePlan, columns: int, settings: RasterSettings):
    """Final transmittance [blocks, lanes, pixels] and features [blocks, features, lanes, pixels]."""

    def block(lanes):
        tile, start, count = lanes
        origin = _origins(tile, columns, settings)

        def step(state):
            i, T, F = state
            _, g, alpha, _ = _alphas(table, plan.ids, origin, start, count, i, settings)
            for k in range(settings.chunk):
                w = jnp.where(T >= settings.transmittance_min, alpha[:, k] * T, 0.0)
                F = [f + g[:, k, GEOMETRY + j, None] * w for j, f in enumerate(F)]
                T = T - w
            return i + settings.chunk, T, F

        T = jnp.ones((tile.shape[0], settings.tile**2))
        F = [jnp.zeros_like(T)] * (table.shape[1] - GEOMETRY)
        _, T, F = jax.lax.while_loop(functools.partial(_unfinished, count, settings), step, (jnp.int32(0), T, F))
        return T, jnp.stack(F)

    return jax.lax.map(block, (plan.tile, plan.start, plan.count))


def _composite_fwd(table, plan: TilePlan, columns: int, settings: RasterSettings):
    T, F = _composite(table, plan, columns, settings)
    return (T, F), (table, plan, T, F)


def _composite_bwd(columns: int, settings: RasterSettings, residuals, cotangent):
    table, plan, T_final, F_final = residuals
    g_T, g_F = cotangent
    basis = _basis(settings.tile)

    def block(gradient, lanes):
        tile, start, count, T_final, F_final, g_T, g_F = lanes
        origin = _origins(tile, columns, settings)

        def step(state):
            i, T, rest, gradient = state
            entry, g, alpha, falloff = _alphas(table, plan.ids, origin, start, count, i, settings)
            ws, ds = [], []
            for k in range(settings.chunk):
                a = alpha[:, k]
                value = sum(g[:, k, GEOMETRY + j, None] * g_F[j] for j in range(g_F.shape[0]))
                open_ = T >= settings.transmittance_min
                w = jnp.where(open_, a * T, 0.0)
                rest = rest - w * value
                ds.append(jnp.where(open_ & (a > 0) & (a < settings.alpha_max), T * value - rest / (1 - a), 0.0))
                ws.append(w)
                T = T - w
            by_falloff = jnp.stack(ds, 1) * falloff
            row = _gradient_rows(g, origin, by_falloff, jnp.stack(ws, 1), g_F, basis)
            return i + settings.chunk, T, rest, gradient.at[entry].add(row, mode="promise_in_bounds")

        rest = (F_final * g_F).sum(0) + T_final * g_T
        state = (jnp.int32(0), jnp.ones_like(T_final), rest, gradient)
        return jax.lax.while_loop(functools.partial(_unfinished, count, settings), step, state)[3], None

    lanes = (plan.tile, plan.start, plan.count, T_final, F_final, g_T, g_F)
    return jax.lax.scan(block, jnp.zeros_like(table), lanes)[0], None


_composite.defvjp(_composite_fwd, _composite_bwd)


def _unfinished(count, settings: RasterSettings, state):
    i, T = state[:2]
    return jnp.max(jnp.where((i < count)[:, None], T, 0.0)) >= settings.transmittance_min


def _origins(tile, columns: int, settings: RasterSettings):
    """Centres of tiles in pixels, [lanes, 2]."""
    return (jnp.stack([tile % columns, tile // columns], -1) + 0.5) * settings.tile


def _offsets(tile: int):
    """Pixel centres from the centre of their tile, row-major: u, v [pixels]."""
    along = np.arange(tile, dtype=np.float32) + 0.5 - tile / 2
    v, u = np.meshgrid(along, along, indexing="ij")
    return u.ravel(), v.ravel()


def _basis(tile: int):
    u, v = _offsets(tile)
    return jnp.asarray(np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], -1))


def _alphas(table, ids, origin, start, count, i, settings: RasterSettings):
    """The chunk at i: gaussians [lanes, chunk], their rows [.., columns], their alphas and falloffs exp(-q) [.., pixels]."""
    step = i + jnp.arange(settings.chunk)
    listed = step < count[:, None]
    entry = ids.at[start[:, None] + step].get(mode="clip")
    g = table.at[entry].get(mode="promise_in_bounds")
    u, v = _offsets(settings.tile)
    dx = u - (g[..., 0] - origin[:, None, 0])[..., None]
    dy = v - (g[..., 1] - origin[:, None, 1])[..., None]
    falloff = jnp.exp(-((g[..., 2, None] * dx + g[..., 3, None] * dy) ** 2) - (g[..., 4, None] * dy) ** 2)
    alpha = jnp.minimum(jnp.where(listed, g[..., 5], 0.0)[..., None] * falloff, settings.alpha_max)
    return entry, g, jnp.where(alpha >= settings.alpha_min, alpha, 0.0), falloff


def _gradient_rows(g, origin, by_falloff, w, g_F, basis):
    """Derivatives by every column of the table, [lanes, chunk, columns], from dL/d(falloff) and the weights."""
    lanes, chunk, pixels = w.shape
    moments = jnp.dot(by_falloff.reshape(-1, pixels), basis, precision="highest").reshape(lanes, chunk, 6)
    features = jnp.einsum("lkp,flp->lkf", w, g_F, precision="highest")
    m0, mu, mv, muu, muv, mvv = jnp.moveaxis(moments, -1, 0)
    x, y = g[..., 0] - origin[:, None, 0], g[..., 1] - origin[:, None, 1]
    sx, sy = mu - x * m0, mv - y * m0
    sxx, syy = muu - 2 * x * mu + x * x * m0, mvv - 2 * y * mv + y * y * m0
    sxy = muv - x * mv - y * mu + x * y * m0
    l0, l1, l2, o = (g[..., j] for j in (2, 3, 4, 5))
    ex, exx, exy = l0 * sx + l1 * sy, l0 * sxx + l1 * sxy, l0 * sxy + l1 * syy  # moments of e = l0 dx + l1 dy times 1, dx, dy
    by_q = [-l0 * ex, -l1 * ex - l2 * l2 * sy, exx, exy, l2 * syy]
    return jnp.concatenate([jnp.stack([*(-2 * o * d for d in by_q), m0], -1), features], -1)
