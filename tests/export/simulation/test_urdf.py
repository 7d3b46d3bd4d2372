"""The robot description is the house, as yourdfpy reads it."""

import pytest

from tests.export.simulation.houses import TABLE, objects, paint, write_run
from wm.export.simulation import urdf

yourdfpy = pytest.importorskip("yourdfpy", reason="the extra simulation is not installed: pip install -e '.[simulation]'")


@pytest.fixture
def run(tmp_path):
    return write_run(tmp_path / "run")


def test_a_house_passes_its_check_and_is_written_in_the_same_bytes(run, tmp_path):
    paint(run)
    first, second = (urdf.write(run, tmp_path / name) for name in ("one", "two"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]
    assert all(row.passed for row in urdf.check(run, tmp_path / "one"))


def test_every_mesh_that_is_named_is_there_and_every_mesh_there_is_named(run, tmp_path):
    path, *others = urdf.write(run, tmp_path)
    text = path.read_text()
    named = {other.name for other in others if other.suffix in (".obj", ".stl")}
    assert all(f'filename="meshes/{name}"' in text for name in named)
    assert text.count("filename=") == len(named)


def test_joints_float_where_objects_may_move(run, tmp_path):
    robot = yourdfpy.URDF.load(str(urdf.write(run, tmp_path)[0]), load_meshes=False, build_scene_graph=False)
    joints = {joint.child: joint.type for joint in robot.robot.joints if not joint.child.startswith("house/")}
    assert joints == {thing.id: "floating" if thing.support in ("floor", "object") else "fixed" for thing in objects()}


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace(f'link name="{TABLE}"', 'link name="else"').replace(f'link="{TABLE}"', 'link="else"'),
        lambda text: text.replace('type="floating"', 'type="fixed"'),
        lambda text: text.replace("<box", "<bix"),
        lambda text: text.replace("<joint", "<junction").replace("</joint", "</junction"),
        lambda text: text[: len(text) // 2],
        lambda text: "",
    ],
)
def test_another_file_than_the_runs_fails_the_check(run, tmp_path, change):
    path = urdf.write(run, tmp_path)[0]
    path.write_text(change(path.read_text()))
    assert not urdf.check(run, tmp_path)[0].passed


def test_a_missing_file_or_mesh_fails_the_check(run, tmp_path):
    paths = urdf.write(run, tmp_path)
    next(path for path in paths if path.suffix == ".stl").unlink()
    assert not urdf.check(run, tmp_path)[0].passed
    paths[0].unlink()
    assert not urdf.check(run, tmp_path)[0].passed
