"""Edits of a run folder's files: used, said, kept while the configuration stays, and never erased without a copy."""

import json

import numpy as np
import pytest

from wm.artifacts.run_folder import open_run_folder
from wm.errors import InputError
from wm.geometry import PlanError, object_nodes
from wm.meter import StageMeter
from wm.run import load_config
from wm.stages.run_context import RunContext
from wm.stages.scene import OBJECT_ARRAYS, OBJECTS, PLAN, Scene, build_scene

HOUSE = (
    "scene.name=house", "scene.theme='a plain cabin'", "scene.rooms=[hall,bedroom]", "preset=draft", "cameras.width=96",
    "cameras.height=64", "cameras.perimeter=2", "cameras.overhead=1", "cameras.heldout_per_room=1", "furnish.density=0.3",
)  # fmt: skip


def build(folder, *overrides) -> Scene:
    config = load_config([*HOUSE, *overrides])
    with open_run_folder(folder, {"theme": config.scene.theme}, overwrite=True) as store:
        return build_scene(RunContext(config=config, folder=store, meter=StageMeter({})))


def change(file, edit) -> bytes:
    document = json.loads(file.read_text())
    edit(document)
    file.write_text(json.dumps(document))
    return file.read_bytes()


def without_first(document) -> None:
    del document["objects"][0]


def test_an_object_removed_stays_removed_and_the_rest_stays_bit_for_bit(tmp_path, capsys):
    made = build(tmp_path)
    data = change(tmp_path / OBJECTS, without_first)
    capsys.readouterr()
    scene = build(tmp_path)
    said = capsys.readouterr().out
    assert "objects.json: edited by hand, and used as it is" in said and said.count("objects.json") == 1
    assert [thing.id for thing in scene.objects] == [thing.id for thing in made.objects[1:]]
    assert [t.vertices.tobytes() for t in scene.objects] == [t.vertices.tobytes() for t in made.objects[1:]]
    assert scene.key != made.key and (tmp_path / OBJECTS).read_bytes() == data
    again = build(tmp_path)
    assert again.key == scene.key and "edited by hand" not in capsys.readouterr().out


def test_an_object_is_moved_turned_and_stretched_as_its_row_says(tmp_path):
    made = build(tmp_path)

    def edit(document):
        row = document["objects"][0]
        matrix = np.array(row["T_world_object"])
        matrix[:3, :3] = matrix[:3, :3] @ [[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]
        matrix[:2, 3] += [0.3, -0.2]
        row["T_world_object"], row["size"] = matrix.tolist(), [2 * row["size"][0], *row["size"][1:]]

    change(tmp_path / OBJECTS, edit)
    before, after = made.objects[0], build(tmp_path).objects[0]
    T = after.T_world_object
    own = (before.vertices - before.T_world_object[:3, 3]) @ before.T_world_object[:3, :3] * [2, 1, 1]
    np.testing.assert_allclose((after.vertices - T[:3, 3]) @ T[:3, :3], own, atol=1e-5)
    np.testing.assert_allclose(T[:2, 3], before.T_world_object[:2, 3] + [0.3, -0.2], atol=1e-5)
    np.testing.assert_allclose(after.size, before.size * [2, 1, 1], rtol=1e-9)


def test_an_object_carried_into_another_room_belongs_to_it(tmp_path):
    made = build(tmp_path)
    other = 1 - made.objects[0].room
    middle = made.plan.rooms[other].polygon.mean(axis=0)

    def edit(document):
        for k in (0, 1):
            document["objects"][0]["T_world_object"][k][3] = float(middle[k])

    change(tmp_path / OBJECTS, edit)
    assert build(tmp_path).objects[0].room == other


def test_a_moved_door_is_used_and_the_former_plan_comes_back_with_its_file(tmp_path, capsys):
    made = build(tmp_path)
    original = (tmp_path / PLAN).read_bytes()

    def edit(document):
        for room in document["rooms"]:
            for opening in room["openings"]:
                opening["width"] -= 0.1 * (opening["type"] != "window")

    data = change(tmp_path / PLAN, edit)
    capsys.readouterr()
    scene = build(tmp_path)
    assert "plan.json: edited by hand" in capsys.readouterr().out
    assert (tmp_path / PLAN).read_bytes() == data and scene.mesh.vertices.tobytes() != made.mesh.vertices.tobytes()
    (tmp_path / PLAN).write_bytes(original)
    assert build(tmp_path).mesh.vertices.tobytes() == made.mesh.vertices.tobytes()


def test_another_configuration_keeps_a_copy_of_the_edits_it_overwrites(tmp_path):
    build(tmp_path)
    data = change(tmp_path / OBJECTS, without_first)
    build(tmp_path)
    build(tmp_path, "scene.theme='a gothic abbey'")
    (copy,) = tmp_path.glob("objects.json.before-*")
    assert copy.read_bytes() == data and (tmp_path / OBJECTS).read_bytes() != data


def test_an_edit_that_breaks_a_rule_is_refused_and_stays(tmp_path):
    build(tmp_path)
    data = change(tmp_path / PLAN, lambda document: document["rooms"][0]["openings"][0].update(position=99.0))
    with pytest.raises(PlanError, match="opening_off_wall"):
        build(tmp_path)
    assert (tmp_path / PLAN).read_bytes() == data


@pytest.mark.parametrize("name", [PLAN, OBJECTS])
def test_what_is_no_json_was_damaged_and_is_made_again_beside_a_copy(name, tmp_path):
    build(tmp_path)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[:100])
    build(tmp_path)
    (copy,) = tmp_path.glob(f"{name}.before-*")
    assert (tmp_path / name).read_bytes() == whole and copy.read_bytes() == whole[:100]


