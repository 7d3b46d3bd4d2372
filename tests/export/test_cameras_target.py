"""Target `cameras`: both models hold the run's poses, held-out views stay apart, and the check finds what is broken."""

import json
import shutil

import numpy as np
import pytest
from PIL import Image

from wm.codecs import DEPTH_UNIT
from wm.export import cameras
from wm.finished import UnfinishedRunError, open_finished
from wm.geometry import cast, load_cameras
from wm.splat import save_point_cloud


@pytest.fixture(scope="module")
def painted(finished):
    """The run as a fit leaves it, as far as this target goes: with points."""
    points = finished.scaffold.vertices[:500]
    save_point_cloud(finished.folder / "points.ply", points.astype(np.float32), np.full((500, 3), 128, np.uint8))
    yield open_finished(finished.folder)
    (finished.folder / "points.ply").unlink()


def test_the_files_hold_every_view_and_pass_their_check(painted, tmp_path):
    paths = cameras.write(painted, tmp_path)
    assert all(path.is_file() for path in paths) and len(set(paths)) == len(paths)
    told = json.loads((tmp_path / "cameras" / "transforms.json").read_text())
    train, test = told["train_filenames"], told["test_filenames"]
    assert (len(train), len(test)) == (len(painted.views), len(painted.heldout)) and told["val_filenames"] == test
    assert all({"file_path", "mask_path", "depth_file_path"} <= set(frame) for frame in told["frames"])
    named = (tmp_path / "cameras" / "sparse" / "0" / "test.txt").read_text().split()
    assert [f"images/{name}" for name in named] == test
    checks = cameras.check(painted, tmp_path)
    assert len(checks) == 5 and all(check.passed for check in checks)


def test_poses_are_the_runs_and_heldout_depth_is_the_scaffolds(painted, tmp_path):
    cameras.write(painted, tmp_path)
    read = load_cameras(tmp_path / "cameras" / "transforms.json")
    for mine, theirs in zip([*painted.views, *painted.heldout], read, strict=True):
        np.testing.assert_allclose(theirs.camera.T_cam_world, mine.camera.T_cam_world, atol=1e-6)
    view = painted.heldout[0]
    with Image.open(tmp_path / "cameras" / "depths" / f"{view.name}.png") as image:
        depth = np.asarray(image) * DEPTH_UNIT
    np.testing.assert_allclose(depth, cast(painted.rays, view.camera).depth, atol=DEPTH_UNIT)


def test_equal_runs_give_equal_bytes(painted, tmp_path):
    first, second = cameras.write(painted, tmp_path / "a"), cameras.write(painted, tmp_path / "b")
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]


def test_what_is_broken_is_found(painted, tmp_path):
    cameras.write(painted, tmp_path)
    root = tmp_path / "cameras"
    told = json.loads((root / "transforms.json").read_text())
    told["frames"][0]["transform_matrix"][0][3] += 0.01
    told["train_filenames"] += told["test_filenames"][:1]
    (root / "transforms.json").write_text(json.dumps(told))
    (root / told["frames"][1]["mask_path"]).unlink()
    images = (root / "sparse" / "0" / "images.txt").read_text().splitlines()
    (root / "sparse" / "0" / "images.txt").write_text("\n".join(images[2:]) + "\n")
    failed = [check.what for check in cameras.check(painted, tmp_path) if not check.passed]
    assert len(failed) == 4 and failed[-1] == "training and held-out views"


def test_a_run_that_is_not_fitted_says_so(finished, tmp_path):
    shutil.copytree(finished.folder, tmp_path / "run", ignore=shutil.ignore_patterns("points.ply"))
    with pytest.raises(UnfinishedRunError, match=r"no points\.ply"):
        cameras.write(open_finished(tmp_path / "run"), tmp_path)
