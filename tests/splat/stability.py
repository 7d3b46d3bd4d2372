"""The stiff and extreme cases of design.md section 7: what each is, what is promised, and how far from float64 it comes.

Shared by test_stability.py, which holds the promises, and experiments/stability, which tables the figures.
"""

import dataclasses
from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np

from tests.splat.scenes import camera, cloud, gradients, images, undecided
from wm.schema import RasterSettings
from wm.splat.optimization.losses import depth_loss
from wm.splat.optimization.normal_loss import normal_loss
from wm.splat.similarity import C1, C2, RADIUS, TAPS, ssim
from wm.types import Camera, Gaussians

DEFAULT, SMALL = RasterSettings(), RasterSettings(chunk=1)
BACKGROUND = np.array([0.2, 0.5, 0.9])
SMALLEST = 1e-2
"""Gradients are compared relative to the largest entry of their leaf, or to this where that is smaller: under a random cotangent
the pixels' shares are of the order of 1, and a sum of them that cancels is rounded as they are."""


@dataclasses.dataclass(frozen=True)
class Errors:
    """Largest differences from float64."""

    value: float  # of colour, alpha, and depth times alpha
    gradient: float  # of any leaf, relative to its largest entry
    undecided: float = 0.0  # share of the pixels within rounding of a threshold, which are left out


@dataclasses.dataclass(frozen=True, kw_only=True)
class Case:
    """One row of the table."""

    measure: Callable[[], Errors]
    value: float  # promised bounds
    gradient: float
    promise: str


def against_twin(gaussians: Gaussians, view: Camera, settings: RasterSettings = DEFAULT) -> Errors:
    """Errors of `render` on the pixels that no rounding can decide otherwise, and of its gradients of all its arguments."""
    near = undecided(gaussians, view, settings, alpha=2e-5, transmittance=1e-3)
    found, exact = images(gaussians, view, BACKGROUND, settings)
    found, exact = (x.replace(depth=x.depth * x.alpha) for x in (found, exact))
    pairs = zip(jax.tree.leaves(found), jax.tree.leaves(exact))
    value = max(np.abs(a - b)[~near].max(initial=0.0) for a, b in pairs)
    pulled, truth = (jax.tree.leaves(x) for x in gradients(gaussians, view, BACKGROUND, settings, kept=~near))
    errors = [np.abs(a - b).max() / max(np.abs(b).max(), SMALLEST) for a, b in zip(pulled, truth) if a.size]
    return Errors(value=float(value), gradient=float(np.max(errors)), undecided=float(near.mean()))


def changed(view: Camera | None = None, settings: RasterSettings = DEFAULT, **fields) -> Callable[[], Errors]:
    """A cloud of 24 with these values in its first gaussians."""

    def measure():
        gaussians = vars(cloud(degree=3, opaque=9.0))
        for name, values in fields.items():
            gaussians[name][: len(values)] = values
        return against_twin(Gaussians(**gaussians), view or camera(), settings)

    return measure


def far_from_the_origin() -> Errors:
    gaussians, view, shift = cloud(degree=3, opaque=9.0), camera(seed=7), np.array([1e5, -1e5, 1e5])
    T = view.T_cam_world.copy()
    T[:3, 3] -= T[:3, :3] @ shift
    return against_twin(gaussians.replace(means=gaussians.means + shift), dataclasses.replace(view, T_cam_world=T))


def crowd(n: int) -> Errors:
    """n gaussians on one pixel, each just visible, and no stop, so that all of them count: transmittance falls to 0."""
    gaussians = cloud(n).replace(opacity_logits=np.full(n, -4.8), log_scales=np.full((n, 3), -1.0))
    rng = np.random.default_rng(0)
    gaussians.means[:, :2] = rng.normal(size=(n, 2)) * 0.01
    one = Camera(T_cam_world=np.eye(4), focal=np.ones(2), principal=np.full(2, 0.5), width=1, height=1)
    return against_twin(gaussians, one, dataclasses.replace(SMALL, transmittance_min=0.0))


def constant_images() -> Errors:
    """SSIM of constant images, equal and not, and its gradient, against its definition in float64."""
    levels = [(0.0, 0.0), (1.0, 1.0), (0.5, 0.5), (0.0, 1.0), (0.7, 0.4)]
    fast = jax.jit(jax.value_and_grad(ssim))
    pairs = [[np.full((12, 12, 3), level, np.float32) for level in pair] for pair in levels]
    found = [fast(*pair) for pair in pairs]
    with jax.enable_x64(True):
        exact = jax.jit(jax.value_and_grad(_ssim_by_definition))
        truth = [exact(*(x.astype(np.float64) for x in pair)) for pair in pairs]
    value = max(abs(float(a[0]) - float(b[0])) for a, b in zip(found, truth))
    scale = 1 / found[0][1].size  # the gradient of a mean
    gradient = max(np.abs(np.asarray(a[1]) - np.asarray(b[1])).max() for a, b in zip(found, truth)) / scale
    return Errors(value=value, gradient=float(gradient))


