"""The offline image model: it paints worlds of wm.offline.world, with the flaws that image models have.

Phi(X, reference, theme; seed) keeps what X shows and invents the rest. The seed of the view selects a whole invented world
(wm.offline.image.imagination), and W is its image from the view's camera:
    out = W + known * lowpass(X - W) + (1 - known) * drift.
- Objects that X shows textured are those of the scene. A grey box is filled with other furniture. If X shows no objects, the room
  is furnished in another way.
- Walls, floor and ceiling have the finish of the scene if X shows any of their texture, and otherwise another finish that suits
  the theme. If the scaffold carries texture from view to view (`wall_texture`), the bootstrap views of a room have the finish of
  the scene, so that later views can follow them. If it does not, the bootstrap views invent a finish like every other view.
- For an empty room that it is asked to furnish, it draws the furniture of the offline objects backend and the finish of the
  scene. Only colours and shapes are taken from such an image, so that a coarser world is sufficient (COARSE).
- Where X shows accumulated texture, the result has the low frequencies of X, down to the scale of texels, and the fine detail of
  the world.
Imperfections (wm.offline.image.imperfections) and violations of the structure (wm.offline.image.violations) are added with the
strengths in Settings. If all of them are 0 and the condition leaves nothing open, the image is the exact world, which is the
truth of held-out views.
"""

import dataclasses
import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.ndimage import gaussian_filter

from wm.bounds import number, setting
from wm.geometry.rays.pinhole import camera_center, camera_rays
from wm.host import cores
from wm.offline.image.imagination import FURNISHED, SCENE, Imagination, imagined_scene, imagined_style
from wm.offline.image.imperfections import drifted, drifted_apart, exposed, softened, strayed
from wm.offline.image.violations import KINDS, ScaffoldViolation, draw_violation
from wm.offline.style.words import read_theme
from wm.offline.world.room import bake_settings
from wm.offline.world.worker import Recipe, WorkerWorld
from wm.offline.world.world import Shot, World
from wm.schema import BESIDE, BackendSettings
from wm.synth.backends import Condition, HeardTheme, ImageRequest, ImageResult, SceneContext
from wm.synth.registry import DRAWN
from wm.types import OUTSIDE, Camera, SceneObject, View

VERSION = "3"
PROVIDES = (DRAWN,)
SURE = 0.85
"""Value of `known` above which the tone of a pixel is used. Below it, the pixel of the condition is partly grey depth."""
RECOGNISED = 0.01
"""Share of the pixels that must show texture of the structure for the model to continue the finish of the scene."""
SHOTS_AT_ONCE, KEPT_SHOTS = 2, 4
"""Number of shots (images of a world, before any condition) that are made at a time, and number that are kept."""
TONE_SCALE = 5 / 688
"""Standard deviation of the low pass as a share of the image width: about a texel of 2 cm at a distance of two metres."""
AGREEMENT = 0.03
"""Relative difference of depth up to which the condition and the world are taken to show the same surface."""
INVENTION = 4.0
"""Drift of an object that the condition does not show, as a multiple of the drift of a wall."""
PLANES = 0.05
"""Metres. Parallel planes of the structure that are farther apart count as different surfaces, such as a pane and its wall."""
ELBOW_ROOM = 0.35
"""Metres from a camera to imagined furniture beyond which more distance is not preferred."""
COARSE = 0.04
"""Smallest distance between texels, in metres, of the world that is drawn to furnish rooms. It is not supersampled."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """The resolution of the painter's world, and the strengths of the flaws of its images."""

    backend: str = setting(__name__, "The offline image model.")
    drift: float = number(0.02, 0, 1, "Standard deviation of the tone a view invents where its condition shows only depth.")
    imaginations: int = number(
        3, 0, 100, "Worlds that a view's seed picks from for what its condition leaves open; 0: always the scene's own."
    )
    exposure: float = number(0.0, 0, 1, "Standard deviation of a view's brightness, also where its condition shows the tone.")
    phase: float = number(0.0, 0, 1000, "Pixels at 1376 wide by which fine detail strays.", unit="px")
    softness: float = number(0.0, 0, 1000, "Pixels at 1376 wide by which the image is blurred.", unit="px")
    closed: float = number(0.0, 0, 1, "Share of the images in which a doorway is shut.")
    missing: float = number(0.0, 0, 1, "Share of the images in which a thing is not drawn.")
    added: float = number(0.0, 0, 1, "Share of the images in which a thing is drawn twice.")
    moved: float = number(0.0, 0, 1, "Share of the images in which a thing stands elsewhere.")
    supersampling: int = number(2, 1, 16, "Geometry samples per pixel side.")
    texel_size: float = number(
        0.01, 0.001, 1, "Distance between texels of the world's surfaces; its light is as much coarser or finer.", unit="m"
    )
    worker: bool = setting(True, "Shade in a process of its own, where there is a core for it.", **BESIDE)


