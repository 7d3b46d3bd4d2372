"""Compiled on its own with wide vectors, or inside whatever a caller compiles: the same image."""

import functools

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tests.splat.scenes import camera, cloud, to_float32
from wm.schema import RasterSettings
from wm.splat import WIDE, render

GAUSSIANS, VIEW = to_float32(cloud()), to_float32(camera())
SMALL = RasterSettings(chunk=1, block=4, planner="host")  # compiles sooner


def image(gaussians):
    return render(gaussians, VIEW, settings=SMALL).rgb


CALLS = {
    "jit": lambda: jax.jit(image)(GAUSSIANS),
    "jit of a constant": lambda: jax.jit(lambda shift: image(GAUSSIANS) + shift)(jnp.zeros(3)),
    "jit with the options": lambda: jax.jit(image, compiler_options=WIDE)(GAUSSIANS),
    "vmap": lambda: jax.vmap(image)(jax.tree.map(lambda x: x[None], GAUSSIANS))[0],
    "vjp": lambda: jax.vjp(image, GAUSSIANS)[0],
}


@functools.cache
def alone():
    return np.asarray(image(GAUSSIANS))


@pytest.mark.parametrize("name", CALLS)
def test_the_image_does_not_depend_on_what_compiles_it(name):
    np.testing.assert_allclose(CALLS[name](), alone(), atol=2e-6)
