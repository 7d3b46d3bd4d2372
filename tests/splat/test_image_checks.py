"""Every image measure refuses what is no image in [0, 1], and names the argument and what would be right."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from wm.splat import depth_error, normals_from_depth, psnr, ssim, ssim_map
from wm.types import Camera

GOOD = np.random.default_rng(0).random((8, 9, 3)).astype(np.float32)
WRONG = [
    ((GOOD * 255).astype(np.uint8), TypeError, "dtype uint8; an image of floats from 0 to 1"),
    ((GOOD * 255).astype(np.int64), TypeError, "dtype int64"),
    (GOOD * 255, ValueError, "an image from 0 to 1 would be right"),
    (GOOD * 2 - 1, ValueError, "values from -"),
    (GOOD[..., 0], ValueError, "height, width, channels"),
]


@pytest.mark.parametrize("measure", [psnr, ssim, ssim_map])
@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize(("wrong", "error", "says"), WRONG)
def test_what_is_no_image_is_named(measure, which, wrong, error, says):
    names = ("image", "truth") if measure is psnr else ("x", "y")
    images = [GOOD, GOOD]
    images[which] = wrong
    with pytest.raises(error, match=rf"^{names[which]} .*{says}"):
        measure(*images)


@pytest.mark.parametrize("measure", [psnr, ssim, ssim_map])
def test_shapes_have_to_be_equal(measure):
    with pytest.raises(ValueError, match=r"has shape \(7, 9, 3\); that of (image|x), \(8, 9, 3\), would be right"):
        measure(GOOD, GOOD[:7])


def test_dtypes_are_seen_while_tracing_and_values_are_not():
    with pytest.raises(TypeError, match=r"^x has dtype uint8"):
        jax.jit(ssim)((GOOD * 255).astype(np.uint8), GOOD)
    assert np.isfinite(jax.jit(ssim)(GOOD * 255, GOOD))
    assert np.isfinite(jax.grad(ssim)(jnp.asarray(GOOD), GOOD)).all()


def test_renders_may_overshoot_and_a_truth_may_not():
    bright = GOOD.copy()
    bright[0, 0] = 3
    assert psnr(bright, np.clip(bright, 0, 1)) == np.inf and np.isfinite(ssim(bright, GOOD))
    with pytest.raises(ValueError, match=r"^truth has values from"):
        psnr(GOOD, bright)
    unseen = np.ones((8, 9), bool)
    unseen[0, 0] = False
    assert np.isfinite(psnr(GOOD * 0.5, bright, unseen))


def test_nan_is_the_measures_affair():
    broken = GOOD.copy()
    broken[0, 0] = np.nan
    assert np.isnan(psnr(broken, GOOD)) and np.isnan(ssim(broken, GOOD))


def test_depth_is_in_metres():
    metres = np.full((8, 9), 2.0)
    with pytest.raises(TypeError, match=r"^depth has dtype uint16; depth in metres"):
        depth_error((metres * 1000).astype(np.uint16), metres)
    with pytest.raises(TypeError, match=r"^scaffold has dtype uint16"):
        depth_error(metres, (metres * 1000).astype(np.uint16))
    with pytest.raises(ValueError, match="scaffold has shape"):
        depth_error(metres, metres[:4])
    camera = Camera(T_cam_world=np.eye(4), focal=np.ones(2), principal=np.ones(2), width=9, height=8)
    with pytest.raises(TypeError, match=r"^depth has dtype uint16"):
        normals_from_depth((metres * 1000).astype(np.uint16), camera)