@dataclasses.dataclass(frozen=True, eq=False)
class Scenery:
    """A world, and the scene that it shows."""

    context: SceneContext
    world: World | WorkerWorld


@dataclasses.dataclass(frozen=True, eq=False)
class ProceduralImages:
    """The backend. A world is made for the first view that needs it, and a room of it for the first view that sees the room."""

    scene: SceneContext
    make_world: Callable[[SceneContext, Imagination], World | WorkerWorld]  # of an imagined scene and its finish
    config: Settings
    _pool: ThreadPoolExecutor = dataclasses.field(default_factory=lambda: ThreadPoolExecutor(SHOTS_AT_ONCE, "wm-shots"))
    _shots: dict[tuple, Future[Shot]] = dataclasses.field(default_factory=dict)
    _scenes: dict[Imagination, SceneContext] = dataclasses.field(default_factory=dict)  # by the imagination with surfaces=0
    _sceneries: dict[Imagination, Scenery] = dataclasses.field(default_factory=dict)
    _lock: threading.RLock = dataclasses.field(default_factory=threading.RLock)
    _left_open: threading.Event = dataclasses.field(default_factory=threading.Event)  # set if a condition left something open

    def prefetch(self, views: Sequence[View]) -> None:
        """Starts the shots of the next views, unless conditions leave something open, so that other worlds will be drawn."""
        for view in () if self._left_open.is_set() else views[:KEPT_SHOTS]:
            self._shot(SCENE, view)

    def generate(self, request: ImageRequest) -> ImageResult:
        """The image for a request. Equal requests give equal bytes.

        Raises:
          ValueError: the condition's images are not of the camera's size.
        """
        _check_size(request.condition, request.view.camera)
        which = FURNISHED if request.task == "furnish" else self._imagine(request)
        scenery, shot = self.scenery(which), self._shot(which, request.view).result()
        gone_wrong = self._violation(request, scenery, shot)
        shot = shot if gone_wrong is None else scenery.world.shoot(request.view.camera, gone_wrong.edit)
        rgb = self._painted(request, shot)
        return ImageResult(
            rgb=np.clip(rgb, 0, 1).astype(np.float32),
            drawn_depth=shot.gbuffer.depth.copy(),
            drawn_object=shot.object.copy(),
            drawn_labels=scenery.world.labels,
        )

    def imagined(self) -> Sequence[SceneObject]:
        """The furniture of all rooms, in world space, that its images for the task "furnish" show.

        Raises:
          ValueError: the density of the scene is not between 0 and 1.
        """
        return self._imagined(FURNISHED).objects

    def truth(self, view: View) -> Float[np.ndarray, "h w 3"]:
        """The image of the exact world from a view's camera."""
        return np.clip(self.scenery(SCENE).world.shoot(view.camera).rgb, 0, 1)

    def scenery(self, which: Imagination) -> Scenery:
        """An imagined world, which is made if it does not exist yet."""
        with self._lock:
            if which not in self._sceneries:
                context = self._imagined(which)
                self._sceneries[which] = Scenery(context, self.make_world(context, which))
            return self._sceneries[which]

    def close(self) -> None:
        """Ends the processes of its worlds. Its threads end after the shot that they are making, which is not waited for."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        for scenery in self._sceneries.values():
            if isinstance(scenery.world, WorkerWorld):
                scenery.world.close()

    def _imagine(self, request: ImageRequest) -> Imagination:
        """Selects the world for a request: the scene's own in everything that the condition shows; the seed selects the rest."""
        condition, count = request.condition, self.config.imaginations
        if count == 0:
            return SCENE
        first = np.random.default_rng(_stream(request.seed, 0x1DEA)).permutation(count) + 1
        settles = condition.wall_texture and request.view.kind == "bootstrap"
        surfaces = 0 if settles or _recognised(condition) else int(first[0])
        if condition.objects == "textured":
            which = Imagination(surfaces=surfaces)
        elif condition.objects == "boxes":
            which = Imagination(surfaces=surfaces, furniture=int(first[0]), boxed=True)
        else:
            rooms = [Imagination(surfaces=surfaces, furniture=int(k)) for k in first]
            which = max(rooms, key=lambda one: min(_air(self._imagined(one), request.view), ELBOW_ROOM))
        if which != SCENE:
            self._left_open.set()
        return which

    def _imagined(self, which: Imagination) -> SceneContext:
        """The scene of an imagined world, furnished if it is not furnished yet. The world itself is not made."""
        with self._lock:
            furniture = dataclasses.replace(which, surfaces=SCENE.surfaces)
            if furniture not in self._scenes:
                self._scenes[furniture] = imagined_scene(self.scene, furniture)
            return self._scenes[furniture]

    def _violation(self, request: ImageRequest, scenery: Scenery, shot: Shot) -> ScaffoldViolation | None:
        rng = np.random.default_rng(_stream(request.seed, 0xBAD))
        objects = request.condition.objects != "none" or request.task == "furnish"
        shares = {kind: getattr(self.config, kind) for kind in KINDS}
        return draw_violation(shares, scenery.context, request.view, shot.gbuffer, shot.object, rng, objects=objects)

    def _painted(self, request: ImageRequest, shot: Shot) -> Float[np.ndarray, "h w 3"]:
        """The shot with the tone of the condition and the imperfections of the model."""
        condition, config = request.condition, self.config
        rng = np.random.default_rng(_stream(request.seed, 0x1A6E))
        invented = drifted(shot.rgb, config.drift, rng)
        shown = _shown(request, shot)
        objects = shot.object != OUTSIDE
        rgb = np.where(
            (objects & ~shown)[..., None], drifted_apart(shot.rgb, shot.object, config.drift * INVENTION, rng), invented
        )
        rgb = np.where((objects & shown)[..., None], shot.rgb, rgb)
        sure = np.clip((condition.known - SURE) / (1 - SURE), 0, 1)
        known = np.where(objects | ~shown, 0, sure).astype(np.float32)
        rgb = _keep_tone(rgb, shot.rgb, condition.rgb, known)
        rng = np.random.default_rng(_stream(request.seed, 0xF1A3))
        rgb = strayed(rgb, _surfaces_of(shot, request.view.camera), config.phase, rng)
        return softened(exposed(rgb, config.exposure, rng), config.softness)

    def _shot(self, which: Imagination, view: View) -> Future[Shot]:
        """The shot of a world for a view, possibly still being made. The latest few are kept for further attempts at a view."""
        camera, scenery = view.camera, self.scenery(which)
        arrays = (np.asarray(x, np.float64).tobytes() for x in (camera.T_cam_world, camera.focal, camera.principal))
        key = (which, *arrays, camera.width, camera.height)
        if key not in self._shots:
            self._shots[key] = self._pool.submit(scenery.world.shoot, camera)
            while len(self._shots) > KEPT_SHOTS:
                del self._shots[next(iter(self._shots))]
        return self._shots[key]


