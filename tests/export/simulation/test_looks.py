"""What a house looks like: painted textures come back to the faces they were painted on, objects keep their colours."""

import numpy as np
import pytest

from tests.export.simulation.houses import objects, paint, shade, write_run
from wm.export.simulation.bodies import rigid_body
from wm.export.simulation.looks import body_appearance, house_parts
from wm.export.simulation.wavefront import obj_files
from wm.types import SurfaceKind, Texture


def looked_up(image, uv):
    """The pixels [n, 3] in [0, 1] at places [n, 2] of an image, v downward."""
    size = np.array([image.shape[1], image.shape[0]])
    column, row = np.clip((uv * size).astype(int), 0, size - 1).T
    return image[row, column] / 255


@pytest.fixture
def run(tmp_path):
    return write_run(tmp_path / "run")


def test_every_face_of_the_structure_is_in_one_part(run):
    parts = house_parts(run)
    assert sorted(np.concatenate([part.faces for part in parts]).tolist()) == list(range(len(run.structure.faces)))
    assert all(look.texture is None and not look.unlit for part in parts for look in part.looks)


def test_painted_surfaces_have_the_colours_of_their_place(run):
    paint(run)
    for part in house_parts(run):
        if part.kind == SurfaceKind.EXTERIOR:
            assert [look.texture for look in part.looks] == [None]
            continue
        for look in part.looks:
            assert look.unlit
            middle = look.vertices[look.faces].mean(axis=1)
            seen = looked_up(look.texture.image, look.texture.corner_uv.mean(axis=1))
            np.testing.assert_allclose(seen, shade(middle), atol=0.03)


def parsed(text):
    """Corners [f, 3, 3] and texture coordinates [f, 3, 2], v downward, of an OBJ."""
    rows = [line.split() for line in text.splitlines()]
    v, vt = (np.array([[float(x) for x in row[1:]] for row in rows if row[0] == word]) for word in ("v", "vt"))
    index = np.array([[[int(x) - 1 for x in corner.split("/")] for corner in row[1:]] for row in rows if row[0] == "f"])
    return v[index[..., 0]], vt[index[..., 1]] * [1, -1] + [0, 1]


def test_an_obj_has_every_triangle_in_its_colour():
    look = body_appearance(rigid_body(objects()[0]))
    files = obj_files(look, "table")
    (mesh,) = files.meshes
    corners, uv = parsed(mesh.obj)
    np.testing.assert_allclose(corners, look.vertices[look.faces], atol=1e-6)
    np.testing.assert_allclose(looked_up(files.image, uv[:, 0]), look.slot_colors[look.face_slot], atol=1 / 255)


def test_what_glows_is_a_mesh_of_its_own():
    look = body_appearance(rigid_body(objects()[4]))
    assert [mesh.glow for mesh in obj_files(look, "lamp").meshes] == [1.5]


def test_an_obj_of_textured_and_plain_faces_has_both_in_one_image(run):
    thing = objects()[0]
    image = np.random.default_rng(0).integers(0, 255, (5, 7, 3), np.uint8)
    uv = np.random.default_rng(1).uniform(0, 1, (len(thing.faces), 3, 2)).astype(np.float32)
    look = body_appearance(rigid_body(thing))
    textured = np.array([True, False, True, False, False])
    mixed = type(look)(**{**vars(look), "texture": Texture(image=image, corner_uv=uv, slots=textured)})
    files = obj_files(mixed, "table")
    _, places = parsed(files.meshes[0].obj)
    mine = textured[thing.face_slot]
    np.testing.assert_allclose(
        looked_up(files.image, places[mine].reshape(-1, 2)), looked_up(image, uv[mine].reshape(-1, 2)), atol=1 / 255
    )
    np.testing.assert_allclose(
        looked_up(files.image, places[~mine][:, 0]), look.slot_colors[thing.face_slot[~mine]], atol=1 / 255
    )