def test_lost_meshes_are_made_again_under_an_edit(tmp_path):
    build(tmp_path)
    data = change(tmp_path / OBJECTS, without_first)
    scene = build(tmp_path)
    (tmp_path / OBJECT_ARRAYS).unlink()
    again = build(tmp_path)
    assert (tmp_path / OBJECTS).read_bytes() == data and again.key == scene.key
    assert [t.vertices.tobytes() for t in again.objects] == [t.vertices.tobytes() for t in scene.objects]


def test_a_file_of_objects_arranges_another_folder(tmp_path):
    made = build(tmp_path / "a")
    change(tmp_path / "a" / OBJECTS, lambda document: document.update(objects=document["objects"][::-2]))
    scene = build(tmp_path / "b", f"objects.file={tmp_path / 'a' / OBJECTS}")
    assert [thing.id for thing in scene.objects] == [thing.id for thing in made.objects[::-2]]
    assert [row["id"] for row in json.loads((tmp_path / "b" / OBJECTS).read_text())["objects"]] == [t.id for t in scene.objects]
    with pytest.raises(InputError, match="no such file"):
        build(tmp_path / "c", "objects.file=nowhere.json")


def test_ids_tie_rows_nodes_and_faces_together(tmp_path):
    scene = build(tmp_path)
    summary = json.loads((tmp_path / OBJECTS).read_text())
    assert summary["units"] == "meters" and "z up" in summary["axes"]
    nodes = {node.name: node.extras for node in object_nodes(scene.objects, scene.rooms)}
    assert len({row["id"] for row in summary["objects"]}) == len(summary["objects"]) == len(nodes)
    for k, row in enumerate(summary["objects"]):
        assert nodes[row["id"]] == {"face_object": k, **{name: row[name] for name in ("id", "label", "room", "support")}}
        T = np.array(row["T_world_object"])
        corners = scene.mesh.vertices[scene.mesh.faces[scene.mesh.face_object == k]].reshape(-1, 3)
        local = (corners - T[:3, 3]) @ T[:3, :3]
        np.testing.assert_allclose(np.ptp(local, axis=0), row["size"], atol=2e-3)


