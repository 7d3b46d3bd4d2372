"""Target `cameras`: posed images for trainers of gaussians and radiance fields, in nerfstudio's form and in COLMAP's.

    cameras/transforms.json        nerfstudio: frames with image, mask and depth; train_filenames, val_filenames, test_filenames
    cameras/sparse/0/*.txt         COLMAP's model in text; test.txt names the held-out images, as INRIA's code reads it
    cameras/images, masks, depths  <room>/<view>.png; masks are white where the image counts, depth is in millimetres
    cameras/points.ply             the coloured points that the run's own fit started from

Training views are those that the run painted; held-out views, where the run knows the truth of them, are only in val and test.
"""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from scipy.spatial.transform import Rotation

from wm import codecs
from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import json_text
from wm.export.records import Check, ExportError
from wm.finished import FinishedRun
from wm.geometry import cast, load_cameras, save_colmap
from wm.stages.scene import POINTS
from wm.types import View

FOLDER, TRANSFORMS, SPARSE = "cameras", "transforms.json", "sparse/0"
TRUTH = "heldout/{}.truth.png"
TOLERANCE = 1e-6
"""Largest difference of an entry of a pose: files round to nine digits or ten."""

_EDGE = 0.01  # metres by which a point may lie outside the building


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Writes the files and reads both models back.

    Raises:
      UnfinishedRunError: the run is not painted, or not fitted, yet.
      ExportError: a pose was read back as another.
    """
    root = folder / FOLDER
    training, heldout = run.views, known_heldout(run)
    paths = [*_training_files(run, root), *_heldout_files(run, root, heldout)]
    write_atomically(root / POINTS, run.file(POINTS).read_bytes())
    write_atomically(root / TRANSFORMS, json_text(transforms(training, heldout, run.rooms)))
    paths += [root / TRANSFORMS, root / POINTS, *_colmap_files(root, [*training, *heldout], heldout)]
    worst = max(pose_errors(root, [*training, *heldout]))
    if worst > TOLERANCE:
        raise ExportError(f"{root}: a pose was read back {worst:.1e} away")
    return paths


def known_heldout(run: FinishedRun) -> list[View]:
    """The held-out views of which the run has a true image."""
    return [view for view in run.heldout if (run.folder / TRUTH.format(view.name)).is_file()]


def transforms(training: Sequence[View], heldout: Sequence[View], rooms: Sequence[str]) -> dict[str, Any]:
    """nerfstudio's transforms.json with its splits."""
    views = [*training, *heldout]
    told = codecs.transforms_json(views, rooms)
    for frame, view in zip(told["frames"], views):
        frame |= {f"{key}path": f"{kind}/{view.name}.png" for key, kind in _PLACES.items()}
    train, test = ([f"images/{view.name}.png" for view in part] for part in (training, heldout))
    return told | {"ply_file_path": POINTS, "train_filenames": train, "val_filenames": test, "test_filenames": test}


_PLACES = {"file_": "images", "mask_": "masks", "depth_file_": "depths"}


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """Poses equal the run's in both models, files are there in the right size, and no held-out view is trained on."""
    root = folder / FOLDER
    told = json.loads((root / TRANSFORMS).read_text(encoding="utf-8"))
    views = [*run.views, *known_heldout(run)]
    names = [frame["name"] for frame in told["frames"]] == [view.name for view in views]
    nerfstudio, colmap = pose_errors(root, views) if names else (np.inf, np.inf)
    whole = [_is_whole(root, frame) for frame in told["frames"]]
    train, test = set(told["train_filenames"]), set(told["test_filenames"])
    split = not train & test and train | test == {frame["file_path"] for frame in told["frames"]}
    points = _points(root / POINTS)[0]
    low, high = run.structure.vertices.min(axis=0) - _EDGE, run.structure.vertices.max(axis=0) + _EDGE
    inside = float(((points >= low) & (points <= high)).all(axis=1).mean())
    return [
        Check("cameras", "poses in transforms.json", f"{nerfstudio:.1e}", f"<= {TOLERANCE:g}", nerfstudio <= TOLERANCE),
        Check("cameras", "poses in COLMAP's model", f"{colmap:.1e}", f"<= {TOLERANCE:g}", colmap <= TOLERANCE),
        Check("cameras", "frames with image, mask and depth", f"{sum(whole)} of {len(whole)}", "all", all(whole)),
        Check("cameras", "training and held-out views", f"{len(train)} and {len(test)}", "apart, all frames", split),
        Check("cameras", "points inside the building", f"{inside:.1%} of {len(points)}", ">= 99 %", inside >= 0.99),
    ]


