"""A nerfstudio folder: transforms.json, images, masks, depths, and a coloured point cloud that trainers start from.

Poses are camera to world with OpenGL's camera axes (x right, y up, z back), the world's z up, metres; depth is a 16-bit PNG of
millimetres along z; masks are white where the image counts. Normals, instances and classes lie beside, under keys of our own.
Source: nerfstudio's documentation, "Data conventions".
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from wm import codecs
from wm.artifacts.atomic import write_atomically
from wm.capture.frames import CapturedFrame
from wm.capture.png import encode_16_bits, encode_normals
from wm.geometry import unproject_depth
from wm.splat import save_point_cloud
from wm.types import View

NAME = "nerfstudio"
_CLOUD = "points.ply"
_POINTS = 200_000
"""Of the cloud at most, evenly from all frames."""


class NerfstudioWriter:
    """Writes frames one by one and the files about all of them at the end."""

    def __init__(self, folder: Path, count: int) -> None:
        self._folder = folder / NAME
        self._share = max(1, _POINTS // max(count, 1))  # points of a frame
        self._frames: list[dict[str, Any]] = []
        self._points: list[np.ndarray] = []
        self._colors: list[np.ndarray] = []

    def add(self, frame: CapturedFrame) -> None:
        """Writes the images of a frame."""
        number = len(self._frames)
        files = {
            "file_path": ("images", codecs.encode_png(frame.rgb)),
            "mask_path": ("masks", codecs.encode_mask(frame.mask)),
            "depth_file_path": ("depths", codecs.encode_depth(frame.depth)),
            "normal_file_path": ("normals", encode_normals(frame.normal)),
            "instance_file_path": ("instances", encode_16_bits(frame.instance)),
            "semantic_file_path": ("semantics", encode_16_bits(frame.semantic)),
        }
        for kind, data in files.values():
            write_atomically(self._folder / kind / f"{number:05d}.png", data, sync_first=False)
        paths = {key: f"{kind}/{number:05d}.png" for key, (kind, _) in files.items()}
        self._frames.append(paths | _pose(frame, number) | {"time": frame.station.time})
        self._collect(frame)

    def finish(self) -> list[Path]:
        """Writes transforms.json and the point cloud; returns their paths."""
        transforms, cloud = self._folder / "transforms.json", self._folder / _CLOUD
        points, colors = np.concatenate(self._points), np.concatenate(self._colors)
        write_atomically(cloud, lambda part: save_point_cloud(part, points, colors))
        told = {
            "camera_model": "OPENCV",
            "depth_unit_scale_factor": codecs.DEPTH_UNIT,
            "ply_file_path": _CLOUD,
            "frames": self._frames,
        }
        write_atomically(transforms, json.dumps(told, indent=1) + "\n")
        return [transforms, cloud]

    def _collect(self, frame: CapturedFrame) -> None:
        """Some points of a frame, evenly over the pixels that have depth and count in the mask."""
        good = np.flatnonzero((frame.depth > 0) & frame.mask)
        some = good[:: max(1, -(-len(good) // self._share))]
        points = unproject_depth(frame.station.camera, frame.depth).reshape(-1, 3)[some]
        self._points.append(points)
        self._colors.append(frame.rgb.reshape(-1, 3)[some])


def _pose(frame: CapturedFrame, number: int) -> dict[str, Any]:
    """The pose and the intrinsics as the run's own cameras.json has them; the frame's files are ours."""
    name = frame.station.name or f"{number:05d}"
    told = codecs.camera_frame(View(camera=frame.station.camera, room=0, kind="capture", name=name), frame.station.room or "")
    kept = {key: value for key, value in told.items() if not key.endswith("_path")}
    return kept if frame.station.room else {key: value for key, value in kept.items() if key != "room"}
