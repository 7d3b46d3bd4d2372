"""Alpha compositing over tiles, front to back, and its derivative.

Per pixel, over its tile's list: q = (l0 dx + l1 dy)^2 + (l2 dy)^2 (l of project.py over sqrt 2),
alpha = exp(min(log o - q, log alpha_max)), dropped below alpha_min; w_i = T_i alpha_i, T_{i+1} = T_i - w_i; features
F = sum w_i f_i: colour, and depth z_i + s_i . d, which is linear in the pixel's place (u, v) in its tile and so three features,
z_i + s_i . (centre of the tile - mean_i) and s_i, put together once a pixel. A pixel is finished once T < transmittance_min: the
gaussian that took it there still counts, later ones do not. Which tile, block or chunk a pixel falls in changes nothing.

Backward, with g = dL/dF and g_T = dL/dT_final: the part of the loss still to come
S_i = g . F + g_T T_final - sum_{j<=i} w_j g . f_j falls along the list, so it is walked front to back again and

    dL/d log alpha_i = w_i g . f_i - S_i alpha_i / (1 - alpha_i)   (0 where alpha is clamped or cut),
    dL/dq_i = -dL/d log alpha_i,   dL/d log o_i = dL/d log alpha_i,   dL/d f_i = sum over pixels of w_i g.

Sums over a tile's pixels are taken with 1, u, v, u^2, uv, v^2, (u, v) from the tile's centre, along its rows and then down; the
derivatives by mean and root follow from those six moments. Tiers: a block of tiles advances together, a chunk of gaussians at a
time, so the overhead of a loop iteration is paid once for block x tile^2 x chunk pairs.

Layout: [pixels, gaussians of the chunk or features, lanes of the block]. The lanes fill the vectors, and what a pixel or a row of
pixels needs stays in the first cache while the loops turn over gaussians and features. Alphas, and in the backward pass every
stage, are compiled apart from their uses (_apart.py), which would otherwise each repeat them.
"""

import functools
import math
from typing import Any

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from wm.numerics import safe_div
from wm.schema import RasterSettings
from wm.splat._apart import apart
from wm.splat._axes import has_slope
from wm.splat._exp2 import exp2_between
from wm.splat._tile_sums import moments, moments_of_rows, offsets, products_of_rows, total
from wm.splat.project import DEFAULTS, Projected
from wm.splat.tiles import TilePlan
from wm.types import Background, Render, record

GEOMETRY = 6
"""Columns of the table before the features: mean x, y, root l0, l1, l2 over sqrt 2, log opacity."""

DEPTH = 3
"""Of the features, the first that is depth: that of the centre in the table, that at the tile's centre where it is composited."""

CLAMPED = 1e-6
"""Alphas closer than this (relative) to alpha_max are the clamped ones: the exponential of the clamp rounds."""


@record
class Composite:
    """Result of the compositing, lane by lane as the plan orders the tiles (blocks and lanes flattened)."""

    transmittance: Any  # [lanes, pixels]
    features: Any  # [lanes, features, pixels]
    length: Any  # [lanes] int32 entries visited before the list ended or every pixel was finished; no gradient


