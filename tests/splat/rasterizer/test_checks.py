"""Bad arguments of a render are named: where, what, and what would be right."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.experimental import checkify

from tests.splat.scenes import camera, cloud, to_float32
from wm.schema import RasterSettings
from wm.splat import plan_tiles, project, rasterize, render
from wm.splat.rasterizer.checks import check_background
from wm.splat.rasterizer.planner import plan_inside_jit, plan_outside_jit

SMALL = RasterSettings(chunk=1, block=4)  # compiles sooner


def changed(**fields):
    return dataclasses.replace(to_float32(cloud(4)), **fields)


SHAPES = {
    "quats of three": (changed(quats=jnp.ones((4, 3))), ValueError, r"gaussians\.quats has shape \(4, 3\); \(n, 4\)"),
    "logits in a column": (changed(opacity_logits=jnp.ones((4, 1))), ValueError, r"opacity_logits has shape \(4, 1\); \(n\)"),
    "one row short": (changed(means=jnp.ones((3, 3))), ValueError, r"different lengths.*'means': 3"),
    "harmonics of no degree": (changed(sh=jnp.ones((4, 5, 3))), ValueError, "5 coefficients"),
    "integers": (changed(means=jnp.ones((4, 3), jnp.int32)), TypeError, r"gaussians\.means has dtype int32; floating-point"),
    "complex numbers": (changed(means=jnp.ones((4, 3), jnp.complex64)), TypeError, "complex64"),
}


@pytest.mark.parametrize("case", SHAPES)
def test_shapes_and_dtypes(case):
    gaussians, kind, message = SHAPES[case]
    with pytest.raises(kind, match=message):
        render(gaussians, camera())
    with pytest.raises(kind, match=message):
        jax.eval_shape(render, gaussians, to_float32(camera()))


def test_lists_are_not_arrays():
    with pytest.raises(TypeError, match=r"gaussians\.opacity_logits is a list; an array"):
        project(changed(opacity_logits=[0.0, 0.0, 0.0, 0.0]), camera())


def test_camera_background_and_constants():
    view, gaussians = camera(), to_float32(cloud(4))
    with pytest.raises(ValueError, match=r"camera\.T_cam_world has shape \(3, 4\); \(4, 4\)"):
        render(gaussians, dataclasses.replace(view, T_cam_world=np.eye(4)[:3]))
    with pytest.raises(ValueError, match="0 x 13 pixels"):
        render(gaussians, dataclasses.replace(view, width=0))
    with pytest.raises(ValueError, match=r"background has shape \(4,\); \(3,\) or \(13, 21, 3\)"):
        check_background(jnp.ones(4), view)
    with pytest.raises(TypeError, match="background has dtype uint8"):
        check_background(np.zeros((13, 21, 3), np.uint8), view)
    with pytest.raises(ValueError, match=r"camera\.focal has shape \(\); \(2\)"):
        render(gaussians, dataclasses.replace(view, focal=np.float32(18.0)))
    with pytest.raises(ValueError, match=r"settings\.alpha_min is 0\.0; a number in \[1e-30, 1\]"):
        render(gaussians, view, settings=RasterSettings(alpha_min=0.0))
    with pytest.raises(ValueError, match=r"settings\.alpha_min 0\.5 and alpha_max 0\.5 are out of order"):
        render(gaussians, view, settings=RasterSettings(alpha_min=0.5, alpha_max=0.5))


def with_value(settings, name, value):
    """Settings with a value that the annotations of the tests' constructor might refuse."""
    object.__setattr__(settings, name, value)
    return settings


@pytest.mark.parametrize(
    "name, value",
    [
        *(("blur", value) for value in (-0.1, np.inf, np.nan)),
        *(("transmittance_min", value) for value in (-1e-4, 1.0, 2.0, np.nan)),
        *(("near", value) for value in (-1.0, 0.0, np.inf)),
        *(("frustum_margin", value) for value in (0.9, np.nan)),
        *((name, value) for name in ("tile", "chunk", "block") for value in (0, -8, 8.0)),
    ],
)
def test_constants_without_meaning_are_named(name, value):
    settings, gaussians, view = with_value(RasterSettings(), name, value), to_float32(cloud(4)), camera()
    projected = project(gaussians, view)
    for call in (
        lambda: render(gaussians, view, settings=settings),
        lambda: rasterize(projected, plan_tiles(projected, 21, 13), 21, 13, settings),
    ):
        with pytest.raises(ValueError, match=rf"settings\.{name} is {value!r}; an? (number|integer) in [\[(]"):
            call()


