"""Scene meshes: labels survive assembly, boxes bound their objects, broken meshes are named."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import two_rooms
from wm.geometry import assemble_scene, build_structure, check_mesh, face_normals, object_boxes
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.types import OUTSIDE, Mesh, SceneObject, SurfaceKind


def wedge(seed: int, label: str = "stool", room: int = 0) -> SceneObject:
    """A tetrahedron of two materials, somewhere, turned about z."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(-np.pi, np.pi)
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    pose[:3, 3] = rng.uniform(1, 3, 3)
    local = np.array([[-0.3, -0.2, 0], [0.3, -0.2, 0], [0, 0.2, 0], [0, 0, 0.5]])
    return SceneObject(
        label=label,
        room=room,
        support="floor",
        vertices=local @ pose[:3, :3].T + pose[:3, 3],
        faces=np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.int32),
        face_slot=np.array([0, 1, 1, 1], np.int32),
        slots=("felt", "brass"),
        slot_colors=np.array([[0.1, 0.2, 0.3], [0.8, 0.7, 0.2]], np.float32),
        T_world_object=pose,
        size=np.array([0.6, 0.4, 0.5]),
        emission=np.array([0.0, 2.0], np.float32),
    )


def test_a_scene_is_its_structure_followed_by_its_objects():
    structure, things = build_structure(two_rooms()), [wedge(0), wedge(1, room=1)]
    scene = assemble_scene(structure, things)
    check_mesh(scene)
    count = len(structure.faces)
    np.testing.assert_array_equal(scene.vertices[scene.faces[:count]], structure.vertices[structure.faces])
    np.testing.assert_array_equal(scene.face_room[count:], [0] * 4 + [1] * 4)
    np.testing.assert_array_equal(scene.face_object, [OUTSIDE] * count + [0] * 4 + [1] * 4)
    assert (scene.face_kind[count:] == SurfaceKind.OBJECT).all()
    for index, thing in enumerate(things):
        np.testing.assert_array_equal(scene.vertices[scene.faces[scene.face_object == index]], thing.vertices[thing.faces])


def test_a_scene_without_objects_is_its_structure():
    structure = build_structure(two_rooms())
    scene = assemble_scene(structure, [])
    for field in dataclasses.fields(Mesh):
        np.testing.assert_array_equal(getattr(scene, field.name), getattr(structure, field.name))


@given(st.integers(0, 1000))
def test_a_box_bounds_its_object_tightly_and_faces_out(seed):
    thing = wedge(seed)
    (box,) = object_boxes([thing])
    np.testing.assert_allclose(box.size, thing.size, atol=1e-12)
    corners = box.vertices[box.faces]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.sum(corners[:, 0] * outward) / 6 == pytest.approx(0.6 * 0.4 * 0.5)  # volume, by the divergence theorem
    middle = box.vertices.mean(axis=0)
    assert (np.sum((corners.mean(axis=1) - middle) * outward, axis=1) > 0).all()
    inverse = np.linalg.inv(box.T_world_object)
    local = box.vertices @ inverse[:3, :3].T + inverse[:3, 3]
    np.testing.assert_allclose(local.min(axis=0), [-0.3, -0.2, 0], atol=1e-12)
    assert (box.label, box.room, box.support) == (thing.label, thing.room, thing.support)


def test_normals_are_unit_and_zero_without_area():
    mesh = build_structure(two_rooms())
    np.testing.assert_allclose(np.linalg.norm(face_normals(mesh), axis=1), 1)
    flat = dataclasses.replace(mesh, faces=np.zeros_like(mesh.faces))
    np.testing.assert_array_equal(face_normals(flat), 0)


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("vertices", np.nan, "vertex 5"),
        ("vertices", np.inf, "vertex 5"),
        ("faces", -1, "face 5"),
        ("faces", 10**6, "face 5"),
        ("face_kind", 99, "face_kind"),
        ("face_room", -2, "face_room"),
        ("face_object", -2, "face_object"),
    ],
)
def test_broken_meshes_are_named(field, value, message):
    mesh = build_structure(two_rooms())
    array = getattr(mesh, field).copy()
    array[5] = value
    with pytest.raises(ValueError, match=message):
        check_mesh(dataclasses.replace(mesh, **{field: array}))


def test_a_broken_object_is_named():
    broken = dataclasses.replace(wedge(0), vertices=np.full((4, 3), np.nan))
    with pytest.raises(ValueError, match=r"object 1 \(stool\)"):
        assemble_scene(build_structure(two_rooms()), [wedge(0), broken])


@given(st.integers(0, 2**16))
def test_crosses_are_normal_to_their_edges_keep_under_turning_corners_and_cancel_over_a_closed_surface(seed):
    rng = np.random.default_rng(seed)
    corners = rng.normal(size=(7, 3, 3))
    crosses = face_crosses(corners)
    np.testing.assert_allclose(np.einsum("fi,fki->fk", crosses, corners - corners[:, :1]), 0, atol=1e-12)
    np.testing.assert_allclose(face_crosses(np.roll(corners, 1, axis=1)), crosses, atol=1e-12)
    np.testing.assert_allclose(face_crosses(3 * corners), 9 * crosses, atol=1e-12)
    thing = wedge(seed)
    np.testing.assert_allclose(face_crosses(thing.vertices[thing.faces]).sum(axis=0), 0, atol=1e-12)
