"""Laws of the metrics on planes: exact depth has no error, known offsets have known ones."""

import dataclasses

import numpy as np
import pytest

from wm.geometry.rays.pinhole import camera_center, camera_rays, make_camera
from wm.splat.metrics import depth_error, normal_error, normals_from_depth, one_surface, psnr
from wm.splat.reprojection import every, mutual_pixels, overlap, reprojection_error, shared_pixels


def camera(eye, target, width=64, height=48):
    return make_camera(np.array(eye, float), np.array(target, float), width=width, height=height, fov_deg=60.0)


def plane_depth(view, point, normal):
    """Exact z-depth of a plane, 0 behind the camera."""
    normal, rays = np.asarray(normal, float), camera_rays(view)
    depth = (np.asarray(point) - camera_center(view)) @ normal / (rays @ normal)
    return np.where(depth > 0, depth, 0.0).reshape(view.height, view.width)


FLOOR = ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
ABOVE = camera((0, 0, 2), (1.5, 0.4, 0))
BESIDE = camera((0.4, -0.3, 1.8), (1.6, 0.5, 0))


def test_psnr_of_a_known_error_and_under_a_mask():
    truth = np.full((4, 5, 3), 0.4)
    np.testing.assert_allclose(psnr(truth + 0.1, truth), 20, atol=1e-9)
    assert psnr(truth, truth) == np.inf and psnr(np.full((4, 5, 3), 7.0), np.ones((4, 5, 3))) == np.inf  # clipped
    mask = np.zeros((4, 5), bool)
    assert np.isnan(psnr(truth, truth, mask))
    mask[0] = True
    wrong = truth.copy()
    wrong[1:] = 1
    assert psnr(wrong, truth, mask) == np.inf


def test_depth_error_counts_where_the_scaffold_is_hit():
    scaffold = np.full((3, 4), 2.0)
    scaffold[0] = 0
    exact = depth_error(scaffold, scaffold)
    assert exact.mae == 0 and exact.rmse == 0
    depth = scaffold + np.array([9.0, 0.3, 0.1])[:, None]
    error = depth_error(depth, scaffold)
    np.testing.assert_allclose([error.mae, error.rmse], [0.2, np.sqrt(0.05)])
    assert error.rmse >= error.mae
    assert np.isnan(depth_error(depth, scaffold * 0).mae)
    np.testing.assert_allclose(depth_error(depth, scaffold, np.arange(3)[:, None] * np.ones(4) == 1).mae, 0.3)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0.3, -0.2, 1), (-0.5, 0.1, 0.4)])
def test_normals_of_a_plane_are_exact_and_face_the_camera(normal):
    normal = np.array(normal) / np.linalg.norm(normal)
    depth = plane_depth(ABOVE, (1.0, 0.2, 0.0), normal)
    inner = normals_from_depth(depth, ABOVE)[1:-1, 1:-1]
    seen = (np.lib.stride_tricks.sliding_window_view(depth, (3, 3)) > 0).all((-2, -1))
    assert seen.any()
    to_camera = (camera_rays(ABOVE).reshape(48, 64, 3)[1:-1, 1:-1] * inner).sum(-1)
    assert (to_camera[seen] < 0).all()
    np.testing.assert_allclose(np.abs(inner[seen] @ normal), 1, atol=1e-6)


def test_normal_error_is_zero_for_exact_depth_and_an_angle_for_a_tilted_plane():
    depth, mask = plane_depth(ABOVE, *FLOOR), np.ones((48, 64), bool)
    mask &= depth > 0
    mask[:3] = False
    up = np.broadcast_to(np.array([0.0, 0, 1]), (48, 64, 3))
    for winding in (1, -1):  # a scaffold wound the other way is turned to the camera
        exact = normal_error(depth, ABOVE, winding * up, mask)
        np.testing.assert_allclose([exact.cosine, exact.angle], [1, 0], atol=2e-3)
    tilt = np.radians(10)
    tilted = np.broadcast_to(np.array([0.0, np.sin(tilt), np.cos(tilt)]), (48, 64, 3))
    error = normal_error(depth, ABOVE, tilted, mask)
    np.testing.assert_allclose([error.cosine, error.angle], [np.cos(tilt), 10], atol=2e-3)
    assert np.isnan(normal_error(depth, ABOVE, up, mask & False).angle)