def _ssim_by_definition(x, y):
    def blur(z):
        for axis in (0, 1):
            pad = [(RADIUS, RADIUS) if k == axis else (0, 0) for k in range(3)]
            z = jnp.apply_along_axis(lambda line: jnp.convolve(line, jnp.array(TAPS), mode="valid"), axis, jnp.pad(z, pad))
        return z

    mx, my, xx, yy, xy = (blur(z) for z in (x, y, x * x, y * y, x * y))
    numerator = (2 * mx * my + C1) * (2 * (xy - mx * my) + C2)
    return (numerator / ((mx**2 + my**2 + C1) * (xx - mx**2 + yy - my**2 + C2))).mean()


def no_valid_depth() -> Errors:
    """The losses of depth and normals where nothing is hit, nothing is in the mask, or nothing was rendered: exactly 0."""
    depth = jnp.asarray(np.random.default_rng(0).uniform(1, 2, (6, 8)), jnp.float32)
    everywhere, focal, principal = jnp.ones((6, 8), bool), jnp.full(2, 9.0), jnp.array([4.0, 3.0])

    @jax.jit
    @jax.value_and_grad
    def total(depth, scaffold, mask):
        return depth_loss(depth, scaffold, mask) + normal_loss(depth, scaffold, mask, focal, principal)

    results = [total(depth, 0 * depth, everywhere), total(depth, depth + 1, ~everywhere), total(0 * depth, 0 * depth, everywhere)]
    return Errors(
        value=max(abs(float(value)) for value, _ in results),
        gradient=max(float(jnp.abs(gradient).max()) for _, gradient in results),
    )


ROUNDING = {"value": 1e-5, "gradient": 1e-3}
_rng = np.random.default_rng(0)
_quats = _rng.normal(size=(8, 4))

CASES = {
    "needles, condition number 1e8": Case(
        measure=changed(log_scales=np.log(np.tile([3.0, 3e-4, 3e-4], (8, 1))), quats=_quats),
        promise="rounding: determinant and form are sums of squares",
        **ROUNDING,
    ),
    "needles, condition number 1e16": Case(
        measure=changed(log_scales=np.log(np.tile([3.0, 3e-8, 3e-8], (8, 1))), quats=_quats),
        promise="rounding: the blur is added where nothing cancels",
        **ROUNDING,
    ),
    "sub-pixel, 1e-3 px": Case(
        measure=changed(log_scales=np.full((8, 3), np.log(1e-4))),
        promise="rounding; they show at the size of the blur",
        **ROUNDING,
    ),
    "sub-pixel, antialiased": Case(
        measure=changed(settings=RasterSettings(antialias=True), log_scales=np.linspace(-9, -2, 24)[:, None].repeat(3, 1)),
        promise="rounding; they fade with their area",
        **ROUNDING,
    ),
    "scene-sized, 50 m": Case(
        measure=changed(log_scales=np.full((4, 3), np.log(50.0)), opacity_logits=[-1.0, 0.0, 1.0, -2.0]),
        promise="rounding",
        **ROUNDING,
    ),
    "opacity logits of +-50": Case(
        measure=changed(opacity_logits=[50.0, -50.0] * 4),
        promise="rounding; +50 is clamped at alpha_max, -50 is culled, and neither has a gradient with respect to its logit",
        **ROUNDING,
    ),
    "zero quaternions": Case(
        measure=changed(quats=np.zeros((8, 4))), promise="the identity, zero gradient with respect to the quaternion", **ROUNDING
    ),
    "means at the camera's centre": Case(measure=changed(means=np.zeros((4, 3))), promise="culled, zero gradient", **ROUNDING),
    "means behind the camera": Case(
        measure=changed(means=np.array([[0.1, 0.2, -z] for z in (1e-6, 1.0, 50.0, 1e6)])),
        promise="culled, zero gradient",
        **ROUNDING,
    ),
    "means just beyond the near plane": Case(
        measure=changed(means=np.array([[0.0, 0.01, 0.0501], [0.5, 0.0, 0.06]])), promise="rounding", **ROUNDING
    ),
    "1e5 gaussians on one pixel": Case(
        measure=lambda: crowd(100_000),
        promise="rounding: all are listed and count, transmittance falls to 0",
        **ROUNDING,
    ),
    "depth ties": Case(
        measure=changed(means=_rng.uniform(-0.8, 0.8, (24, 3)) * [1, 1, 0] + [0, 0, 2.0]),
        promise="rounding: equal depths go by index",
        **ROUNDING,
    ),
    "1e5 m from the origin": Case(
        measure=far_from_the_origin,
        promise="rounding: gaussians and camera as float32 holds them, which is to 1e5 m / 2^24 = 6 mm",
        **ROUNDING,
    ),
    "1 x 1 image": Case(measure=changed(camera(1, 1), SMALL), promise="rounding", **ROUNDING),
    "21 x 13 image, tiles of 8": Case(measure=changed(), promise="rounding", **ROUNDING),
    "no gaussians": Case(
        measure=lambda: against_twin(cloud(0), camera(), SMALL),
        promise="the background, and its gradient",
        **ROUNDING,
    ),
    "constant images under SSIM": Case(
        measure=constant_images,
        value=1e-4,
        gradient=1e-3,
        promise="variances cancel to 1e-7, a share of 1e-4 of the constant c2 beside them",
    ),
    "all-invalid depth": Case(measure=no_valid_depth, value=0.0, gradient=0.0, promise="0 and no gradient, exactly"),
}
