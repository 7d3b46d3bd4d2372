"""`Drawer`: what a camera sees of a compared scene, whatever it is made of."""

import dataclasses
from typing import Protocol, runtime_checkable

import numpy as np

from wm.compare.axes import moved_camera, rotation_matrix
from wm.compare.painted_mesh import PaintedMesh, see
from wm.compare.records import ComparedScene
from wm.finished import FinishedRun
from wm.geometry import cast
from wm.geometry.rays.pinhole import scale_camera
from wm.schema import RasterSettings
from wm.splat.scene.scene_render import SceneRenderer
from wm.types import OUTSIDE, Camera, Gaussians, Render

GLIMPSE = 1 / 4
"""Share of the resolution at which the scaffold of a run of ours is cast: it tells which rooms show."""
ROOM = 3.0
"""Metres that half the extent of a scene without a metric unit is taken to be: gaussians nearer than `RasterSettings.near` to the
eye are not drawn, 5 cm in a scene of ours."""


@runtime_checkable
class Drawer(Protocol):
    """Draws one scene; may be called from several threads."""

    def __call__(self, camera: Camera) -> Render:
        """What a camera of the comparison's world sees (NumPy leaves), over black."""
        ...


def drawer_of(scene: ComparedScene) -> Drawer:
    """What draws a scene as it was trained to be drawn."""
    if scene.run is not None:
        return _RunDrawer(scene.run, antialias=scene.antialias)
    if scene.mesh is not None:
        return _MeshDrawer(scene.mesh, rotation_matrix(scene.R_world_file))
    assert scene.gaussians is not None
    return _SplatDrawer(scene.gaussians, rotation_matrix(scene.R_world_file), antialias=scene.antialias, metric=scene.metric)


class _RunDrawer:
    def __init__(self, run: FinishedRun, *, antialias: bool) -> None:
        self._run = run
        self._mesh, self._rays = run.scaffold, run.rays
        self._renderer = SceneRenderer(run.gaussians_by_room, dataclasses.replace(run.raster, antialias=antialias))

    def __call__(self, camera: Camera) -> Render:
        gbuffer = cast(self._rays, scale_camera(camera, GLIMPSE))
        rooms = np.unique(self._mesh.face_room[gbuffer.face[gbuffer.hit]])
        return self._renderer.render(camera, [int(room) for room in rooms if room != OUTSIDE], gbuffer.depth)


class _MeshDrawer:
    def __init__(self, mesh: PaintedMesh, T_world_file: np.ndarray) -> None:
        self._mesh, self._T = mesh, T_world_file

    def __call__(self, camera: Camera) -> Render:
        return see(self._mesh, moved_camera(camera, self._T))


class _SplatDrawer:
    """Draws gaussians without a metric unit as if they were ROOM across, where the rasterizer's nearest depth makes sense."""

    def __init__(self, gaussians: Gaussians, T_world_file: np.ndarray, *, antialias: bool, metric: bool) -> None:
        self._scale = 1.0 if metric else ROOM / extent(np.asarray(gaussians.means))
        scaled = dataclasses.replace(
            gaussians,
            means=np.asarray(gaussians.means) * np.float32(self._scale),
            log_scales=np.asarray(gaussians.log_scales) + np.float32(np.log(self._scale)),
        )
        self._renderer = SceneRenderer([scaled], RasterSettings(antialias=antialias))
        self._T = T_world_file

    def __call__(self, camera: Camera) -> Render:
        T = moved_camera(camera, self._T).T_cam_world.copy()
        T[:3, 3] *= self._scale
        render = self._renderer.render(dataclasses.replace(camera, T_cam_world=T), [0])
        return dataclasses.replace(render, depth=np.asarray(render.depth) / np.float32(self._scale))


def extent(means: np.ndarray) -> float:
    """Half the extent of the middle nine tenths of points, along the axis along which they spread most; above 0."""
    low, high = np.quantile(means[np.isfinite(means).all(axis=1)], [0.05, 0.95], axis=0)
    return max(float(np.max(high - low)) / 2, 1e-9)
