"""Setting things upright, and moving them: rigid motions of scene objects.

A reconstructed thing stands only nearly upright in the world. The face of its oriented box that is nearest to level
becomes level, by the smallest turn that does it; its frame is then chosen again, so that z points up and the origin is the
middle of its foot.
Source: WorldMesh, supplement, "Object Placement".
"""

import dataclasses
import math

import numpy as np
from jaxtyping import Float

from wm.geometry.placement.upright_box import UprightBox, box_of
from wm.types import SceneObject

EXACT = 1e-7
"""Metres and radians below which nothing is moved, so that placing again changes no bit."""


def transformed(thing: SceneObject, motion: Float[np.ndarray, "4 4"]) -> SceneObject:
    """A thing after a rigid motion [4, 4] of the world, or out of another frame into it (T_world_cam)."""
    return dataclasses.replace(
        thing,
        vertices=thing.vertices @ motion[:3, :3].T + motion[:3, 3],
        T_world_object=motion @ thing.T_world_object,
    )


def levelled(thing: SceneObject) -> SceneObject:
    """The thing with the most level face of its oriented box made level, its frame upright and its size measured anew.

    What is level within EXACT, its z axis up, is returned as it is, with the size it says it has.
    """
    axes = thing.T_world_object[:3, :3]
    k = int(np.argmax(np.abs(axes[2])))
    up = axes[:, k] * math.copysign(1.0, axes[2, k])
    turn = _turn_onto_z(up)
    if k == 2 and axes[2, 2] > 0 and np.abs(turn - np.eye(3)).max() < EXACT:
        return thing
    motion = np.eye(4)
    motion[:3, :3] = turn
    back = turn @ axes[:, 1 if k != 1 else 2]
    yaw = math.atan2(-float(back[0]), float(back[1]))
    turned = transformed(thing, motion)
    frame = UprightBox(0.0, 0.0, 0.0, yaw, 1.0, 1.0, 1.0).transform
    box = box_of(dataclasses.replace(turned, T_world_object=frame))
    pivot = box_of(thing)  # the foot's middle stays where it was, so that levelling moves nothing across the room
    settled = dataclasses.replace(box, x=pivot.x, y=pivot.y, z=pivot.z)
    shift = settled.transform[:3, 3] - box.transform[:3, 3]
    return dataclasses.replace(
        turned,
        vertices=turned.vertices + shift,
        T_world_object=settled.transform,
        size=np.array([box.width, box.depth, box.height]),
    )


def moved_to(thing: SceneObject, box: UprightBox) -> SceneObject:
    """An upright thing moved so that its box is this one; of the box only place and yaw are used."""
    at = box_of(thing)
    if max(abs(at.x - box.x), abs(at.y - box.y), abs(at.z - box.z), abs(turn_between(at.yaw, box.yaw))) < EXACT:
        return thing
    return transformed(thing, box.transform @ np.linalg.inv(at.transform))


def flattened(thing: SceneObject, height: float) -> SceneObject:
    """A thing that lies flat, pressed to at most this height."""
    box = box_of(thing)
    if box.height <= height + EXACT:
        return thing
    vertices = thing.vertices.copy()
    vertices[:, 2] = box.z + (vertices[:, 2] - box.z) * (height / box.height)
    return dataclasses.replace(thing, vertices=vertices, size=np.array([*thing.size[:2], height]))


def turn_between(a: float, b: float) -> float:
    """Radians from yaw a to yaw b, in (-pi, pi]."""
    return math.remainder(b - a, 2 * math.pi)


def _turn_onto_z(up: np.ndarray) -> np.ndarray:
    """The smallest rotation that takes a unit vector, not pointing down, onto z."""
    x, y, z = up.tolist()
    return np.array(
        [
            [1 - x * x / (1 + z), -x * y / (1 + z), -x],
            [-x * y / (1 + z), 1 - y * y / (1 + z), -y],
            [x, y, z],
        ]
    )
