"""Paints the scene: the anchors, then its rooms side by side, and joins their texture in one atlas.

The bootstrap views of the first room are painted first: they are the anchors of the scene's style. Then every room, the rest of
the first included, looks only at the anchors and at itself: for style references (wm.synth.order) and for the texture that its
conditions show (wm.geometry.texture.scene_texture). So the result does not depend on how many rooms are under way, and an image
model that answers several requests at once paints as many rooms at once. With one at a time, rooms follow one another.

Work per scene: the atlas and the depth range; the rest is in wm.synth.room_painting. Memory: the atlas, and for each room under
way a copy of its part of the atlas, one view, and the images that it refers to.
"""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from wm.geometry.rays.pinhole import scale_camera
from wm.geometry.rays.raycast import RayScene, cast
from wm.geometry.texture.atlas import build_atlas
from wm.geometry.texture.scene_texture import SceneTexture
from wm.synth.attempt import PaintedView
from wm.synth.backends import ConcurrentBackend, DepthBackend, ImageBackend
from wm.synth.order import RoomSteps, SceneOrder, scene_order
from wm.synth.prompts import ViewPrompt
from wm.synth.room_painting import PaintSettings, RoomPainter, Scaffold
from wm.synth.side_by_side import DepthInTurn, Turns, side_by_side
from wm.types import Atlas, GBuffer, View

_RANGE_SCALE = 1 / 8  # image size, relative to the view, at which the scene's depth range is measured


@dataclasses.dataclass(frozen=True, eq=False)
class PaintSummary:
    atlas: Atlas  # the accumulated texture
    order: tuple[str, ...]  # view names in the order of one room after the other
    yield_share: float  # share of the planned views that were accepted; 1 if no view is planned
    atm: float | None  # mean number of attempts per accepted view; None if no view was accepted


def paint_scene(
    views: Sequence[View],
    scaffold: Scaffold,
    conditioning: Scaffold,
    image: ImageBackend,
    depth: DepthBackend,
    *,
    prompt: Callable[[View, bool], ViewPrompt],
    seed: int,
    load: Callable[[View], PaintedView | None],
    store: Callable[[View, PaintedView, GBuffer], None],
    settings: PaintSettings | None = None,
    progress: Callable[[View, PaintedView], None] | None = None,
) -> PaintSummary:
    """Paint all views: the anchors, then `image.at_once` rooms at a time (ConcurrentBackend), else one.

    Args:
      views: the planned views; in each room, those of kind "bootstrap" are painted first.
      scaffold: the true scaffold, which decides occlusion and receives the texture.
      conditioning: the scaffold that the image model is shown and images are verified against. It differs from `scaffold` in
        the variants that replace objects by boxes or leave them out. Its structure faces must be those of `scaffold`.
      image, depth: the image backend and the depth backend.
      prompt: a function of a view, and of whether it has a style reference, to its prompt.
      seed: seed of the scene; the seed of each attempt is derived from it, the index of the view and that of the attempt.
      load: returns what `store` was given for a view, in this run or an earlier one; None for a view that is not finished.
      store: keeps a finished view; it is also given the G-buffer of the true scaffold. It is called once per view, before
        anything uses the view.
      settings: texture, condition and verification.
      progress: called after each view.

    `prompt`, `load`, `store` and `progress` are called from the threads of the rooms, never two calls at the same time.

    Raises:
      ValueError: a backend returned something other than an image, or a depth estimate, of the view's size.
      Exception: what a backend or a callback raised first. The other rooms are stopped; what they have stored is kept.
    """
    settings = settings or PaintSettings()
    atlas = build_atlas(scaffold.scene.mesh, settings.texture.texel_size)
    if not views:
        return PaintSummary(atlas=atlas, order=(), yield_share=1.0, atm=None)
    order = scene_order(views)
    painter = RoomPainter(
        views=views,
        scaffold=scaffold,
        conditioning=conditioning,
        image=image,
        depth=depth if isinstance(depth, ConcurrentBackend) else DepthInTurn(depth),
        prompt=prompt,
        seed=seed,
        load=load,
        store=store,
        progress=progress or (lambda view, painted: None),
        settings=settings,
        depth_range=scene_depth_range(views, conditioning.scene),
        referred=order.referred,
        turns=Turns(),
    )
    at_once = image.at_once if isinstance(image, ConcurrentBackend) else 1
    attempts = _paint(painter, order, atlas, at_once)
    return PaintSummary(
        atlas=atlas,
        order=tuple(views[index].name for index in order.views),
        yield_share=len(attempts) / len(views),
        atm=float(np.mean(attempts)) if attempts else None,
    )


def _paint(painter: RoomPainter, order: SceneOrder, atlas: Atlas, at_once: int) -> list[int]:
    """Paints all views into the atlas; returns the attempts of the accepted ones, in the order of one room after the other."""
    anchors = painter.paint(order.anchors.steps, atlas, {}, order.after(order.anchors))
    texture = SceneTexture(atlas, order.anchors.room)

    def paint_room(part: RoomSteps) -> list[int]:
        own = texture.part(part.room)
        following = order.after(part) if at_once == 1 else ()  # rooms side by side do not know which view comes next
        painted = painter.paint(part.steps, own, anchors.images, following)
        texture.finish(part.room, own)
        return painted.attempts  # and not the images, which no other room looks at

    rooms = side_by_side(paint_room, order.rooms, painter.turns, at_once=at_once)
    texture.join()
    return [count for attempts in (anchors.attempts, *rooms) for count in attempts]


def scene_depth_range(views: Sequence[View], scene: RayScene) -> tuple[float, float]:
    """(smallest, largest) depth in any of the views, metres: the range over which the condition shows depth."""
    near, far = np.inf, -np.inf
    for view in views:
        gbuffer = cast(scene, scale_camera(view.camera, _RANGE_SCALE))
        near = min(near, float(gbuffer.depth.min(initial=np.inf, where=gbuffer.hit)))
        far = max(far, float(gbuffer.depth.max(initial=-np.inf, where=gbuffer.hit)))
    return (near, far) if near < far else (0.0, max(far, 1.0))
