"""A folder as those of the TUM RGB-D benchmark: rgb/, depth/, their lists, associations.txt and groundtruth.txt.

A line of groundtruth.txt is `timestamp tx ty tz qx qy qz qw`: place and orientation of the colour camera's optical centre in the
world, where the camera's z axis points forward, x right, y down. The world here has z up. Depth is a 16-bit PNG with 5000 steps a
metre, so that it ends at 13.1 m, and 0 where there is none. In the benchmark's tools pixel (0, 0) has its centre at (0, 0): the
principal point in camera.txt is half a pixel less than elsewhere in wm.
Source: Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", IROS 2012, and its page "File Formats".
"""

from pathlib import Path

import numpy as np

from wm import codecs
from wm.artifacts.atomic import write_atomically
from wm.capture.frames import CapturedFrame
from wm.capture.png import depth_steps, encode_16_bits
from wm.geometry import camera_center, camera_quat

NAME = "tum"
STEPS = 5000.0
"""A metre."""


class TumWriter:
    """Writes frames one by one and the lists at the end."""

    def __init__(self, folder: Path, count: int) -> None:
        self._folder = folder / NAME
        self._times: list[str] = []
        self._poses: list[str] = []
        self._cameras: list[str] = []

    def add(self, frame: CapturedFrame) -> None:
        """Writes the two images of a frame."""
        time = f"{frame.station.time:.6f}"
        steps = depth_steps(frame.depth, STEPS)
        write_atomically(self._folder / "rgb" / f"{time}.png", codecs.encode_png(frame.rgb), sync_first=False)
        write_atomically(self._folder / "depth" / f"{time}.png", encode_16_bits(steps), sync_first=False)
        camera = frame.station.camera
        w, x, y, z = camera_quat(camera)
        self._times.append(time)
        self._poses.append(" ".join([time, *(f"{value:.9f}" for value in (*camera_center(camera), x, y, z, w))]))
        cx, cy = np.asarray(camera.principal, float) - 0.5
        fx, fy = np.asarray(camera.focal, float)
        self._cameras.append(" ".join([time, *(f"{value:.6f}" for value in (fx, fy, cx, cy)), f"{camera.width} {camera.height}"]))

    def finish(self) -> list[Path]:
        """Writes the lists; returns their paths."""
        lists = {
            "rgb.txt": ("timestamp filename", [f"{time} rgb/{time}.png" for time in self._times]),
            "depth.txt": ("timestamp filename", [f"{time} depth/{time}.png" for time in self._times]),
            "groundtruth.txt": ("timestamp tx ty tz qx qy qz qw", self._poses),
            "camera.txt": ("timestamp fx fy cx cy width height", self._cameras),
        }
        paths = []
        for name, (head, lines) in lists.items():
            write_atomically(self._folder / name, "\n".join([f"# {head}", *lines]) + "\n")
            paths.append(self._folder / name)
        both = [f"{time} rgb/{time}.png {time} depth/{time}.png" for time in self._times]  # scripts split it without a head
        write_atomically(self._folder / "associations.txt", "\n".join(both) + "\n")
        return [*paths, self._folder / "associations.txt"]
