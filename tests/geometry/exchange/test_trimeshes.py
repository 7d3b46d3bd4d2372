"""What trimesh is handed is the same surface, with its labels."""

import dataclasses

import numpy as np
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.mesh.test_scene_mesh import wedge
from tests.geometry.plans import random_plan, two_rooms
from wm.geometry import assemble_scene, build_structure, object_to_trimesh
from wm.types import Texture


@given(st.integers(0, 1000))
def test_a_scaffold_keeps_its_vertices_faces_and_labels(seed):
    mesh = assemble_scene(build_structure(random_plan(seed, 3)), [wedge(seed)])
    found = mesh.to_trimesh()
    np.testing.assert_array_equal(found.vertices, mesh.vertices)
    np.testing.assert_array_equal(found.faces, mesh.faces)
    for key, labels in {"room": mesh.face_room, "kind": mesh.face_kind, "object": mesh.face_object}.items():
        np.testing.assert_array_equal(found.face_attributes[key], labels)


def test_trimesh_finds_a_building_closed():
    assert build_structure(two_rooms()).to_trimesh().is_watertight


@given(st.integers(0, 1000))
def test_a_plain_object_has_the_colour_of_its_slot_at_every_corner(seed):
    thing = wedge(seed)
    found = object_to_trimesh(thing)
    np.testing.assert_array_equal(found.vertices[found.faces], thing.vertices[thing.faces])
    np.testing.assert_array_equal(found.face_attributes["slot"], thing.face_slot)
    wanted = np.round(thing.slot_colors[thing.face_slot] * 255)
    np.testing.assert_array_equal(found.visual.vertex_colors[found.faces][:, :, :3], wanted[:, None].repeat(3, axis=1))


@given(st.integers(0, 1000))
def test_trimesh_reads_the_pixels_of_a_texture_where_we_do(seed):
    rng = np.random.default_rng(seed)
    image = rng.integers(0, 256, (5, 7, 3), np.uint8)
    pixel = rng.integers(0, [7, 5], (4, 3, 2))  # column and row of each corner, at whose centre it looks
    uv = ((pixel + 0.5) / [7, 5]).astype(np.float32)
    thing = dataclasses.replace(wedge(seed), texture=Texture(image=image, corner_uv=uv, slots=np.array([True, False])))
    found = object_to_trimesh(thing)
    colors = trimesh.visual.color.uv_to_color(found.visual.uv, found.visual.material.baseColorTexture)[found.faces][:, :, :3]
    np.testing.assert_array_equal(colors[0], image[pixel[0, :, 1], pixel[0, :, 0]])
    np.testing.assert_array_equal(colors[1:], np.tile(np.round(thing.slot_colors[1] * 255), (3, 3, 1)))
