"""Mesh files: what trimesh or we wrote is read back as the same surface in the same colours; what cannot be used is named."""

import dataclasses
import json
import struct

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tests.geometry.mesh.test_scene_mesh import wedge
from tests.geometry.things import box
from wm.color import to_linear
from wm.errors import InputError
from wm.geometry import MeshError, load_object, object_nodes, object_to_trimesh, save_glb
from wm.geometry.mesh.object_colors import object_colors
from wm.types import SceneObject, Texture

PBR = trimesh.visual.material.PBRMaterial


def surface(thing: SceneObject) -> np.ndarray:
    """[f, 9 + 12] corners of each face and its colours at four points, in an order that no numbering decides."""
    barycentric = np.array([[1, 1], [1, 2], [2, 1], [0.2, 0.3]]) / 4
    face = np.repeat(np.arange(len(thing.faces)), len(barycentric))
    rgb = object_colors([thing], np.zeros(len(face), np.intp), face, np.tile(barycentric, (len(thing.faces), 1)))
    rows = np.concatenate([thing.vertices[thing.faces].reshape(-1, 9), rgb.reshape(len(thing.faces), -1)], axis=1)
    return rows[np.lexsort(np.round(rows[:, :9].T, 4))]


def textured(seed: int, *, plain: bool) -> SceneObject:
    """A wedge with noise on one slot and, unless `plain`, on the other too."""
    rng = np.random.default_rng(seed)
    thing = wedge(seed)
    texture = Texture(
        image=rng.integers(0, 256, (rng.integers(2, 20), rng.integers(2, 20), 3), np.uint8),
        corner_uv=rng.random((len(thing.faces), 3, 2)).astype(np.float32),
        slots=np.array([True, not plain]),
    )
    return dataclasses.replace(thing, texture=texture)


def recolored(seed: int) -> SceneObject:
    return dataclasses.replace(wedge(seed), slot_colors=np.random.default_rng(seed).random((2, 3)).astype(np.float32))


def same(a: SceneObject, b: SceneObject, *, metres: float = 1e-5, color: float = 1.001 / 255) -> None:
    found, wanted = surface(a), surface(b)
    assert found.shape == wanted.shape
    np.testing.assert_allclose(found[:, :9], wanted[:, :9], atol=metres)
    np.testing.assert_allclose(found[:, 9:], wanted[:, 9:], atol=color)


@given(st.integers(0, 10_000), st.sampled_from(["glb", "obj", "ply"]))
def test_what_trimesh_exports_of_an_object_is_that_object(tmp_path_factory, seed, ending):
    thing, path = recolored(seed), tmp_path_factory.mktemp("exchange") / f"thing.{ending}"
    object_to_trimesh(thing).export(path)
    found = load_object(path, label="stool", room=0, up="z")
    same(found, thing)
    assert len(found.vertices) == len(thing.vertices) and len(found.slots) == 2 and found.texture is None


@given(st.integers(0, 10_000), st.booleans(), st.sampled_from(["glb", "obj"]))
def test_textures_survive_trimesh_exporters(tmp_path_factory, seed, plain, ending):
    thing, path = textured(seed, plain=plain), tmp_path_factory.mktemp("exchange") / f"thing.{ending}"
    object_to_trimesh(thing).export(path)
    found = load_object(path, label="stool", room=0, up="z")
    # uv travel as float32 or eight decimals: a pixel of noise read 1e-6 beside its place
    same(found, thing, color=1.5 / 255)
    if not plain:
        np.testing.assert_array_equal(found.texture.image, thing.texture.image)


@given(st.integers(0, 10_000), st.booleans())
def test_our_own_glb_is_read_back_with_its_materials(tmp_path_factory, seed, plain):
    thing = dataclasses.replace(textured(seed, plain=plain), slot_colors=recolored(seed).slot_colors)
    path = tmp_path_factory.mktemp("exchange") / "thing.glb"
    save_glb(path, object_nodes([thing]))
    found = load_object(path, label="stool", room=2, support="ceiling")
    same(found, thing, color=1e-4)
    np.testing.assert_allclose(found.emission, thing.emission, rtol=1e-5)
    np.testing.assert_array_equal(found.texture.slots, thing.texture.slots)
    np.testing.assert_array_equal(found.texture.image, thing.texture.image)
    assert (found.label, found.room, found.support, len(found.slots)) == ("stool", 2, "ceiling", 2)


