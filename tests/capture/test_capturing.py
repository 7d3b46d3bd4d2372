"""What a capture writes is read back: poses by `load_cameras`, depth onto the mesh, TUM's poses by their definition."""

import json
import shutil

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from wm.capture.__main__ import main
from wm.capture.labels import label_table
from wm.finished import open_finished
from wm.geometry import camera_center, camera_rays, load_cameras, unproject_depth
from wm.geometry.rays._reference import cast_rays_reference
from wm.types import Camera, SurfaceKind


@pytest.fixture(scope="module")
def run(finished, tmp_path_factory):
    """A copy, since what is captured is written into the run."""
    return open_finished(shutil.copytree(finished.folder, tmp_path_factory.mktemp("fitted") / "run"))


@pytest.fixture(scope="module")
def folder(run):
    assert main([str(run.folder), "trajectory=orbit", "fps=3"]) == 0
    return run.folder / "capture" / "orbit"


def frames(folder):
    """The npz files with the cameras that they hold."""
    for path in sorted((folder / "npz").glob("*.npz")):
        arrays = dict(np.load(path))
        K, (height, width) = arrays["K"], arrays["depth"].shape
        pose = np.linalg.inv(arrays["T_world_cam"])
        yield arrays, Camera(T_cam_world=pose, focal=K[[0, 1], [0, 1]], principal=K[:2, 2], width=width, height=height)


def some_rays(run, camera):
    """Indices of some pixels of an image, and what the slow twin of the raycasts finds along their rays."""
    pixels = np.random.default_rng(0).choice(camera.width * camera.height, 50, replace=False)
    origin = np.repeat(camera_center(camera)[None], len(pixels), axis=0)
    return pixels, cast_rays_reference(run.scaffold, origin, camera_rays(camera)[pixels])


def test_nerfstudio_is_read_back_by_load_cameras(run, folder):
    views = load_cameras(folder / "nerfstudio" / "transforms.json")
    wanted = [camera for _, camera in frames(folder)]
    assert len(views) == len(wanted) > 3
    for view, camera in zip(views, wanted):
        for name in ("T_cam_world", "focal", "principal"):
            np.testing.assert_allclose(getattr(view.camera, name), getattr(camera, name), atol=1e-8)
        assert (view.camera.width, view.camera.height) == (camera.width, camera.height) == (64, 36)
    told = json.loads((folder / "nerfstudio" / "transforms.json").read_text())
    for frame in told["frames"]:
        assert all((folder / "nerfstudio" / path).is_file() for key, path in frame.items() if key.endswith("_path"))
    assert {frame["room"] for frame in told["frames"]} == set(run.rooms)


def test_depth_lies_on_the_scaffold_to_a_millimetre(run, folder):
    for number, (arrays, camera) in enumerate(frames(folder)):
        pixels, truth = some_rays(run, camera)
        assert (arrays["depth"] > 0).mean() > 0.99
        np.testing.assert_allclose(arrays["depth"].ravel()[pixels], truth.t, atol=1e-3)
        millimetres = np.asarray(Image.open(folder / "nerfstudio" / "depths" / f"{number:05d}.png"))
        np.testing.assert_allclose(millimetres / 1000, arrays["depth"], atol=0.501e-3)
        points = unproject_depth(camera, arrays["depth"])
        floor = (arrays["normal"][..., 2] > 0.999) & (points[..., 2] < 0.01)
        assert floor.any() and np.abs(points[floor][:, 2]).max() < 1e-3 + 0.02


def test_tum_poses_are_the_optical_centre_and_its_orientation(folder):
    rows = np.loadtxt(folder / "tum" / "groundtruth.txt")
    for row, (arrays, camera) in zip(rows, frames(folder), strict=True):
        np.testing.assert_allclose(row[1:4], camera_center(camera), atol=1e-8)
        turned = Rotation.from_quat(row[4:]).as_matrix()  # x y z w
        np.testing.assert_allclose(turned, arrays["T_world_cam"][:3, :3], atol=1e-8)
        assert row[0] == pytest.approx(arrays["time"], abs=1e-6)