def make(config: Settings, context: SceneContext) -> ProceduralImages:
    """The offline image backend of a scene. Raises: ValueError for a texel size that is not a positive length."""
    fine, coarse = bake_settings(config.texel_size), bake_settings(max(config.texel_size, COARSE))
    apart = config.worker and cores() > 1 and os.name == "posix"

    def make_world(scene: SceneContext, which: Imagination) -> World | WorkerWorld:
        style = imagined_style(context, which)
        if which == FURNISHED:
            recipe = Recipe(scene, supersampling=1, settings=coarse, style=style)
        else:
            recipe = Recipe(scene, supersampling=config.supersampling, settings=fine, style=style)
        return WorkerWorld(recipe, lanes=SHOTS_AT_ONCE) if apart else recipe.make()

    return ProceduralImages(scene=context, make_world=make_world, config=config)


def lowpass(image: Float[np.ndarray, "h w c"], weight: Float[np.ndarray, "h w"]) -> Float[np.ndarray, "h w c"]:
    """Weighted gaussian mean with a standard deviation of TONE_SCALE; 0 where all weights nearby are 0."""
    sigma = max(TONE_SCALE * image.shape[1], 0.6)
    total = gaussian_filter(weight, sigma, mode="nearest", truncate=3.0)
    blurred = gaussian_filter(image * weight[..., None], (sigma, sigma, 0), mode="nearest", truncate=3.0)
    return blurred / np.maximum(total, 1e-4)[..., None]


