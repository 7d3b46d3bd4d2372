"""Alpha compositing and its derivative as kernels for NVIDIA GPUs, through Pallas and Triton; compositing.py holds the equations.

A program composites one tile, and its pixels are one vector: it traverses the tile's list one gaussian per iteration, front to
back, until the list ends or every pixel is finished. Where the loops of _loops.py launch a dozen kernels for every chunk of every
block and meet in memory between them, here transmittance and features stay in registers from the first gaussian to the last.

The derivative with respect to a gaussian is a sum over the pixels of each tile that lists it, reduced within the program, and
over those tiles. The latter is not left to atomic additions, which come in any order: programs write a row for every entry of the
lists, and a second kernel adds the rows of a gaussian as they are listed. So derivatives, like images, repeat to the bit.

The kernels are Triton's, which Pallas deprecates from JAX 0.11 on; its successor there knows Hopper and later GPUs only.
"""

import functools
import warnings
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax.experimental import pallas as pl
from jax.experimental.pallas import triton as plgpu

from wm.schema import RasterSettings
from wm.splat.rasterizer._axes import has_slope
from wm.splat.rasterizer._pairs import DEPTH, GEOMETRY, Composite, alpha_at, gradient_columns, slope, weight
from wm.splat.rasterizer._tile_sums import POWERS
from wm.splat.rasterizer.tiles import TilePlan

# A caller can do nothing about it. For the process: JAX warns when it lowers a kernel, long after the call here has returned; so
# this module is imported where kernels are asked for, and nowhere else.
warnings.filterwarnings("ignore", "The Pallas Triton backend is deprecated", DeprecationWarning)

UNROLLED = 8
"""Gaussians per test whether any pixel is open; their rows are fetched while the first of them is composited."""

SUMMED = 8
"""Gaussians whose rows one program adds up."""

LANES = 16
"""Length of the vector that holds a row of the table, a power of two as Triton asks."""


def forward(table, plan: TilePlan, *, columns: int, settings: RasterSettings, interpret: bool = False) -> Composite:
    """Every lane composited; `columns` is the number of tiles in a row of the image."""
    lanes, pixels, features = plan.tile.size, settings.tile**2, table.shape[1] - GEOMETRY
    shapes = [((lanes, pixels), jnp.float32), ((lanes, features, pixels), jnp.float32), ((lanes,), jnp.int32)]
    call = pl.pallas_call(
        functools.partial(_forward, columns=columns, settings=settings),
        grid=(lanes,),
        out_shape=[jax.ShapeDtypeStruct(*shape) for shape in shapes],
        compiler_params=_ONE_WARP,
        interpret=interpret,
        name="composite",
    )
    t, F, length = call(table, *_lists(plan))
    return Composite(transmittance=t, features=F, length=length)


def backward(
    table,
    plan: TilePlan,
    composite: Composite,
    cotangent: Composite,
    *,
    columns: int,
    settings: RasterSettings,
    interpret: bool = False,
):
    """The cotangent of the table, from what `forward` returned and the cotangent of that."""
    ids, tile, start, _ = _lists(plan)
    final, g_final = ((x.transmittance, x.features) for x in (composite, cotangent))
    call = pl.pallas_call(
        functools.partial(_backward, columns=columns, settings=settings),
        grid=(len(tile),),
        out_shape=jax.ShapeDtypeStruct((len(ids), table.shape[1]), jnp.float32),
        input_output_aliases={0: 0},
        compiler_params=_ONE_WARP,
        interpret=interpret,
        name="composite_derivative",
    )
    nothing = jnp.zeros((len(ids), table.shape[1]), jnp.float32)  # of an entry that nothing visits
    rows = call(nothing, table, ids, tile, start, composite.length, *final, *g_final)
    return _sums_by_gaussian(rows, ids, len(table), interpret)