def test_a_tum_point_by_its_tools_definition_is_the_point_of_the_pixel(folder):
    cameras = np.loadtxt(folder / "tum" / "camera.txt")
    names = (folder / "tum" / "associations.txt").read_text().splitlines()
    for told, line, (arrays, camera) in zip(cameras, names, frames(folder), strict=True):
        time, rgb, again, depth = line.split()
        assert time == again and float(time) == told[0]
        z = np.asarray(Image.open(folder / "tum" / depth)) / 5000
        fx, fy, cx, cy = told[1:5]
        v, u = np.mgrid[: z.shape[0], : z.shape[1]]
        points = np.stack([(u - cx) * z / fx, (v - cy) * z / fy, z], axis=-1) @ arrays["T_world_cam"][:3, :3].T + camera_center(
            camera
        )
        np.testing.assert_allclose(points, unproject_depth(camera, arrays["depth"]), atol=5e-4)
        np.testing.assert_array_equal(np.asarray(Image.open(folder / "tum" / rgb)), arrays["rgb"])


def test_labels_name_what_the_pixels_show(run, folder):
    table = json.loads((folder / "labels.json").read_text())
    rows = {row["id"]: row for row in table["instances"]}
    assert sorted(rows) == list(range(1, len(rows) + 1))
    assert [row["object"] for row in rows.values() if row["object"]] == [thing.id for thing in run.objects]
    classes = {row["id"]: row["label"] for row in table["classes"]}
    for arrays, camera in frames(folder):
        pixels, truth = some_rays(run, camera)
        shown = [rows[i]["object"] for i in arrays["instance"].ravel()[pixels].tolist()]
        assert shown == [run.objects[k].id if k >= 0 else None for k in run.scaffold.face_object[truth.face].tolist()]
        for i, c in set(zip(arrays["instance"].ravel().tolist(), arrays["semantic"].ravel().tolist())) - {(0, 0)}:
            assert rows[i]["label"] == classes[c] and rows[i]["class"] == c


def test_structure_has_an_instance_for_each_surface_of_each_room(run):
    table = label_table(run)
    floors = [row.room for row in table.instances if row.label == "floor"]
    assert floors == run.rooms
    assert (table.face_instance > 0).all()
    walls = table.face_instance[(run.scaffold.face_kind == SurfaceKind.WALL) & (run.scaffold.face_room == 1)]
    assert len(np.unique(walls)) == 1


def test_the_cloud_lies_on_the_scaffold(run, folder):
    import trimesh

    cloud = trimesh.load(folder / "nerfstudio" / "points.ply")
    assert 1000 < len(cloud.vertices) <= 200_000 and cloud.colors.shape[1] == 4
    low, high = run.scaffold.vertices.min(axis=0), run.scaffold.vertices.max(axis=0)
    assert (cloud.vertices > low - 0.01).all() and (cloud.vertices < high + 0.01).all()


def test_views_bring_their_own_images(run, tmp_path):
    words = [str(run.folder), "trajectory=views", "rgb=images", "format=[nerfstudio]", f"output={tmp_path}"]
    assert main(words) == 0
    views = load_cameras(tmp_path / "nerfstudio" / "transforms.json")
    assert [view.name for view in views] == [view.name for view in run.views]
    first = np.asarray(Image.open(tmp_path / "nerfstudio" / "images" / "00000.png"))
    np.testing.assert_array_equal(first, np.asarray(Image.open(run.folder / "views" / f"{views[0].name}.png")))


def test_a_file_of_cameras_is_followed_at_another_size(run, tmp_path):
    cameras = run.folder / "cameras.heldout.json"
    words = [str(run.folder), f"trajectory={cameras}", "width=48", "height=24", "fov=40", "format=npz", f"output={tmp_path}"]
    assert main([*words, "depth=splats"]) == 0
    for (arrays, camera), view in zip(frames(tmp_path), run.heldout, strict=True):
        np.testing.assert_allclose(camera.T_cam_world, view.camera.T_cam_world, atol=1e-8)
        assert arrays["depth"].shape == (24, 48)
        np.testing.assert_allclose(camera.focal, 12 / np.tan(np.radians(20)))