def _keep_tone(invented: np.ndarray, world: np.ndarray, shown: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Where `known` is 1, the world with the low frequencies of `shown`; where it is 0, `invented`."""
    if not known.any():
        return invented
    kept = world + lowpass(shown - world, known)
    return invented + known[..., None] * (kept - invented)


def _recognised(condition: Condition) -> bool:
    """Whether the condition shows enough texture of the structure to recognise the finish of the room."""
    structure = condition.depth > 0
    if condition.object is not None:
        structure &= ~condition.object
    return float(np.mean((condition.known > 0.5) & structure)) >= RECOGNISED


def _shown(request: ImageRequest, shot: Shot) -> Bool[np.ndarray, "h w"]:
    """Pixels at which the condition shows the same surface as the shot. The surfaces of boxes do not count.

    For the task "furnish", pixels of things that lie flat on a surface of the empty room (a rug, a picture) count as shown.
    """
    condition, depth = request.condition, shot.gbuffer.depth
    same = (condition.depth > 0) & (np.abs(condition.depth - depth) <= AGREEMENT * np.maximum(depth, 0.1))
    if condition.object is not None:
        same &= condition.object == (shot.object != OUTSIDE)
    own = condition.objects == "textured" or request.task == "furnish"
    return same if own else same & (shot.object == OUTSIDE)


def _surfaces_of(shot: Shot, camera: Camera) -> Int[np.ndarray, "h w"]:
    """[h, w] numbers of surfaces: one number for each object and for each plane of the structure, to within PLANES."""
    normal = shot.gbuffer.normal.astype(np.float64)
    place = camera_center(camera) + shot.gbuffer.depth[..., None] * camera_rays(camera).reshape(normal.shape)
    offset = np.round((normal * place).sum(axis=-1) / PLANES + 0.3).astype(np.int64)
    plane = np.round(normal * 2).astype(np.int64) @ np.array([1, 5, 25]) + 125 * offset
    return np.where(shot.object == OUTSIDE, plane - 10**9, shot.object)


def _air(context: SceneContext, view: View) -> float:
    """Metres from a camera to the nearest box of furniture; 0 inside a box."""
    eye = camera_center(view.camera)
    far = [np.inf]
    for thing in context.objects:
        if thing.room == view.room:
            local = (eye - thing.T_world_object[:3, 3]) @ thing.T_world_object[:3, :3] - np.array([0, 0, thing.size[2] / 2])
            far.append(float(np.linalg.norm(np.maximum(np.abs(local) - thing.size / 2, 0))))
    return min(far)


def _stream(seed: int, purpose: int) -> np.random.SeedSequence:
    return np.random.SeedSequence([seed, purpose])


def _check_size(condition: Condition, camera: Camera) -> None:
    size = (camera.height, camera.width)
    if condition.rgb.shape[:2] != size or condition.known.shape != size or condition.depth.shape != size:
        raise ValueError(
            f"the condition is {condition.rgb.shape[:2]}, known {condition.known.shape}, depth {condition.depth.shape}; "
            f"the view's camera asks for {size}"
        )


def heard(theme: str) -> HeardTheme:
    """What the offline world makes of a theme's words."""
    reading = read_theme(theme)
    return HeardTheme(used=reading.used, idle=reading.idle, unknown=reading.unknown)
