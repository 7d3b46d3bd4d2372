"""Small scenes of gaussians, and the comparison with the float64 twin, for the tests of the splat floor.

The twin is given the numbers that `render` is given, rounded to float32: what is compared is arithmetic, not input.
"""

import jax
import jax.numpy as jnp
import numpy as np

from wm.schema import RasterSettings
from wm.splat import project, render
from wm.splat.rasterizer._reference import distance_to_thresholds, render_reference
from wm.types import Camera, Gaussians, Render

SMOOTH = RasterSettings(alpha_min=1e-7, transmittance_min=0.0)
"""Cuts so small that crossing one cannot be seen: what is left is smooth as long as opacities stay below alpha_max."""


def camera(width=21, height=13, *, focal=18.0, seed=None) -> Camera:
    """At the origin, looking along z, a little off centre; turned and moved a little with a seed."""
    T = np.eye(4)
    if seed is not None:
        rng = np.random.default_rng(seed)
        T[:3, :3] = _rotation(rng.normal(size=3) * 0.1)
        T[:3, 3] = rng.normal(size=3) * 0.1
    principal = np.array([width / 2 + 0.7, height / 2 - 0.4])
    return Camera(T_cam_world=T, focal=np.array([focal, focal * 1.1]), principal=principal, width=width, height=height)


def _rotation(axis):
    angle = np.linalg.norm(axis)
    x, y, z = axis / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def cloud(n=24, *, seed=0, degree=0, opaque=2.0) -> Gaussians:
    """n gaussians in front of the camera, float64 NumPy; opacity logits in [-2, opaque]."""
    rng = np.random.default_rng([seed, n, degree])
    return Gaussians(
        means=np.concatenate([rng.uniform(-1.2, 1.2, (n, 2)), rng.uniform(1.0, 4.0, (n, 1))], 1),
        quats=rng.normal(size=(n, 4)),
        log_scales=rng.normal(-1.8, 0.5, (n, 3)),
        opacity_logits=rng.uniform(-2.0, opaque, n),
        sh=rng.normal(size=(n, (degree + 1) ** 2, 3)) * 0.3,
    )


def _needles(rng, g):
    g["log_scales"] = np.log(
        np.stack([rng.uniform(0.5, 3.0, len(g["means"])), *rng.uniform(5e-5, 3e-4, (2, len(g["means"])))], 1)
    )


def _giants(rng, g):
    g["log_scales"] = rng.uniform(1.0, 4.0, g["log_scales"].shape)


def _specks(rng, g):
    g["log_scales"] = rng.uniform(-14.0, -6.0, g["log_scales"].shape)


def _disks(rng, g):
    g["log_scales"][:, rng.integers(3)] = -12.0


def _certain(rng, g):
    g["opacity_logits"] = rng.choice([-50.0, 50.0], len(g["means"]))


def _unturned(rng, g):
    g["quats"] = np.zeros_like(g["quats"])


def _grazing(rng, g):
    g["means"][:, 2] = rng.uniform(0.051, 0.1, len(g["means"]))


def _behind(rng, g):
    g["means"][:, 2] = rng.uniform(-3.0, 0.05, len(g["means"]))


def _centred(rng, g):
    g["means"] = np.zeros_like(g["means"])


def _tied(rng, g):
    g["means"] = np.tile([0.1, -0.1, 2.0], (len(g["means"]), 1))


KINDS = (_needles, _giants, _specks, _disks, _certain, _unturned, _grazing, _behind, _centred, _tied)
"""Ways in which gaussians are unpleasant, each at the origin camera; several may befall one gaussian."""


def troubled(seed, kinds, *, degree=3) -> Gaussians:
    """A cloud of 24 in which each of `kinds` (indices of KINDS) befalls four gaussians."""
    rng = np.random.default_rng([seed, len(kinds)])
    gaussians = vars(cloud(seed=seed, degree=degree, opaque=9.0))
    for kind in kinds:
        hit = rng.choice(24, 4, replace=False)
        part = {name: value[hit] for name, value in gaussians.items()}
        KINDS[kind](rng, part)
        for name, value in part.items():
            gaussians[name][hit] = value
    return Gaussians(**gaussians)


def to_float32(tree):
    return jax.tree.map(lambda x: jnp.asarray(x, jnp.float32), tree)


def to_float64(tree):
    return jax.tree.map(lambda x: np.asarray(x, np.float64), tree)


jit_project = jax.jit(project, static_argnames="settings")
jit_reference = jax.jit(render_reference, static_argnames="settings")
_jit_distance = jax.jit(distance_to_thresholds, static_argnames="settings")


def cotangent(view: Camera, seed=1) -> Render:
    rng = np.random.default_rng(seed)
    shape = (view.height, view.width)
    return Render(rgb=rng.normal(size=(*shape, 3)), depth=rng.normal(size=shape), alpha=rng.normal(size=shape))


def dot(image: Render, weights: Render):
    return sum((a * b).sum() for a, b in zip(jax.tree.leaves(image), jax.tree.leaves(weights)))


def _gradient(renderer):
    def total(gaussians, view, background, weights, settings):
        return dot(renderer(gaussians, view, background=background, settings=settings), weights)

    return jax.jit(jax.grad(total, (0, 1, 2)), static_argnames="settings")


fast_gradient = _gradient(render)
"""(gaussians, camera, background, weights, settings) -> gradients of the weighted sum of the image, of the first three."""
exact_gradient = _gradient(render_reference)


def gradients(gaussians: Gaussians, view: Camera, background, settings: RasterSettings = SMOOTH, seed=1, kept=None):
    """(fast, exact) gradients of gaussians, camera and background for one random cotangent, 0 where `kept` is False.

    Depth is weighted with alpha: where next to nothing is seen, depth is next to nothing divided by next to nothing.
    """
    arguments, weights = to_float32((gaussians, view, background)), cotangent(view, seed)
    if kept is not None:
        weights = jax.tree.map(lambda x: x * kept.reshape(kept.shape + (1,) * (x.ndim - 2)), weights)
    with jax.enable_x64(True):
        alpha = jit_reference(*to_float64(arguments[:2]), settings=settings).alpha
        weights = to_float32(weights.replace(depth=weights.depth * np.asarray(alpha)))
        exact = exact_gradient(*to_float64(arguments), to_float64(weights), settings=settings)
    found = fast_gradient(*arguments, weights, settings=settings)
    return to_float64(found), to_float64(exact)


def undecided(gaussians: Gaussians, view: Camera, settings: RasterSettings, *, alpha: float, transmittance: float):
    """[h, w] pixels where the twin came relatively this close to a threshold: where rounding may decide otherwise."""
    with jax.enable_x64(True):
        distance = to_float64(_jit_distance(*to_float64(to_float32((gaussians, view))), settings=settings))
    return (distance.alpha < alpha) | (distance.transmittance < transmittance)


def images(gaussians: Gaussians, view: Camera, background=None, settings: RasterSettings = SMOOTH):
    """(fast, exact) renders as float64 NumPy."""
    found = render(to_float32(gaussians), view, background=background, settings=settings)
    with jax.enable_x64(True):
        exact = jit_reference(*to_float64(to_float32((gaussians, view))), background=background, settings=settings)
    return to_float64(found), to_float64(exact)


def worst(found, exact) -> float:
    """Largest difference of any leaf, relative to that leaf's largest exact entry."""
    pairs = zip(jax.tree.leaves(found), jax.tree.leaves(exact))
    return max((np.abs(a - b).max() / max(np.abs(b).max(), 1e-6) for a, b in pairs if a.size), default=0.0)
