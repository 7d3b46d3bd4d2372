"""What a camera of a trajectory sees: colour, depth, normals, instances and classes."""

import dataclasses
from pathlib import PurePosixPath

import numpy as np

from wm import codecs
from wm.capture.labels import LabelTable
from wm.capture.request import CaptureRequest
from wm.capture.trajectories import Station
from wm.color import to_bytes
from wm.finished import FinishedRun
from wm.geometry import cast, visible_rooms
from wm.splat import SceneRenderer
from wm.types import View

OPAQUE = 0.5
"""Alpha from which on a pixel of a render counts in the mask: below it more of the black behind is seen than of the scene."""


@dataclasses.dataclass(frozen=True, eq=False)
class CapturedFrame:
    """The images of one station.

    Attributes:
        rgb: [h, w, 3] uint8 sRGB
        mask: [h, w] bool: where the colour counts
        depth: [h, w] float32 z-depth, metres; 0 where there is none
        normal: [h, w, 3] float32 unit normals of the scaffold in world axes, 0 where nothing is hit
        instance, semantic: [h, w] uint16, numbers of the label table, 0 where nothing is hit
    """

    station: Station
    rgb: np.ndarray
    mask: np.ndarray
    depth: np.ndarray
    normal: np.ndarray
    instance: np.ndarray
    semantic: np.ndarray


class FrameMaker:
    """Makes frames of a run, one at a time."""

    def __init__(self, run: FinishedRun, request: CaptureRequest, table: LabelTable) -> None:
        self._run, self._request, self._table = run, request, table
        renders = "splats" in (request.rgb, request.depth)
        self._renderer = SceneRenderer(run.gaussians_by_room, run.raster) if renders else None

    def frame(self, station: Station) -> CapturedFrame:
        """What the station sees. Raises: UnfinishedRunError: the run has no image of the view."""
        buffer = cast(self._run.rays, station.camera)
        depth, rgb, mask = buffer.depth, None, buffer.hit
        if self._renderer is not None:
            view = View(camera=station.camera, room=0, kind="", name=station.name)
            rooms = np.flatnonzero(visible_rooms(self._run.plan, self._run.scaffold, view)[0])
            render = self._renderer.render(station.camera, [int(room) for room in rooms], buffer.depth)
            rgb, mask = to_bytes(np.asarray(render.rgb)), np.asarray(render.alpha) >= OPAQUE
            depth = np.asarray(render.depth) if self._request.depth == "splats" else depth
        if rgb is None or self._request.rgb == "images":
            rgb, mask = self._painted(station)
        instance = np.where(buffer.hit, self._table.face_instance[buffer.face], 0).astype(np.uint16)
        return CapturedFrame(
            station=station,
            rgb=rgb,
            mask=mask,
            depth=depth,
            normal=buffer.normal,
            instance=instance,
            semantic=self._table.instance_class[instance],
        )

    def _painted(self, station: Station) -> tuple[np.ndarray, np.ndarray]:
        """The training image of a view and where it counts."""
        name = PurePosixPath("views") / station.name
        rgb = codecs.decode_png(self._run.file(f"{name}.png").read_bytes())
        return rgb, codecs.decode_mask(self._run.file(f"{name}.mask.png").read_bytes())
