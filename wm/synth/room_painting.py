"""Paints views of one room, one after the other. Several threads may paint a room each.

In the order of the steps: the condition X is made from the scaffold and the texture so far; the image is Phi(X, reference,
prompt; seed); it is verified; if it fails, another seed is tried; if the last attempt fails too, the best image is used where it
agrees with the scaffold. Images are rounded to 8 bits before anything else uses them, so that a run that resumes from its stored
views ends with the same bytes.

Work per view: one G-buffer (two if the conditioning scaffold is another one). Per attempt: one image and one depth estimate.
Memory: one view, and the finished images that later views of the room refer to.
"""

import dataclasses
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from wm.geometry.rays.raycast import RayScene, cast
from wm.geometry.texture.accumulation import accumulate_in_place
from wm.schema import ConditionConfig, TextureSettings, VerifySettings
from wm.synth.attempt import PaintedView, as_float, paint_view
from wm.synth.backends import Condition, DepthBackend, ImageBackend, ImageRequest, PrefetchingBackend
from wm.synth.condition import make_condition
from wm.synth.order import PaintStep
from wm.synth.prompts import ViewPrompt
from wm.synth.side_by_side import ImagesUntilStopped, Turns
from wm.types import Atlas, GBuffer, SceneObject, View

_AHEAD = 3  # number of views, including the current one, that are announced to a backend


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
class RoomPainter:
    """What painting any room of a scene needs; the fields up to `settings` are the arguments of `paint_scene`."""

    views: Sequence[View]
    scaffold: Scaffold
    conditioning: Scaffold
    image: ImageBackend
    depth: DepthBackend
    prompt: Callable[[View, bool], ViewPrompt]
    seed: int
    load: Callable[[View], PaintedView | None]
    store: Callable[[View, PaintedView, GBuffer], None]
    progress: Callable[[View, PaintedView], None]
    settings: PaintSettings
    depth_range: tuple[float, float]  # of the scene, metres
    referred: frozenset[int]  # views that another view has as its style reference
    turns: Turns  # the callbacks above are called in turns

    def paint(
        self, steps: Sequence[PaintStep], atlas: Atlas, images: Mapping[int, np.ndarray], then: Sequence[int]
    ) -> "PaintedSteps":
        """Paints views and projects them into an atlas.

        Args:
          steps: the views of one room.
          atlas: what these views see and write; it is changed.
          images: [h, w, 3] uint8 images of finished views that these views may refer to, by index.
          then: views that will be painted after these, to be announced.

        Raises:
          ValueError: a backend returned something other than an image, or a depth estimate, of the view's size.
          RoomStoppedError: another room has failed.
        """
        kept, attempts = dict(images), []
        coming = [*(step.view for step in steps), *then]
        for place, step in enumerate(steps):
            painted, gbuffer = self._view(step, atlas, kept, coming[place : place + _AHEAD])
            view = self.views[step.view]
            rgb, texture = as_float(painted.rgb), self.settings.texture
            accumulate_in_place(atlas, gbuffer, view.camera, rgb, view.room, texture, usable=painted.mask)
            attempts += [painted.attempts] if painted.accepted else []
            if step.view in self.referred:
                kept[step.view] = painted.rgb
            with self.turns.turn():
                self.progress(view, painted)
        return PaintedSteps(images=kept, attempts=attempts)

    def _view(
        self, step: PaintStep, atlas: Atlas, images: Mapping[int, np.ndarray], coming: Sequence[int]
    ) -> tuple[PaintedView, GBuffer]:
        """A view, loaded or painted and stored, and the G-buffer of the true scaffold."""
        view = self.views[step.view]
        with self.turns.turn():
            painted = self.load(view)
        gbuffer = cast(self.scaffold.scene, view.camera)
        if painted is None:
            shown = gbuffer if self.conditioning is self.scaffold else cast(self.conditioning.scene, view.camera)
            with self.turns.turn():
                prompt = self.prompt(view, step.reference is not None)
                if isinstance(self.image, PrefetchingBackend):
                    self.image.prefetch([self.views[k] for k in coming])
            request = ImageRequest(
                condition=self._condition(shown, view, atlas),
                reference=None if step.reference is None else as_float(images[step.reference]),
                prompt=prompt.text,
                theme=prompt.theme,
                room=prompt.room,
                sights=prompt.sights,
                view=view,
                seed=self.seed,
            )
            style = None if step.reference is None else self.views[step.reference].name
            image = ImagesUntilStopped(self.image, self.turns)
            painted = paint_view(request, shown, image, self.depth, self.settings.verify, (self.seed, step.view), style)
            with self.turns.turn():
                self.store(view, painted, gbuffer)
        return painted, gbuffer

    def _condition(self, shown: GBuffer, view: View, atlas: Atlas) -> Condition:
        mesh, objects, settings = self.conditioning.scene.mesh, self.conditioning.objects, self.settings
        return make_condition(shown, view.camera, atlas, mesh, objects, self.depth_range, settings.condition, settings.texture)


@dataclasses.dataclass(frozen=True, eq=False)
class PaintedSteps:
    """What is left of painted views when they are stored."""

    images: Mapping[int, np.ndarray]  # [h, w, 3] uint8 by index: those that were given, and those that views refer to
    attempts: list[int]  # of the accepted views, in painting order
