"""Which finished views a view may take as its style reference: today's scheme and two others, without painting.

all      every finished view of the scene, room after room (WorldMesh)
anchors  the bootstrap views of the first room, and the finished views of the own room
leader   as many views of the first room as it has finished when all rooms paint at the same pace, and the own room
"""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from wm.geometry import place_cameras
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.pinhole import camera_quat
from wm.geometry.rays.raycast import build_ray_scene
from wm.run import load_config
from wm.synth.furnished import furnished_context
from wm.synth.order import paint_order, scene_order, similarity
from wm.types import View


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What a scheme makes of a scene."""

    similarities: list[float]  # of each view that has a reference to that reference
    own_room: float  # share of the references that are in the view's room
    rounds: int  # requests one after the other, if rooms are painted side by side where the scheme lets them


def scene_views(scene: str) -> list[View]:
    config = load_config([f"+scene={scene}"])
    context = furnished_context(config)
    rays = build_ray_scene(assemble_scene(context.structure, context.objects))
    return place_cameras(context.plan, rays, config.cameras)


def _outcome(views: Sequence[View], pairs: Sequence[tuple[int, int]], rounds: int) -> Outcome:
    quats = np.array([camera_quat(view.camera) for view in views])
    near = [float(similarity(quats[[a]], quats[[b]])[0, 0]) for a, b in pairs]
    return Outcome(near, float(np.mean([views[a].room == views[b].room for a, b in pairs])), rounds)


def every_view(views: Sequence[View]) -> Outcome:
    done: list[int] = []
    pairs = []
    for room in sorted({view.room for view in views}):
        members = _members(views, room)
        known = [*done, *members]
        steps = paint_order(_quats(views, members), _quats(views, done))
        pairs += [(members[step.view], known[step.reference]) for step in steps if step.reference is not None]
        done += [members[step.view] for step in steps]
    return _outcome(views, pairs, len(views))


def anchors(views: Sequence[View]) -> Outcome:
    order = scene_order(views)
    parts = (order.anchors, *order.rooms)
    pairs = [(step.view, step.reference) for part in parts for step in part.steps if step.reference is not None]
    return _outcome(views, pairs, len(order.anchors.steps) + max(len(part.steps) for part in order.rooms))


def leader(views: Sequence[View]) -> Outcome:
    """The k-th view of another room begins when the first room has finished its first k + 2 views."""
    first, *others = sorted({view.room for view in views})
    members = _members(views, first)
    steps = paint_order(_quats(views, members), np.zeros((0, 4)))
    led = [members[step.view] for step in steps]
    pairs = [(members[step.view], members[step.reference]) for step in steps if step.reference is not None]
    longest = len(members)
    for room in others:
        waiting, finished = _members(views, room), []
        longest = max(longest, 2 + len(waiting))
        while waiting:
            seen = led[: len(finished) + 2] + finished
            near = np.round(similarity(_quats(views, waiting), _quats(views, seen)), 9)
            chosen = 0 if len(finished) < 2 else int(near.max(axis=1).argmax())
            pairs.append((waiting[chosen], seen[int(near[chosen].argmax())]))
            finished.append(waiting.pop(chosen))
    return _outcome(views, pairs, longest)


SCHEMES: dict[str, Callable[[Sequence[View]], Outcome]] = {"all": every_view, "anchors": anchors, "leader": leader}


def _members(views: Sequence[View], room: int) -> list[int]:
    """A room's views by index, those of kind "bootstrap" first."""
    return sorted((i for i, view in enumerate(views) if view.room == room), key=lambda i: views[i].kind != "bootstrap")


def _quats(views: Sequence[View], indices: Sequence[int]) -> np.ndarray:
    return np.array([camera_quat(views[i].camera) for i in indices]).reshape(-1, 4)