def test_one_surface_leaves_out_borders_edges_and_bends():
    group = np.zeros((8, 10), np.int32)
    normal = np.zeros((8, 10, 3))
    normal[..., 2] = 1
    whole = one_surface(group, normal)
    assert whole[1:-1, 1:-1].all() and not whole[0].any() and not whole[:, -1].any()
    group[:, 5:] = 1
    np.testing.assert_array_equal(np.flatnonzero(one_surface(group, normal)[3]), [1, 2, 3, 6, 7, 8])
    bent = normal.copy()
    bent[:, 5:] = [1, 0, 0]
    np.testing.assert_array_equal(one_surface(group * 0, bent), one_surface(group, normal))
    assert not one_surface(group - 5, normal).any() and not one_surface(group[:2], normal[:2]).any()


def share(depth_i, camera_i, depth_j, camera_j):
    masks = shared_pixels(depth_i, camera_i, depth_j, camera_j), shared_pixels(depth_j, camera_j, depth_i, camera_i)
    return overlap(masks[0], depth_i, masks[1], depth_j)


def test_exact_depth_reprojects_without_error_and_a_scaled_one_by_its_scale():
    depth_i, depth_j = plane_depth(ABOVE, *FLOOR), plane_depth(BESIDE, *FLOOR)
    shared = shared_pixels(depth_i, ABOVE, depth_j, BESIDE)
    assert shared.mean() > 0.3 and share(depth_i, ABOVE, depth_j, BESIDE) > 0.3
    exact = reprojection_error(depth_i, ABOVE, depth_j, BESIDE, shared)
    assert exact.pixels == shared.sum()
    np.testing.assert_allclose([exact.absrel, exact.mae_norm], 0, atol=1e-9)
    error = reprojection_error(depth_i, ABOVE, 1.1 * depth_j, BESIDE, shared)
    np.testing.assert_allclose(error.absrel, 0.1 / 1.1, rtol=1e-6)
    assert mutual_pixels(depth_i, ABOVE, depth_j, BESIDE)[shared].all()
    assert mutual_pixels(depth_i, ABOVE, 1.5 * depth_j, BESIDE).sum() < 0.5 * shared.sum()


@pytest.mark.parametrize("step", [1, 2, 3])
def test_every_few_pixels_are_the_same_rays(step):
    depth = plane_depth(ABOVE, *FLOOR)
    some, camera_of_some = every(step, depth, ABOVE)
    np.testing.assert_allclose(plane_depth(camera_of_some, *FLOOR), some, rtol=1e-9)


def test_an_occluder_and_the_other_way_round_are_not_shared():
    depth_i, depth_j = plane_depth(ABOVE, *FLOOR), plane_depth(BESIDE, *FLOOR)
    assert not shared_pixels(depth_i, ABOVE, 0.5 * depth_j, BESIDE).any()
    away = camera((-4, 0, 2), (-5.5, 0.4, 0))
    assert share(depth_i, ABOVE, plane_depth(away, *FLOOR), away) == 0
    nothing = reprojection_error(depth_i, ABOVE, plane_depth(away, *FLOOR), away, np.ones((48, 64), bool))
    assert nothing.pixels == 0 and np.isnan(nothing.absrel)
    empty = np.zeros_like(depth_i)
    assert share(empty, ABOVE, depth_j, BESIDE) == 0 and not mutual_pixels(empty, ABOVE, depth_j, BESIDE).any()


def test_overlap_with_itself_is_whole_but_for_the_rim():
    depth = plane_depth(ABOVE, *FLOOR)
    assert share(depth, ABOVE, depth, dataclasses.replace(ABOVE)) > 0.85
