"""Target `world`: `world.json` keeps its schema, says what the run says, and its spawn points stand free."""

import json

import numpy as np
import pytest
import shapely

from wm.export import scaffold, world
from wm.export.records import ExportError
from wm.geometry.placement.navigation import body_area

jsonschema = pytest.importorskip("jsonschema", reason="needs the extra world")


def test_the_file_keeps_its_schema_and_passes_its_check(finished, tmp_path):
    path, schema = world.write(finished, tmp_path)
    rules = json.loads(schema.read_text())
    jsonschema.Draft202012Validator.check_schema(rules)
    jsonschema.validate(json.loads(path.read_text()), rules)
    checks = world.check(finished, tmp_path)
    assert len(checks) == 5 and all(check.passed for check in checks)


def test_every_spawn_point_stands_free_and_reaches_the_rooms_of_its_part(finished):
    told = world.world_json(finished)
    area = body_area(finished.plan, finished.objects, finished.navigation)
    (part,) = told["parts"]
    assert part["rooms"] == finished.rooms == [room["id"] for room in told["rooms"]]
    places = [told["spawn"]["position"], part["spawn"]["position"], *(room["spawn"]["position"] for room in told["rooms"])]
    (piece,) = [one for one in shapely.get_parts(area) if one.buffer(1e-3).contains(shapely.Point(places[0][:2]))]
    assert all(piece.buffer(1e-3).contains(shapely.Point(place[:2])) and place[2] == 0 for place in places)


def test_names_lead_to_the_other_files(finished):
    told = world.world_json(finished)
    nodes = {node["name"] for node in scaffold.glb_document(finished.scaffold_file)["nodes"]}
    assert {row["glb_node"] for row in [*told["rooms"], *told["objects"]]} <= nodes
    paths = [row["usd_path"] for row in [*told["rooms"], *told["objects"]]]
    assert len(set(paths)) == len(paths) and all(path.startswith("/House/Scaffold/") for path in paths)
    for row, thing in zip(told["objects"], finished.objects, strict=True):
        np.testing.assert_allclose(row["bounds"], [thing.vertices.min(axis=0), thing.vertices.max(axis=0)], atol=1e-6)
        assert told["rooms"][thing.room]["id"] == row["room"]


def test_what_is_wrong_is_found(finished, tmp_path):
    path, _ = world.write(finished, tmp_path)
    told = json.loads(path.read_text())
    sofa = told["objects"][0]
    told["spawn"]["position"] = [*np.mean(sofa["bounds"], axis=0)[:2], 5.0]
    told["units"] = "feet"
    sofa["T_world_object"][0][3] += 1.0
    path.write_text(json.dumps(told))
    failed = {check.what for check in world.check(finished, tmp_path) if not check.passed}
    assert failed == {"schema", "spawn points that stand free", "objects as in the run"}
    path.write_text(json.dumps(told | {"version": 2}))
    with pytest.raises(ExportError, match="has version 2"):
        world.check(finished, tmp_path)
