"""Which surfaces the views see, and which rooms a view can look into.

The reachable surface is what a visitor could see who stands or sits anywhere in the rooms: points of the mesh, even by area,
that face and are in sight of at least one probe in free air. Outer skin, the backs of cupboards and the undersides of low
tables are not part of it, so they cost no coverage.

Tiers of work: per scene the surface points and the probes; per probe and per view the shadow rays of the points that face it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.air import floor_grid, free
from wm.geometry.camera import camera_center, project_points
from wm.geometry.footprint import interior_polygon
from wm.geometry.plan_records import FloorPlan
from wm.geometry.raycast import RayScene, build_ray_scene, occluded
from wm.types import Mesh, SurfaceKind, View

_POINTS = 20_000
"""Surface points: a share near 0.97 is then known to about 0.001."""
_LIFT = 1e-3  # metres in front of its surface from which a point looks, so that it does not shadow itself
_EYES = (1.0, 1.6)  # metres above the floor: a visitor sitting, a visitor standing
_ELBOW = 0.15  # metres of free air around a probe
_PROBES = 40  # a room and height


@dataclasses.dataclass(frozen=True)
class Coverage:
    """Shares (0..1, by area) of the reachable surface."""

    once: float  # seen by at least one view
    three: float  # seen by at least three


@dataclasses.dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on a mesh, each standing for the same area."""

    position: np.ndarray  # [p, 3] float64
    normal: np.ndarray  # [p, 3] float64 unit
    face: np.ndarray  # [p] int


def coverage(plan: FloorPlan, mesh: Mesh, views: Sequence[View]) -> Coverage:
    """The shares of the reachable surface that the views see: in the picture, facing it, with nothing between.

    Both are 0 without views, and 1 where nothing is reachable (a plan without rooms has nothing to see).
    """
    scene = build_ray_scene(mesh)
    points = surface_points(mesh, _POINTS)
    reachable = reachable_points(plan, scene, points)
    points = SurfacePoints(points.position[reachable], points.normal[reachable], points.face[reachable])
    if not len(points.face):
        return Coverage(once=1.0, three=1.0)
    times = times_seen(scene, points, views)
    return Coverage(once=float(np.mean(times >= 1)), three=float(np.mean(times >= 3)))


def surface_points(mesh: Mesh, count: int) -> SurfacePoints:
    """About `count` points over all but the outer skin, evenly by area; the same for the same mesh.

    Source: systematic sampling along the faces' summed area, and within a face the R2 sequence (Roberts, "The Unreasonable
    Effectiveness of Quasirandom Sequences", 2018) folded into the triangle.
    """
    faces = np.flatnonzero(mesh.face_kind != SurfaceKind.EXTERIOR)
    corners = mesh.vertices[mesh.faces[faces]]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(cross, axis=1)
    total = np.cumsum(doubled)
    if not len(total) or total[-1] == 0:
        return SurfacePoints(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0, int))
    k = np.arange(count)
    chosen = np.minimum(np.searchsorted(total, (k + 0.5) / count * total[-1], side="right"), len(faces) - 1)
    u, v = np.modf(0.5 + k * 0.7548776662466927)[0], np.modf(0.5 + k * 0.5698402909980532)[0]
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    p0, p1, p2 = corners[chosen].transpose(1, 0, 2)
    return SurfacePoints(
        position=(1 - u - v)[:, None] * p0 + u[:, None] * p1 + v[:, None] * p2,
        normal=cross[chosen] / doubled[chosen, None],
        face=faces[chosen],
    )


def reachable_points(plan: FloorPlan, scene: RayScene, points: SurfacePoints) -> Bool[np.ndarray, "p"]:
    """Which points at least one probe sees: probes of a point's own room first, then for what is left those of all rooms."""
    probes = [_room_probes(plan, index, scene) for index in range(len(plan.rooms))]
    reached = np.zeros(len(points.face), bool)
    room = scene.mesh.face_room[points.face]
    for index, own in enumerate(probes):
        for probe in own:
            left = np.flatnonzero((room == index) & ~reached)
            reached[left] = _in_sight(scene, points, left, probe)
    for probe in (probe for own in probes for probe in own):
        left = np.flatnonzero(~reached)
        reached[left] = _in_sight(scene, points, left, probe)
    return reached


def times_seen(scene: RayScene, points: SurfacePoints, views: Sequence[View]) -> np.ndarray:
    """How many views see each point, int [p]."""
    times = np.zeros(len(points.face), int)
    for view in views:
        uv, depth = project_points(view.camera, points.position)
        with np.errstate(invalid="ignore"):
            framed = (depth > 0) & np.all((uv >= 0) & (uv < (view.camera.width, view.camera.height)), axis=1)
        inside = np.flatnonzero(framed)
        times[inside] += _in_sight(scene, points, inside, camera_center(view.camera))
    return times


def _room_probes(plan: FloorPlan, index: int, scene: RayScene) -> Float[np.ndarray, "n 3"]:
    floor = interior_polygon(plan, index).buffer(-_ELBOW)
    grid = floor_grid(floor, _PROBES)
    heights = [height for height in _EYES if height + _ELBOW < plan.rooms[index].ceiling_height]
    probes = np.concatenate([np.column_stack([grid, np.full(len(grid), height)]) for height in heights] or [np.zeros((0, 3))])
    return probes[free(scene, probes, _ELBOW)]


def _in_sight(scene: RayScene, points: SurfacePoints, which: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Whether the points `which` face the eye with nothing between, bool."""
    normal = points.normal[which]
    towards = eye - points.position[which]
    seen = np.sum(normal * towards, axis=1) > _LIFT
    facing = np.flatnonzero(seen)
    origins = points.position[which[facing]] + _LIFT * normal[facing]
    seen[facing] = ~occluded(scene, origins, eye - origins, 1.0 - 1e-4)
    return seen
