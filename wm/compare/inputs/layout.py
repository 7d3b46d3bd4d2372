"""A room as layout-guided methods are given it: a closed shell, and a box for each thing, coloured by class."""

import dataclasses
import itertools

import numpy as np
import shapely
from jaxtyping import Float

from wm.compare.inputs.classes import CEILING, FLOOR, WALL, class_of
from wm.finished import FinishedRun
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.rays.raycast import RayScene, build_ray_scene
from wm.types import Mesh, SceneObject

_BOX = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_BOX_FACES = np.array([
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
])  # fmt: skip


@dataclasses.dataclass(frozen=True, eq=False)
class ThingBox:
    """The oriented box of a thing."""

    id: str
    label: str  # SpatialGen's class
    color: tuple[int, int, int]
    T_world_box: np.ndarray  # [4, 4], the box's middle, without scale
    size: np.ndarray  # [3] metres


@dataclasses.dataclass(frozen=True, eq=False)
class RoomLayout:
    """The layout of one room: rays for what is drawn, a colour for each face, and its boxes."""

    rays: RayScene
    face_color: np.ndarray  # [f, 3] uint8
    boxes: tuple[ThingBox, ...]


def room_layout(run: FinishedRun, room: int, *, around: Float[np.ndarray, "n 3"] | None = None) -> RoomLayout:
    """The layout of a room.

    Args:
        around: places of cameras; a box that holds one is left out, as SpatialGen does.
    """
    boxes = tuple(box_of(thing) for thing in run.objects if thing.room == room)
    if around is not None:
        boxes = tuple(box for box in boxes if not _holds(box, around))
    vertices, faces, colors = _shell(run, room)
    for box in boxes:
        corners = (_BOX * box.size) @ box.T_world_box[:3, :3].T + box.T_world_box[:3, 3]
        faces.append(_BOX_FACES + sum(map(len, vertices)))
        vertices.append(corners)
        colors.append(np.tile(np.array(box.color, np.uint8), (len(_BOX_FACES), 1)))
    mesh = Mesh.from_triangles(np.concatenate(vertices), np.concatenate(faces))
    return RoomLayout(rays=build_ray_scene(mesh), face_color=np.concatenate(colors), boxes=boxes)


def box_of(thing: SceneObject) -> ThingBox:
    """The box of a thing along its own axes."""
    T = np.asarray(thing.T_world_object, np.float64)
    rotation = T[:3, :3] / np.linalg.norm(T[:3, :3], axis=0)
    local = (thing.vertices - T[:3, 3]) @ rotation
    low, high = local.min(axis=0), local.max(axis=0)
    T_world_box = np.eye(4)
    T_world_box[:3, :3] = rotation
    T_world_box[:3, 3] = rotation @ ((low + high) / 2) + T[:3, 3]
    label, color = class_of(thing.label)
    return ThingBox(id=thing.id, label=label, color=color, T_world_box=T_world_box, size=np.maximum(high - low, 0.01))


def _holds(box: ThingBox, places: Float[np.ndarray, "n 3"]) -> bool:
    local = (places - box.T_world_box[:3, 3]) @ box.T_world_box[:3, :3]
    return bool((np.abs(local) < box.size / 2).all(axis=1).any())


def _shell(run: FinishedRun, room: int) -> tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray]]:
    """Vertices, faces and colours of walls, floor and ceiling without openings."""
    polygon, height = interior_polygon(run.plan, room), run.plan.rooms[room].ceiling_height
    triangles = [shapely.get_coordinates(t)[:3] for t in shapely.constrained_delaunay_triangles(polygon).geoms]
    flat = np.concatenate(triangles)
    floor = np.column_stack([flat, np.zeros(len(flat))])
    ring = shapely.get_coordinates(polygon.exterior)
    walls = []
    for a, b in itertools.pairwise(ring):
        low, high = [[*a, 0.0], [*b, 0.0]], [[*b, height], [*a, height]]
        walls += [low[0], low[1], high[0], low[0], high[0], high[1]]
    parts = [(floor, FLOOR), (floor + np.array([0, 0, height]), CEILING), (np.array(walls), WALL)]
    vertices, faces, colors, start = [], [], [], 0
    for corners, color in parts:
        vertices.append(corners)
        faces.append(start + np.arange(len(corners)).reshape(-1, 3))
        colors.append(np.tile(np.array(color, np.uint8), (len(corners) // 3, 1)))
        start += len(corners)
    return vertices, faces, colors
