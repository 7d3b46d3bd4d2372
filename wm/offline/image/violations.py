"""Violations of the scaffold by one image: a doorway drawn shut, or a thing missing, drawn twice, or drawn elsewhere.

A violation is an edit of the world for one image, so that the image and its depth agree. Only a doorway or a thing that covers
at least PLAIN of the image can be affected. If the view has none, there is no violation.
"""

import dataclasses
import math
from collections.abc import Mapping

import numpy as np
import shapely
from jaxtyping import Float

from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.site import room_site
from wm.geometry.rays.pinhole import camera_center, camera_rays
from wm.offline.world.edit import Edit
from wm.synth.backends import SceneContext
from wm.types import GBuffer, SceneObject, View

KINDS = ("closed", "missing", "added", "moved")
PLAIN = 0.005
"""Smallest share of the image that a doorway or a thing must cover to be part of a violation."""
SOLID = 0.15
"""Metres. A thing on a wall that is less deep is not part of violations, since depth hardly shows it."""
ASTRAY = (0.4, 1.2)
"""Smallest and largest distance, in metres, by which a thing is moved."""
APART = 1.2
"""Smallest horizontal distance, in metres, between the camera and a thing that is added."""
TRIES = 12


@dataclasses.dataclass(frozen=True, eq=False)
class ScaffoldViolation:
    """A violation, and the edit of the world that draws it."""

    kind: str  # one of KINDS
    what: str  # label of the thing; "door" for a doorway
    edit: Edit


def draw_violation(
    shares: Mapping[str, float], context: SceneContext, view: View, gbuffer: GBuffer, thing: np.ndarray, rng: np.random.Generator,
    *, objects: bool = True,
) -> ScaffoldViolation | None:  # fmt: skip
    """The violation of one image; None for an image without one.

    Args:
      shares: share of the images with a violation of each kind in KINDS.
      gbuffer, thing: the view without a violation: its G-buffer and the [h, w] object of each pixel, OUTSIDE for structure.
      objects: whether the condition shows objects; if not, only doorways can be affected.
    """
    draw = float(rng.random())
    for kind in KINDS:
        if draw < shares[kind]:
            return violation(kind, context, view, gbuffer, thing, rng) if objects or kind == "closed" else None
        draw -= shares[kind]
    return None


def violation(
    kind: str, context: SceneContext, view: View, gbuffer: GBuffer, thing: np.ndarray, rng: np.random.Generator
) -> ScaffoldViolation | None:
    """A violation of one kind; None if the view shows nothing suitable. Raises: ValueError if `kind` is not in KINDS."""
    if kind == "closed":
        return _closed(context, view, gbuffer, rng)
    seen = np.bincount(thing[thing >= 0], minlength=len(context.objects)) / thing.size
    plain = [k for k, share in enumerate(seen.tolist()) if share >= PLAIN and _stands_out(context.objects[k])]
    if kind == "added":
        plain = [k for k in plain if context.objects[k].support == "floor"]
    if kind not in KINDS:
        raise ValueError(f"unknown kind of violation {kind!r}; kinds: {', '.join(KINDS)}")
    if not plain:
        return None
    chosen = plain[int(rng.integers(len(plain)))]
    label = context.objects[chosen].label
    together = (chosen, *_on_top(context.objects, chosen))
    if kind == "missing":
        return ScaffoldViolation(kind, label, Edit(removed=together))
    transform = _elsewhere(context, chosen, rng) if kind == "moved" else _once_more(context, view, chosen, gbuffer, thing, rng)
    if transform is None:
        return None
    if kind == "moved":
        return ScaffoldViolation(kind, label, Edit(moved=tuple((k, transform) for k in together)))
    return ScaffoldViolation(kind, label, Edit(added=((chosen, transform),)))


def _closed(context: SceneContext, view: View, gbuffer: GBuffer, rng: np.random.Generator) -> ScaffoldViolation | None:
    """Closes a doorway of the view's room through which the view looks."""
    doors = []
    for k, portal in enumerate(portals(context.plan)):
        if portal.is_way and view.room in portal.rooms and _seen_through(portal, view, gbuffer) >= PLAIN:
            doors.append(k)
    if not doors:
        return None
    return ScaffoldViolation("closed", "door", Edit(closed=(doors[int(rng.integers(len(doors)))],)))


