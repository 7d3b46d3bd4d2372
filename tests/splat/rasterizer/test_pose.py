"""Points near a camera keep their digits in its axes however far from the origin both are."""

import jax
import jax.numpy as jnp
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.splat.scenes import camera
from wm.splat.rasterizer._pose import from_centre, to_camera


@jax.jit
def both(means, T):
    return jnp.stack(to_camera(list(means), T)), jnp.stack(from_centre(list(means), T))


@given(st.integers(0, 10**6), st.sampled_from([0.0, 1.0, 1e3, 1e5, 1e7]))
def test_points_are_placed_to_the_last_digits(seed, distance):
    rng = np.random.default_rng(seed)
    centre = rng.normal(size=3) * distance
    T = camera(seed=seed).T_cam_world
    T[:3, 3] -= T[:3, :3] @ centre
    T, means = T.astype(np.float32), (rng.normal(size=(3, 40)) * 3 + centre[:, None]).astype(np.float32)
    found = [np.asarray(x, np.float64) for x in both(means, T)]
    exact, means = T.astype(np.float64), means.astype(np.float64)
    R, t = exact[:3, :3], exact[:3, 3:]
    for x, truth in zip(found, (R @ means + t, means + R.T @ t)):
        # a few roundings of numbers as large as the distance to the camera
        assert np.abs(x - truth).max() < 1e-6 * np.abs(truth).max()


def test_its_derivative_is_that_of_the_plain_product():
    T, rng = jnp.asarray(camera(seed=3).T_cam_world, jnp.float32), np.random.default_rng(0)
    means, weights = (jnp.asarray(rng.normal(size=(3, 8)), jnp.float32) for _ in range(2))

    def total(points):
        return lambda means, T: (points(means, T) * weights).sum()

    pairs = (
        (lambda m, T: both(m, T)[0], lambda m, T: T[:3, :3] @ m + T[:3, 3:]),
        (lambda m, T: both(m, T)[1], lambda m, T: m + T[:3, :3].T @ T[:3, 3:]),
    )
    for points, plain in pairs:
        found, exact = (jax.grad(total(f), (0, 1))(means, T) for f in (points, plain))
        for a, b in zip(found, exact):
            np.testing.assert_allclose(a, b, atol=1e-5)
