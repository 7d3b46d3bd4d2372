"""Target `navmesh`: its files are what a viewer is promised, and its check finds what is broken."""

import json

import numpy as np
import pytest

from wm.export import navmesh
from wm.export.records import ExportError


def test_the_files_hold_the_promise_and_pass_their_check(finished, tmp_path):
    told, glb = navmesh.write(finished, tmp_path)
    content = json.loads(told.read_text())
    assert content["version"] == 1 and content["axes"] == "right-handed, z up" and content["rooms"] == finished.rooms
    assert content["radius"] == finished.navigation.body_radius
    assert len(content["triangles"]) == len(content["triangle_room"]) == len(content["triangle_part"])
    a, b, c = np.array(content["vertices"])[np.array(content["triangles"])].transpose(1, 0, 2)
    assert (np.cross(b - a, c - a)[:, 2] >= 0).all()  # counter-clockwise from above
    assert glb.stat().st_size > 1000
    checks = navmesh.check(finished, tmp_path)
    assert len(checks) == 6 and all(check.passed for check in checks)


def test_equal_runs_give_equal_bytes(finished, tmp_path):
    first, second = navmesh.write(finished, tmp_path / "a"), navmesh.write(finished, tmp_path / "b")
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]


def test_a_closed_door_and_a_floating_floor_are_found(finished, tmp_path):
    told, _ = navmesh.write(finished, tmp_path)
    content = json.loads(told.read_text())
    inside = [k for k, room in enumerate(content["triangle_room"]) if room >= 0]
    for name in ("triangles", "triangle_room", "triangle_part"):
        content[name] = [content[name][k] for k in inside]
    content["vertices"][0][2] = 0.5
    told.write_text(json.dumps(content))
    failed = {check.what for check in navmesh.check(finished, tmp_path) if not check.passed}
    assert failed >= {"doors and passages that it leads through", "connected pieces", "height above the floor", "GLB equals JSON"}


def test_a_damaged_file_is_named(finished, tmp_path):
    told, _ = navmesh.write(finished, tmp_path)
    told.write_text("{")
    with pytest.raises(ExportError, match=r"navmesh\.json: is no navmesh"):
        navmesh.check(finished, tmp_path)
