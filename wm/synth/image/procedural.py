"""The offline image model: it paints the exact world of wm.synth.procedural, and behaves as an image model does.

Given the condition X it returns
    out = W + known * lowpass(X - W) + (1 - known) * drift,
W the world from this camera. Where X shows accumulated texture its tone is kept at the scale of texels (the low frequencies of
the result are those of X) while the world's fine detail is restored; where X shows only depth the model invents: the world under
a tone that drifts from view to view by a seeded gain and hue, smooth over the image. Objects that X shows keep their identity and
get the world's materials and light; objects that X leaves out are drawn all the same, with a stronger drift of their own.
"""

import dataclasses
import os
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import gaussian_filter, zoom

from wm.host import cores
from wm.schema import ImageConfig
from wm.synth.backends import Condition, ImageRequest, ImageResult, SceneContext
from wm.synth.procedural.room import bake_settings
from wm.synth.procedural.worker import Recipe, WorkerWorld
from wm.synth.procedural.world import Shot, World
from wm.types import OUTSIDE, View

SURE = 0.85
"""How far known a pixel must be before its tone counts: below, the condition is part grey depth."""
SHOTS_AT_ONCE, KEPT_SHOTS = 2, 4
"""Views whose share of the work that no condition changes is done side by side, and how many of them are kept."""
TONE_SCALE = 5 / 688
"""Standard deviation of the low pass, as a share of the image's width: about a texel of 2 cm at two metres."""
AGREEMENT = 0.03
"""Relative difference of depth up to which the condition is taken to show what the world has there."""
INVENTION = 4.0
"""How many times stronger an object that the condition does not show drifts than a wall."""


@dataclasses.dataclass(frozen=True, eq=False)
class ProceduralImages:
    """The backend. Rooms are dressed and lit when a view first needs them."""

    world: World | WorkerWorld
    config: ImageConfig
    _pool: ThreadPoolExecutor = dataclasses.field(default_factory=lambda: ThreadPoolExecutor(SHOTS_AT_ONCE, "wm-shots"))
    _shots: dict[tuple, Future[Shot]] = dataclasses.field(default_factory=dict)

    def prefetch(self, views: Sequence[View]) -> None:
        """Starts on the views that come next: what they show of the world, whatever their conditions will be."""
        for view in views[:KEPT_SHOTS]:
            self._shot(view)

    def generate(self, request: ImageRequest) -> ImageResult:
        """The world seen from the request's camera, in the tone that the condition already has; same request, same bytes.

        Raises:
          ValueError: the condition's images are not of the camera's size.
        """
        shot, condition = self._shot(request.view).result(), request.condition
        _check_size(condition, shot)
        rng = np.random.default_rng(np.random.SeedSequence([request.seed, 0x1A6E]))
        invented = _drifted(shot.rgb, self.config.drift, rng)
        shown = _shown(condition, shot)
        objects = shot.object != OUTSIDE
        rgb = np.where((objects & ~shown)[..., None], _object_drift(shot, self.config.drift * INVENTION, rng), invented)
        rgb = np.where((objects & shown)[..., None], shot.rgb, rgb)
        sure = np.clip((condition.known - SURE) / (1 - SURE), 0, 1)
        known = np.where(objects | ~shown, 0, sure).astype(np.float32)
        rgb = _keep_tone(rgb, shot.rgb, condition.rgb, known)
        return ImageResult(
            rgb=np.clip(rgb, 0, 1).astype(np.float32),
            drawn_depth=shot.gbuffer.depth.copy(),
            drawn_object=shot.object.copy(),
            drawn_labels=self.world.labels,
        )

    def _shot(self, view: View) -> Future[Shot]:
        """What the world shows the view, under way or done; the latest few are kept, so that a further attempt costs no other."""
        camera = view.camera
        arrays = (np.asarray(x, np.float64).tobytes() for x in (camera.T_cam_world, camera.focal, camera.principal))
        key = (*arrays, camera.width, camera.height)
        if key not in self._shots:
            self._shots[key] = self._pool.submit(self.world.shoot, camera)
            while len(self._shots) > KEPT_SHOTS:
                del self._shots[next(iter(self._shots))]
        return self._shots[key]

    def truth(self, view: View) -> Float[np.ndarray, "h w 3"]:
        """The exact world from a view's camera."""
        return np.clip(self.world.shoot(view.camera).rgb, 0, 1)


