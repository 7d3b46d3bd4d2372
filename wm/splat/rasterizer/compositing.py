"""Alpha compositing over tiles, front to back, and its derivative.

Logarithms are binary, since powers of two are cheap: q = (l0 dx + l1 dy)^2 + (l2 dy)^2 with the l of projection.py times
sqrt(log2(e) / 2), so that 2^-q is the gaussian. The derivatives below are with respect to natural logarithms;
d log2 x = log2(e) d ln x.

Per pixel, over its tile's list: alpha = 2^min(log2 o - q, log2 alpha_max), dropped below alpha_min; w_i = T_i alpha_i,
T_{i+1} = T_i - w_i; features F = sum w_i f_i: colour, and depth z_i + s_i . d, which is linear in the pixel's place (u, v) in its
tile and so three features, z_i + s_i . (centre of the tile - mean_i) and s_i, combined once per pixel; s_i is limited so that
what is drawn of a gaussian lies beyond `near`. A pixel is finished once
T < transmittance_min: the gaussian that took it there still counts, later ones do not. Which tile, block or chunk a pixel falls
in changes nothing.

Backward, with g = dL/dF and g_T = dL/dT_final: the part of the loss still to come
S_i = g . F + g_T T_final - sum_{j<=i} w_j g . f_j falls along the list, so the backward pass traverses it front to back again and

    dL/d ln alpha_i = w_i g . f_i - S_i alpha_i / (1 - alpha_i)   (0 where alpha is clamped or cut),
    dL/d log2 o_i = ln 2 dL/d ln alpha_i = -dL/dq_i,   dL/d f_i = w_i g,   each summed over pixels.

Sums over a tile's pixels are taken with 1, u, v, u^2, uv, v^2, (u, v) from the tile's centre, along its rows and then down; the
derivatives with respect to mean and root follow from those six moments. The arithmetic is in _pairs.py; the loop over a list is
in _loops.py for any device and in _kernels.py for NVIDIA GPUs.
"""

import functools
import math

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from wm.numerics import safe_div
from wm.schema import RasterSettings
from wm.splat.rasterizer import _loops
from wm.splat.rasterizer._axes import has_slope, limited_slope
from wm.splat.rasterizer._pairs import DEPTH, GEOMETRY, Composite
from wm.splat.rasterizer._tile_sums import offsets
from wm.splat.rasterizer.checks import check_raster
from wm.splat.rasterizer.projection import DEFAULTS, Projected
from wm.splat.rasterizer.tiles import Planned, TilePlan
from wm.splat.xla.blocks import in_blocks
from wm.types import Background, Render