def test_dark_colours_keep_all_their_bits(tmp_path):
    # 8 bits of linear light, in which trimesh holds a factor, would make 0.02 of sRGB 0 and 0.03 equal to 0.05.
    thing = dataclasses.replace(wedge(0), slot_colors=np.array([[0.02, 0.03, 0.05], [0.01, 0.07, 0.09]], np.float32))
    save_glb(tmp_path / "a.glb", object_nodes([thing]))
    np.testing.assert_allclose(load_object(tmp_path / "a.glb", label="a", room=0).slot_colors, thing.slot_colors, atol=1e-6)


def test_gltf_is_y_up_and_its_front_comes_to_face_us(tmp_path):
    tall = trimesh.creation.box(bounds=[[-1, 0, -0.5], [1, 3, 0.25]])  # 3 high, front at z = 0.25
    tall.export(tmp_path / "a.glb")
    found = load_object(tmp_path / "a.glb", label="wardrobe", room=1)
    np.testing.assert_allclose([found.vertices.min(axis=0), found.vertices.max(axis=0)], [[-1, -0.25, 0], [1, 0.5, 3]])
    np.testing.assert_allclose(found.size, [2, 0.75, 3])
    np.testing.assert_allclose(found.T_world_object[:3, 3], [0, 0.125, 0])
    tall.export(tmp_path / "a.ply")
    as_it_is = load_object(tmp_path / "a.ply", label="wardrobe", room=1)
    np.testing.assert_allclose(as_it_is.size, [2, 3, 0.75])
    same(load_object(tmp_path / "a.ply", label="wardrobe", room=1, up="y"), found, color=1.0)


@given(st.integers(0, 10_000))
def test_all_nodes_are_baked_with_their_transforms(tmp_path_factory, seed):
    rng = np.random.default_rng(seed)
    scene, wanted = trimesh.Scene(), []
    cube = trimesh.creation.box(extents=[0.5, 0.4, 0.3])
    for k in range(3):
        T = trimesh.transformations.rotation_matrix(rng.uniform(0, 6), rng.normal(size=3), rng.uniform(-1, 1, 3))
        T[:3, 3] += 4 * k * np.array([1, 0, 0])
        T[:3, :3] @= np.diag(rng.uniform(0.5, 1.5, 3) * rng.choice([-1, 1], 3))  # mirrored half of the time
        scene.add_geometry(cube, geom_name="cube" if k < 2 else "another", node_name=f"node {k}", transform=T)
        wanted.append(cube.vertices @ T[:3, :3].T + T[:3, 3])
    path = tmp_path_factory.mktemp("exchange") / "scene.glb"
    scene.export(path)
    found = load_object(path, label="three boxes", room=0, up="z")
    wanted = np.concatenate(wanted)
    distance = np.linalg.norm(found.vertices[:, None] - wanted[None], axis=2)
    assert found.vertices.shape == wanted.shape and distance.min(axis=1).max() < 1e-5 and distance.min(axis=0).max() < 1e-5
    mesh = trimesh.Trimesh(found.vertices, found.faces)
    assert mesh.is_watertight and all(part.volume > 0 for part in mesh.split())  # outward also where a transform mirrors


def test_a_closed_surface_that_winds_inward_is_turned_with_its_texture(tmp_path):
    thing = textured(3, plain=False)
    turned = dataclasses.replace(
        thing,
        faces=thing.faces[:, ::-1].copy(),
        texture=dataclasses.replace(thing.texture, corner_uv=thing.texture.corner_uv[:, ::-1].copy()),
    )
    for name, item in (("out", thing), ("in", turned)):
        save_glb(tmp_path / f"{name}.glb", object_nodes([item]))
    out, inward = (load_object(tmp_path / f"{name}.glb", label="stool", room=0) for name in ("out", "in"))
    volume = [trimesh.Trimesh(item.vertices, item.faces).volume for item in (out, inward)]
    assert volume[0] == pytest.approx(volume[1]) and volume[0] > 0
    point = np.full((4, 2), 1 / 3)  # the middle of a face is where both windings agree
    where = np.zeros(4, np.intp), np.arange(4), point
    np.testing.assert_allclose(object_colors([out], *where), object_colors([inward], *where), atol=1e-5)