def pose_errors(root: Path, views: Sequence[View]) -> tuple[float, float]:
    """The largest difference of an entry of T_cam_world: in transforms.json, in COLMAP's model; inf where views are missing."""
    wanted = np.array([np.asarray(view.camera.T_cam_world, np.float64) for view in views])
    read = [[np.asarray(view.camera.T_cam_world) for view in load_cameras(root / TRANSFORMS)], list(_colmap_poses(root / SPARSE))]
    same = (len(poses) == len(wanted) for poses in read)
    first, second = (float(np.abs(np.array(p) - wanted).max()) if fits else np.inf for p, fits in zip(read, same))
    return first, second


def _colmap_poses(folder: Path) -> Iterator[np.ndarray]:
    """T_cam_world [4, 4] of the images in order."""
    lines = (folder / "images.txt").read_text(encoding="utf-8").splitlines()
    for line in lines[::2]:
        w, x, y, z, *translation = (float(value) for value in line.split()[1:8])
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = Rotation.from_quat([x, y, z, w]).as_matrix(), translation
        yield T


def _training_files(run: FinishedRun, root: Path) -> Iterator[Path]:
    for view in run.views:
        for kind, suffix in (("images", ""), ("masks", ".mask"), ("depths", ".depth")):
            path = root / kind / f"{view.name}.png"
            write_atomically(path, run.file(f"views/{view.name}{suffix}.png").read_bytes(), sync_first=False)
            yield path


def _heldout_files(run: FinishedRun, root: Path, views: Sequence[View]) -> Iterator[Path]:
    """True images count everywhere; their depth is the scaffold's."""
    for view in views:
        everywhere = np.ones((view.camera.height, view.camera.width), bool)
        contents = {
            "images": run.file(TRUTH.format(view.name)).read_bytes(),
            "masks": codecs.encode_mask(everywhere),
            "depths": codecs.encode_depth(cast(run.rays, view.camera).depth),
        }
        for kind, content in contents.items():
            write_atomically(root / kind / f"{view.name}.png", content, sync_first=False)
            yield root / kind / f"{view.name}.png"


def _colmap_files(root: Path, views: Sequence[View], heldout: Sequence[View]) -> list[Path]:
    folder = root / SPARSE
    save_colmap(folder, views, *_points(root / POINTS))
    write_atomically(folder / "test.txt", "".join(f"{view.name}.png\n" for view in heldout))
    return [folder / f"{name}.txt" for name in ("cameras", "images", "points3D", "test")]


def _points(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Places [p, 3] and colours [p, 3] uint8 of a point cloud, as trimesh reads them."""
    import trimesh

    with path.open("rb") as file:
        cloud: Any = trimesh.load(file, file_type="ply", process=False)
    return np.asarray(cloud.vertices, np.float64), np.asarray(cloud.colors, np.uint8)[:, :3]


def _is_whole(root: Path, frame: dict[str, Any]) -> bool:
    """Whether a frame's three files are there in its size."""
    for key in _PLACES:
        path = root / frame[f"{key}path"]
        if not path.is_file():
            return False
        with Image.open(path) as image:
            if image.size != (frame["w"], frame["h"]):
                return False
    return True
