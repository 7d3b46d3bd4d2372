"""Cameras come back from our file, and from the forms that other programs write."""

import json

import numpy as np
import pytest
from PIL import Image

from wm import codecs
from wm.geometry import CameraFileError, load_cameras, make_camera
from wm.types import OUTSIDE, View


def views():
    eyes = [((0, 0, 1.6), (2, 1, 1.2)), ((3, 1, 1.5), (0, 0, 2)), ((1, 4, 2.2), (1, 1, 0))]
    cameras = [make_camera(np.array(e, float), np.array(t, float), width=64, height=48, fov_deg=60.0) for e, t in eyes]
    return [View(camera=c, room=k // 2, kind="perimeter", name=f"r{k // 2}/perimeter{k}") for k, c in enumerate(cameras)]


def read(tmp_path, file, **how):
    (tmp_path / "t.json").write_text(json.dumps(file))
    return load_cameras(tmp_path / "t.json", **how)


def same(found, wanted):
    for a, b in zip(found, wanted, strict=True):
        for name in ("T_cam_world", "focal", "principal"):
            np.testing.assert_allclose(getattr(a.camera, name), getattr(b.camera, name), atol=1e-7)
        assert (a.camera.width, a.camera.height) == (b.camera.width, b.camera.height)


@pytest.mark.parametrize(
    "file", [codecs.transforms_json(views(), ["r0", "r1"]), codecs.heldout_json(views(), ["r0", "r1"], "heldout/{}.png")]
)
def test_what_is_written_comes_back(tmp_path, file):
    found = read(tmp_path, file)
    same(found, views())
    for a, b in zip(found, views()):
        assert (a.room, a.kind, a.name) == (b.room, b.kind, b.name)


def test_every_frame_names_its_mask():
    file = codecs.transforms_json(views(), ["r0", "r1"])
    assert [frame["mask_path"] for frame in file["frames"]] == [f"views/{view.name}.mask.png" for view in views()]


def bare():
    """A file of another program: only poses in its frames, intrinsics once."""
    file = codecs.transforms_json(views(), ["r0", "r1"])
    shared = {name: file["frames"][0][name] for name in ("fl_x", "fl_y", "cx", "cy", "w", "h")}
    frames = [{"file_path": f"./images/{k}.png", "transform_matrix": f["transform_matrix"]} for k, f in enumerate(file["frames"])]
    return {**shared, "frames": frames}


def test_intrinsics_may_stand_once_for_all_frames(tmp_path):
    found = read(tmp_path, bare())
    same(found, views())
    assert [(view.room, view.kind, view.name) for view in found] == [(OUTSIDE, "", f"images/{k}") for k in range(3)]


def test_an_angle_and_the_size_of_the_images_are_enough(tmp_path):
    file = {"camera_angle_x": 2 * np.arctan(32 / views()[0].camera.focal[0]), "frames": bare()["frames"]}
    (tmp_path / "images").mkdir()
    for k in range(3):
        Image.new("RGB", (64, 48)).save(tmp_path / f"images/{k}.png")
        file["frames"][k]["file_path"] = f"./images/{k}" if k else "./images/0.png"  # Blender's leave the suffix out
    same(read(tmp_path, file), views())


@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_an_applied_transform_is_undone_or_left(tmp_path, scale):
    applied = np.array([[0, 1, 0, 0.5], [1, 0, 0, -2], [0, 0, -1, 3.0]])
    applied[:, :3] *= scale
    file, square = bare(), np.concatenate([applied, [[0, 0, 0, 1]]])
    for frame in file["frames"]:
        moved = square @ np.array(frame["transform_matrix"])
        moved[:3, :3] /= scale
        frame["transform_matrix"] = moved.tolist()
    file["applied_transform"] = applied.tolist()
    same(read(tmp_path, file), views())
    left = read(tmp_path, file, undo_applied_transform=False)
    np.testing.assert_allclose(np.linalg.inv(left[0].camera.T_cam_world)[:3, 3], applied @ [0, 0, 1.6, 1], atol=1e-7)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda file: file.pop("frames"), "no list 'frames'"),
        (lambda file: file["frames"][1].pop("transform_matrix"), "frame 1: no transform_matrix"),
        (lambda file: file["frames"][1].update(transform_matrix=[[1, 2], [3]]), "frame 1: transform_matrix is no 4 x 4"),
        (lambda file: file["frames"][2].update(transform_matrix=np.diag([1.0, 2, 3, 1]).tolist()), "frame 2: .* does not rotate"),
        (
            lambda file: file["frames"][2].update(transform_matrix=np.diag([1.0, 1, -1, 1]).tolist()),
            "frame 2: .* does not rotate",
        ),
        (lambda file: file.pop("fl_x"), "frame 0: no focal length; fl_x"),
        (lambda file: file.update(fl_x="wide"), "fl_x is 'wide'"),
        (lambda file: file.pop("w"), "w and h would be right"),
        (lambda file: file.update(h=0), "64.0 x 0.0 pixels"),
        (lambda file: file.update(k1=0.1), "undistorted images would be right"),
        (lambda file: file.update(camera_model="OPENCV_FISHEYE"), "undistorted images would be right"),
        (lambda file: file.update(applied_transform=np.zeros((3, 4)).tolist()), "applied_transform cannot be undone"),
    ],
)
def test_refusals_name_file_frame_and_what_would_be_right(tmp_path, change, says):
    file = bare()
    change(file)
    with pytest.raises(CameraFileError, match=says) as caught:
        read(tmp_path, file)
    assert "t.json" in str(caught.value)


def test_what_is_not_json_is_refused(tmp_path):
    (tmp_path / "t.json").write_text("{")
    with pytest.raises(CameraFileError, match="not JSON"):
        load_cameras(tmp_path / "t.json")