def quads(uv: np.ndarray, image: np.ndarray, **fields) -> trimesh.Trimesh:
    """A square metre of two triangles in the plane y = 0 with a texture."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], float)
    material = PBR(baseColorTexture=Image.fromarray(image), **({"name": "tiles"} | fields))
    visual = trimesh.visual.TextureVisuals(uv=uv, material=material)
    return trimesh.Trimesh(vertices, [[0, 1, 2], [0, 2, 3]], visual=visual, process=False)


SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)


def colors_at(thing: SceneObject, points: np.ndarray) -> np.ndarray:
    """Colours of the square at (x, z)."""
    rgb = np.zeros((len(points), 3))
    for k, corner in enumerate(thing.vertices[thing.faces][:, :, [0, 2]]):
        uv = np.linalg.solve((corner[1:] - corner[0]).T, (points - corner[0]).T).T
        inside = (uv >= -1e-9).all(axis=1) & (uv.sum(axis=1) <= 1 + 1e-9)
        count = int(inside.sum())
        rgb[inside] = object_colors([thing], np.zeros(count, np.intp), np.full(count, k), uv[inside])
    return rgb


def test_a_texture_that_repeats_is_written_out(tmp_path):
    image = np.random.default_rng(0).integers(0, 256, (4, 8, 3), np.uint8)
    quads(SQUARE * [3, 2] + [5, -7], image).export(tmp_path / "a.glb")
    found = load_object(tmp_path / "a.glb", label="tiles", room=0, up="z")
    assert found.texture.image.shape == (8, 24, 3) and 0 <= found.texture.corner_uv.min() <= found.texture.corner_uv.max() <= 1
    i, j = np.mgrid[0:8, 0:24]
    points = np.stack([(j.ravel() + 0.5) / 24, 1 - (i.ravel() + 0.5) / 8], axis=1)
    wanted = image[i % 4, j % 8].reshape(-1, 3) / 255
    np.testing.assert_allclose(colors_at(found, points), wanted, atol=1e-3)


def test_textures_of_several_materials_share_one_image(tmp_path):
    rng = np.random.default_rng(1)
    images = [rng.integers(0, 256, shape, np.uint8) for shape in ((4, 8, 3), (16, 3, 3))]
    scene = trimesh.Scene()
    for k, image in enumerate(images):
        scene.add_geometry(
            quads(SQUARE, image, name=f"side {k}"), transform=trimesh.transformations.translation_matrix([0, k, 0])
        )
    scene.export(tmp_path / "a.glb")
    found = load_object(tmp_path / "a.glb", label="screen", room=0, up="z")
    for k, image in enumerate(images):
        mine = np.isclose(found.vertices[found.faces][:, :, 1], k).all(axis=1)
        one = dataclasses.replace(
            found,
            faces=found.faces[mine],
            face_slot=found.face_slot[mine],
            texture=dataclasses.replace(found.texture, corner_uv=found.texture.corner_uv[mine]),
        )
        h, w = image.shape[:2]
        i, j = np.mgrid[0:h, 0:w]
        points = np.stack([(j.ravel() + 0.5) / w, 1 - (i.ravel() + 0.5) / h], axis=1)
        np.testing.assert_allclose(colors_at(one, points), image.reshape(-1, 3) / 255, atol=1e-3)
        # the slot's own colour is about that of the texture
        assert np.abs(found.slot_colors[found.slots.index(f"side {k}")] - image.mean(axis=(0, 1)) / 255).max() < 0.4


def test_a_factor_beside_a_texture_multiplies_it_in_linear_light(tmp_path):
    image = np.full((2, 2, 3), 200, np.uint8)
    quads(SQUARE, image, baseColorFactor=[0.5, 1.0, 0.25, 1.0]).export(tmp_path / "a.glb")
    found = load_object(tmp_path / "a.glb", label="screen", room=0)
    factor = np.round(np.array([0.5, 1.0, 0.25]) * 255) / 255  # as trimesh writes it
    np.testing.assert_allclose(to_linear(found.texture.image[0, 0] / 255), to_linear(np.array(200 / 255)) * factor, atol=4e-3)


@given(st.integers(0, 10_000), st.sampled_from(["ply", "obj", "glb"]))
def test_colours_that_blend_across_faces_become_a_texture_of_them(tmp_path_factory, seed, ending):
    rng = np.random.default_rng(seed)
    mesh = trimesh.creation.icosphere(subdivisions=1, radius=0.4)
    mesh.visual.vertex_colors = rng.integers(60, 190, (len(mesh.vertices), 3))  # so that the fourth pixel is not clipped much
    path = tmp_path_factory.mktemp("exchange") / f"ball.{ending}"
    mesh.export(path)
    found = load_object(path, label="ball", room=0, up="z")
    assert found.texture is not None and found.texture.slots.tolist() == [True]
    for vertex, color in zip(mesh.vertices, mesh.visual.vertex_colors[:, :3] / 255):
        k = int(np.argmin(np.linalg.norm(found.vertices - vertex, axis=1)))
        face, corner = np.argwhere(found.faces == k)[0]
        at = np.array([[[0, 0], [1, 0], [0, 1]][corner]], float)
        np.testing.assert_allclose(object_colors([found], np.zeros(1, np.intp), np.array([face]), at)[0], color, atol=2 / 255)


def rewritten(source, target, edit) -> None:
    """A GLB with its JSON changed."""
    data = source.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + size])
    edit(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + size :]
    target.write_bytes(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest)


def test_vertex_colours_are_linear_light_unless_trimesh_wrote_them(tmp_path):
    cube = trimesh.creation.box()
    cube.visual.vertex_colors = [100, 150, 200, 255]
    cube.export(tmp_path / "a.glb")
    rewritten(tmp_path / "a.glb", tmp_path / "b.glb", lambda document: document["asset"].update(generator="another"))
    first, second = (load_object(tmp_path / f"{name}.glb", label="cube", room=0).slot_colors[0] for name in "ab")
    np.testing.assert_allclose(first, np.array([100, 150, 200]) / 255, atol=1e-6)
    np.testing.assert_allclose(to_linear(second), np.array([100, 150, 200]) / 255, atol=4e-3)


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda d: d.update(extensionsRequired=["KHR_draco_mesh_compression"]), "requires KHR_draco_mesh_compression"),
        (lambda d: d["asset"].update(version="1.0"), "glTF 1.0"),
        (lambda d: d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].update(texCoord=1), "second set"),
        (
            lambda d: d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].update(
                extensions={"KHR_texture_transform": {"scale": [2, 2]}}
            ),
            "KHR_texture_transform",
        ),
        (lambda d: (d["textures"][0].update(sampler=0), d.update(samplers=[{"wrapS": 33648}])), "mirrored"),
        (lambda d: (d["textures"][0].update(sampler=0), d.update(samplers=[{"wrapS": 33071}])), "does not repeat"),
        (lambda d: d["images"][0].update(mimeType="image/ktx2"), "decoded"),
        (lambda d: d["meshes"][0]["primitives"][0]["attributes"].pop("TEXCOORD_0"), "no texture coordinates"),
        (lambda d: d["meshes"][0]["primitives"][0].update(mode=0), "no triangles"),
    ],
)
def test_what_is_not_read_of_a_gltf_is_refused_by_name(tmp_path, edit, message):
    quads(SQUARE * 2, np.full((4, 4, 3), 9, np.uint8)).export(tmp_path / "whole.glb")
    load_object(tmp_path / "whole.glb", label="screen", room=0)
    rewritten(tmp_path / "whole.glb", tmp_path / "odd.glb", edit)
    with pytest.raises(MeshError, match=f"odd.glb.*{message}"):
        load_object(tmp_path / "odd.glb", label="screen", room=0)


def test_an_error_of_a_mesh_file_is_one_of_input():
    assert issubclass(MeshError, InputError)


def exported(path, vertices, faces) -> None:
    trimesh.Trimesh(np.array(vertices, float), faces, process=False).export(path)


@pytest.mark.parametrize(
    ("vertices", "message"),
    [
        ([[0, 0, 0], [np.nan, 0, 0], [0, 1, 0]], "not finite"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], "none of its 1 triangles has an area"),
        ([[0, 0, 0], [800, 0, 0], [0, 0, 400]], r"is 800 m across.*`unit`.*0.001 for millimetres"),
        ([[0, 0, 0], [1e-4, 0, 0], [0, 0, 1e-4]], "is 0.0001 m across"),
    ],
)
def test_surfaces_that_no_object_has_are_refused(tmp_path, vertices, message):
    exported(tmp_path / "a.ply", vertices, [[0, 1, 2]])
    with pytest.raises(MeshError, match=f"a.ply.*{message}"):
        load_object(tmp_path / "a.ply", label="thing", room=0)


def test_a_unit_makes_it_metres(tmp_path):
    exported(tmp_path / "a.stl", [[0, 0, 0], [800, 0, 0], [0, 0, 400]], [[0, 1, 2]])
    np.testing.assert_allclose(load_object(tmp_path / "a.stl", label="sheet", room=0, unit=1e-3).size, [0.8, 0, 0.4], rtol=1e-6)


def test_files_that_are_no_mesh_are_named(tmp_path):
    with pytest.raises(MeshError, match=r"no file .*none\.glb"):
        load_object(tmp_path / "none.glb", label="thing", room=0)
    for name in ("a.glb", "a.gltf", "a.ply", "a.obj", "a.nonsense"):
        (tmp_path / name).write_bytes(b"not a mesh at all")
        with pytest.raises(MeshError, match=name):
            load_object(tmp_path / name, label="thing", room=0)


@pytest.mark.parametrize("fields", [{"up": "x"}, {"unit": 0.0}, {"unit": np.inf}, {"label": " "}])
def test_arguments_out_of_order_are_named(tmp_path, fields):
    exported(tmp_path / "a.ply", [[0, 0, 0], [1, 0, 0], [0, 0, 1]], [[0, 1, 2]])
    with pytest.raises(MeshError, match=f"{next(iter(fields))}.*a.ply|a.ply.*{next(iter(fields))}"):
        load_object(tmp_path / "a.ply", **({"label": "thing", "room": 0} | fields))


def test_a_missing_texture_or_material_file_is_an_error_and_not_a_grey_object(tmp_path):
    object_to_trimesh(textured(0, plain=False)).export(tmp_path / "a.obj")
    image = next(tmp_path.glob("*.png"))
    image.rename(tmp_path / "moved")
    with pytest.raises(MeshError, match=f"a.obj refers to {image.name}"):
        load_object(tmp_path / "a.obj", label="thing", room=0)
    next(tmp_path.glob("*.mtl")).unlink()
    with pytest.raises(MeshError, match=r"a.obj refers to .*mtl"):
        load_object(tmp_path / "a.obj", label="thing", room=0)


def test_gltf_and_the_files_beside_it_are_read_or_missed_by_name(tmp_path):
    image = np.arange(4 * 4 * 3, dtype=np.uint8).reshape(4, 4, 3)
    for name, data in quads(SQUARE, image).scene().export(file_type="gltf").items():
        (tmp_path / name).write_bytes(data)
    found = load_object(tmp_path / "model.gltf", label="screen", room=0)
    np.testing.assert_array_equal(found.texture.image, image)
    buffer = next(tmp_path.glob("*.bin"))
    buffer.unlink()
    with pytest.raises(MeshError, match=f"model.gltf refers to {buffer.name}"):
        load_object(tmp_path / "model.gltf", label="screen", room=0)


def test_obj_materials_are_slots_that_glow_as_they_say(tmp_path):
    (tmp_path / "a.mtl").write_text("newmtl wood\nKd 0.6 0.4 0.2\nnewmtl bulb\nKd 0.8 0.8 0.8\nKe 0.8 0.8 0.8\n")
    faces = "usemtl wood\nf 1 2 3 4\nusemtl bulb\nf 1 3 5\n"
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 1\n" + faces)
    found = load_object(tmp_path / "a.obj", label="lamp", room=0)
    order = [found.slots.index(name) for name in ("wood", "bulb")]
    np.testing.assert_allclose(found.slot_colors[order], [[0.6, 0.4, 0.2], [0.8, 0.8, 0.8]], atol=0.5 / 255)
    np.testing.assert_allclose(found.emission[order], [0, 1], atol=0.01)
    assert sorted(np.bincount(found.face_slot).tolist()) == [1, 2]


def test_what_rests_where_goes_by_label_and_size(tmp_path):
    object_to_trimesh(box((0, 0, 0), (0.5, 0.5, 1))).export(tmp_path / "a.ply")
    supports = [load_object(tmp_path / "a.ply", label=label, room=0).support for label in ("armchair", "chandelier")]
    assert supports == ["floor", "ceiling"]
