"""Alpha compositing and its derivative as loops that XLA compiles for any device; compositing.py holds the equations.

Tiers: a block of tiles advances together, one chunk of gaussians per iteration, so the overhead of an iteration is paid once per
block x tile^2 x chunk pairs.

Layout: [pixels, gaussians of the chunk or features, lanes of the block]. The lanes fill the vectors, and what a pixel or a row of
pixels needs stays in the L1 cache while the loops run over gaussians and features. A fusion barrier (xla/fusion_barrier.py)
follows the alphas, and in the backward pass every stage: otherwise XLA repeats them in each of their uses.
"""

import functools

import jax
import jax.numpy as jnp

from wm.schema import RasterSettings
from wm.splat.rasterizer._axes import has_slope
from wm.splat.rasterizer._pairs import DEPTH, GEOMETRY, Composite, alpha_at, gradient_columns, slope, weight
from wm.splat.rasterizer._tile_sums import moments, moments_of_rows, offsets, products_of_rows, total
from wm.splat.rasterizer.tiles import TilePlan
from wm.splat.xla.fusion_barrier import fusion_barrier


def forward(table, plan: TilePlan, *, columns: int, settings: RasterSettings) -> Composite:
    """Every lane composited; `columns` is the number of tiles in a row of the image."""

    def block(lanes):
        tile, start, count = lanes
        origin = _origins(tile, columns, settings)

        def step(state):
            i, length, t, F = state
            _, g, alpha = _alphas(table, plan.ids, origin, start, count, i, settings)
            for k, feature in enumerate(_features(g, origin, settings)):
                w = weight(t, alpha[:, k], settings)
                F = F + w[:, None] * feature[None]
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


def backward(table, plan: TilePlan, composite: Composite, cotangent: Composite, *, columns: int, settings: RasterSettings):
    """The cotangent of the table, from what `forward` returned and the cotangent of that."""
    weights, slopes = (functools.partial(stage, settings=settings) for stage in (_weights, _slopes))

    def block(gradient, lanes):
        # lanes that end together are in one block: the forward pass knows where each ends
        tile, start, count, t_final, F_final, g_t, g_F = (x[lanes].T for x in per_lane)
        origin = _origins(tile, columns, settings)
        stage = functools.partial(fusion_barrier, start[0] < 0)

        def step(state):
            i, t, rest, gradient = state
            entry, g, alpha = _alphas(table, plan.ids, origin, start, count, i, settings)
            w, t = stage(weights, t, alpha)
            shares = stage(_shares, w, _features(g, origin, settings), g_F)
            d_ln_alpha, rest = stage(slopes, rest, alpha, w, shares)
            place_moments = stage(moments, stage(moments_of_rows, d_ln_alpha))
            feature_sums = stage(total, stage(products_of_rows, w, g_F))
            rows = _gradient_rows(g, origin, place_moments, feature_sums, settings)
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
    return jax.lax.scan(block, jnp.zeros_like(table), by_length)[0]


def _weights(t, alpha, settings: RasterSettings):
    """Weights of the chunk [pixels, chunk, lanes], and the transmittance after it [pixels, lanes]."""
    ws = []
    for k in range(settings.chunk):
        ws.append(weight(t, alpha[:, k], settings))
        t = t - ws[k]
    return jnp.stack(ws, 1), t


def _shares(w, features, g_F):
    """w_i g . f_i, [pixels, chunk, lanes]."""
    return w * sum(features[None, :, j] * g_F[:, j, None] for j in range(g_F.shape[1]))


def _slopes(rest, alpha, w, shares, settings: RasterSettings):
    """dL/d ln alpha of the chunk [pixels, chunk, lanes], and the part of the loss still to come after it [pixels, lanes]."""
    ds = []
    for k in range(settings.chunk):
        rest = rest - shares[:, k]
        ds.append(slope(rest, alpha[:, k], w[:, k], shares[:, k], settings))
    return jnp.stack(ds, 1), rest


def _origins(tile, columns: int, settings: RasterSettings):
    """Centres of tiles, [2, lanes] pixels."""
    return (jnp.stack([tile % columns, tile // columns]).astype(jnp.float32) + 0.5) * settings.tile


def _alphas(table, ids, origin, start, count, i, settings: RasterSettings):
    """The chunk at i: gaussians [chunk, lanes], their rows [columns, chunk, lanes], their alphas [pixels, chunk, lanes]."""
    step = i + jnp.arange(settings.chunk)[:, None]
    entry = ids.at[start[None] + step].get(mode="clip")
    g = table.at[entry].get(mode="promise_in_bounds")
    g = jnp.stack([g[..., j] for j in range(table.shape[1])])  # moved, the axis would stay last in memory and lanes apart
    u, v = (x[:, None, None] for x in offsets(settings.tile))

    def alphas(x, y, l0, l1, l2, log2_opacity):
        l0, l1, l2, log2_opacity = (row[None] for row in (l0, l1, l2, log2_opacity))
        return alpha_at(u - x[None], v - y[None], l0, l1, l2, log2_opacity, settings)

    log2_opacity = jnp.where(step < count[None], g[5], -jnp.inf)
    return entry, g, fusion_barrier(start[0] < 0, alphas, *_place(g, origin), g[2], g[3], g[4], log2_opacity)


def _place(g, origin):
    """x, y of the means from the centres of their tiles, [chunk, lanes] each."""
    return g[0] - origin[0][None], g[1] - origin[1][None]


def _features(g, origin, settings: RasterSettings):
    """The composited features, [chunk, features, lanes]: columns of the table, with the depth at the tile's centre."""
    features = g[GEOMETRY:]
    if has_slope(settings):
        color, depth, tilt = jnp.split(features, (DEPTH, DEPTH + 1))
        features = jnp.concatenate([color, depth - (tilt * (g[:2] - origin[:, None])).sum(0, keepdims=True), tilt])
    return jnp.swapaxes(features, 0, 1)


def _gradient_rows(g, origin, place_moments, feature_sums, settings: RasterSettings):
    """Derivatives with respect to the columns of the table, [chunk, lanes, columns], from moments of dL/d ln alpha and sums of
    w g."""
    place = _place(g, origin)
    place_moments, feature_sums = ([x[:, j] for j in range(x.shape[1])] for x in (place_moments, feature_sums))
    return jnp.stack(gradient_columns(place, g[2:5], g[GEOMETRY + DEPTH + 1 :], place_moments, feature_sums, settings), -1)