@pytest.mark.parametrize(
    "size, tile, rows, message",
    [
        ((13, 21), 8, 4, "its width is 21, not 13, its height is 13, not 21"),
        ((21, 14), 8, 4, "its height is 13, not 14"),
        ((21, 13), 16, 4, "its tile is 8, not 16"),
        ((21, 13), 8, 3, "its gaussians is 4, not 3"),
    ],
)
def test_a_plan_of_another_image_is_refused(size, tile, rows, message):
    projected = project(to_float32(cloud(4)), camera())
    plan, fewer = plan_tiles(projected, 21, 13), jax.tree.map(lambda x: x[..., :rows], projected)
    for call in (rasterize, jax.jit(rasterize, static_argnums=(2, 3, 4))):
        with pytest.raises(ValueError, match=message):
            call(fewer, plan, *size, RasterSettings(tile=tile))


@pytest.mark.parametrize("planner", ["host", "traced"])
def test_a_plan_says_what_it_is_of_wherever_it_was_made(planner):
    projected, settings = project(to_float32(cloud(4)), camera()), RasterSettings(planner=planner)
    outside = plan_outside_jit(projected, 21, 13, settings)
    within = jax.jit(lambda projected: plan_inside_jit(projected, 21, 13, settings))(projected)
    assert outside.of == within.of == (21, 13, 8, 4)


@pytest.mark.parametrize(
    "field, value", [("focal", [0.0, 18.0]), ("principal", [np.nan, 1.0]), ("T_cam_world", np.full((4, 4), np.inf))]
)
def test_a_camera_without_meaning_is_refused_outside_jit(field, value):
    with pytest.raises(ValueError, match=rf"camera\.{field}\[0\] is"):
        render(to_float32(cloud(4)), dataclasses.replace(camera(), **{field: np.asarray(value)}))


@pytest.mark.parametrize("field", ["means", "quats", "log_scales", "opacity_logits", "sh"])
def test_checked_names_the_first_bad_gaussian(field):
    gaussians = cloud(4)
    getattr(gaussians, field)[2:] = np.nan
    with pytest.raises(ValueError, match=rf"gaussians\.{field}\[2\] is .*nan.*; finite numbers"):
        render(to_float32(gaussians), camera(), checked=True)


@jax.jit
@checkify.checkify
def checked_image(gaussians, view):
    return render(gaussians, view, settings=SMALL, checked=True)


def test_checked_inside_jit():
    good, view = to_float32(cloud(4)), to_float32(camera())
    error, image = checked_image(good, view)
    error.throw()
    np.testing.assert_allclose(image.rgb, render(good, view, settings=SMALL).rgb, atol=1e-6)
    error, _ = checked_image(changed(quats=good.quats.at[3, 1].set(jnp.inf)), view)
    with pytest.raises(Exception, match=r"gaussians\.quats\[3\] is bad"):
        error.throw()
    error, _ = checked_image(good, dataclasses.replace(view, focal=-view.focal))
    with pytest.raises(Exception, match=r"camera\.focal\[0\] is bad; positive"):
        error.throw()


def total(gaussians, view, checked, settings=SMALL):
    return render(gaussians, view, settings=settings, checked=checked).rgb.sum()


@pytest.mark.slow
def test_checked_inside_grad():
    gradient = jax.jit(checkify.checkify(jax.grad(lambda g: total(g, camera(), True))))
    good = to_float32(cloud(4))
    error, found = gradient(good)
    error.throw()
    np.testing.assert_allclose(found.sh, jax.grad(total)(good, camera(), False).sh, rtol=1e-5)
    error, _ = gradient(changed(sh=good.sh.at[1, 0, 0].set(jnp.nan)))
    with pytest.raises(Exception, match=r"gaussians\.sh\[1\] is bad"):
        error.throw()


def test_float64_comes_out_as_float32():
    plain = render(to_float32(cloud(4)), camera(), settings=SMALL)
    with jax.enable_x64(True):
        gaussians = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), to_float32(cloud(4)))
        image = render(gaussians, camera(), background=np.zeros(3), settings=SMALL)
    assert {x.dtype.name for x in jax.tree.leaves(image)} == {"float32"}
    np.testing.assert_allclose(image.rgb, plain.rgb, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("compositor", ["loops", "interpreted"])
def test_the_gradient_by_float64_is_float64(compositor):
    plain = jax.grad(total)(to_float32(cloud(4)), camera(), False)
    with jax.enable_x64(True):
        gaussians = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), to_float32(cloud(4)))
        found = jax.grad(total)(gaussians, camera(), False, dataclasses.replace(SMALL, compositor=compositor))
    for a, b in zip(jax.tree.leaves(found), jax.tree.leaves(plain)):
        assert a.dtype == np.float64
        np.testing.assert_allclose(a, b, rtol=1e-4, atol=1e-5)
