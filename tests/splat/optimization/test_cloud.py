"""Laws of the initial cloud: it lies on the surface, as dense as asked, whatever the order of the views."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.splat.rooms import SIZE, look, views_of
from wm.schema import FitSettings
from wm.splat.optimization.cloud import (
    SH_C0,
    Cloud,
    depth_normals,
    extended,
    initial_gaussians,
    one_a_cell,
    quats_from_normals,
    surface_cloud,
    vacant,
)


def rotate(quats, v):
    w, u = quats[:, :1], quats[:, 1:]
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


def wall_distance(points):
    return np.minimum(np.abs(points), np.abs(points - np.array(SIZE))).min(axis=1)


def test_points_lie_on_the_walls_with_their_normals_and_colours():
    cloud = surface_cloud(views_of(), 0.3)
    assert wall_distance(cloud.points).max() < 1e-5
    inside = cloud.points + 0.1 * cloud.normals
    assert ((inside > 0) & (inside < SIZE)).all()
    shade = 0.5 + 0.2 * np.sin(3 * cloud.points + np.array([0.0, 1.0, 2.0])) + 0.1 * cloud.normals.sum(-1, keepdims=True)
    np.testing.assert_allclose(cloud.colors, shade, atol=0.03)  # a cell averages the shade over 0.3 m


@pytest.mark.parametrize("spacing", [0.15, 0.3])
def test_one_point_a_cell(spacing):
    views = views_of(width=160, height=96)
    points = surface_cloud(views, spacing).points
    floor = points[points[:, 2] < 1e-3, :2]
    area = len(floor) * spacing**2
    seen = np.ptp(floor, axis=0)
    assert 0.4 * seen.prod() < area < 1.3 * seen.prod()


def test_detail_is_gathered_in_its_own_finer_cells():
    views = [dataclasses.replace(view, detailed=view.depth < np.median(view.depth)) for view in views_of(width=160, height=96)]
    cloud = surface_cloud(views, 0.3, 0.1)
    plain = [dataclasses.replace(view, detailed=None) for view in views]
    coarse, fine = surface_cloud(plain, 0.3), surface_cloud(plain, 0.1)
    assert set(cloud.spacings) == {0.3, 0.1} and (coarse.spacings == 0.3).all()
    assert len(coarse.points) < len(cloud.points) < len(coarse.points) + len(fine.points)
    assert wall_distance(cloud.points).max() < 1e-5
    both = initial_gaussians(views, settings=FitSettings(spacing=0.3, detail_spacing=0.1), rng=np.random.default_rng(0))
    size = np.where(cloud.spacings == 0.3, 0.65, 0.5) * cloud.spacings
    np.testing.assert_allclose(np.exp(both.log_scales[:, 0]), size, rtol=1e-6)


def test_the_near_side_of_a_silhouette_counts_as_detail():
    view = views_of()[0]
    depth = np.full_like(view.depth, 3.0)
    depth[:, : depth.shape[1] // 2] = 1.0
    fine = surface_cloud([dataclasses.replace(view, depth=depth, own=None)], 0.3, 0.1).spacings == 0.1
    points = surface_cloud([dataclasses.replace(view, depth=depth, own=None)], 0.3, 0.1).points
    z = points @ view.camera.T_cam_world[2, :3] + view.camera.T_cam_world[2, 3]
    assert fine.any() and (z[fine] < 1.5).all() and (z[~fine] < 1.5).any()


def test_order_of_views_changes_nothing_but_rounding_and_the_same_views_give_the_same_bytes():
    views = views_of()
    a, b, again = (surface_cloud(v, 0.3) for v in (views, views[::-1], views))
    np.testing.assert_allclose(a.points, b.points, atol=1e-9)
    assert a.points.tobytes() == again.points.tobytes() and a.colors.tobytes() == again.colors.tobytes()


def test_only_own_pixels_with_a_scaffold_make_points():
    views = views_of(room=0, rooms=2)
    assert surface_cloud(views, 0.3).points[:, 0].max() <= SIZE[0] + 1e-6
    everything = [dataclasses.replace(view, own=None) for view in views]
    assert surface_cloud(everything, 0.3).points[:, 0].max() > SIZE[0] + 0.5
    nothing = [dataclasses.replace(view, depth=np.zeros_like(view.depth)) for view in views]
    assert len(surface_cloud(nothing, 0.3).points) == 0
    assert len(initial_gaussians(nothing, settings=FitSettings(), rng=np.random.default_rng(0)).means) == 0


def test_masked_pixels_give_geometry_and_no_colour():
    views = views_of()
    red = dataclasses.replace(views[0], rgb=np.full_like(views[0].rgb, (255, 0, 0)), mask=np.zeros_like(views[0].mask))
    a, b = surface_cloud(views, 0.3), surface_cloud([red, *views[1:]], 0.3)
    np.testing.assert_array_equal(a.points, b.points)
    assert np.abs(a.colors - b.colors).max() < 0.5 and (b.colors[:, 0] < 0.95).all()


def part_of(cloud, which):
    return Cloud(**{field.name: getattr(cloud, field.name)[which] for field in dataclasses.fields(Cloud)})


@given(st.floats(0.5, 3.5))
def test_what_a_cloud_leaves_bare_is_found_once_a_cell_and_covered_in_the_colours_around(cut):
    cloud = surface_cloud(views_of(), 0.3)
    assert not len(vacant(cloud, cloud.points, cloud.normals, cloud.spacings))
    kept = part_of(cloud, cloud.points[:, 0] < cut)
    twice = part_of(cloud, np.tile(np.arange(len(cloud.points)), 2))
    bare = vacant(kept, twice.points, twice.normals, twice.spacings)
    turned = np.linalg.norm(twice.normals[:, None] - kept.normals, axis=-1)
    away = np.hypot(np.linalg.norm(twice.points[:, None] - kept.points, axis=-1), 0.3 * turned).min(axis=1, initial=np.inf)
    np.testing.assert_array_equal(bare, np.flatnonzero(away > 0.3))
    bare = bare[one_a_cell(twice.points[bare], twice.normals[bare], twice.spacings[bare])]
    np.testing.assert_array_equal(bare, np.flatnonzero(away[: len(cloud.points)] > 0.3))
    more = dataclasses.replace(part_of(cloud, bare), colors=np.full((len(bare), 3), np.nan))
    whole = extended(kept, more)
    assert len(whole.points) == len(kept.points) + len(bare)
    np.testing.assert_array_equal(whole.colors[: len(kept.points)], kept.colors)
    assert (whole.colors >= kept.colors.min(0) - 1e-9).all() and (whole.colors <= kept.colors.max(0) + 1e-9).all()
    told = extended(kept, dataclasses.replace(more, colors=np.full((len(bare), 3), 0.25)))
    assert (told.colors[len(kept.points) :] == 0.25).all()


def test_bare_detail_is_covered_in_its_own_finer_cells():
    cloud = surface_cloud(views_of(), 0.3)
    away = np.array([10.0, 0.0, 0.0])
    rng = np.random.default_rng(0)
    points = away + rng.random((2000, 3)) * [0.6, 0.6, 0.0]
    normals = np.tile([0.0, 0.0, 1.0], (2000, 1))
    fine = np.where(np.arange(2000) < 1000, 0.1, 0.3)
    bare = vacant(cloud, points, normals, fine)
    assert len(bare) == len(points)
    bare = one_a_cell(points, normals, fine)
    assert (bare < 1000).sum() in range(36, 50) and (bare >= 1000).sum() in range(4, 10)


def test_far_coordinates_are_refused_with_the_reach():
    view = views_of()[0]
    far = view.camera.T_cam_world.copy()
    far[:3, 3] -= far[:3, :3] @ np.array([1e6, 0, 0])
    moved = dataclasses.replace(view, camera=dataclasses.replace(view.camera, T_cam_world=far))
    with pytest.raises(ValueError, match="from the origin"):
        surface_cloud([moved], 0.01)
    with pytest.raises(ValueError, match="spacing"):
        surface_cloud([view], 0.0)


@given(st.integers(0, 99))
def test_quats_take_z_to_the_normal(seed):
    normals = np.random.default_rng(seed).normal(size=(5, 3))
    normals = np.concatenate([normals / np.linalg.norm(normals, axis=1, keepdims=True), [[0, 0, 1], [0, 0, -1], [1, 0, 0]]])
    quats = quats_from_normals(normals)
    np.testing.assert_allclose(np.linalg.norm(quats, axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(rotate(quats, np.array([[0.0, 0, 1]])), normals, atol=1e-9)


def test_normals_from_depth_agree_with_the_walls_up_to_the_edge():
    view = look([1.0, 1.0, 1.3], [3.0, 2.0, 0.8], width=160, height=96)
    cosine = (depth_normals(view) * view.normal).sum(-1)
    assert (cosine > 0.999).mean() > 0.97
    empty = dataclasses.replace(view, depth=np.zeros_like(view.depth))
    np.testing.assert_allclose(np.linalg.norm(depth_normals(empty), axis=-1), 1, atol=1e-9)


def test_the_variants_share_count_and_differ_as_they_say():
    views, settings = views_of(), FitSettings(spacing=0.3, sh_degree=1)
    flat, ball, random = (
        initial_gaussians(views, settings=dataclasses.replace(settings, init=name), rng=np.random.default_rng(0))
        for name in ("flat", "isotropic", "random")
    )
    assert flat.means.shape == ball.means.shape == random.means.shape and flat.sh.shape[1:] == (4, 3)
    assert np.ptp(ball.log_scales) == 0 and np.ptp(flat.log_scales) > 1
    np.testing.assert_array_equal(flat.means, ball.means)
    normals = rotate(flat.quats.astype(float), np.array([[0.0, 0, 1]]))
    assert ((flat.means + 0.1 * normals > 0) & (flat.means + 0.1 * normals < SIZE)).all()
    assert wall_distance(random.means).max() > 0.5
    assert (random.means >= flat.means.min(0)).all() and (random.means <= flat.means.max(0)).all()
    colors = 0.5 + SH_C0 * flat.sh[:, 0]
    assert ((colors >= 0) & (colors <= 1)).all() and not flat.sh[:, 1:].any()
    with pytest.raises(ValueError, match=r"fit\.init 'round' is unknown; one of flat, isotropic, random"):
        initial_gaussians(views, settings=dataclasses.replace(settings, init="round"), rng=np.random.default_rng(0))


def test_spare_gaussians_come_with_refinement_and_no_view_shows_them():
    views, settings = views_of(), FitSettings(spacing=0.3, refine_spare=0.25)
    plain, refined = (
        initial_gaussians(views, settings=dataclasses.replace(settings, refine_every=every), rng=np.random.default_rng(0))
        for every in (0, 10)
    )
    n, spare = len(plain.means), len(refined.means) - len(plain.means)
    assert spare == n // 4
    np.testing.assert_array_equal(refined.means[:n], plain.means)
    np.testing.assert_array_equal(refined.opacity_logits[:n], plain.opacity_logits)
    assert (1 / (1 + np.exp(-refined.opacity_logits[n:].astype(float))) < 1e-9).all()


def test_a_view_whose_arrays_do_not_fit_its_camera_is_refused():
    view = views_of()[0]
    with pytest.raises(ValueError, match="depth has shape"):
        dataclasses.replace(view, depth=view.depth[:-1])
    with pytest.raises(ValueError, match="uint8"):
        dataclasses.replace(view, rgb=view.rgb / 255.0)
