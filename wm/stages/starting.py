"""Where the fit of a room starts: gaussians on all its surface that anyone may see, also where none of its own views looks.

What the room's views show makes the cloud. Exposed surface that they leave bare (wm.geometry.cameras.exposed_surface) is covered
too: in the colours that views from other rooms show of it through the doors, else in those of the surface nearest to it. No view
of the room corrects these gaussians, so they keep them.
"""

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from jaxtyping import Float

from wm.geometry import visible_rooms
from wm.geometry.cameras.exposed_surface import exposed, room_eyes, room_surface
from wm.geometry.rays.pinhole import camera_center, project_points
from wm.geometry.rays.surface_points import SurfacePoints, in_picture, in_sight, some_points
from wm.schema import CameraSettings, FitSettings
from wm.splat.optimization.cloud import Cloud, extended, initial_gaussians, one_a_cell, vacant
from wm.splat.optimization.training import TrainingView
from wm.stages.scene import Scene
from wm.types import OUTSIDE, Gaussians, View

Picture = Callable[[View], tuple[np.ndarray, np.ndarray]]
"""From a view its image [h, w, 3] uint8 and its usable pixels [h, w] bool."""


def starting_gaussians(
    scene: Scene,
    room: int,
    views: Iterable[TrainingView],
    picture: Picture | None,
    *,
    cameras: CameraSettings,
    settings: FitSettings,
    rng: np.random.Generator,
) -> Gaussians:
    """The initial gaussians of a room.

    Args:
        views: the room's own.
        picture: the images of the views of other rooms, asked for one at a time; None: they are not painted yet.
        cameras: the heights at which eyes may be.
        rng: as for `initial_gaussians`.
    """

    def complete(cloud: Cloud) -> Cloud:
        bare = _bare(scene, room, cloud, cameras, settings)
        colors = np.full((len(bare.face), 3), np.nan) if picture is None else _shown(scene, room, bare, picture)
        spacings = _spacings(scene, bare, settings)
        return extended(cloud, Cloud(points=bare.position, normals=bare.normal, colors=colors, spacings=spacings))

    return initial_gaussians(views, settings=settings, rng=rng, complete=complete)


def _bare(scene: Scene, room: int, cloud: Cloud, cameras: CameraSettings, settings: FitSettings) -> SurfacePoints:
    """Exposed points of the room's surface, one in every cell that the cloud leaves empty."""
    points = room_surface(scene.mesh, room, spacing=settings.spacing, detail_spacing=settings.detail_spacing)
    points = some_points(points, vacant(cloud, points.position, points.normal, _spacings(scene, points, settings)))
    # exposed ones first: a cell may hold a layer that is hidden under another
    points = some_points(points, exposed(scene.rays, points, room_eyes(scene.plan, scene.rays, room, cameras)))
    return some_points(points, one_a_cell(points.position, points.normal, _spacings(scene, points, settings)))


def _spacings(scene: Scene, points: SurfacePoints, settings: FitSettings) -> Float[np.ndarray, "p"]:
    return np.where(scene.mesh.face_object[points.face] != OUTSIDE, settings.detail_spacing, settings.spacing)


def _shown(scene: Scene, room: int, points: SurfacePoints, picture: Picture) -> Float[np.ndarray, "p 3"]:
    """The mean colour in which the other rooms' views show each point; NaN where none does."""
    total, times = np.zeros((len(points.face), 3)), np.zeros((len(points.face), 1))
    for view in _onlookers(scene, room):
        inside = np.flatnonzero(in_picture(view.camera, points))
        seen = inside[in_sight(scene.rays, points, inside, camera_center(view.camera))]
        if len(seen):
            rgb, usable = picture(view)
            column, row = np.floor(project_points(view.camera, points.position[seen])[0]).astype(np.int64).T
            weight = usable[row, column].astype(np.float64)[:, None]
            total[seen] += weight * rgb[row, column] / 255.0
            times[seen] += weight
    return np.where(times > 0, total / np.maximum(times, 1), np.nan)


def _onlookers(scene: Scene, room: int) -> Sequence[View]:
    """Views of other rooms that look into this one."""
    others = [view for view in scene.views if view.room != room]
    return [view for view, seen in zip(others, visible_rooms(scene.plan, scene.mesh, others)[:, room]) if seen]
