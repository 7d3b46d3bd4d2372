"""Target `scaffold`: what other programs read of `scaffold.glb` is the run's furniture and rooms."""

import dataclasses

import numpy as np
import pytest

from wm.export import scaffold
from wm.export.records import ExportError
from wm.finished import open_finished


def test_the_file_holds_the_run_and_passes_its_check(finished, tmp_path):
    (path,) = scaffold.write(finished, tmp_path)
    assert path.read_bytes() == finished.scaffold_file.read_bytes()
    checks = scaffold.check(finished, tmp_path)
    assert len(checks) == 5 and all(check.passed for check in checks)
    document = scaffold.glb_document(path)
    assert {node["name"] for node in document["nodes"]} >= {*finished.rooms, *(thing.id for thing in finished.objects)}
    assert len(document["cameras"]) >= len(finished.rooms)


def test_furniture_that_stands_elsewhere_is_found(finished, tmp_path):
    (path,) = scaffold.write(finished, tmp_path)
    first, *others = finished.objects
    moved = dataclasses.replace(first, vertices=first.vertices + np.array([0.01, 0, 0]))
    assert scaffold.object_deviation(path, finished.objects) < 1e-5
    assert scaffold.object_deviation(path, [moved, *others]) == pytest.approx(0.01, abs=1e-4)
    assert scaffold.object_deviation(path, [dataclasses.replace(first, id="unknown")]) == float("inf")


def test_a_file_that_is_none_is_named(finished, tmp_path):
    (tmp_path / scaffold.FILE).write_bytes(b"glTF")
    with pytest.raises(ExportError, match=r"scaffold\.glb: is no GLB file"):
        scaffold.check(open_finished(finished.folder), tmp_path)