def rasterize(
    projected: Projected,
    plan: TilePlan,
    width: int,
    height: int,
    settings: RasterSettings = DEFAULTS,
    background: Background | None = None,
    frozen: Projected | None = None,
) -> Render:
    """The image of projected gaussians; pure, jittable, differentiable in `projected` and `background`.

    Args:
        projected: what `project` returned.
        plan: what `plan_tiles` returned for as many gaussians and the same width, height and settings.
        width, height: of the image, pixels.
        settings: near, alpha_min, alpha_max, transmittance_min, tile, chunk, depth, slanted and compositor are read here.
        background: colour behind everything; None is black.
        frozen: more gaussians, after those of `projected` in the plan's numbering; not differentiated.

    Returns:
        The image, float32 even where float64 is enabled. With `settings.depth` False its depth is 0 everywhere and costs nothing.

    Raises:
        ValueError: a constant has no meaning, or the plan is of another image or of another number of gaussians.

    Differentiable once, in reverse mode (`jax.grad`, `jax.vjp`): its derivative is written out.
    """
    check_raster(settings)
    plan = jax.tree.map(jnp.asarray, plan)
    projected, frozen = jax.tree.map(lambda x: jnp.asarray(x, jnp.float32), (projected, frozen))
    n = sum(part.opacity.shape[0] for part in (projected, frozen) if part is not None)
    _check_plan(plan, Planned(width, height, settings.tile, n))
    composite = _composite(_table(projected, frozen, settings), plan, -(-width // settings.tile), settings)
    image = functools.partial(_image, plan=plan, width=width, height=height, tile=settings.tile)
    t = image(composite.transmittance)
    rgb = jnp.stack([image(composite.features[:, j]) for j in range(3)], -1)
    if background is not None:
        rgb = rgb + t[..., None] * jnp.broadcast_to(jnp.asarray(background, jnp.float32), rgb.shape)
    depth = safe_div(image(_depth(composite.features, settings)), 1 - t) if settings.depth else jnp.zeros_like(t)
    return Render(rgb=rgb, depth=depth, alpha=1 - t)


def _check_plan(plan: TilePlan, wanted: Planned) -> None:
    """Raises unless a plan is of this image: compositing checks no bounds."""
    wrong = [f"{name} is {a}, not {b}" for name, a, b in zip(Planned._fields, plan.of, wanted) if a != b]
    if wrong:
        raise ValueError(f"the plan is of another image: its {', its '.join(wrong)}; one of this projection would be right")


@functools.partial(jax.custom_vjp, nondiff_argnums=(2,))
def _table(projected: Projected, frozen: Projected | None, settings: RasterSettings) -> Float[Array, "rows columns"]:
    """One row per gaussian, and a last row of zero opacity at which the padding of a plan points. `frozen` has no derivative."""
    parts = [part for part in (projected, frozen) if part is not None]
    starts = np.cumsum([0, *(part.opacity.shape[0] for part in parts)])
    width = GEOMETRY + 3 + settings.depth + 2 * has_slope(settings)
    rows = jnp.broadcast_to(jnp.zeros(width, jnp.float32).at[GEOMETRY - 1].set(-jnp.inf), (int(starts[-1]) + 1, width))
    for part, start in zip(parts, starts):
        rows = in_blocks(
            functools.partial(_rows, settings=settings), _any_visible, [part], [-1], out_axis=0, into=rows, at=int(start)
        )
    return rows


def _rows(projected: Projected, settings: RasterSettings) -> Float[Array, "n columns"]:
    culled = projected.opacity <= 0
    log2_opacity = jnp.where(culled, -jnp.inf, jnp.log2(jnp.where(culled, 1.0, projected.opacity)))
    features = [projected.color]
    if settings.depth:
        features.append(projected.depth[None])
    if has_slope(settings):
        limited = limited_slope(projected.slope, projected.root, projected.opacity, projected.depth, settings)
        features.append(jnp.stack(limited))
    columns = [projected.mean2d, projected.root * math.sqrt(0.5 * math.log2(math.e)), log2_opacity[None], *features]
    return jnp.concatenate(columns).T


def _any_visible(projected: Projected, *_) -> Bool[Array, ""]:
    return (projected.opacity > 0).any()


def _table_fwd(projected: Projected, frozen: Projected | None, settings: RasterSettings):
    return _table(projected, frozen, settings), projected


def _table_bwd(settings: RasterSettings, projected: Projected, cotangent):
    def vjp(projected: Projected, cotangent) -> Projected:
        return jax.vjp(functools.partial(_rows, settings=settings), projected)[1](cotangent)[0]

    return in_blocks(vjp, _any_visible, [projected, cotangent], [-1, 0], out_axis=-1), None


_table.defvjp(_table_fwd, _table_bwd)


def _depth(features: Float[Array, "lanes features pixels"], settings: RasterSettings) -> Float[Array, "lanes pixels"]:
    """The weighted sum of depths at every pixel."""
    if not has_slope(settings):
        return features[:, DEPTH]
    u, v = (x[None] for x in offsets(settings.tile))
    return features[:, DEPTH] + u * features[:, DEPTH + 1] + v * features[:, DEPTH + 2]


def _image(lanes: Float[Array, "lanes pixels"], plan: TilePlan, width: int, height: int, tile: int) -> Float[Array, "h w"]:
    columns, rows = -(-width // tile), -(-height // tile)
    tiles = lanes[plan.slot].reshape(rows, columns, tile, tile)
    return jnp.swapaxes(tiles, 1, 2).reshape(rows * tile, columns * tile)[:height, :width]


def _forward(table, plan: TilePlan, columns: int, settings: RasterSettings) -> Composite:
    return _run_compositor("forward", (table, plan), columns, settings)


_composite = jax.custom_vjp(_forward, nondiff_argnums=(2, 3))


def _composite_fwd(table, plan: TilePlan, columns: int, settings: RasterSettings):
    composite = _forward(table, plan, columns, settings)
    return composite, (table, plan, composite)


def _composite_bwd(columns: int, settings: RasterSettings, residuals, cotangent: Composite):
    return _run_compositor("backward", (*residuals, cotangent), columns, settings), None


_composite.defvjp(_composite_fwd, _composite_bwd)


def _run_compositor(way: str, arguments: tuple, columns: int, settings: RasterSettings):
    """The forward or backward pass over the lists, by the compositor that the settings name.

    "auto" is kernels on an NVIDIA GPU, and loops on other devices, where JAX has no GPU, and for tiles that do not suit kernels.
    """
    loops = functools.partial(getattr(_loops, way), columns=columns, settings=settings)
    suits = settings.tile.bit_count() == 1 and jax.default_backend() == "gpu"
    if settings.compositor == "loops" or (settings.compositor == "auto" and not suits):
        return loops(*arguments)
    from wm.splat.rasterizer import _kernels  # here: Pallas is slow to import, and not there on every platform

    kernels = functools.partial(getattr(_kernels, way), columns=columns, settings=settings)
    if settings.compositor == "auto":
        return jax.lax.platform_dependent(*arguments, cuda=kernels, default=loops)
    return kernels(*arguments, interpret=settings.compositor == "interpreted")
