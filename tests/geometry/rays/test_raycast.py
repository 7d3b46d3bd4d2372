"""Embree against its float64 twin, and the laws of depth, occlusion and misses."""

import dataclasses
import inspect

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.geometry.rays import raycast
from wm.geometry.rays._reference import cast_rays_reference, cast_reference, occluded_reference
from wm.geometry.rays.pinhole import camera_center, camera_rays, make_camera, unproject_depth
from wm.geometry.rays.raycast import build_ray_scene, cast, cast_rays, occluded
from wm.types import Mesh

laws = settings(max_examples=15, deadline=None)
seeds = st.integers(0, 2**32 - 1)


def _mesh(vertices, faces):
    faces = np.asarray(faces, np.int32).reshape(-1, 3)
    label = np.zeros(len(faces), np.int32)
    return Mesh(
        vertices=np.asarray(vertices, np.float64),
        faces=faces,
        face_room=label,
        face_kind=label,
        face_object=label - 1,
    )


def _soup(seed, count=40):
    """Random triangles in a unit box, none of them a sliver."""
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-1.0, 1.0, (8 * count, 3, 3))
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    corners = corners[np.linalg.norm(np.cross(e1, e2), axis=1) > 0.3][:count]
    return _mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)))


def _room(low, high):
    """A box seen from inside: every normal points into it."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return _mesh(corners, faces)


def _rays(seed, count=60):
    rng = np.random.default_rng(seed)
    return rng.uniform(-2.0, 2.0, (count, 3)), rng.normal(size=(count, 3))


def _away_from_edges(mesh, origins, directions):
    """Rays for which no face is within 1e-3 (barycentric) of the decision inside or outside, nor two hits within 1e-4."""
    v0, v1, v2 = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    normal = np.cross(v1 - v0, v2 - v0)
    along = directions @ normal.T
    t = np.sum((v0 - origins[:, None]) * normal, axis=-1) / along
    p = origins[:, None] + t[..., None] * directions[:, None]
    area = np.sum(normal**2, axis=-1)
    u = np.sum(np.cross(p - v0, v2 - v0) * normal, axis=-1) / area
    v = np.sum(np.cross(v1 - v0, p - v0) * normal, axis=-1) / area
    margin = np.minimum(np.minimum(u, v), 1.0 - u - v)
    grazing = np.abs(along) < 1e-2 * np.linalg.norm(normal, axis=1) * np.linalg.norm(directions, axis=1, keepdims=True)
    unclear = (np.abs(margin) < 1e-3) | (grazing & (margin > -1e-1)) | ((np.abs(t) < 1e-3) & (margin > -1e-3))
    hits = np.sort(np.where((margin > 0) & (t > 0), t, np.inf), axis=1)
    tied = np.isfinite(hits[:, 1]) & (hits[:, 1] < hits[:, 0] + 1e-4)
    return ~unclear.any(axis=1) & ~tied


@laws
@given(seeds)
def test_nearest_hits_equal_the_twin(seed):
    mesh = _soup(seed)
    origins, directions = _rays(seed)
    clear = _away_from_edges(mesh, origins, directions)
    assert clear.sum() > 20
    origins, directions = origins[clear], directions[clear]
    fast, slow = cast_rays(build_ray_scene(mesh), origins, directions), cast_rays_reference(mesh, origins, directions)
    np.testing.assert_array_equal(fast.face, slow.face)
    np.testing.assert_array_equal(fast.hit, slow.hit)
    np.testing.assert_allclose(fast.t, slow.t, rtol=1e-4, atol=1e-5)  # float32 origins 1e-7 over a 1e-2 grazing sine
    np.testing.assert_allclose(fast.barycentric, slow.barycentric, atol=1e-4)


@laws
@given(seeds)
def test_occlusion_equals_the_twin_and_the_nearest_hit(seed):
    mesh = _soup(seed)
    origins, directions = _rays(seed)
    clear = _away_from_edges(mesh, origins, directions)
    origins, directions = origins[clear], directions[clear]
    limits = np.random.default_rng(seed).uniform(-2.0, 2.0, len(origins))
    t = cast_rays_reference(mesh, origins, directions).t
    limits = np.where(np.abs(limits - t) < 1e-3, limits + 2e-3, limits)
    limits[:5] = np.nan, -np.inf, np.inf, 0.0, -0.0  # nothing is nearer than NaN, as nothing is nearer than zero
    scene = build_ray_scene(mesh)
    np.testing.assert_array_equal(
        occluded(scene, origins, directions, limits), occluded_reference(mesh, origins, directions, limits)
    )
    np.testing.assert_array_equal(occluded(scene, origins, directions), cast_rays(scene, origins, directions).hit)
    for limit in (-0.5, -np.inf, np.nan, 0.0):
        assert not occluded(scene, origins, directions, limit).any()


def test_the_gbuffer_equals_the_twin_and_unprojects_onto_its_faces():
    mesh = _soup(3, count=60)
    camera = make_camera(np.array([0.1, -2.5, 0.3]), np.zeros(3), width=40, height=30, fov_deg=50.0)
    fast, slow = cast(mesh, camera), cast_reference(mesh, camera)
    clear = _away_from_edges(mesh, np.tile(camera_center(camera), (1200, 1)), camera_rays(camera)).reshape(30, 40)
    assert clear.mean() > 0.8 and slow.hit[clear].mean() > 0.3
    for name, tolerance in {"depth": 1e-5, "normal": 1e-6, "face": 0, "barycentric": 1e-4, "hit": 0}.items():
        np.testing.assert_allclose(getattr(fast, name)[clear], getattr(slow, name)[clear], atol=tolerance, err_msg=name)
    hit = fast.hit
    u, v = fast.barycentric[hit].T.astype(np.float64)
    v0, v1, v2 = (mesh.vertices[mesh.faces[fast.face[hit], k]] for k in range(3))
    points = (1 - u - v)[:, None] * v0 + u[:, None] * v1 + v[:, None] * v2
    np.testing.assert_allclose(unproject_depth(camera, fast.depth.astype(np.float64))[hit], points, atol=1e-5)


def test_a_closed_room_is_seen_everywhere_and_from_inside():
    mesh = _room((0.0, 0.0, 0.0), (4.0, 5.0, 2.5))
    camera = make_camera(np.array([1.0, 1.0, 1.6]), np.array([3.0, 4.0, 1.0]), width=64, height=40, fov_deg=80.0)
    gbuffer = cast(mesh, camera)
    assert gbuffer.hit.all()
    directions = camera_rays(camera).reshape(40, 64, 3)
    assert (np.sum(gbuffer.normal * directions, axis=-1) < 0).all()
    p = unproject_depth(camera, gbuffer.depth.astype(np.float64))
    on_wall = np.min([np.abs(p - [0, 0, 0]), np.abs(p - [4.0, 5.0, 2.5])], axis=(0, -1))
    assert on_wall.max() < 1e-5


@settings(max_examples=10, deadline=None)
@given(st.floats(-np.pi, np.pi), st.tuples(*[st.floats(-100.0, 100.0)] * 3))
def test_depth_does_not_change_when_scene_and_camera_move_together(angle, shift):
    mesh = _room((0.0, 0.0, 0.0), (4.0, 5.0, 2.5))
    eye, target = np.array([1.0, 1.2, 1.6]), np.array([3.1, 4.0, 1.0])
    r = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    moved = dataclasses.replace(mesh, vertices=mesh.vertices @ r.T + shift)
    size = {"width": 24, "height": 16, "fov_deg": 60.0}
    here = cast(mesh, make_camera(eye, target, **size))
    there = cast(moved, make_camera(r @ eye + shift, r @ target + shift, **size))
    np.testing.assert_allclose(there.depth, here.depth, atol=2e-5)
    same = there.face == here.face  # a ray through an edge may take either side
    assert same.mean() > 0.98
    np.testing.assert_allclose(there.normal[same], (here.normal @ r.T)[same], atol=1e-5)


def test_far_from_the_origin_depth_keeps_its_digits():
    shift = np.array([1e5, -1e5, 0.0])
    mesh = _room((0.0, 0.0, 0.0), (4.0, 5.0, 2.5))
    moved = dataclasses.replace(mesh, vertices=mesh.vertices + shift)
    eye, target = np.array([1.0, 1.2, 1.6]), np.array([3.1, 4.0, 1.0])
    size = {"width": 24, "height": 16, "fov_deg": 60.0}
    near, far = cast(mesh, make_camera(eye, target, **size)), cast(moved, make_camera(eye + shift, target + shift, **size))
    np.testing.assert_allclose(far.depth, near.depth, atol=1e-5)


def test_misses_have_the_documented_values():
    mesh = _mesh([[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [0.0, 1.0, 5.0]], [[0, 1, 2]])
    scene = build_ray_scene(mesh)
    origins = np.tile([[0.2, 0.2, 0.0]], (3, 1))
    hits = cast_rays(scene, origins, np.array([[0.0, 0.0, 2.0], [0.0, 0.0, -1.0], [np.nan, 0.0, 1.0]]))
    np.testing.assert_allclose(hits.t, [2.5, np.inf, np.inf], rtol=1e-6)
    assert hits.face.tolist() == [0, -1, -1] and hits.hit.tolist() == [True, False, False]
    assert (hits.barycentric[1:] == 0).all()
    gbuffer = cast(scene, make_camera(np.zeros(3), np.array([1.0, 0.0, 0.0]), width=5, height=3, fov_deg=30.0))
    assert not gbuffer.hit.any() and (gbuffer.depth == 0).all() and (gbuffer.face == -1).all()
    assert (gbuffer.normal == 0).all() and (gbuffer.barycentric == 0).all()


def test_a_mesh_without_faces_is_never_hit():
    scene = build_ray_scene(_mesh(np.zeros((0, 3)), np.zeros((0, 3))))
    ray = np.zeros((2, 3)), np.ones((2, 3))
    assert not cast_rays(scene, *ray).hit.any() and not occluded(scene, *ray).any()
    assert not cast_rays_reference(scene.mesh, *ray).hit.any()
    assert not cast(scene, make_camera(np.zeros(3), np.ones(3), width=3, height=2, fov_deg=60.0)).hit.any()


def test_a_mesh_may_be_given_for_its_scene():
    mesh = _soup(2)
    scene, rays = build_ray_scene(mesh), _rays(2)
    np.testing.assert_array_equal(cast_rays(mesh, *rays).t, cast_rays(scene, *rays).t)
    np.testing.assert_array_equal(occluded(mesh, *rays, 1.0), occluded(scene, *rays, 1.0))


def test_no_rays_are_no_hits():
    scene = build_ray_scene(_soup(1))
    assert len(cast_rays(scene, np.zeros((0, 3)), np.zeros((0, 3))).t) == 0
    assert len(occluded(scene, np.zeros((0, 3)), np.zeros((0, 3)))) == 0


def test_wrong_shapes_and_broken_meshes_are_refused():
    scene = build_ray_scene(_soup(1))
    for query in (cast_rays, occluded):
        with pytest.raises(ValueError, match="one shape"):
            inspect.unwrap(query)(scene, np.zeros((4, 3)), np.ones((3, 3)))  # past jaxtyping, as a user calls it
    for limits in (np.ones(3), np.ones((4, 1))):
        with pytest.raises(ValueError, match="max_distance"):
            inspect.unwrap(occluded)(scene, np.zeros((4, 3)), np.ones((4, 3)), limits)
    broken = _soup(1)
    broken.vertices[0, 0] = np.nan
    with pytest.raises(ValueError):
        build_ray_scene(broken)
    with pytest.raises(ValueError):
        build_ray_scene(_mesh(np.eye(3), [[0, 1, 3]]))


def test_the_number_of_threads_and_the_chunks_do_not_matter(monkeypatch):
    scene = build_ray_scene(_soup(5, count=200))
    camera = make_camera(np.array([0.1, -2.5, 0.3]), np.zeros(3), width=90, height=70, fov_deg=50.0)
    origins, directions = _rays(5, count=3000)
    limits = np.linspace(0.0, 3.0, 3000)
    once = cast(scene, camera), cast_rays(scene, origins, directions), occluded(scene, origins, directions, limits)
    monkeypatch.setattr(raycast, "_CHUNK", 500)
    monkeypatch.setattr(raycast, "cores", lambda: 5)
    again = cast(scene, camera), cast_rays(scene, origins, directions), occluded(scene, origins, directions, limits)
    for name in ("depth", "normal", "face", "barycentric", "hit"):
        np.testing.assert_array_equal(getattr(once[0], name), getattr(again[0], name))
    for name in ("t", "face", "barycentric", "hit"):
        np.testing.assert_array_equal(getattr(once[1], name), getattr(again[1], name))
    np.testing.assert_array_equal(once[2], again[2])
