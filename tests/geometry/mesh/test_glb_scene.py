"""What a GLB file holds beside triangles: frames of nodes, lights, cameras, a second scene, shared materials."""

import dataclasses

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from tests.geometry.mesh.test_glb import quad, read
from tests.geometry.mesh.test_scene_mesh import wedge
from tests.geometry.plans import two_rooms
from tests.geometry.things import box
from wm.geometry import GlbLight, house_lights, make_camera, object_nodes, save_glb
from wm.types import View

Y_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], float)


def turned(yaw: float, at) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_euler("z", yaw, degrees=True).as_matrix(), at
    return T


def matrix(node) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_quat(node.get("rotation", [0, 0, 0, 1])).as_matrix(), node.get("translation", [0, 0, 0])
    return T


def test_a_node_in_its_own_frame_stands_where_it_stood(tmp_path):
    frame = turned(40.0, [3.0, -2.0, 0.5])
    save_glb(tmp_path / "plain.glb", [quad()])
    save_glb(tmp_path / "framed.glb", [quad(T_world_node=frame)])
    plain, framed = (trimesh.load_scene(tmp_path / f"{name}.glb").to_mesh() for name in ("plain", "framed"))
    np.testing.assert_allclose(framed.vertices, plain.vertices, atol=1e-6)
    (node,) = read(tmp_path / "framed.glb")[0]["nodes"]
    np.testing.assert_allclose(matrix(node), Y_UP @ frame @ Y_UP.T, atol=1e-12)
    local = trimesh.load_scene(tmp_path / "framed.glb").geometry["painting"].vertices
    expected = (quad().vertices - frame[:3, 3]) @ frame[:3, :3] @ Y_UP[:3, :3].T
    np.testing.assert_allclose(np.sort(local, axis=0), np.sort(expected, axis=0), atol=1e-6)


@pytest.mark.parametrize("frame", [np.eye(3), 2 * np.eye(4), np.diag([1.0, 1, -1, 1]), np.full((4, 4), np.nan)])
def test_a_frame_that_is_not_rigid_is_refused(tmp_path, frame):
    with pytest.raises(ValueError, match="'painting': T_world_node must be a rotation and a translation"):
        save_glb(tmp_path / "scene.glb", [quad(T_world_node=frame)])


def test_objects_have_their_frames_and_equal_materials_are_one(tmp_path):
    things = [wedge(0), wedge(1), wedge(0)]
    save_glb(tmp_path / "scene.glb", object_nodes(things, ["hall"]))
    document, _ = read(tmp_path / "scene.glb")
    for node, thing in zip(document["nodes"], things):
        np.testing.assert_allclose(matrix(node), Y_UP @ thing.T_world_object @ Y_UP.T, atol=1e-6)
        assert node["extras"]["room"] == "hall" and node["extras"]["support"] == thing.support
    told = [[p["material"] for p in mesh["primitives"]] for mesh in document["meshes"]]
    assert told[0] == told[2]
    assert len({str(material) for material in document["materials"]}) == len(document["materials"])
    assert {material["name"] for material in document["materials"]} == {slot for thing in things for slot in thing.slots}


def test_what_stands_apart_is_the_second_scene(tmp_path):
    save_glb(tmp_path / "scene.glb", [quad(), quad(name="skin", apart=True)])
    document, _ = read(tmp_path / "scene.glb")
    assert document["scene"] == 0
    assert [(scene["name"], scene["nodes"]) for scene in document["scenes"]] == [("house", [0]), ("exterior", [1])]


def test_a_camera_sees_what_the_view_sees(tmp_path):
    camera = make_camera(np.array([1.0, 2.0, 1.6]), np.array([4.0, 3.0, 1.0]), width=64, height=36, fov_deg=60.0)
    save_glb(tmp_path / "scene.glb", [quad()], views=[View(camera=camera, room=0, kind="bootstrap", name="hall/bootstrap0")])
    document, _ = read(tmp_path / "scene.glb")
    node = document["nodes"][1]
    lens = document["cameras"][node["camera"]]["perspective"]
    point = np.array([3.0, 2.5, 1.2, 1.0])
    x, y, z, _ = np.linalg.inv(matrix(node)) @ Y_UP @ point  # right, up, backwards
    ndc = np.array([x / lens["aspectRatio"], y]) / (-z * np.tan(lens["yfov"] / 2))
    p = camera.T_cam_world @ point
    pixel = camera.focal * p[:2] / p[2] + camera.principal
    np.testing.assert_allclose(ndc, [pixel[0] / 32 - 1, 1 - pixel[1] / 18], atol=1e-6)


def test_a_light_stays_with_its_lamp(tmp_path):
    frame = turned(90.0, [3.0, -2.0, 0.5])
    light = GlbLight("lamp light", np.array([3.0, -1.0, 2.0]), np.array([1.0, 0.5, 0.2]), 80.0, parent="painting")
    save_glb(tmp_path / "scene.glb", [quad(T_world_node=frame)], lights=[light])
    document, _ = read(tmp_path / "scene.glb")
    parent, child = document["nodes"]
    assert parent["children"] == [1] and document["scenes"][0]["nodes"] == [0]
    np.testing.assert_allclose((matrix(parent) @ matrix(child))[:3, 3], [3.0, 2.0, 1.0], atol=1e-6)
    (told,) = document["extensions"]["KHR_lights_punctual"]["lights"]
    assert (
        told["intensity"] == 80.0
        and told["color"][0] == 1.0
        and document["extensionsUsed"] == ["KHR_lights_punctual", "KHR_materials_unlit"]
    )


def test_every_room_has_light_and_lamps_are_lit_from_outside_themselves():
    plan = two_rooms()
    lamp = dataclasses.replace(
        box((1, 1, 2), (1.4, 1.4, 2.4)), id="hall lamp", support="ceiling", emission=np.ones(1, np.float32)
    )
    lights = house_lights(plan, [lamp, dataclasses.replace(box((2, 2, 0), (3, 3, 1)), id="chest")])
    assert [light.parent for light in lights] == ["hall lamp", ""]
    assert lights[0].position[2] < lamp.vertices[:, 2].min()
    # six sides of 0.16 m2 of which a quarter is seen, at 1000 candela a square metre
    assert lights[0].intensity == pytest.approx(240.0)
    assert lights[1].position[0] > 5 and lights[1].position[2] < plan.rooms[1].ceiling_height
