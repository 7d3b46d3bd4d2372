"""Gaussians on disk: an exact round trip, the INRIA layout, and numbers that other programs can read."""

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.splat.ply.files import some
from wm.splat.ply import load_ply, save_ply, save_point_cloud, splat_render_mode
from wm.splat.rasterizer.rendering import render
from wm.types import Camera, Gaussians


@given(st.integers(0, 5), st.sampled_from([1, 4, 9, 16]), st.integers(0, 99))
def test_round_trip_is_exact_and_bytes_repeat(tmp_path_factory, n, k, seed):
    path, gaussians = tmp_path_factory.mktemp("ply") / "a.ply", some(n, k, seed)
    save_ply(path, gaussians)
    first = path.read_bytes()
    jax.tree.map(np.testing.assert_array_equal, load_ply(path), gaussians)
    save_ply(path, load_ply(path))
    assert path.read_bytes() == first


def test_fields_lie_as_in_the_inria_layout(tmp_path):
    gaussians = some(2, 4)
    save_ply(tmp_path / "a.ply", gaussians)
    header, body = (tmp_path / "a.ply").read_bytes().split(b"end_header\n")
    names = [line.split()[-1] for line in header.decode().splitlines() if line.startswith("property")]
    assert names[:9] == ["x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"]
    assert names[9:18] == [f"f_rest_{i}" for i in range(9)]
    assert names[18:] == ["opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    rows = np.frombuffer(body, "<f4").reshape(2, -1)
    np.testing.assert_array_equal(rows[:, 9:12], gaussians.sh[:, 1:, 0])  # channel-major: all of red first
    np.testing.assert_array_equal(rows[:, 3:6], 0)


CAMERA = Camera(T_cam_world=np.eye(4), focal=np.full(2, 20.0), principal=np.array([16.0, 12.0]), width=32, height=24)


def seen(gaussians):
    return np.asarray(render(gaussians, CAMERA).rgb)


def test_quaternions_are_written_with_unit_length_and_the_image_stays(tmp_path):
    gaussians = some(20, 1)
    gaussians.means[:, 2] += 4
    long = Gaussians(**{**vars(gaussians), "quats": gaussians.quats * np.linspace(0.01, 1e30, 20, dtype=np.float32)[:, None]})
    save_ply(tmp_path / "a.ply", long)
    loaded = load_ply(tmp_path / "a.ply")
    np.testing.assert_allclose(np.linalg.norm(loaded.quats, axis=1), 1, atol=1e-6)
    np.testing.assert_allclose(seen(loaded), seen(long), atol=1e-5)


def test_the_zero_quaternion_is_written_as_the_identity_and_nan_stays(tmp_path):
    gaussians = some(2, 1)
    gaussians.quats[0], gaussians.quats[1] = 0, np.nan
    save_ply(tmp_path / "a.ply", gaussians)
    np.testing.assert_array_equal(load_ply(tmp_path / "a.ply").quats, [[1, 0, 0, 0], [np.nan] * 4])


def test_opacities_are_finite_in_8_bits_too_and_no_pixel_changes_by_half_a_step(tmp_path):
    gaussians = some(6, 1)
    gaussians.means[:, 2] = np.linspace(3, 5, 6)
    gaussians.opacity_logits[:] = [np.inf, 40, 7, -np.inf, np.nan, 6]
    save_ply(tmp_path / "a.ply", gaussians)
    logits = load_ply(tmp_path / "a.ply").opacity_logits
    eighths = np.round(255 / (1 + np.exp(-logits.astype(np.float64))))
    assert np.isfinite(logits).all() and eighths.max() == 254
    assert logits[5] == 6
    broken = np.isnan(gaussians.opacity_logits)
    assert (logits[broken] < -15).all()
    np.testing.assert_allclose(seen(load_ply(tmp_path / "a.ply")), seen(gaussians), atol=np.abs(gaussians.sh).max() / 255)


@pytest.mark.parametrize("antialias", [False, True])
def test_whether_gaussians_were_trained_antialiased_is_written_and_read(tmp_path, antialias):
    save_ply(tmp_path / "a.ply", some(2, 1), antialias=antialias)
    assert splat_render_mode(tmp_path / "a.ply") == ("mip" if antialias else "default")
    assert (b"comment SplatRenderMode: mip\n" in (tmp_path / "a.ply").read_bytes()) == antialias
    jax.tree.map(np.testing.assert_array_equal, load_ply(tmp_path / "a.ply"), some(2, 1))


def test_a_point_cloud_has_the_fields_that_trainers_read(tmp_path):
    points, colors = np.arange(6.0).reshape(2, 3), np.array([[0, 128, 255], [1, 2, 3]], np.uint8)
    save_point_cloud(tmp_path / "p.ply", points, colors)
    header, body = (tmp_path / "p.ply").read_bytes().split(b"end_header\n")
    lines = [line for line in header.decode().splitlines() if line.startswith("property")]
    assert lines == [*(f"property float {c}" for c in "xyz"), *(f"property uchar {c}" for c in ("red", "green", "blue"))]
    rows = np.frombuffer(body, [("p", "<f4", 3), ("c", "u1", 3)])
    np.testing.assert_array_equal(rows["p"], points)
    np.testing.assert_array_equal(rows["c"], colors)
