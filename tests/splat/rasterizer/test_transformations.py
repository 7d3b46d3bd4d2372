"""A render inside the caller's jit, grad and vmap over cameras, and over two devices."""

import dataclasses
import os
import subprocess
import sys

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.sharding import PartitionSpec as P

from tests.splat.scenes import camera, cloud, cotangent, dot, to_float32
from wm.schema import RasterSettings
from wm.splat import plan_views, project, rasterize, render
from wm.types import Camera

GAUSSIANS = to_float32(cloud())
WEIGHTS = to_float32(cotangent(camera()))
VIEWS = [to_float32(camera(seed=seed)) for seed in range(4)]
CAMERAS: Camera = jax.tree.map(lambda *x: jnp.stack(x), *VIEWS)
SMALL = RasterSettings(chunk=1, block=4)  # compiles sooner
HOST, TRACED = (dataclasses.replace(SMALL, planner=planner) for planner in ("host", "traced"))


def loss(gaussians, view, settings):
    image = render(gaussians, view, settings=settings)
    return dot(image, WEIGHTS), image


several = jax.value_and_grad(loss, (0, 1), has_aux=True)


def assert_same(found, expected, rtol=1e-4):
    for a, b in zip(jax.tree.leaves(found), jax.tree.leaves(expected)):
        np.testing.assert_allclose(a, b, atol=rtol * max(np.abs(b).max(), 1e-3))


@pytest.fixture(scope="module")
def alone():
    """Values and gradients of one view after the other, planned outside jit."""
    images = [render(GAUSSIANS, view, settings=SMALL) for view in VIEWS]
    single = jax.jit(lambda g, v: several(g, v, HOST))
    values, gradients = zip(*(single(GAUSSIANS, view) for view in VIEWS))
    stack = lambda *x: np.stack(x)  # noqa: E731
    return jax.tree.map(stack, *images), jax.tree.map(stack, *[v[0] for v in values]), jax.tree.map(stack, *gradients)


def test_vmap_over_cameras_gives_the_images():
    found = jax.jit(jax.vmap(lambda g, v: render(g, v, settings=HOST), (None, 0)))(GAUSSIANS, CAMERAS)
    for k, view in enumerate(VIEWS):
        assert_same(jax.tree.map(lambda x, k=k: x[k], found), render(GAUSSIANS, view, settings=SMALL))


@pytest.mark.slow
@pytest.mark.parametrize("settings", [HOST, TRACED], ids=["host", "traced"])
def test_vmap_over_cameras_gives_the_gradients(alone, settings):
    many = jax.jit(jax.vmap(lambda g, v: several(g, v, settings), (None, 0)))
    (values, images), gradients = many(GAUSSIANS, CAMERAS)
    assert_same((images, values, gradients), alone)


@pytest.mark.parametrize(
    "derivative",
    [
        lambda f, x: jax.jvp(f, (x,), (x,)),
        lambda f, x: jax.jvp(jax.grad(f), (x,), (x,)),
        pytest.param(lambda f, x: jax.grad(lambda x: jax.grad(f)(x).sum())(x), marks=pytest.mark.slow),
    ],
    ids=["forward", "forward over reverse", "reverse twice"],
)
def test_other_derivatives_than_the_first_in_reverse_mode_raise(derivative):
    def brightness(logits):
        return render(GAUSSIANS.replace(opacity_logits=logits), VIEWS[0], settings=SMALL).rgb.sum()

    with pytest.raises((TypeError, ValueError), match=r"custom_vjp|Reverse-mode differentiation does not work"):
        derivative(brightness, GAUSSIANS.opacity_logits)


def two_phases(devices: int):
    """The image and gradient of every view, planned between two sharded passes: what the docstring of render shows."""
    mesh = jax.make_mesh((devices,), ("views",), axis_types=(jax.sharding.AxisType.Auto,))

    def shard(f, arguments):
        specs = (P(), *(P("views"),) * (arguments - 1))
        return jax.jit(jax.shard_map(f, mesh=mesh, in_specs=specs, out_specs=P("views"), check_vma=False))

    projected = shard(jax.vmap(project, (None, 0)), 2)(GAUSSIANS, CAMERAS)
    plans = plan_views(projected, 21, 13, SMALL)

    def value(gaussians, view, plan):
        image = rasterize(project(gaussians, view), plan, 21, 13, SMALL)
        return dot(image, WEIGHTS), image

    both = jax.vmap(jax.value_and_grad(value, (0, 1), has_aux=True), (None, 0, 0))
    (values, images), gradients = shard(both, 3)(GAUSSIANS, CAMERAS, plans)
    return images, values, gradients


def in_graph(devices: int):
    """The same in one pass, planned by the devices themselves."""
    mesh = jax.make_mesh((devices,), ("views",), axis_types=(jax.sharding.AxisType.Auto,))

    def each(gaussians, cameras):
        return jax.lax.map(lambda view: several(gaussians, view, TRACED), cameras)

    sharded = jax.shard_map(each, mesh=mesh, in_specs=(P(), P("views")), out_specs=P("views"), check_vma=False)
    (values, images), gradients = jax.jit(sharded)(GAUSSIANS, CAMERAS)
    return images, values, gradients


@pytest.mark.slow
@pytest.mark.parametrize("way", ["two_phases", "in_graph"])
def test_shard_map_over_two_devices(alone, way, tmp_path):
    code = (
        "import sys, jax, numpy as np; from tests.splat.rasterizer import test_transformations as t;"
        "assert len(jax.devices()) == 2;"
        "found = jax.tree.leaves(getattr(t, sys.argv[1])(2)); np.savez(sys.argv[2], *map(np.asarray, found))"
    )
    env = os.environ | {"JAX_NUM_CPU_DEVICES": "2", "JAX_PLATFORMS": "cpu"}
    command = [sys.executable, "-c", code, way, str(tmp_path / "found.npz")]
    subprocess.run(command, env=env, check=True, timeout=500)
    with np.load(tmp_path / "found.npz") as found:
        assert_same([found[f"arr_{k}"] for k in range(len(found.files))], jax.tree.leaves(alone))
