"""The furniture that a plan lists itself, as objects of the scene: boxes, or meshes read from files."""

import dataclasses
import math

import numpy as np

from wm.geometry.exchange.object_file import load_object
from wm.geometry.mesh.scene_mesh import BOX_COLOR, BOX_CORNERS, BOX_FACES
from wm.geometry.placement.support import support_of
from wm.geometry.plan.records import FloorPlan, PlanObject
from wm.types import SceneObject


def plan_objects(plan: FloorPlan) -> tuple[SceneObject, ...]:
    """The plan's own objects, where the plan puts them.

    Raises:
      MeshError: a mesh file cannot be used.
    """
    return tuple(_placed(_boxed(thing) if thing.mesh is None else _shaped(thing, thing.mesh), thing) for thing in plan.objects)


def _boxed(thing: PlanObject) -> SceneObject:
    """A box in its own frame."""
    size = np.array(thing.size, np.float64)
    color = (BOX_COLOR,) * 3 if thing.color is None else thing.color
    return SceneObject(
        label=thing.label,
        room=thing.room,
        support=thing.support or support_of(thing.label, size.tolist(), thing.position[2]),
        vertices=(BOX_CORNERS - [0.5, 0.5, 0.0]) * size,
        faces=BOX_FACES.copy(),
        face_slot=np.zeros(len(BOX_FACES), np.int32),
        slots=("own",),
        slot_colors=np.array([color], np.float32),
        T_world_object=np.eye(4),
        size=size,
        emission=np.zeros(1, np.float32),
    )


def _shaped(thing: PlanObject, mesh: str) -> SceneObject:
    """The object of a mesh file, stretched to the size that the plan gives, in its own frame."""
    loaded = load_object(mesh, label=thing.label, room=thing.room, support=thing.support)
    size = loaded.size if thing.size is None else np.array(thing.size, np.float64)
    stretch = np.where(loaded.size > 0, size / np.where(loaded.size > 0, loaded.size, 1.0), 1.0)
    vertices = (loaded.vertices - loaded.T_world_object[:3, 3]) * stretch
    return dataclasses.replace(loaded, vertices=vertices, T_world_object=np.eye(4), size=loaded.size * stretch)


def _placed(own: SceneObject, thing: PlanObject) -> SceneObject:
    c, s = math.cos(math.radians(thing.yaw)), math.sin(math.radians(thing.yaw))
    T_world_object = np.eye(4)
    T_world_object[:2, :2] = [[c, -s], [s, c]]
    T_world_object[:3, 3] = thing.position
    vertices = own.vertices @ T_world_object[:3, :3].T + T_world_object[:3, 3]
    return dataclasses.replace(own, vertices=vertices, T_world_object=T_world_object)