def make(config: ImageConfig, context: SceneContext) -> ProceduralImages:
    """The offline image backend of a scene. Raises: ValueError for a texel size that is not a positive length."""
    recipe = Recipe(context, supersampling=config.supersampling, settings=bake_settings(config.texel_size))
    apart = config.worker and cores() > 1 and os.name == "posix"
    return ProceduralImages(world=WorkerWorld(recipe, lanes=SHOTS_AT_ONCE) if apart else recipe.make(), config=config)


def lowpass(image: Float[np.ndarray, "h w c"], weight: Float[np.ndarray, "h w"]) -> Float[np.ndarray, "h w c"]:
    """Weighted gaussian mean at the scale of TONE_SCALE; 0 where no weight is near."""
    sigma = max(TONE_SCALE * image.shape[1], 0.6)
    total = gaussian_filter(weight, sigma, mode="nearest", truncate=3.0)
    blurred = gaussian_filter(image * weight[..., None], (sigma, sigma, 0), mode="nearest", truncate=3.0)
    return blurred / np.maximum(total, 1e-4)[..., None]


def _keep_tone(invented: np.ndarray, world: np.ndarray, shown: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Where known, the world with the low frequencies of what is shown; elsewhere what was invented."""
    if not known.any():
        return invented
    kept = world + lowpass(shown - world, known)
    return invented + known[..., None] * (kept - invented)


def _shown(condition: Condition, shot: Shot) -> Bool[np.ndarray, "h w"]:
    """Pixels whose surface the condition shows where the world has it."""
    depth = shot.gbuffer.depth
    return (condition.depth > 0) & (np.abs(condition.depth - depth) <= AGREEMENT * np.maximum(depth, 0.1))


def _drifted(image: np.ndarray, amount: float, rng: np.random.Generator) -> np.ndarray:
    """The image under a gain and a hue that wander smoothly: a value for the view, and a field of 3 x 4 knots."""
    whole = rng.normal(size=3) * 0.35 + rng.normal()
    knots = rng.normal(size=(3, 4, 3)) * 0.35 + rng.normal(size=(3, 4, 1)) * 0.35
    if amount == 0:
        return image
    height, width = image.shape[:2]
    field = np.stack([_stretched(knots[..., c], height, width) for c in range(3)], axis=-1)
    return image * (1 + np.float32(amount) * (whole + field)).astype(np.float32)


def _object_drift(shot: Shot, amount: float, rng: np.random.Generator) -> np.ndarray:
    """Every object under a gain and hue of its own: what a model invents anew in each view."""
    count = int(shot.object.max(initial=OUTSIDE)) + 2
    gains = (1 + amount * (rng.normal(size=(count, 3)) * 0.7 + rng.normal(size=(count, 1)))).astype(np.float32)
    gains[0] = 1  # structure
    return shot.rgb * np.maximum(gains[shot.object + 1], 0.2)


def _stretched(knots: np.ndarray, height: int, width: int) -> np.ndarray:
    rows, columns = knots.shape
    stretched = zoom(knots, (max(height, rows) / rows, max(width, columns) / columns), order=1, mode="nearest", grid_mode=True)
    return np.asarray(stretched)[:height, :width]


def _check_size(condition: Condition, shot: Shot) -> None:
    size = shot.rgb.shape[:2]
    if condition.rgb.shape[:2] != size or condition.known.shape != size or condition.depth.shape != size:
        raise ValueError(
            f"the condition is {condition.rgb.shape[:2]}, known {condition.known.shape}, depth {condition.depth.shape}; "
            f"the view's camera asks for {size}"
        )
