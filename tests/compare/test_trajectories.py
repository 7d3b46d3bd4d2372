"""Camera paths: deterministic, collision-free in ours, within what is seen to be free elsewhere, and of any unit and axes."""

import dataclasses

import numpy as np
import pytest

from tests.compare.test_consistency import room
from wm.compare.axes import UP, upright
from wm.compare.drawing import drawer_of
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene
from wm.compare.trajectories import DEFAULT, Picture, file_text, parse_names, read_file
from wm.compare.trajectories_foreign import ForeignPaths
from wm.compare.trajectories_ours import CLEARANCE, NEAREST, RunPaths, longest_run
from wm.finished import FinishedRun, open_finished
from wm.geometry.cameras.air import free
from wm.geometry.rays.pinhole import camera_center, camera_rotation

PICTURE = Picture(width=64, height=36, frames=16)


@pytest.fixture(scope="module")
def paths(run_folder) -> tuple[FinishedRun, RunPaths]:
    run = open_finished(run_folder)
    return run, RunPaths(run, PICTURE)


@pytest.mark.parametrize("name", DEFAULT)
def test_no_frame_of_ours_touches_anything(name, paths):
    run, of_run = paths
    trajectory = of_run.path(name)
    assert len(trajectory.cameras) == PICTURE.frames
    centers = np.array([camera_center(camera) for camera in trajectory.cameras])
    assert free(run.rays, centers, 0.9 * min(CLEARANCE, NEAREST)).all()
    assert np.ptp(centers, axis=0).max() > 0.2
    again = RunPaths(open_finished(run.folder), PICTURE).path(name)
    for a, b in zip(trajectory.cameras, again.cameras, strict=True):
        np.testing.assert_array_equal(a.T_cam_world, b.T_cam_world)


def test_an_object_stays_in_the_middle_while_it_is_walked_round(paths):
    run, of_run = paths
    cameras = of_run.path("around1").cameras
    looks = np.array([camera_rotation(camera)[2] for camera in cameras])
    assert np.degrees(np.arccos(np.clip(looks[0] @ looks[-1], -1, 1))) > 25
    crossings = [camera_center(camera) + s * camera_rotation(camera)[2] for camera in cameras for s in (0.0, 1.0)]
    middles = np.array([(thing.vertices.min(axis=0) + thing.vertices.max(axis=0)) / 2 for thing in run.objects])
    away = [
        max(np.linalg.norm(np.cross(middle - a, b - a)) for a, b in zip(crossings[::2], crossings[1::2])) for middle in middles
    ]
    assert min(away) < 0.1


def test_a_door_is_walked_through_from_one_room_into_another(paths):
    run, of_run = paths
    ends = [camera_center(of_run.path("door1").cameras[k]) for k in (0, -1)]
    inside = [int(run.scaffold.face_room[face]) for face in _below(run, np.array(ends))]
    assert inside[0] != inside[1]


def _below(run: FinishedRun, points: np.ndarray) -> np.ndarray:
    from wm.geometry import cast_rays

    return cast_rays(run.rays, points, np.tile([0.0, 0, -1], (len(points), 1))).face


def test_what_a_scene_does_not_have_is_said(paths):
    for name, what in (("door99", "doors join rooms"), ("around99", "objects can be walked round")):
        with pytest.raises(CompareError, match=what):
            paths[1].path(name)


def foreign(scale: float, up: str) -> ForeignPaths:
    rotation = upright(UP[up])
    mesh = room(scale)
    turned = dataclasses.replace(mesh.parts[0], corners=mesh.parts[0].corners @ rotation)
    scene = ComparedScene(method="theirs", mesh=_mesh(turned), R_world_file=rotation)
    return ForeignPaths(scene, drawer_of(scene), PICTURE)


def _mesh(part):
    from wm.compare.painted_mesh import PaintedMesh
    from wm.geometry.rays.raycast import build_ray_scene
    from wm.types import Mesh

    faces = np.arange(3 * len(part.corners)).reshape(-1, 3)
    mesh = Mesh.from_triangles(part.corners.reshape(-1, 3), faces, face_object=0)
    return PaintedMesh(rays=build_ray_scene(mesh), parts=(part,), start=np.array([0]))


@pytest.mark.parametrize("name", DEFAULT)
def test_paths_of_a_foreign_room_stay_inside_and_scale_with_it(name):
    small, large = foreign(1.0, "z").path(name), foreign(1000.0, "-y").path(name)
    centers = np.array([camera_center(camera) for camera in small.cameras])
    assert (np.abs(centers[:, :2]) < 1.95).all() and (centers[:, 2] > 0).all() and (centers[:, 2] < 3).all()
    assert np.ptp(centers, axis=0).max() > 0.3
    moved = np.array([camera_center(camera) for camera in large.cameras])
    np.testing.assert_allclose(moved, 1000 * centers, atol=30)


def test_a_scene_that_shows_nothing_is_said():
    scene = ComparedScene(method="theirs", mesh=room(), eye=np.array([0, 0, 500.0]))
    with pytest.raises(CompareError, match="theirs: nothing is to be seen"):
        ForeignPaths(scene, drawer_of(scene), PICTURE).path("along1")


def test_cameras_of_a_path_are_read_back(tmp_path):
    trajectory = foreign(1.0, "z").path("around1")
    (tmp_path / "around1.json").write_text(file_text(trajectory, PICTURE))
    again = read_file(tmp_path / "around1.json", PICTURE)
    for a, b in zip(trajectory.cameras, again.cameras, strict=True):
        np.testing.assert_allclose(a.T_cam_world, b.T_cam_world, atol=1e-7)
        np.testing.assert_allclose(a.focal, b.focal)
    (tmp_path / "none.json").write_text('{"frames": []}')
    with pytest.raises(CompareError, match=r"none\.json: 0 cameras"):
        read_file(tmp_path / "none.json", PICTURE)


@pytest.mark.parametrize(
    ("ring", "wanted"),
    [("1111", [0, 1, 2, 3]), ("0110", [1, 2]), ("1001", [3, 0]), ("1011011", [5, 6, 0]), ("0000", []), ("0101", [1])],
)
def test_the_longest_run_goes_over_the_end_of_the_ring(ring, wanted):
    assert longest_run(np.array([c == "1" for c in ring])).tolist() == wanted


def test_names_of_trajectories():
    assert parse_names(["around", "door2"]) == ["around1", "door2"]
    for words in (["sideways"], ["around0"], ["around", "around1"]):
        with pytest.raises(CompareError, match="would be right"):
            parse_names(words)
