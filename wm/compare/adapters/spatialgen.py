"""SpatialGen: `inference_results.npz`, the views that it has made of a room, with their depths, from which it fits gaussians.

One entry a room, a pickled dictionary: lists of `*_points` [h w, 3], `*_colors` [h w, 3] in [0, 1], `*_poses` (camera to world,
OpenCV's axes), `input_poses_metric`, and `scene_scale`. Points that a mask refused were multiplied by 0 and lie at the origin.
The world is the first view's camera, scaled; with the metric pose of that view it is the layout's own: z up, in metres.

The fit itself (Sparse-RaDeGS) is not redone: points become small round gaussians.
A PLY of a fitted scene can be given as `splats`. Pickles are read with an unpickler that makes nothing but NumPy's arrays.
"""

import io
import pathlib
import pickle
import zipfile
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from wm.compare.adapters.files import check_some, one_file, reading
from wm.compare.axes import mean_up, moved_camera, rotation_matrix, upright
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene, Source, System
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Camera, Gaussians

SYSTEM = System(
    name="SpatialGen",
    file="inference_results.npz",
    up="+z of the layout, by the metric pose of the first view",
    scale="metres, by scene_scale",
    colors="points with sRGB",
    activations="none: points, which become round gaussians",
    antialias=False,
    source="manycore-research/SpatialGen: src/inference_sd.py",
    commit="677c1168b359b00ae4a64a58783bc71048aabcdd",
)
_EXPECTED = "SpatialGen's inference_results.npz: one dictionary a room with input_ and target_points, _colors and _poses"
_NEEDED = tuple(f"{kind}_{what}" for kind in ("input", "target") for what in ("points", "colors", "poses"))
MOST = 600_000
"""Points that are kept, evenly strided: more than a screen shows of one room."""
_OPACITY_LOGIT = 4.0
"""Opacity 0.98: the points are surfaces as they are, and nothing trains them."""


def files(source: Source) -> list[pathlib.Path]:
    """The files whose content decides what is drawn. Raises: CompareError."""
    return [one_file(source, _EXPECTED, "inference_results.npz")]


def read(source: Source) -> ComparedScene:
    """The only room of the file. Raises: CompareError."""
    (file,) = files(source)
    rooms = reading(source, file, _EXPECTED, read_rooms)
    if len(rooms) != 1:
        raise CompareError(f"{source.method}: {file}: {len(rooms)} rooms; expected {_EXPECTED}, with one room")
    ((_, room),) = rooms.items()
    missing = [name for name in _NEEDED if not len(room.get(name, ()))]
    if missing:
        raise CompareError(f"{source.method}: {file}: no {', '.join(missing)}; expected {_EXPECTED}")
    return reading(source, file, _EXPECTED, lambda path: _scene(source, path, room))


def read_rooms(file: pathlib.Path) -> dict[str, dict[str, Any]]:
    """The dictionaries of a file by room. Raises: ValueError, OSError where it is anything else."""
    try:
        with zipfile.ZipFile(file) as archive:
            return {name.removesuffix(".npy"): _dictionary(archive.read(name), name) for name in archive.namelist()}
    except zipfile.BadZipFile as error:
        raise ValueError(f"{file}: no whole .npz archive ({error})") from error


def _dictionary(raw: bytes, name: str) -> dict[str, Any]:
    stream = io.BytesIO(raw)
    version = np.lib.format.read_magic(stream)
    read_header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, dtype = read_header(stream)
    if shape != () or dtype.kind != "O":
        raise ValueError(f"{name} is an array of {dtype}, not a dictionary")
    try:
        held = _Arrays(stream).load()
    except (pickle.UnpicklingError, EOFError, AttributeError, IndexError, ImportError) as error:
        raise ValueError(f"{name} cannot be unpickled: {error}") from error
    room = held.item() if isinstance(held, np.ndarray) and held.shape == () else held
    if not isinstance(room, dict):
        raise ValueError(f"{name} holds a {type(room).__name__}, not a dictionary")
    return room


