"""GLB files: read back by another library, and held to the parts of the specification that break viewers."""

import dataclasses
import io
import json
import struct

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tests.geometry.mesh.test_scene_mesh import wedge
from wm.geometry import GlbNode, object_nodes, save_glb
from wm.types import Texture


def read(path) -> tuple[dict, bytes]:
    """The JSON and the binary chunk, by the container's own words."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and size % 4 == 0
    document, rest = json.loads(data[20 : 20 + size]), data[20 + size :]
    if not rest:
        return document, b""
    size, kind = struct.unpack_from("<I4s", rest)
    assert kind == b"BIN\0" and size % 4 == 0 and len(rest) == 8 + size
    return document, rest[8:]


def accessor(document: dict, binary: bytes, index: int) -> np.ndarray:
    entry = document["accessors"][index]
    view = document["bufferViews"][entry["bufferView"]]
    dtype = {5126: "<f4", 5125: "<u4"}[entry["componentType"]]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[entry["type"]]
    assert view["byteOffset"] % 4 == 0 and view["byteLength"] == entry["count"] * width * 4
    return np.frombuffer(binary, dtype, entry["count"] * width, view["byteOffset"]).reshape(entry["count"], width)


def quad(**fields) -> GlbNode:
    """A painting of 2 x 1 m on the wall y = 3, its lower left corner at (1, 3, 1), seen from the side of smaller y."""
    vertices = np.array([[1, 3, 1], [3, 3, 1], [3, 3, 2], [1, 3, 2]], float)
    uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], float)
    pixels = np.arange(4 * 8 * 3, dtype=np.uint8).reshape(4, 8, 3)
    base = {"name": "painting", "vertices": vertices, "faces": np.array([[0, 1, 2], [0, 2, 3]]), "uv": uv, "texture": pixels}
    return GlbNode(**(base | {"unlit": True} | fields))


@given(st.integers(0, 10_000), st.integers(1, 6))
def test_every_accessor_says_what_it_holds(tmp_path_factory, seed, count):
    path = tmp_path_factory.mktemp("glb") / "scene.glb"
    save_glb(path, [*object_nodes([wedge(seed + k) for k in range(count)]), quad()])
    document, binary = read(path)
    assert document["buffers"][0]["byteLength"] == len(binary)
    ends = [view["byteOffset"] + view["byteLength"] for view in document["bufferViews"]]
    assert max(ends) <= len(binary)
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            entry = document["accessors"][primitive["attributes"]["POSITION"]]
            positions = accessor(document, binary, primitive["attributes"]["POSITION"])
            indices = accessor(document, binary, primitive["indices"])
            assert np.isfinite(positions).all()
            np.testing.assert_array_equal(np.float32(entry["min"]), positions.min(axis=0))
            np.testing.assert_array_equal(np.float32(entry["max"]), positions.max(axis=0))
            assert indices.max() < len(positions) and len(indices) % 3 == 0
            assert document["materials"][primitive["material"]]["pbrMetallicRoughness"]["metallicFactor"] == 0


def test_another_library_reads_it_in_metres_and_the_right_way_up(tmp_path):
    save_glb(tmp_path / "scene.glb", [quad()])
    (mesh,) = trimesh.load(tmp_path / "scene.glb").geometry.values()
    # y up: ours (x, y, z) is theirs (x, z, -y), a rotation, so that faces keep their front.
    np.testing.assert_allclose(mesh.bounds, [[1, 1, -3], [3, 2, -3]])
    np.testing.assert_allclose(mesh.face_normals, np.tile([0, 0, 1], (2, 1)), atol=1e-12)


def test_a_texture_is_kept_to_the_byte_and_not_upside_down(tmp_path):
    save_glb(tmp_path / "scene.glb", [quad()])
    document, binary = read(tmp_path / "scene.glb")
    view = document["bufferViews"][document["images"][0]["bufferView"]]
    png = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(png))), quad().texture)
    primitive = document["meshes"][0]["primitives"][0]
    uv = accessor(document, binary, primitive["attributes"]["TEXCOORD_0"])
    positions = accessor(document, binary, primitive["attributes"]["POSITION"])
    assert uv[np.argmax(positions[:, 1] - positions[:, 0])].tolist() == [0, 0]  # upper left corner, first pixel
    assert document["samplers"][0]["wrapS"] == document["samplers"][0]["wrapT"] == 33071
    assert "KHR_materials_unlit" in document["extensionsUsed"]


def test_an_object_is_one_node_with_a_primitive_for_each_material(tmp_path):
    save_glb(tmp_path / "scene.glb", object_nodes([wedge(0), wedge(1), wedge(2, label="lamp")]))
    document, _ = read(tmp_path / "scene.glb")
    assert [node["name"] for node in document["nodes"]] == ["stool 1", "stool 2", "lamp 1"]
    assert [len(mesh["primitives"]) for mesh in document["meshes"]] == [2, 2, 2]
    felt, brass = document["materials"][:2]
    # sRGB 0.8 is 0.6038 in linear light.
    np.testing.assert_allclose(brass["pbrMetallicRoughness"]["baseColorFactor"][0], 0.6038, atol=1e-4)
    assert "emissiveFactor" not in felt and brass["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] == 2


def test_same_nodes_same_bytes_and_shared_textures_are_stored_once(tmp_path):
    pixels = np.zeros((64, 64, 3), np.uint8)
    for name in ("first", "second"):
        save_glb(tmp_path / name, [quad(name="a", texture=pixels), quad(name="b", texture=pixels)])
    assert (tmp_path / "first").read_bytes() == (tmp_path / "second").read_bytes()
    document, _ = read(tmp_path / "first")
    assert len(document["images"]) == 1 and len(document["materials"]) == 2


def test_nothing_is_a_valid_file_too(tmp_path):
    save_glb(tmp_path / "scene.glb", [quad(faces=np.zeros((0, 3), int))])
    document, binary = read(tmp_path / "scene.glb")
    assert binary == b"" and "meshes" not in document


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"vertices": np.full((4, 3), np.nan)}, "vertex"),
        ({"vertices": np.full((4, 3), 1e300)}, "vertex"),
        ({"uv": np.full((4, 2), np.inf)}, "uv"),
        ({"uv": np.zeros((3, 2))}, "uv"),
        ({"uv": None}, "together"),
        ({"texture": None}, "together"),
        ({"texture": np.zeros((4, 4, 3), np.float32)}, "uint8"),
        ({"faces": np.array([[0, 1, 4]])}, "face"),
        ({"faces": np.array([[0, 1, -1]])}, "face"),
        ({"faces": np.array([[0, 1, 2, 3]])}, r"faces must be integers .f, 3.*1, 4"),
        ({"faces": np.array([0, 1, 2])}, "faces must be integers"),
        ({"faces": np.array([[0.0, 1.0, 2.5]])}, "faces must be integers .*float64"),
        ({"faces": np.zeros((0, 4), int)}, "faces must be integers"),
        ({"vertices": np.zeros((4, 2))}, r"vertices must be .v, 3.; they are .4, 2."),
        ({"vertices": np.zeros(12)}, "vertices must be"),
        ({"emission": np.nan}, "emission"),
        ({"base_color": np.array([0, np.nan, 0])}, "base_color"),
    ],
)
def test_broken_nodes_are_named_and_nothing_is_written(tmp_path, fields, message):
    with pytest.raises(ValueError, match=f"'painting'.*{message}"):
        save_glb(tmp_path / "scene.glb", [quad(**fields)])
    assert not (tmp_path / "scene.glb").exists()


def test_a_textured_object_is_lit_and_its_slots_share_one_image(tmp_path):
    thing = wedge(0)
    image = np.arange(4 * 8 * 3, dtype=np.uint8).reshape(4, 8, 3)
    corner_uv = np.random.default_rng(0).random((len(thing.faces), 3, 2)).astype(np.float32)
    textured = dataclasses.replace(thing, texture=Texture(image=image, corner_uv=corner_uv, slots=np.array([True, False])))
    save_glb(tmp_path / "scene.glb", object_nodes([textured]))
    document, binary = read(tmp_path / "scene.glb")
    first, second = document["materials"]
    assert len(document["images"]) == 1 and "KHR_materials_unlit" not in document.get("extensionsUsed", [])
    assert first["pbrMetallicRoughness"]["baseColorTexture"] == {"index": 0}
    assert "baseColorTexture" not in second["pbrMetallicRoughness"]
    primitive = document["meshes"][0]["primitives"][0]
    uv = accessor(document, binary, primitive["attributes"]["TEXCOORD_0"])
    index = accessor(document, binary, primitive["indices"]).ravel()
    np.testing.assert_array_equal(uv[index], corner_uv[thing.face_slot == 0].reshape(-1, 2))
