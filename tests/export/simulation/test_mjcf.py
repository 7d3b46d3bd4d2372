"""The MuJoCo model is the house, and the settle test tells what stands from what falls."""

import dataclasses

import numpy as np
import pytest

from tests.export.simulation.houses import TABLE, named, objects, paint, table, write_run
from tests.geometry.things import box
from wm.export.records import ExportError
from wm.export.simulation import mjcf
from wm.export.simulation.settling import settle

mujoco = pytest.importorskip("mujoco", reason="the extra simulation is not installed: pip install -e '.[simulation]'")


@pytest.fixture
def run(tmp_path):
    return write_run(tmp_path / "run")


def test_a_house_passes_its_check_and_is_written_in_the_same_bytes(run, tmp_path):
    paint(run)
    first, second = (mjcf.write(run, tmp_path / name) for name in ("one", "two"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]
    assert [row for row in mjcf.check(run, tmp_path / "one") if not row.passed] == []


def test_free_bodies_are_those_that_stand(run, tmp_path):
    model = mujoco.MjModel.from_xml_path(str(mjcf.write(run, tmp_path)[0]))
    free = {model.body(k).name for k in range(model.nbody) if model.body_dofnum[k] == 6}
    assert free == {thing.id for thing in objects() if thing.support in ("floor", "object")}
    assert model.body("hall-vase-1").mass[0] == pytest.approx(2200 * 0.006 * (2 * 0.01 + 4 * 0.02), rel=1e-4)


def test_a_ball_thrown_at_walls_floor_and_window_stays_in_the_room(tmp_path):
    ball = named(box((2.4, 1.9, 1.4), (2.5, 2.0, 1.5), label="ball"), "ball", support="object")
    model = mujoco.MjModel.from_xml_path(str(mjcf.write(write_run(tmp_path / "run", [ball]), tmp_path)[0]))
    for velocity in ([-3, 0, 0], [0, 3, 0], [0, -3, 1], [0, 0, 3], [2, 2, -2]):
        data = mujoco.MjData(model)
        data.qvel[:3] = velocity
        mujoco.mj_step(model, data, 2000)
        assert np.all(data.qpos[:3] > -0.01) and np.all(data.qpos[:3] < [5, 4, 2.8])  # contacts give way by less


def test_a_ball_rolls_through_the_open_door(tmp_path):
    ball = named(box((4.4, 1.9, 1.0), (4.5, 2.0, 1.1), label="ball"), "ball", support="object")
    model = mujoco.MjModel.from_xml_path(str(mjcf.write(write_run(tmp_path / "run", [ball]), tmp_path)[0]))
    data = mujoco.MjData(model)
    data.qvel[0] = 4
    mujoco.mj_step(model, data, 200)
    assert data.qpos[0] > 5.3


@pytest.mark.parametrize(
    ("low", "high", "turned", "told"),
    [
        ((1, 3, 0.05), (1.5, 3.5, 0.5), False, "moved"),  # hangs in the air
        ((1, 3, 0), (1.1, 3.1, 1.5), True, "tipped"),  # leans by 10 degrees, with its weight beside its edge
    ],
)
def test_what_falls_is_told(tmp_path, low, high, turned, told):
    thing = named(box(low, high), "thing")
    if turned:
        angle, foot = np.radians(10), np.array([1.1, 3.1, 0])
        R = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        thing = dataclasses.replace(thing, vertices=(thing.vertices - foot) @ R.T + foot)
    run = write_run(tmp_path / "run", [thing, table()])
    path = mjcf.write(run, tmp_path)[0]
    settled = settle(path)
    assert getattr(settled, told) == ["thing"]
    assert TABLE not in settled.moved
    assert not all(row.passed for row in mjcf.check(run, tmp_path))


def test_another_file_than_the_runs_fails_the_check(run, tmp_path):
    path = mjcf.write(run, tmp_path)[0]
    path.write_text(path.read_text().replace(f'body name="{TABLE}"', 'body name="else"'))
    assert not mjcf.check(run, tmp_path)[0].passed
    path.write_text("<mujoco")
    assert not mjcf.check(run, tmp_path)[0].passed
    path.unlink()
    assert not mjcf.check(run, tmp_path)[0].passed


def test_meshes_of_an_earlier_export_are_removed(run, tmp_path):
    mjcf.write(run, tmp_path)
    left = tmp_path / "mjcf" / "meshes" / "gone.obj"
    left.write_text("")
    mjcf.write(run, tmp_path)
    assert not left.exists()


def test_an_object_without_a_surface_is_refused(tmp_path):
    thing = named(box((1, 1, 0), (1, 1, 0)), "nothing")
    with pytest.raises(ExportError, match="nothing"):
        mjcf.write(write_run(tmp_path / "run", [thing]), tmp_path)


@pytest.mark.parametrize("name", ["world", "house", "house/hall_floor"])
def test_ids_that_the_building_has_are_refused(tmp_path, name):
    with pytest.raises(ExportError, match="another one"):
        mjcf.write(write_run(tmp_path / "run", [named(box((1, 1, 0), (2, 2, 1)), name)]), tmp_path)


def test_odd_ids_and_single_triangles_are_no_obstacle(tmp_path):
    sheet = named(box((1, 3, 0), (1.5, 3.5, 0.5)), 'a/b <c> & "d" 床', support="wall")
    sheet = dataclasses.replace(sheet, faces=sheet.faces[:1], face_slot=sheet.face_slot[:1])
    run = write_run(tmp_path / "run", [sheet])
    mjcf.write(run, tmp_path)
    assert all(row.passed for row in mjcf.check(run, tmp_path))


def test_an_unfurnished_house_is_a_house(tmp_path):
    run = write_run(tmp_path / "run", [])
    mjcf.write(run, tmp_path)
    assert all(row.passed for row in mjcf.check(run, tmp_path))
