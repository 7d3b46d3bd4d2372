"""Which surfaces the views see, and which rooms a view can look into.

The reachable surface is what a visitor can see who stands or sits wherever a body fits on the free floor: points of the mesh,
even by area, that face and are in sight of at least one such eye. The outer skin, the backs of cupboards and the undersides
of low tables are not part of it, so they cost no coverage.

Tiers of work: per scene the surface points and the probes; per probe and per view the shadow rays of the points that face it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.cameras.air import FACE, floor_grid, free
from wm.geometry.placement.clearances import BODY
from wm.geometry.placement.navigation import body_floor, object_corners
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.raycast import RayScene, ray_scene
from wm.geometry.rays.surface_points import SurfacePoints, in_sight, some_points, surface_points, times_seen
from wm.types import Mesh, View

_POINTS = 20_000
"""Surface points: a share near 0.97 is then known to about 0.001."""
_EYES = (1.2, 1.6)  # metres above the floor: a visitor sitting, a visitor standing
_PROBES = 40  # per room and height


@dataclasses.dataclass(frozen=True)
class Coverage:
    """Shares (0..1, by area) of the reachable surface."""

    once: float  # seen by at least one view
    three: float  # seen by at least three


def coverage(plan: FloorPlan, mesh: Mesh | RayScene, views: Sequence[View]) -> Coverage:
    """The shares of the reachable surface that the views see: in the picture, facing it, with nothing between.

    Both are 0 without views, and 1 where nothing is reachable (a plan without rooms has nothing to see).
    """
    scene = ray_scene(mesh)
    points = surface_points(scene.mesh, _POINTS)
    reachable = reachable_points(plan, scene, points)
    points = some_points(points, reachable)
    if not len(points.face):
        return Coverage(once=1.0, three=1.0)
    times = times_seen(scene, points, [view.camera for view in views])
    return Coverage(once=float(np.mean(times >= 1)), three=float(np.mean(times >= 3)))


def reachable_points(plan: FloorPlan, scene: RayScene, points: SurfacePoints) -> Bool[np.ndarray, "p"]:
    """Which points at least one probe sees: probes of a point's own room first, then for what is left those of all rooms."""
    probes = _probes(plan, scene)
    reached = np.zeros(len(points.face), bool)
    room = scene.mesh.face_room[points.face]
    for index, own in enumerate(probes):
        for probe in own:
            left = np.flatnonzero((room == index) & ~reached)
            reached[left] = in_sight(scene, points, left, probe)
    for probe in (probe for own in probes for probe in own):
        left = np.flatnonzero(~reached)
        reached[left] = in_sight(scene, points, left, probe)
    return reached


def _probes(plan: FloorPlan, scene: RayScene) -> list[Float[np.ndarray, "n 3"]]:
    """The eyes of visitors in each room, evenly over the floor that a body can stand on."""
    body = body_floor(plan, object_corners(scene.mesh), height=max(_EYES), radius=BODY)
    probes = []
    for index, room in enumerate(plan.rooms):
        grid = floor_grid(interior_polygon(plan, index).intersection(body), _PROBES)
        eyes = [np.column_stack([grid, np.full(len(grid), height)]) for height in _EYES if height + FACE < room.ceiling_height]
        points = np.concatenate([*eyes, np.zeros((0, 3))])
        probes.append(points[free(scene, points, FACE)])
    return probes
