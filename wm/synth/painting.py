"""Paints the scene: each view is conditioned on the scaffold, generated, verified, and projected into the texture atlas.

In each room, in the order of `paint_order`: the condition X is made from the scaffold and the texture so far; the image is
Phi(X, reference, prompt; seed); it is verified; if it fails, another seed is tried; if the last attempt fails too, the best image
is used where it agrees with the scaffold. Images are rounded to 8 bits before anything else uses them, so that a run that
resumes from its stored views ends with the same bytes.

Work per scene: the atlas and the depth range. Per view: one G-buffer (two if the conditioning scaffold is another one). Per
attempt: one image and one depth estimate. Memory: the atlas, one view, and the finished images of the room.
"""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from wm.geometry.rays.pinhole import camera_quat, scale_camera
from wm.geometry.rays.raycast import RayScene, cast
from wm.geometry.texture.accumulation import accumulate_in_place
from wm.geometry.texture.atlas import build_atlas
from wm.schema import ConditionConfig, TextureSettings, VerifySettings
from wm.synth.attempt import PaintedView, as_float, paint_view
from wm.synth.backends import Condition, DepthBackend, ImageBackend, ImageRequest, PrefetchingBackend
from wm.synth.condition import make_condition
from wm.synth.order import paint_order
from wm.types import Atlas, GBuffer, SceneObject, View

_AHEAD = 3  # number of views, including the current one, that are announced to a backend
_RANGE_SCALE = 1 / 8  # image size, relative to the view, at which the scene's depth range is measured


@dataclasses.dataclass(frozen=True, eq=False)
class Scaffold:
    """A structure with objects, ready for raycasts: `scene.mesh` holds structure faces, then those of `objects` in order."""

    scene: RayScene
    objects: tuple[SceneObject, ...]


@dataclasses.dataclass(frozen=True)
class PaintSettings:
    texture: TextureSettings = dataclasses.field(default_factory=TextureSettings)
    condition: ConditionConfig = dataclasses.field(default_factory=ConditionConfig)
    verify: VerifySettings = dataclasses.field(default_factory=VerifySettings)


@dataclasses.dataclass(frozen=True, eq=False)
class PaintSummary:
    atlas: Atlas  # the accumulated texture
    order: tuple[str, ...]  # view names as they were painted
    yield_share: float  # share of the planned views that were accepted; 1 if no view is planned
    atm: float | None  # mean number of attempts per accepted view; None if no view was accepted


def paint_scene(
    views: Sequence[View],
    scaffold: Scaffold,
    conditioning: Scaffold,
    image: ImageBackend,
    depth: DepthBackend,
    *,
    prompt: Callable[[View, bool], str],
    seed: int,
    load: Callable[[View], PaintedView | None],
    store: Callable[[View, PaintedView, GBuffer], None],
    settings: PaintSettings | None = None,
    progress: Callable[[View, PaintedView], None] | None = None,
) -> PaintSummary:
    """Paint all views, room by room.

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

    Raises:
      ValueError: a backend returned something other than an image, or a depth estimate, of the view's size.
      RuntimeError: a view that was stored cannot be loaded.
    """
    settings = settings or PaintSettings()
    atlas = build_atlas(scaffold.scene.mesh, settings.texture.texel_size)
    depth_range = scene_depth_range(views, conditioning.scene) if views else (0.0, 1.0)
    attempts: list[int] = []
    order = _scene_order(views)
    images: dict[int, np.ndarray] = {}  # of the current room; those of earlier rooms are loaded when needed
    for place, (index, reference) in enumerate(order):
        view = views[index]
        if place and views[order[place - 1][0]].room != view.room:
            images.clear()
        gbuffer = cast(scaffold.scene, view.camera)
        painted = load(view)
        if painted is None:
            shown = gbuffer if conditioning is scaffold else cast(conditioning.scene, view.camera)
            request = ImageRequest(
                condition=_condition(shown, view, atlas, conditioning, depth_range, settings),
                reference=None if reference is None else _image_of(views[reference], images.get(reference), load),
                prompt=prompt(view, reference is not None),
                view=view,
                seed=seed,
            )
            style = None if reference is None else views[reference].name
            if isinstance(image, PrefetchingBackend):
                image.prefetch([views[i] for i, _ in order[place : place + _AHEAD]])
            painted = paint_view(request, shown, image, depth, settings.verify, (seed, index), style)
            store(view, painted, gbuffer)
        accumulate_in_place(atlas, gbuffer, view.camera, as_float(painted.rgb), view.room, settings.texture, usable=painted.mask)
        images[index] = painted.rgb
        attempts += [painted.attempts] if painted.accepted else []
        if progress is not None:
            progress(view, painted)
    return PaintSummary(
        atlas=atlas,
        order=tuple(views[index].name for index, _ in order),
        yield_share=len(attempts) / len(views) if views else 1.0,
        atm=float(np.mean(attempts)) if attempts else None,
    )


def _scene_order(views: Sequence[View]) -> list[tuple[int, int | None]]:
    """(view, reference) as indices into `views`, in painting order: room by room."""
    order: list[tuple[int, int | None]] = []
    for room in sorted({view.room for view in views}):
        order += _room_order(views, room, [index for index, _ in order])
    return order


def _room_order(views: Sequence[View], room: int, done: Sequence[int]) -> list[tuple[int, int | None]]:
    """(view, reference) of a room as indices into `views`, in painting order."""
    members = [i for i, view in enumerate(views) if view.room == room]
    members.sort(key=lambda i: views[i].kind != "bootstrap")
    bootstraps = sum(views[i].kind == "bootstrap" for i in members)
    candidates = [*done, *members]
    steps = paint_order(_quats(views, members), _quats(views, done), bootstraps=bootstraps)
    return [(members[s.view], None if s.reference is None else candidates[s.reference]) for s in steps]


def _condition(
    shown: GBuffer, view: View, atlas: Atlas, scaffold: Scaffold, depth_range: tuple[float, float], settings: PaintSettings
) -> Condition:
    mesh, objects = scaffold.scene.mesh, scaffold.objects
    return make_condition(shown, view.camera, atlas, mesh, objects, depth_range, settings.condition, settings.texture)


def scene_depth_range(views: Sequence[View], scene: RayScene) -> tuple[float, float]:
    """(smallest, largest) depth in any of the views, metres: the range over which the condition shows depth."""
    near, far = np.inf, -np.inf
    for view in views:
        gbuffer = cast(scene, scale_camera(view.camera, _RANGE_SCALE))
        near = min(near, float(gbuffer.depth.min(initial=np.inf, where=gbuffer.hit)))
        far = max(far, float(gbuffer.depth.max(initial=-np.inf, where=gbuffer.hit)))
    return (near, far) if near < far else (0.0, max(far, 1.0))


def _image_of(view: View, rgb: np.ndarray | None, load: Callable[[View], PaintedView | None]) -> np.ndarray:
    """The image of a finished view: `rgb` if it is still in memory, otherwise loaded."""
    if rgb is None:
        painted = load(view)
        if painted is None:
            raise RuntimeError(f"view {view.name} was stored but cannot be loaded as a style reference")
        rgb = painted.rgb
    return as_float(rgb)


def _quats(views: Sequence[View], indices: Sequence[int]) -> np.ndarray:
    return np.array([camera_quat(views[i].camera) for i in indices]).reshape(-1, 4)