def rasterize(
    projected: Projected,
    plan: TilePlan,
    width: int,
    height: int,
    settings: RasterSettings = DEFAULTS,
    background: Background | None = None,
) -> Render:
    """The image of projected gaussians; pure, jittable, differentiable in `projected` and `background`.

    Args:
        projected: what `project` returned.
        plan: what `plan_tiles` returned for the same width, height and settings.
        width, height: of the image, pixels.
        settings: alpha_min, alpha_max, transmittance_min, tile, chunk and depth are read here.
        background: colour behind everything; None is black.

    Returns:
        The image, float32 even where float64 is enabled. With `settings.depth` False its depth is 0 everywhere and costs nothing.
    """
    plan = jax.tree.map(jnp.asarray, plan)
    composite = _composite(_table(projected, settings), plan, -(-width // settings.tile), settings)
    image = functools.partial(_image, plan=plan, width=width, height=height, tile=settings.tile)
    t = image(composite.transmittance)
    rgb = jnp.stack([image(composite.features[:, j]) for j in range(3)], -1)
    if background is not None:
        rgb = rgb + t[..., None] * jnp.asarray(background, jnp.float32)
    depth = safe_div(image(_depth(composite.features, settings)), 1 - t) if settings.depth else jnp.zeros_like(t)
    return Render(rgb=rgb, depth=depth, alpha=1 - t)


def _table(projected: Projected, settings: RasterSettings) -> Float[Array, "rows columns"]:
    """One row a gaussian, and a last row of zero opacity at which the padding of a plan points."""
    culled = projected.opacity <= 0
    log_opacity = jnp.where(culled, -jnp.inf, jnp.log2(jnp.where(culled, 1.0, projected.opacity)))
    features = [projected.color]
    if settings.depth:
        features.append(projected.depth[None])
    if has_slope(settings):
        features.append(projected.slope)
    columns = jnp.concatenate(
        [projected.mean2d, projected.root * math.sqrt(0.5 * math.log2(math.e)), log_opacity[None], *features]
    )
    return jnp.pad(columns.T, ((0, 1), (0, 0)), constant_values=0.0).at[-1, GEOMETRY - 1].set(-jnp.inf)


def _depth(features: Float[Array, "lanes features pixels"], settings: RasterSettings) -> Float[Array, "lanes pixels"]:
    """The weighted sum of depths at every pixel."""
    if not has_slope(settings):
        return features[:, DEPTH]
    u, v = offsets(settings.tile)
    return features[:, DEPTH] + u * features[:, DEPTH + 1] + v * features[:, DEPTH + 2]


def _image(lanes: Float[Array, "lanes pixels"], plan: TilePlan, width: int, height: int, tile: int) -> Float[Array, "h w"]:
    columns, rows = -(-width // tile), -(-height // tile)
    tiles = lanes[plan.slot].reshape(rows, columns, tile, tile)
    return jnp.swapaxes(tiles, 1, 2).reshape(rows * tile, columns * tile)[:height, :width]


def _forward(table, plan: TilePlan, columns: int, settings: RasterSettings) -> Composite:
    def block(lanes):
        tile, start, count = lanes
        origin = _origins(tile, columns, settings)

        def step(state):
            i, length, t, F = state
            _, g, alpha = _alphas(table, plan.ids, origin, start, count, i, settings)
            for k, feature in enumerate(_features(g, origin, settings)):
                w = _weight(t, alpha[:, k], settings)
                F = F + w[:, None] * feature
                t = t - w
            i = i + settings.chunk
            # a lane goes on while it has entries and an open pixel; where it stops is what the backward pass will visit
            goes_on = (length == i - settings.chunk) & (i < count) & (jnp.max(t, 0) >= settings.transmittance_min)
            return i, jnp.where(goes_on, i, length), t, F

        t = jnp.ones((settings.tile**2, len(tile)), jnp.float32)
        F = jnp.zeros((settings.tile**2, table.shape[1] - GEOMETRY, len(tile)), jnp.float32)
        state = (jnp.int32(0), jnp.zeros_like(count), t, F)
        _, length, t, F = jax.lax.while_loop(lambda state: jnp.max(jnp.where(state[1] == state[0], count, 0)) > 0, step, state)
        length = jnp.minimum(length + settings.chunk, count)
        return Composite(transmittance=t.T, features=jnp.transpose(F, (2, 1, 0)), length=length)

    blocks = jax.lax.map(block, (plan.tile, plan.start, plan.count))
    return jax.tree.map(lambda x: x.reshape(-1, *x.shape[2:]), blocks)


_composite = jax.custom_vjp(_forward, nondiff_argnums=(2, 3))


def _composite_fwd(table, plan: TilePlan, columns: int, settings: RasterSettings):
    composite = _forward(table, plan, columns, settings)
    return composite, (table, plan, composite)


def _composite_bwd(columns: int, settings: RasterSettings, residuals, cotangent: Composite):
    table, plan, composite = residuals
    weights, slopes = (functools.partial(stage, settings=settings) for stage in (_weights, _slopes))

    def block(gradient, lanes):
        # lanes that end together walk together: the forward pass knows where each ends
        tile, start, count, t_final, F_final, g_t, g_F = (x[lanes].T for x in per_lane)
        origin = _origins(tile, columns, settings)
        stage = functools.partial(apart, start[0] < 0)

        def step(state):
            i, t, rest, gradient = state
            entry, g, alpha = _alphas(table, plan.ids, origin, start, count, i, settings)
            w, t = stage(weights, t, alpha)
            shares = stage(_shares, w, _features(g, origin, settings), g_F)
            d_log_alpha, rest = stage(slopes, rest, alpha, w, shares)
            by_place = stage(moments, stage(moments_of_rows, d_log_alpha))
            by_features = stage(total, stage(products_of_rows, w, g_F))
            rows = _gradient_rows(g, origin, by_place, by_features, settings)
            return i + settings.chunk, t, rest, gradient.at[entry].add(rows, mode="promise_in_bounds")

        rest = (F_final * g_F).sum(1) + t_final * g_t
        state = (jnp.int32(0), jnp.ones_like(t_final), rest, gradient)
        return jax.lax.while_loop(lambda state: state[0] < jnp.max(count), step, state)[3], None

    per_lane = (
        *(x.reshape(-1) for x in (plan.tile, plan.start)),
        composite.length,
        composite.transmittance,
        composite.features,
        cotangent.transmittance,
        cotangent.features,
    )
    by_length = jnp.argsort(-composite.length).reshape(plan.tile.shape)
    return jax.lax.scan(block, jnp.zeros_like(table), by_length)[0], None


_composite.defvjp(_composite_fwd, _composite_bwd)


def _weight(t, alpha, settings: RasterSettings):
    """What a gaussian takes of the transmittance t before it: nothing where the pixel is finished."""
    return jnp.where(t >= settings.transmittance_min, alpha * t, 0.0)


def _weights(t, alpha, settings: RasterSettings):
    """Weights of the chunk [pixels, chunk, lanes], and the transmittance after it [pixels, lanes]."""
    ws = []
    for k in range(settings.chunk):
        ws.append(_weight(t, alpha[:, k], settings))
        t = t - ws[k]
    return jnp.stack(ws, 1), t


def _shares(w, features, g_F):
    """w_i g . f_i, [pixels, chunk, lanes]."""
    return w * sum(features[:, j] * g_F[:, j, None] for j in range(g_F.shape[1]))


def _slopes(rest, alpha, w, shares, settings: RasterSettings):
    """dL/d log alpha of the chunk [pixels, chunk, lanes], and the part of the loss still to come after it [pixels, lanes]."""
    ds = []
    for k in range(settings.chunk):
        a, share = alpha[:, k], shares[:, k]
        rest = rest - share
        free = (w[:, k] > 0) & (a < settings.alpha_max * (1 - CLAMPED))
        ds.append(jnp.where(free, share - rest * (a / (1 - a)), 0.0))
    return jnp.stack(ds, 1), rest


def _origins(tile, columns: int, settings: RasterSettings):
    """Centres of tiles, [2, lanes] pixels."""
    return (jnp.stack([tile % columns, tile // columns]) + jnp.float32(0.5)) * settings.tile


def _alphas(table, ids, origin, start, count, i, settings: RasterSettings):
    """The chunk at i: gaussians [chunk, lanes], their rows [columns, chunk, lanes], their alphas [pixels, chunk, lanes]."""
    step = i + jnp.arange(settings.chunk)[:, None]
    entry = ids.at[start + step].get(mode="clip")
    g = table.at[entry].get(mode="promise_in_bounds")
    g = jnp.stack([g[..., j] for j in range(table.shape[1])])  # moved, the axis would stay last in memory and lanes apart
    u, v = (x[:, None, None] for x in offsets(settings.tile))
    lowest, highest = math.log2(settings.alpha_min), math.log2(settings.alpha_max)

    def alphas(x, y, l0, l1, l2, log_opacity):
        dx, dy = u - x, v - y
        log_alpha = log_opacity - (l0 * dx + l1 * dy) ** 2 - (l2 * dy) ** 2
        kept = log_alpha >= lowest
        return jnp.where(kept, exp2_between(jnp.where(kept, jnp.minimum(log_alpha, highest), 0.0), lowest), 0.0)

    log_opacity = jnp.where(step < count, g[5], -jnp.inf)
    return entry, g, apart(start[0] < 0, alphas, g[0] - origin[0], g[1] - origin[1], g[2], g[3], g[4], log_opacity)


def _features(g, origin, settings: RasterSettings):
    """What is composited, [chunk, features, lanes]: the table's columns, depth as it is at the tile's centre."""
    features = g[GEOMETRY:]
    if has_slope(settings):
        color, depth, slope = jnp.split(features, (DEPTH, DEPTH + 1))
        features = jnp.concatenate([color, depth - (slope * (g[:2] - origin[:, None])).sum(0, keepdims=True), slope])
    return jnp.swapaxes(features, 0, 1)


def _gradient_rows(g, origin, by_place, by_features, settings: RasterSettings):
    """Derivatives by every column of the table, [chunk, lanes, columns], from moments of dL/d log alpha and sums of w g."""
    m0, mu, mv, muu, muv, mvv = (math.log(2) * by_place[:, j] for j in range(6))
    features = [by_features[:, j] for j in range(by_features.shape[1])]
    x, y = g[0] - origin[0], g[1] - origin[1]
    sx, sy = mu - x * m0, mv - y * m0
    sxx, syy = muu - 2 * x * mu + x * x * m0, mvv - 2 * y * mv + y * y * m0
    sxy = muv - x * mv - y * mu + x * y * m0
    l0, l1, l2 = g[2], g[3], g[4]
    ex, exx, exy = l0 * sx + l1 * sy, l0 * sxx + l1 * sxy, l0 * sxy + l1 * syy  # e = l0 dx + l1 dy summed with 1, dx, dy
    by_mean = [2 * l0 * ex, 2 * (l1 * ex + l2 * l2 * sy)]
    if has_slope(settings):
        *color, by_depth, by_right, by_down = features
        right, down = g[GEOMETRY + DEPTH + 1 :]
        by_mean = [by_mean[0] - right * by_depth, by_mean[1] - down * by_depth]
        features = [*color, by_depth, by_right - x * by_depth, by_down - y * by_depth]
    return jnp.stack([*by_mean, -2 * exx, -2 * exy, -2 * l2 * syy, m0, *features], -1)
