"""KHR_gaussian_splatting as its specification has it, beside meshes, below nodes, and refused where it is not plain."""

import numpy as np
import pytest

from tests.splat.ply.files import some
from wm.geometry import save_glb
from wm.geometry.mesh.glb import GlbNode
from wm.splat.formats import SplatFileError, load_splats, save_gltf_splats
from wm.splat.formats.glb_file import GlbFile, glb_bytes, parse_glb
from wm.splat.formats.gltf_splats import NAME, with_gaussians
from wm.splat.formats.turning import turned


def written(tmp_path, gaussians, change):
    """The file of gaussians after a change of its document, read again."""
    path = tmp_path / "a.glb"
    save_gltf_splats(path, gaussians)
    glb = parse_glb("a.glb", path.read_bytes())
    change(glb.document)
    path.write_bytes(glb_bytes(glb))
    return load_splats(path)


def test_attributes_are_those_of_the_specification(tmp_path):
    gaussians = some(3, 4)
    save_gltf_splats(tmp_path / "a.glb", gaussians)
    document = parse_glb("a.glb", (tmp_path / "a.glb").read_bytes()).document
    (primitive,) = document["meshes"][0]["primitives"]
    assert primitive["mode"] == 0 and document["extensionsUsed"] == [NAME]
    assert primitive["extensions"][NAME] == {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}
    shapes = {name: document["accessors"][index]["type"] for name, index in primitive["attributes"].items()}
    assert shapes == {
        "POSITION": "VEC3", "COLOR_0": "VEC4", f"{NAME}:ROTATION": "VEC4", f"{NAME}:SCALE": "VEC3", f"{NAME}:OPACITY": "SCALAR",
        f"{NAME}:SH_DEGREE_0_COEF_0": "VEC3", **{f"{NAME}:SH_DEGREE_1_COEF_{k}": "VEC3" for k in range(3)},
    }  # fmt: skip


def test_a_mesh_and_gaussians_share_one_file(tmp_path):
    triangle = GlbNode(name="room", vertices=np.eye(3), faces=np.array([[0, 1, 2]]))
    save_glb(tmp_path / "mesh.glb", [triangle])
    mesh = parse_glb("mesh.glb", (tmp_path / "mesh.glb").read_bytes())
    both = with_gaussians(mesh, some(4, 1), extras={"up": "y"})
    (tmp_path / "both.glb").write_bytes(glb_bytes(both))
    assert len(load_splats(tmp_path / "both.glb").means) == 4
    assert [node["name"] for node in both.document["nodes"]] == ["room", "gaussians"]
    assert both.binary[: len(mesh.binary)] == mesh.binary and both.document["accessors"][:2] == mesh.document["accessors"]


def test_nodes_move_their_gaussians(tmp_path):
    gaussians = some(5, 4)

    def below(document):
        document["nodes"][0] |= {"rotation": [0, 0, np.sqrt(0.5), np.sqrt(0.5)], "scale": [2, 2, 2]}
        document["nodes"].append({"children": [0], "translation": [1, 2, 3]})
        document["scenes"][0]["nodes"] = [1]

    loaded = written(tmp_path, gaussians, below)
    quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    wanted = turned(gaussians, quarter, 2.0, np.array([1.0, 2, 3]))
    np.testing.assert_allclose(loaded.means, 2 * gaussians.means @ quarter.T + [1, 2, 3], atol=1e-5)
    for field in ("log_scales", "sh"):
        np.testing.assert_allclose(getattr(loaded, field), getattr(wanted, field), atol=1e-5)
    np.testing.assert_allclose(np.abs((loaded.quats * wanted.quats).sum(1)), 1, atol=1e-6)


def drop_scale(document):
    del document["meshes"][0]["primitives"][0]["attributes"][f"{NAME}:SCALE"]


def pack(document):
    document["meshes"][0]["primitives"][0]["extensions"][NAME]["extensions"] = {"KHR_gaussian_splatting_compression_spz_2": {}}


def no_extension(document):
    del document["meshes"][0]["primitives"][0]["extensions"]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (drop_scale, "without the attributes KHR_gaussian_splatting:SCALE"),
        (pack, "packed by KHR_gaussian_splatting_compression_spz_2"),
        (no_extension, "no primitive with KHR_gaussian_splatting"),
        (lambda d: d["nodes"][0].update(scale=[1, 2, 1]), "stretches or mirrors"),
        (lambda d: d["nodes"][0].update(scale=[1, 1, -1]), "stretches or mirrors"),
        (lambda d: d["nodes"][0].update(children=[0]), "below two others or below itself"),
        (lambda d: d["nodes"][0].update(mesh=7), "damaged"),
        (lambda d: d["accessors"][0].update(count=10**6), "binary chunk has"),
        (lambda d: d["accessors"][0].update(count=2), "different lengths"),
        (lambda d: d["accessors"][0].update(type="SCALAR"), "3 numbers a row"),
        (lambda d: d["accessors"].pop(), "not there"),
    ],
)
def test_refusals_say_what_is_wrong(tmp_path, change, says):
    with pytest.raises(SplatFileError, match=says):
        written(tmp_path, some(5, 1), change)


def test_normalised_integers_are_the_shares_they_stand_for(tmp_path):
    opacity = np.array([0, 128, 255], np.uint8)

    def quantised(document):
        index = document["meshes"][0]["primitives"][0]["attributes"][f"{NAME}:OPACITY"]
        document["accessors"][index] = {"bufferView": 0, "componentType": 5121, "normalized": True, "count": 3, "type": "SCALAR"}

    save_gltf_splats(tmp_path / "a.glb", some(3, 1))
    glb = parse_glb("a.glb", (tmp_path / "a.glb").read_bytes())
    quantised(glb.document)
    glb.document["bufferViews"].append({"buffer": 0, "byteOffset": len(glb.binary), "byteLength": 3})
    glb.document["accessors"][4]["bufferView"] = len(glb.document["bufferViews"]) - 1
    (tmp_path / "a.glb").write_bytes(glb_bytes(GlbFile("a.glb", glb.document, glb.binary + opacity.tobytes())))
    loaded = load_splats(tmp_path / "a.glb")
    np.testing.assert_allclose(1 / (1 + np.exp(-loaded.opacity_logits)), [0, 128 / 255, 1], atol=3e-3)


def test_no_gaussians_cannot_be_written(tmp_path):
    with pytest.raises(SplatFileError, match="no gaussians"):
        save_gltf_splats(tmp_path / "a.glb", some(0, 1))
