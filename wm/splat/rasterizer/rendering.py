"""One call from gaussians to an image: project, plan (planner.py), rasterize."""

import jax
from jax.core import Tracer

from wm.schema import RasterSettings
from wm.splat.rasterizer.checks import check_background, check_camera, check_types, check_values
from wm.splat.rasterizer.compositing import rasterize
from wm.splat.rasterizer.planner import plan_inside_jit, plan_outside_jit
from wm.splat.rasterizer.projection import DEFAULTS, project
from wm.splat.xla.vector_width import jit_wide
from wm.types import Background, Camera, Gaussians, Render

_project = jax.jit(project, static_argnames="settings")  # wide vectors gain nothing here
_rasterize = jit_wide(rasterize, ("width", "height", "settings"))


def render(
    gaussians: Gaussians,
    camera: Camera,
    *,
    background: Background | None = None,
    settings: RasterSettings = DEFAULTS,
    checked: bool = False,
) -> Render:
    """What a camera sees of gaussians; differentiable in the gaussians, the camera's arrays and the background.

    Its derivative is written out: of first order, in reverse mode (`jax.grad`, `jax.vjp`); a second one or `jax.jvp` raises.

    It may be called inside jit, grad and vmap, over cameras too. The callback by which a CPU plans there works on one device:
    inside shard_map over several, one view at a time under `settings.planner` "traced", or plan between two sharded passes:

        projected = shard(jax.vmap(project, (None, 0)))(gaussians, cameras)
        plans = plan_views(projected, width, height)                                  # on the host, outside jit
        see = lambda gaussians, camera, plan: rasterize(project(gaussians, camera), plan, width, height)
        images = shard(jax.vmap(see, (None, 0, 0)))(gaussians, cameras, plans)

    `shard` is jit of shard_map with `check_vma=False`, since loops here start from constants. On a CPU with AVX-512 a jit of the
    caller's gains a fifth from `compiler_options=wm.splat.WIDE`; called outside jit, this function sets them itself.

    Args:
        gaussians: n gaussians in world space; n may be 0. Unless `checked`, one that is not finite is left out, but for an
            opacity logit of +inf, which is that of opacity 1, and a log scale of -inf, which is that of a disc.
        camera: where they are seen from; any image size from 1 x 1.
        background: colour behind everything, one colour or one per pixel; None is black.
        settings: the constants of the rasterizer, static under jit.
        checked: refuse whatever is not finite; inside jit by `jax.experimental.checkify`, which the caller then applies:
            `error, image = checkify.checkify(jax.jit(lambda g: render(g, camera, checked=True)))(gaussians); error.throw()`.

    Returns:
        Colour, expected depth and alpha, float32 on the device.

    Raises:
        TypeError: an array does not hold floating-point numbers.
        ValueError: a shape is wrong, or the camera is not finite where its numbers are there to be seen. Under tracing, when a
            view has more entries than a traced plan has room for (XLA may wrap it). No gaussian is ever silently left out of the
            image.
    """
    check_types(gaussians, camera, settings)
    if background is not None:
        check_background(background, camera)
    if checked:
        check_values(gaussians, camera, background)
    size = (camera.width, camera.height)
    check_camera(camera)
    projected = _project(gaussians, camera, settings=settings)
    traced = any(isinstance(x, Tracer) for x in jax.tree.leaves(projected))
    plan = (plan_inside_jit if traced else plan_outside_jit)(projected, *size, settings)
    return _rasterize(projected, plan, *size, settings=settings, background=background)