def _sums_by_gaussian(rows, ids, n: int, interpret: bool):
    """The sum of the rows of every gaussian's entries, in the order of the entries; 0 for the last, the padding's."""
    entries = jnp.argsort(ids, stable=True)
    # the last is left out: its entries are the plan's padding, millions that would be counted one after the other
    count = jnp.pad(jnp.zeros(n - 1, jnp.int32).at[ids].add(1, mode="drop"), (0, 1))
    call = pl.pallas_call(
        _sum_rows,
        grid=(-(-n // SUMMED),),
        out_shape=jax.ShapeDtypeStruct((n, rows.shape[1]), jnp.float32),
        compiler_params=_ONE_WARP,
        interpret=interpret,
        name="sum_rows",
    )
    return call(rows, entries, jnp.cumsum(count) - count, count)


_ONE_WARP = plgpu.CompilerParams(num_warps=1)  # a program's sums over its pixels then need no shared memory


def _lists(plan: TilePlan):
    return plan.ids, *(x.reshape(-1) for x in (plan.tile, plan.start, plan.count))


def _forward(table, ids, tile, start, count, t_out, F_out, length_out, *, columns: int, settings: RasterSettings):
    lane = pl.program_id(0)
    tile_list = _TileList(table, ids, tile[lane], start[lane], count[lane], columns, settings)

    def step(state):
        i, _, t, F = state
        for k in range(UNROLLED):
            gaussian = tile_list.gaussian(i + k)
            w = weight(t, gaussian.alpha, settings)
            F = [total + w * feature for total, feature in zip(F, gaussian.features)]
            t = t - w
        return i + UNROLLED, jnp.max(t), t, F

    def goes_on(state):
        return (state[0] < tile_list.count) & (state[1] >= settings.transmittance_min)

    one, zero = jnp.ones_like(tile_list.u), jnp.zeros_like(tile_list.u)
    start_state = (jnp.int32(0), jnp.float32(1), one, [zero] * F_out.shape[1])
    visited, _, t, F = jax.lax.while_loop(goes_on, step, start_state)
    t_out[lane, :] = t
    for j, feature in enumerate(F):
        F_out[lane, j, :] = feature
    length_out[lane] = jnp.minimum(visited, tile_list.count)


def _backward(_, table, ids, tile, start, length, t_end, F_end, g_t, g_F, rows, *, columns: int, settings: RasterSettings):
    lane, features = pl.program_id(0), F_end.shape[1]
    tile_list = _TileList(table, ids, tile[lane], start[lane], length[lane], columns, settings)
    g_features = [g_F[lane, j, :] for j in range(features)]
    u, v = tile_list.u, tile_list.v
    powers = {0: (jnp.ones_like(u), jnp.ones_like(v)), 1: (u, v), 2: (u * u, v * v)}
    column, nothing = jnp.arange(LANES), jnp.zeros(LANES, jnp.float32)

    def step(i, state):
        t, rest = state
        gaussian = tile_list.gaussian(i)
        w = weight(t, gaussian.alpha, settings)
        share = w * sum(f * g for f, g in zip(gaussian.features, g_features))
        rest = rest - share
        d = slope(rest, gaussian.alpha, w, share, settings)
        moments = [jnp.sum(d * powers[m][0] * powers[n][1]) for m, n in POWERS]
        sums = [jnp.sum(w * g) for g in g_features]
        derivatives = gradient_columns(gaussian.place, gaussian.root, gaussian.tilt, moments, sums, settings)
        row = functools.reduce(lambda row, jd: jnp.where(column == jd[0], jd[1], row), enumerate(derivatives), nothing)
        plgpu.store(rows.at[tile_list.start + i, column], row, mask=column < len(derivatives))
        return t - w, rest

    rest = sum((F_end[lane, j, :] * g for j, g in enumerate(g_features)), t_end[lane, :] * g_t[lane, :])
    jax.lax.fori_loop(0, tile_list.count, step, (jnp.ones_like(u), rest))


def _sum_rows(rows, entries, start, count, sums):
    gaussian, column = pl.program_id(0) * SUMMED + jnp.arange(SUMMED), jnp.arange(LANES)
    there, wide = gaussian < sums.shape[0], column < rows.shape[1]
    first, number = (plgpu.load(x.at[gaussian], mask=there, other=0) for x in (start, count))

    def step(k, total):
        has = k < number
        entry = plgpu.load(entries.at[first + k], mask=has, other=0)
        return total + plgpu.load(rows.at[entry[:, None], column[None]], mask=has[:, None] & wide[None], other=0.0)

    total = jax.lax.fori_loop(0, jnp.max(number), step, jnp.zeros((SUMMED, LANES), jnp.float32))
    plgpu.store(sums.at[gaussian[:, None], column[None]], total, mask=there[:, None] & wide[None])


class _TileList:
    """The list of one tile, and the places of its pixels from its centre."""

    def __init__(self, table, ids, tile, start, count, columns: int, settings: RasterSettings) -> None:
        side = settings.tile
        pixel = jnp.arange(side * side)  # `_tile_sums.offsets` in the kernel's own terms: it cannot close over an array
        self.u, self.v = ((x + (0.5 - side / 2)).astype(jnp.float32) for x in (pixel % side, pixel // side))
        self.x, self.y = (((x.astype(jnp.float32) + 0.5) * side) for x in (tile % columns, tile // columns))
        self.table, self.ids, self.start, self.count, self.settings = table, ids, start, count, settings

    def gaussian(self, i) -> "_Gaussian":
        """The i-th of the list; one past its end has alpha 0 everywhere."""
        id_ = self.ids[jnp.minimum(self.start + i, self.ids.shape[0] - 1)]
        x, y, l0, l1, l2, log2_opacity, *features = (self.table[id_, j] for j in range(self.table.shape[1]))
        x, y = x - self.x, y - self.y
        log2_opacity = jnp.where(i < self.count, log2_opacity, -jnp.inf)
        tilt = features[DEPTH + 1 :]
        if has_slope(self.settings):
            features[DEPTH] -= tilt[0] * x + tilt[1] * y
        alpha = alpha_at(self.u - x, self.v - y, l0, l1, l2, log2_opacity, self.settings)
        return _Gaussian((x, y), (l0, l1, l2), features, tilt, alpha)


class _Gaussian(NamedTuple):
    place: Any  # x, y of its mean from the tile's centre
    root: Any  # l0, l1, l2
    features: Any  # what is composited: depth as it is at the tile's centre
    tilt: Any  # of depth to the right and down, if it is slanted
    alpha: Any  # [pixels]