def _seen_through(portal: Portal, view: View, gbuffer: GBuffer) -> float:
    """Share of the image that shows something behind an opening."""
    eye, rays = camera_center(view.camera)[:2], camera_rays(view.camera).reshape(*gbuffer.depth.shape, 3)
    height = camera_center(view.camera)[2]
    toward = rays[..., :2] @ portal.normal
    distance = float((portal.ends[0] - eye) @ portal.normal)
    t = np.divide(distance, toward, out=np.full(toward.shape, -1.0), where=np.abs(toward) > 1e-6)
    along = portal.ends[1] - portal.ends[0]
    place = ((eye - portal.ends[0]) @ along + t * (rays[..., :2] @ along)) / (along @ along)
    z = height + t * rays[..., 2]
    through = (t > 0.3) & (t < gbuffer.depth) & (place > 0) & (place < 1) & (z > portal.sill) & (z < portal.head)
    return float(through.mean())


def _stands_out(thing: SceneObject) -> bool:
    """Whether a thing is deep enough to be visible in a depth map."""
    return thing.support != "flat" and (thing.support != "wall" or float(thing.size[1]) >= SOLID)


def _on_top(objects: tuple[SceneObject, ...], below: int) -> list[int]:
    """The things that stand on a thing and are moved with it."""
    base = objects[below]
    low, high = base.vertices.min(axis=0), base.vertices.max(axis=0)

    def stands(thing: SceneObject) -> bool:
        foot = thing.T_world_object[:3, 3]
        inside = (foot[:2] > low[:2]).all() and (foot[:2] < high[:2]).all()
        return thing.support == "object" and thing.room == base.room and bool(inside and foot[2] > low[2] + 0.1)

    return [k for k, thing in enumerate(objects) if k != below and stands(thing)]


def _elsewhere(context: SceneContext, chosen: int, rng: np.random.Generator) -> np.ndarray | None:
    """A transformation that moves a thing along the floor within its room; None if none was found in TRIES tries."""
    thing = context.objects[chosen]
    polygon = room_site(context.plan, thing.room).polygon
    middle = thing.T_world_object[:3, 3]
    for _ in range(TRIES):
        angle, far, turn = rng.uniform(0, 2 * math.pi), rng.uniform(*ASTRAY), rng.uniform(-0.5, 0.5)
        target = middle + far * np.array([math.cos(angle), math.sin(angle), 0.0])
        if polygon.buffer(-0.25).contains(shapely.Point(target[:2])):
            return _carried(middle, target, turn)
    return None


def _once_more(
    context: SceneContext, view: View, chosen: int, gbuffer: GBuffer, thing: np.ndarray, rng: np.random.Generator
) -> np.ndarray | None:
    """A transformation that puts a copy of a thing on floor in the view, away from the camera; None if none was found."""
    floor = (gbuffer.normal[..., 2] > 0.9) & (thing < 0) & gbuffer.hit
    spots = np.argwhere(floor)
    if len(spots) == 0:
        return None
    polygon = room_site(context.plan, context.objects[chosen].room).polygon
    eye, rays = camera_center(view.camera), camera_rays(view.camera).reshape(*thing.shape, 3)
    for _ in range(TRIES):
        i, j = spots[int(rng.integers(len(spots)))]
        target = eye + float(gbuffer.depth[i, j]) * rays[i, j]
        near = float(np.linalg.norm((target - eye)[:2])) < APART
        if not near and abs(target[2]) < 0.05 and polygon.buffer(-0.3).contains(shapely.Point(target[:2])):
            middle = context.objects[chosen].T_world_object[:3, 3]
            return _carried(middle, np.array([target[0], target[1], middle[2]]), float(rng.uniform(-math.pi, math.pi)))
    return None


def _carried(middle: Float[np.ndarray, "3"], target: Float[np.ndarray, "3"], turn: float) -> Float[np.ndarray, "4 4"]:
    """The transformation that moves the point `middle` to `target` and turns about the vertical axis through it by `turn`."""
    c, s = math.cos(turn), math.sin(turn)
    transform = np.eye(4)
    transform[:2, :2] = [[c, -s], [s, c]]
    transform[:3, 3] = target - transform[:3, :3] @ middle
    return transform
