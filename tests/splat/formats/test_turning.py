"""A turned scene seen by a turned camera is the same image."""

import jax
import numpy as np
import pytest

from tests.splat.ply.files import some
from wm.splat.formats import to_y_up, to_z_up
from wm.splat.formats.turning import Y_UP, turned
from wm.splat.rasterizer.rendering import render
from wm.types import Camera, Gaussians


def rotation(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.linalg.det(q)


def image(gaussians, T_cam_world):
    camera = Camera(T_cam_world=T_cam_world, focal=np.full(2, 20.0), principal=np.array([16.0, 12.0]), width=32, height=24)
    return np.asarray(render(gaussians, camera).rgb)


@pytest.mark.parametrize("k", [1, 4, 9, 16])
def test_the_image_stays(k):
    gaussians = some(30, k)
    gaussians.means[:, 2] += 4
    R, shift, scale = rotation(k), np.array([0.3, -1.0, 2.0]), 1.7
    back = np.eye(4)
    back[:3, :3], back[:3, 3] = R.T, -R.T @ shift  # the scaled scene, of which a pinhole camera at its origin sees the same
    seen, wanted = image(turned(gaussians, R, scale, shift), back), image(gaussians, np.eye(4))
    np.testing.assert_allclose(seen, wanted, atol=2e-4)


def test_up_goes_up_and_back():
    gaussians = some(20, 16)
    up = Gaussians(**{**vars(gaussians), "means": np.tile(np.array([[0, 0, 1]], np.float32), (20, 1))})
    np.testing.assert_allclose(to_y_up(up).means, np.tile([[0, 1, 0]], (20, 1)), atol=1e-7)
    assert np.linalg.det(Y_UP) == pytest.approx(1)
    again = to_z_up(to_y_up(gaussians))
    again = again.replace(quats=again.quats * np.sign((again.quats * gaussians.quats).sum(1, keepdims=True)))
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, atol=1e-5), again, gaussians)