class _Arrays(pickle.Unpickler):
    """Makes NumPy's arrays and plain values, and refuses whatever else a pickle may name."""

    def find_class(self, module: str, name: str) -> Any:
        root = module.replace("numpy._core", "numpy.core")
        if root in ("numpy", "numpy.core.multiarray", "numpy.core.numeric") and name in _MADE:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"it names {module}.{name}; arrays and plain values would be right")


_MADE = {"ndarray", "dtype", "_reconstruct", "scalar", "_frombuffer"}


def _scene(source: Source, file: pathlib.Path, room: dict[str, Any]) -> ComparedScene:
    points = np.concatenate([np.asarray(x, np.float64).reshape(-1, 3) for kind in _KINDS for x in room[f"{kind}_points"]])
    colors = np.concatenate([np.asarray(x, np.float64).reshape(-1, 3) for kind in _KINDS for x in room[f"{kind}_colors"]])
    if len(points) != len(colors):
        raise ValueError(f"{len(points)} points and {len(colors)} colours")
    kept = np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)
    points, colors = points[kept], colors[kept]
    check_some(source, file, len(points), _EXPECTED)
    stride = -(-len(points) // MOST)
    points, colors = points[::stride], colors[::stride]
    poses = [np.asarray(x, np.float64).reshape(4, 4) for kind in _KINDS for x in room[f"{kind}_poses"]]
    T_layout_file, metric = _layout(room)
    scale = np.cbrt(np.linalg.det(T_layout_file[:3, :3]))
    cameras = [_camera(T_layout_file, scale, pose, room) for pose in poses]
    rotation = np.eye(3) if metric else upright(mean_up(cameras))
    placed = points @ T_layout_file[:3, :3].T + T_layout_file[:3, 3]
    return ComparedScene(
        method=source.method,
        gaussians=_of_points(placed, colors),
        R_world_file=rotation,
        metric=metric,
        cameras=tuple(moved_camera(camera, rotation_matrix(rotation.T)) for camera in cameras),
    )


_KINDS = ("input", "target")


def _layout(room: dict[str, Any]) -> tuple[np.ndarray, bool]:
    """[4, 4] from the file's world to the layout's in metres, where the file knows it; else the identity."""
    poses, scale = room.get("input_poses_metric"), room.get("scene_scale")
    if poses is None or scale is None or not len(poses):
        return np.eye(4), False
    return np.asarray(poses[0], np.float64).reshape(4, 4) @ np.diag([*np.full(3, 1 / float(scale)), 1.0]), True


def _camera(T_layout_file: np.ndarray, scale: float, pose: np.ndarray, room: dict[str, Any]) -> Camera:
    T = T_layout_file @ pose
    T[:3, :3] /= scale
    image = np.asarray(room["input_rgbs"][0]) if len(room.get("input_rgbs", ())) else np.zeros((256, 256, 3))
    height, width = image.shape[:2]
    K = np.asarray(room["intrinsic"], np.float64).reshape(3, 3) if "intrinsic" in room else None
    focal = np.array([K[0, 0], K[1, 1]]) if K is not None else np.full(2, width / 2)
    return Camera(
        T_cam_world=np.linalg.inv(T), focal=focal, principal=np.array([width / 2, height / 2]), width=width, height=height
    )


def _of_points(points: np.ndarray, colors: np.ndarray) -> Gaussians:
    """Round gaussians half as large as points are apart, nearly opaque."""
    n = len(points)
    distance = KDTree(points).query(points, k=min(4, n))[0].reshape(n, -1)[:, 1:]
    size = np.sqrt((distance**2).mean(axis=1)) if distance.shape[1] else np.ones(n)
    return Gaussians(
        means=points.astype(np.float32),
        quats=np.tile(np.array([1, 0, 0, 0], np.float32), (n, 1)),
        log_scales=np.repeat(np.log(np.maximum(size / 2, 1e-6))[:, None], 3, axis=1).astype(np.float32),
        opacity_logits=np.full(n, _OPACITY_LOGIT, np.float32),
        sh=((colors[:, None] - 0.5) / SH_C0).astype(np.float32),
    )
