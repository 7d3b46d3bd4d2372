"""The kernels for GPUs, interpreted on a CPU, have the loops' images and derivatives, and translate to Triton without a GPU."""

import dataclasses
import functools

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.scenes import KINDS, camera, cloud, cotangent, jit_project, to_float32, troubled
from wm.schema import RasterSettings
from wm.splat import plan_tiles, plan_views, rasterize, render

SIZE = (21, 13)
TILES = [RasterSettings(), RasterSettings(tile=16, slanted=False), RasterSettings(tile=4, depth=False)]


def with_(constants, compositor):
    return dataclasses.replace(constants, compositor=compositor)


@functools.partial(jax.jit, static_argnames="constants")
def image_and_derivative(projected, plan, seen, constants):
    image, pull = jax.vjp(lambda projected: rasterize(projected, plan, *SIZE, constants), projected)
    return image, pull(seen)[0]


@pytest.mark.parametrize("constants", TILES, ids=["slanted", "flat, tiles of 16", "no depth, tiles of 4"])
@given(st.integers(0, 10**6), st.lists(st.integers(0, len(KINDS) - 1), max_size=4, unique=True))
@settings(max_examples=8, deadline=None)
def test_images_and_derivatives_are_those_of_the_loops(constants, seed, kinds):
    projected = jit_project(troubled(seed, kinds, degree=0), camera())
    plan = plan_tiles(projected, *SIZE, constants)
    seen = to_float32(cotangent(camera(), seed))
    loops, kernels = (image_and_derivative(projected, plan, seen, with_(constants, name)) for name in ("loops", "interpreted"))
    for a, b in zip(jax.tree.leaves(loops[0]), jax.tree.leaves(kernels[0])):
        np.testing.assert_allclose(b, a, rtol=1e-5, atol=1e-6)
    for a, b in zip(jax.tree.leaves(loops[1]), jax.tree.leaves(kernels[1])):
        # sums over pixels are taken in another order: where they cancel, rounding of the largest terms is left
        np.testing.assert_allclose(b, a, rtol=0, atol=1e-3 * np.abs(a).max(initial=1e-6))


def test_a_finished_tile_is_left_and_what_is_behind_it_has_no_derivative():
    wall = cloud().replace(log_scales=np.full((24, 3), 1.0), opacity_logits=np.full(24, 8.0))
    projected = jit_project(wall, camera())
    plan = plan_tiles(projected, *SIZE)
    seen = to_float32(cotangent(camera()))
    image, derivative = image_and_derivative(projected, plan, seen, with_(TILES[0], "interpreted"))
    behind = np.argsort(projected.depth)[8:]  # 0.99 three times leaves 1e-6 of the light
    np.testing.assert_allclose(image.alpha, 1, atol=1e-4)
    assert not np.asarray(derivative.color)[:, behind].any() and np.asarray(derivative.color).any()


def test_nothing_to_show():
    projected = jit_project(to_float32(cloud(0)), camera())
    plan, seen = plan_tiles(projected, *SIZE), to_float32(cotangent(camera()))
    image, derivative = image_and_derivative(projected, plan, seen, with_(TILES[0], "interpreted"))
    assert not np.asarray(image.alpha).any() and derivative.mean2d.shape == (2, 0)


def test_views_side_by_side_are_those_one_by_one():
    parts = [jit_project(to_float32(cloud()), camera(seed=seed)) for seed in (1, 2)]
    together = jax.tree.map(lambda *x: np.stack(x), *parts)
    plans = plan_views(together, *SIZE)

    def seen(projected, plan, constants):
        return jax.value_and_grad(lambda projected: rasterize(projected, plan, *SIZE, constants).rgb.sum())(projected)

    sums, derivatives = jax.jit(jax.vmap(lambda *view: seen(*view, with_(TILES[0], "interpreted"))))(together, plans)
    for k, part in enumerate(parts):
        alone, derivative = seen(part, plan_tiles(part, *SIZE), TILES[0])
        np.testing.assert_allclose(sums[k], alone, rtol=1e-6)
        np.testing.assert_allclose(derivatives.color[k], derivative.color, atol=1e-5)


@pytest.mark.parametrize("x64", [False, True])
@pytest.mark.parametrize(("compositor", "kernels"), [("kernels", True), ("auto", True), ("loops", False)])
def test_they_translate_to_triton_where_there_is_no_gpu(compositor, kernels, x64, monkeypatch):
    projected = jit_project(to_float32(cloud()), camera())
    plan, seen = plan_tiles(projected, *SIZE), to_float32(cotangent(camera()))
    monkeypatch.setattr(jax, "default_backend", lambda: "gpu")
    with jax.enable_x64(x64):
        traced = jax.jit(image_and_derivative.__wrapped__, static_argnames="constants").trace(
            projected, plan, seen, with_(TILES[0], compositor)
        )
        assert ("__gpu$xla.gpu.triton" in traced.lower(lowering_platforms=("cuda",)).as_text()) == kernels


@pytest.mark.skipif(jax.default_backend() == "gpu", reason="there is a GPU")
def test_kernels_are_refused_where_there_is_no_gpu():
    with pytest.raises(ValueError, match="needs an NVIDIA GPU"):
        jax.block_until_ready(render(to_float32(cloud()), camera(), settings=RasterSettings(compositor="kernels")))


@pytest.mark.parametrize(
    "wrong, message",
    [
        ({"compositor": "cuda"}, "compositor 'cuda' is unknown; one of auto, loops"),
        ({"planner": "gpu"}, "planner 'gpu' is unknown; one of auto, host"),
        ({"compositor": "interpreted", "tile": 12}, "tile 12 does not suit kernels; a power of two"),
    ],
)
def test_settings_that_nothing_answers_to_are_named(wrong, message):
    with pytest.raises(ValueError, match=message):
        render(cloud(2), camera(), settings=RasterSettings(**wrong))


def test_tiles_that_do_not_suit_kernels_are_composited_by_loops():
    gaussians, view = to_float32(cloud()), to_float32(camera())
    image = render(gaussians, view, settings=RasterSettings(tile=5))
    np.testing.assert_allclose(image.rgb, render(gaussians, view).rgb, atol=1e-6)
