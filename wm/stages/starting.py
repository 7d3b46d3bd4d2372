"""The initial gaussians of a room: on all of its surface that can be seen from somewhere, also where none of its own views looks.

Most lie on the surface that the room's own views show. Exposed surface that these views miss is covered as well
(wm.geometry.cameras.exposed_surface), in colours from the views of other rooms that see it through the doors, or else from the
nearest covered surface of the same object and material: the side of a fireplace is as its front and not as the soot behind it.
Those that no view of the room shows start out of sight of its views (wm.stages.tucked), so that the fit does not fade them.
"""

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial import KDTree

from wm.geometry import visible_rooms
from wm.geometry.cameras.exposed_surface import exposed, room_eyes, room_surface
from wm.geometry.rays.pinhole import camera_center, project_points
from wm.geometry.rays.surface_points import SurfacePoints, in_picture, in_sight, some_points, times_seen
from wm.schema import CameraSettings, FitSettings
from wm.splat.optimization.cloud import TANGENTIAL, TANGENTIAL_DETAIL, Cloud, extended, initial_gaussians, one_a_cell, vacant
from wm.splat.optimization.training import TrainingView
from wm.stages.scene import Scene
from wm.stages.tucked import tucked
from wm.types import OUTSIDE, Gaussians, SurfaceKind, View

LOOKALIKES, FACING = 4, 0.25
"""An added gaussian has the mean colour of so many of its surface, the nearest; opposite normals count as twice FACING metres."""

Picture = Callable[[View], tuple[np.ndarray, np.ndarray]]
"""Returns the image [h, w, 3] uint8 of a view and its usable pixels [h, w] bool."""


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
        views: the training views of the room.
        picture: reads the image of a view of another room; None if the views are not painted yet.
        cameras: gives the heights at which eyes may be.
        rng: see `initial_gaussians`.
    """

    def complete(cloud: Cloud) -> Cloud:
        surface = room_surface(scene.mesh, room, spacing=settings.spacing, detail_spacing=settings.detail_spacing)
        bare = _bare(scene, room, surface, cloud, cameras, settings)
        colors = np.full((len(bare.face), 3), np.nan) if picture is None else _shown(scene, room, bare, picture)
        colors = np.where(np.isnan(colors), _of_the_same_surface(scene, surface, cloud, bare), colors)
        return extended(cloud, _covering(scene, room, bare, colors, _spacings(scene, bare, settings)))

    return initial_gaussians(views, settings=settings, rng=rng, complete=complete)


def _bare(
    scene: Scene, room: int, surface: SurfacePoints, cloud: Cloud, cameras: CameraSettings, settings: FitSettings
) -> SurfacePoints:
    """Exposed points of the room's surface: one in every cell that the cloud leaves empty."""
    spacings = _spacings(scene, surface, settings)
    points = some_points(surface, vacant(cloud, surface.position, surface.normal, spacings))
    # Exposed points are selected before cells are, since a cell may also contain a layer that another one hides.
    points = some_points(points, exposed(scene.rays, points, room_eyes(scene.plan, scene.rays, room, cameras)))
    return some_points(points, one_a_cell(points.position, points.normal, _spacings(scene, points, settings)))


def _covering(
    scene: Scene, room: int, bare: SurfacePoints, colors: Float[np.ndarray, "p 3"], spacings: Float[np.ndarray, "p"]
) -> Cloud:
    """A cloud on bare points. What no view of the room sees stays out of sight of its views."""
    cameras = [view.camera for view in scene.views if view.room == room]
    shown = times_seen(scene.rays, bare, cameras) > 0
    extents = np.where(shown, TANGENTIAL_DETAIL, TANGENTIAL) * spacings
    discs = tucked(scene.rays, some_points(bare, ~shown), extents[~shown], cameras)
    centres, sizes = bare.position.copy(), np.repeat(extents[:, None], 2, axis=1)
    centres[~shown], sizes[~shown] = discs.centres, discs.extents
    return Cloud(points=centres, normals=bare.normal, colors=colors, spacings=spacings, extents=sizes, shown=shown)


def _spacings(scene: Scene, points: SurfacePoints, settings: FitSettings) -> Float[np.ndarray, "p"]:
    return np.where(scene.mesh.face_object[points.face] != OUTSIDE, settings.detail_spacing, settings.spacing)


def _of_the_same_surface(scene: Scene, surface: SurfacePoints, cloud: Cloud, bare: SurfacePoints) -> Float[np.ndarray, "p 3"]:
    """The mean colour of the points of the cloud that are nearest to each on its own object and material, facing much the same
    way; NaN where the cloud shows nothing of these."""
    colors = np.full((len(bare.face), 3), np.nan)
    if not len(cloud.points) or not len(bare.face):
        return colors
    number = _surface_numbers(scene)
    _, nearest = KDTree(_places(surface.position, surface.normal)).query(_places(cloud.points, cloud.normals))
    known, wanted = number[surface.face[nearest]], number[bare.face]
    for one in np.intersect1d(known, wanted):
        there, here = np.flatnonzero(known == one), np.flatnonzero(wanted == one)
        tree = KDTree(_places(cloud.points[there], cloud.normals[there]))
        _, found = tree.query(_places(bare.position[here], bare.normal[here]), k=min(LOOKALIKES, len(there)))
        colors[here] = cloud.colors[there[np.reshape(found, (len(here), -1))]].mean(axis=1)
    return colors


def _places(points: Float[np.ndarray, "n 3"], normals: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 6"]:
    return np.concatenate([points, FACING * normals], axis=1)


def _surface_numbers(scene: Scene) -> np.ndarray:
    """[f] a number for each kind of structure, and for each material of each object."""
    mesh = scene.mesh
    slot = np.zeros(len(mesh.faces), np.int64)
    slot[mesh.face_object != OUTSIDE] = np.concatenate([np.zeros(0, np.int64), *(thing.face_slot for thing in scene.objects)])
    slots = 1 + int(slot.max(initial=0))
    return np.where(mesh.face_object == OUTSIDE, mesh.face_kind, len(SurfaceKind) + mesh.face_object * slots + slot)


def _shown(scene: Scene, room: int, points: SurfacePoints, picture: Picture) -> Float[np.ndarray, "p 3"]:
    """The mean colour of each point in the views of other rooms that show it; NaN where none does."""
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
