"""One .npz file a frame, without any rounding: colour, depth, normals, instances, classes, pose and intrinsics.

rgb [h, w, 3] uint8          mask [h, w] bool              depth [h, w] float32, metres along z, 0 for none
normal [h, w, 3] float32     instance, semantic [h, w] uint16
T_world_cam [4, 4] float64   OpenCV's camera axes (x right, y down, z forward), the world's z up
K [3, 3] float64             pixels; pixel (i, j) has its centre at (i + 0.5, j + 0.5)
time [] float64              seconds
"""

from pathlib import Path

import numpy as np

from wm import codecs
from wm.artifacts.atomic import write_atomically
from wm.capture.frames import CapturedFrame

NAME = "npz"


class NpzWriter:
    """Writes frames one by one."""

    def __init__(self, folder: Path, count: int) -> None:
        self._folder = folder / NAME
        self._number = 0

    def add(self, frame: CapturedFrame) -> None:
        """Writes the file of a frame."""
        camera = frame.station.camera
        K = np.eye(3)
        K[[0, 1], [0, 1]], K[:2, 2] = camera.focal, camera.principal
        images = {name: getattr(frame, name) for name in ("rgb", "mask", "depth", "normal", "instance", "semantic")}
        pose = {
            "T_world_cam": np.linalg.inv(np.asarray(camera.T_cam_world, np.float64)),
            "K": K,
            "time": np.float64(frame.station.time),
        }
        path = self._folder / f"{self._number:05d}.npz"
        write_atomically(path, codecs.encode_arrays(images | pose), sync_first=False)
        self._number += 1

    def finish(self) -> list[Path]:
        """There are no files about all frames."""
        return []
