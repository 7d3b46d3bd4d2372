"""Renders of a scene whose gaussians are kept by room: only the rooms that a camera may see are projected."""

import threading
from collections.abc import Sequence

import jax
import numpy as np

from wm.schema import RasterSettings
from wm.splat.optimization.batch import Device, default_device
from wm.splat.optimization.frozen import join_columns, pad_columns, visible_columns
from wm.splat.optimization.padding import Capacity, host, pad_gaussians, plan_with
from wm.splat.optimization.step import project_view, rasterize_view
from wm.types import Camera, Gaussians, Render

_COLUMNS = 2.0
"""Factor by which the padded number of visible gaussians exceeds the need when it grows, so that most views share a compiled
pass."""


class SceneRenderer:
    """Renders views of many rooms; may be called from several threads.

    Padded sizes only grow, so the views of a camera path through a scene compile a handful of times.
    """

    def __init__(
        self,
        rooms: Sequence[Gaussians],
        raster: RasterSettings,
        *,
        capacity: Capacity | None = None,
        device: Device | None = None,
    ) -> None:
        """A renderer of rooms.

        Args:
          rooms: the gaussians of each room, on the host.
          raster: the rasterizer's constants.
          capacity: of the fit that made the gaussians: images of its size then reuse what was compiled for it.
          device: the jax.Device that renders, JAX's default if None.
        """
        largest = max((len(room.opacity_logits) for room in rooms), default=0)
        self._device = device or default_device()
        self._rooms = [jax.device_put(pad_gaussians(room, largest), self._device) if largest else None for room in rooms]
        self._raster = raster
        self._capacity = capacity or Capacity()
        self._columns = largest if len(rooms) == 1 else 2 * largest  # as the fit has them
        self._growing = threading.Lock()

    def render(self, camera: Camera, rooms: Sequence[int], scaffold_depth: np.ndarray | None = None) -> Render:
        """What the camera sees (NumPy leaves), over black.

        Args:
          camera: any camera.
          rooms: indices of the rooms it may see; the others are not projected.
          scaffold_depth: [h, w] metres, as large as the image or coarser; gaussians well behind it are left out. They would show
            only through surfaces.
        """
        camera = jax.tree.map(lambda x: np.asarray(x, np.float32), camera)
        depth = np.zeros((1, 1), np.float32) if scaffold_depth is None else scaffold_depth
        size = (camera.height, camera.width)
        on_device = jax.device_put(camera, self._device)
        seen = [
            visible_columns(host(project_view(self._rooms[room], on_device, raster=self._raster)), depth, size)
            for room in rooms
            if self._rooms[room] is not None
        ]
        if not seen:
            empty = np.zeros((camera.height, camera.width), np.float32)
            return Render(rgb=np.zeros((camera.height, camera.width, 3), np.float32), depth=empty, alpha=empty)
        projected = join_columns(*seen)
        count = projected.opacity.shape[-1]
        with self._growing:
            if count > self._columns:
                self._columns = int(count * _COLUMNS)
            columns = self._columns
        projected = pad_columns(projected, columns)
        plan = plan_with(projected, camera.width, camera.height, self._raster, self._capacity)
        return host(rasterize_view(projected, plan, width=camera.width, height=camera.height, raster=self._raster))
