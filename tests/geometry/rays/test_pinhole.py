"""Laws of pinhole cameras: orthonormality, round trips, and the half-pixel convention."""

import copy
import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.geometry.rays.pinhole import (
    camera_center,
    camera_quat,
    camera_rays,
    camera_rotation,
    make_camera,
    project_points,
    scale_camera,
    unproject_depth,
)
from wm.types import View

coordinate = st.floats(-50.0, 50.0)
point = st.tuples(coordinate, coordinate, coordinate).map(np.array)
cameras = st.builds(
    lambda eye, yaw, pitch, fov: make_camera(eye, eye + _direction(yaw, pitch), width=13, height=7, fov_deg=fov),
    point,
    st.floats(-np.pi, np.pi),
    st.floats(-np.pi / 2, np.pi / 2),
    st.floats(10.0, 120.0),
)
laws = settings(max_examples=40, deadline=None)


def _direction(yaw, pitch):
    return 3.0 * np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])


def _matrix(q):
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@laws
@given(cameras)
def test_look_at_is_a_rotation_with_the_horizon_level(camera):
    r = camera_rotation(camera)
    np.testing.assert_allclose(r @ r.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(r) == pytest.approx(1.0)
    assert abs(r[0, 2]) < 1e-9  # right is horizontal
    assert r[1, 2] < 1e-9  # down never points up


@laws
@given(point, point)
def test_the_target_lies_in_the_middle_of_the_image(eye, offset):
    if np.linalg.norm(offset) < 1e-3:
        offset = np.array([0.0, 0.0, 1.0])
    camera = make_camera(eye, eye + offset, width=20, height=10, fov_deg=60.0)
    uv, depth = project_points(camera, (eye + offset)[None])
    np.testing.assert_allclose(uv[0], [10.0, 5.0], atol=1e-6)
    np.testing.assert_allclose(depth[0], np.linalg.norm(offset), rtol=1e-9)
    np.testing.assert_allclose(camera_center(camera), eye, atol=1e-9)


@laws
@given(cameras, st.integers(0, 2**32 - 1))
def test_project_undoes_unproject(camera, seed):
    depth = np.random.default_rng(seed).uniform(0.1, 20.0, (camera.height, camera.width))
    uv, z = project_points(camera, unproject_depth(camera, depth).reshape(-1, 3))
    j, i = np.mgrid[: camera.height, : camera.width]
    np.testing.assert_allclose(uv, np.stack([i, j], axis=-1).reshape(-1, 2) + 0.5, atol=1e-8)
    np.testing.assert_allclose(z, depth.reshape(-1), rtol=1e-10)


@laws
@given(cameras)
def test_rays_have_unit_depth_and_the_field_of_view_is_vertical(camera):
    forward = camera_rotation(camera)[2]
    np.testing.assert_allclose(camera_rays(camera) @ forward, 1.0, atol=1e-12)
    down = camera_rotation(camera)[1]
    edges, _ = project_points(
        camera, camera_center(camera) + forward + np.outer([-1.0, 1.0], down) * (camera.height / 2 / camera.focal[1])
    )
    np.testing.assert_allclose(edges[:, 1], [0.0, camera.height], atol=1e-8)


@laws
@given(cameras)
def test_the_quaternion_is_the_rotation_from_camera_to_world(camera):
    q = camera_quat(camera)
    assert np.linalg.norm(q) == pytest.approx(1.0) and q[0] >= 0
    np.testing.assert_allclose(_matrix(q), camera_rotation(camera).T, atol=1e-9)


def test_pixel_centres_are_at_half_integers():
    camera = make_camera(np.zeros(3), np.array([0.0, 1.0, 0.0]), width=4, height=2, fov_deg=90.0)
    assert camera.focal[0] == pytest.approx(1.0)  # 2 pixels high, 90 degrees
    rays = camera_rays(camera).reshape(2, 4, 3)
    np.testing.assert_allclose(rays[0, 0], [-1.5, 1.0, 0.5], atol=1e-12)
    np.testing.assert_allclose(rays[1, 3], [1.5, 1.0, -0.5], atol=1e-12)


def test_a_crop_moves_the_principal_point_and_keeps_the_rays():
    camera = make_camera(np.array([1.0, 2.0, 1.5]), np.array([4.0, 1.0, 0.5]), width=12, height=8, fov_deg=50.0)
    crop = dataclasses.replace(camera, principal=camera.principal - np.array([3.0, 2.0]), width=5, height=4)
    whole = camera_rays(camera).reshape(8, 12, 3)
    np.testing.assert_allclose(camera_rays(crop).reshape(4, 5, 3), whole[2:6, 3:8], atol=1e-14)


@pytest.mark.parametrize("factor", [0.5, 2.0, 3.0, 0.3])
def test_scaling_keeps_what_the_image_shows(factor):
    camera = make_camera(np.zeros(3), np.array([1.0, 1.0, 0.2]), width=16, height=9, fov_deg=60.0)
    scaled = scale_camera(camera, factor)
    points = np.array([[3.0, 2.0, 1.0], [2.0, 4.0, 0.0]])
    uv, _ = project_points(camera, points)
    uv_scaled, _ = project_points(scaled, points)
    np.testing.assert_allclose(uv_scaled / [scaled.width, scaled.height], uv / [camera.width, camera.height], atol=1e-12)


def test_points_behind_have_no_pixel():
    camera = make_camera(np.zeros(3), np.array([1.0, 0.0, 0.0]), width=4, height=4, fov_deg=60.0)
    uv, depth = project_points(camera, np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    assert np.isnan(uv).all() and (depth <= 0).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"width": 0}, "at least one pixel"),
        ({"fov_deg": 180.0}, "field of view"),
        ({"target": np.zeros(3)}, "different eye and target"),
        ({"target": np.array([np.nan, 0.0, 0.0])}, "finite"),
    ],
)
def test_what_is_no_camera_is_refused(change, message):
    arguments = {"eye": np.zeros(3), "target": np.ones(3), "width": 4, "height": 4, "fov_deg": 60.0} | change
    with pytest.raises(ValueError, match=message):
        make_camera(**arguments)
    camera = make_camera(np.zeros(3), np.ones(3), width=4, height=4, fov_deg=60.0)
    with pytest.raises(ValueError, match="does not fit"):
        unproject_depth(camera, np.zeros((3, 4)))
    with pytest.raises(ValueError, match="positive factor"):
        scale_camera(camera, 0.0)


def test_cameras_and_views_are_compared_and_hashed_as_things():
    """Field by field NumPy would raise, or say a truth for each number."""
    camera = make_camera(np.zeros(3), np.ones(3), width=4, height=4, fov_deg=60.0)
    view = View(camera=camera, room=0, kind="bootstrap", name="hall/bootstrap0")
    for thing in (camera, view):
        other = copy.deepcopy(thing)
        assert thing == thing and thing != other and thing in [other, thing]
        assert len({thing, other, thing}) == 2
