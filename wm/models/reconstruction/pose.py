"""Where a reconstructed object stands in the world: as its model says, or as its outline and depth in the image say.

A model that is given the scene's points says p_cam = R (s * p) + t of the points p of its file; p_cam in the image's camera.
Of the objects of other models only the shape is known: they stand upright, at an unknown yaw, in an unknown size and place. Each
of _YAWS yaws is tried: from a first guess the object is drawn _STEPS times, and each time its size is changed by the ratio of the
areas of mask and drawing, and its place by the offset of their middles and of their depths. The yaw whose drawing covers the mask
best, and lies nearest in depth, is taken:

    cost = 1 - IoU(mask, drawing) + median |depth - drawn depth| / size of the object

Work: one BVH an object, and a drawing of at most _WIDE pixels across a step.
"""

import dataclasses
import math

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.placement.support import support_of
from wm.geometry.placement.upright import levelled
from wm.geometry.placement.upright_box import UprightBox, box_of
from wm.geometry.rays.pinhole import ray_basis, scale_camera
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast
from wm.synth.backends import Observation
from wm.types import Camera, Mesh, SceneObject

_YAWS, _STEPS, _WIDE = 24, 6, 96
_SHARE = (0.7, 1.4)
"""Factors between which the size changes in a step."""
_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From the axes of a GLB (y up) to those of an object that is read from it (z up)."""


@dataclasses.dataclass(frozen=True, eq=False)
class ModelPose:
    """Where a model says that the points of its GLB file lie: p_cam = rotation @ (scale * p) + translation."""

    scale: np.ndarray  # [3], positive
    rotation: np.ndarray  # [3, 3]
    translation: np.ndarray  # [3] metres, in the camera of the image


def posed(thing: SceneObject, pose: ModelPose, camera: Camera) -> SceneObject:
    """The object in the world and upright, if it stands where its model says.

    Args:
      thing: as it was read from the file, z up.
      camera: of the image that the model was given.
    """
    T_world_cam = np.linalg.inv(np.asarray(camera.T_cam_world, np.float64))
    rotation = T_world_cam[:3, :3] @ pose.rotation @ _UP.T
    place = T_world_cam[:3, :3] @ pose.translation + T_world_cam[:3, 3]
    return _standing(thing, np.abs(_UP) @ pose.scale, rotation, place)


def fitted(thing: SceneObject, seen: Observation) -> SceneObject | None:
    """The object in the world, upright, where its outline and depth fit the observation best; None if they fit nowhere.

    Args:
      thing: as it was read from the file, z up, in any unit.
      seen: an observation with pixels that have depth.
    """
    low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
    middle, size = (low + high) / 2, float(np.linalg.norm(high - low))
    scene = build_ray_scene(Mesh.from_triangles(thing.vertices - middle, thing.faces))
    target = _target(seen)
    tries = [_fit_yaw(scene, size, 2 * math.pi * k / _YAWS, target) for k in range(_YAWS)]
    best = min(tries, key=lambda one: one.cost)
    if not math.isfinite(best.cost):
        return None
    rotation = UprightBox(0.0, 0.0, 0.0, best.yaw, 1.0, 1.0, 1.0).transform[:3, :3]
    return _standing(thing, np.full(3, best.scale), rotation, best.place - best.scale * rotation @ middle)


def _standing(thing: SceneObject, scale: np.ndarray, rotation: np.ndarray, place: np.ndarray) -> SceneObject:
    """The object with its points p moved to rotation @ (scale * p) + place, then made upright; its frame at its foot."""
    own = thing.vertices * scale
    low, high = own.min(axis=0), own.max(axis=0)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation, rotation @ [*(low + high)[:2] / 2, low[2]] + place
    moved = dataclasses.replace(thing, vertices=own @ rotation.T + place, T_world_object=T, size=high - low)
    upright = levelled(moved)
    box = box_of(upright)
    return dataclasses.replace(upright, support=support_of(thing.label, upright.size.tolist(), max(box.z, 0.0)))


@dataclasses.dataclass(frozen=True, eq=False)
class _Target:
    """What a drawing is compared with, at a low resolution."""

    camera: Camera
    mask: np.ndarray  # [h, w] bool
    depth: np.ndarray  # [h, w] metres, 0 outside the mask or where unknown
    middle: np.ndarray  # [2] of the mask, pixels
    distance: float  # median depth


@dataclasses.dataclass(frozen=True, eq=False)
class _Fit:
    """A yaw with the size and place that fit best."""

    yaw: float
    scale: float
    place: np.ndarray  # [3] world, of the middle of the object's bounding box
    cost: float  # inf if it is not in the image


def _target(seen: Observation) -> _Target:
    camera = scale_camera(seen.camera, min(1.0, _WIDE / seen.camera.width))
    rows = np.minimum(((np.arange(camera.height) + 0.5) * seen.camera.height / camera.height).astype(int), seen.camera.height - 1)
    columns = np.minimum(((np.arange(camera.width) + 0.5) * seen.camera.width / camera.width).astype(int), seen.camera.width - 1)
    mask = seen.mask[np.ix_(rows, columns)]
    depth = np.where(mask, seen.depth[np.ix_(rows, columns)], 0.0)
    distance = float(np.median(seen.depth[seen.mask & (seen.depth > 0)]))
    return _Target(camera=camera, mask=mask, depth=depth, middle=_middle(mask), distance=distance)


def _fit_yaw(scene: RayScene, size: float, yaw: float, target: _Target) -> _Fit:
    """The fit of one yaw; the best of its steps."""
    across, down = ray_basis(target.camera)
    scale = target.distance / float(np.min(target.camera.focal)) * 2 * math.sqrt(max(int(target.mask.sum()), 1)) / size
    x, y = np.clip(target.middle, 0, [target.camera.width - 1, target.camera.height - 1]).astype(int)
    T_world_cam = np.linalg.inv(np.asarray(target.camera.T_cam_world, np.float64))
    place = T_world_cam[:3, 3] + target.distance * (across[x] + down[y])
    best = _Fit(yaw, scale, place, math.inf)
    for _ in range(_STEPS):
        depth = scale * _drawn(scene, yaw, scale, place, target.camera)
        drawn = depth > 0
        if not drawn.any():
            break
        cost = _cost(depth, drawn, target, scale * size)
        if cost < best.cost:
            best = _Fit(yaw, scale, place, cost)
        both = drawn & (target.depth > 0)
        away = float(np.median(target.depth[both] - depth[both])) if both.any() else 0.0
        pixels = target.middle - _middle(drawn)
        step = np.append(pixels / np.asarray(target.camera.focal) * target.distance, away)
        place = place + T_world_cam[:3, :3] @ step
        scale *= float(np.clip(math.sqrt(target.mask.sum() / drawn.sum()), *_SHARE))
    return best


def _drawn(scene: RayScene, yaw: float, scale: float, place: np.ndarray, camera: Camera) -> Float[np.ndarray, "h w"]:
    """[h, w] depth of the object in its own units: the camera is moved in place of the object."""
    x, y, z = place.tolist()
    T_world_object = UprightBox(x, y, z, yaw, 1.0, 1.0, 1.0).transform
    T = np.asarray(camera.T_cam_world, np.float64) @ T_world_object
    T[:3, 3] /= scale
    return cast(scene, dataclasses.replace(camera, T_cam_world=T)).depth


def _cost(depth: np.ndarray, drawn: np.ndarray, target: _Target, size: float) -> float:
    both = drawn & (target.depth > 0)
    if not both.any():
        return math.inf
    covered = (drawn & target.mask).sum() / (drawn | target.mask).sum()
    return float(1 - covered + np.median(np.abs(depth[both] - target.depth[both])) / size)


def _middle(mask: Bool[np.ndarray, "h w"]) -> Float[np.ndarray, "2"]:
    """(x, y) of the mean of a mask's pixel centres; (0, 0) for an empty mask."""
    y, x = np.nonzero(mask)
    return np.array([x.mean(), y.mean()]) + 0.5 if len(x) else np.zeros(2)
