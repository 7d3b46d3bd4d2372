"""The image-driven objects backend: an image model draws each room furnished, and what it drew is lifted into the scaffold.

    D0         depth of the empty room from its two bootstrap cameras (the paper has one: what stands behind it is lost)
    I_obj      what the image model makes of D0
    D          the depth of I_obj by a depth model, made metric where the image still shows the room
    instances  segments of each image; those of both images that show the same thing are one instance
    mesh       each instance reconstructed in the frame of its first camera
    room       all of them placed

The image model is shown the empty room, and nothing else of the scene is known here. The cameras are those of the empty room too,
unless the image model is an ImaginingBackend: then they are kept clear of the furniture that it says it will draw.
Source: WorldMesh, "Object Instantiation" and supplement, "Object Segmentation", "Object Placement".
"""

import contextlib
import dataclasses
import pathlib

import numpy as np

from wm.bounds import number, setting
from wm.geometry.cameras.views import bootstrap_cameras
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.placement.placing import Placement, place_objects
from wm.geometry.placement.upright import levelled, transformed
from wm.geometry.placement.upright_box import box_of
from wm.geometry.plan.site import Site, room_site
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast
from wm.schema import CameraSettings, ObjectsSettings
from wm.services.faults import RefusedError, ServiceError
from wm.synth.backends import (
    Condition,
    DepthBackend,
    ImageBackend,
    ImageRequest,
    ImageResult,
    ImaginingBackend,
    ModelSettings,
    Observation,
    Reconstruction,
    ReconstructionBackend,
    SceneContext,
    Segment,
    SegmentationBackend,
    Surroundings,
)
from wm.synth.checked import checked_estimate, checked_image
from wm.synth.condition import depth_grey
from wm.synth.lifting.metric_depth import metric_depth
from wm.synth.lifting.observations import Instance, gather, in_room, joined
from wm.synth.lifting.segments import tidy_segments
from wm.synth.lifting.unlit import unlit
from wm.synth.prompts import furnish_prompt
from wm.synth.registry import BackendError, close_backend, make_backend, mismatch
from wm.synth.seeds import room_number
from wm.synth.sights import sights
from wm.types import Camera, SceneObject, View

VERSION = "2"
_ATTEMPTS = 4
"""Seeds of a drawing that are tried before the image model's refusals end the run."""
USES = ("image", "depth", "segmentation", "reconstruction")


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(ObjectsSettings):
    """The images that rooms are lifted from, and what is left out of them."""

    backend: str = setting(__name__, "Furniture lifted out of images of each room.")
    image_width: int = number(640, 16, 16384, "Width of the images that rooms are lifted from.", unit="px")
    image_height: int = number(480, 16, 16384, "Height of the images that rooms are lifted from.", unit="px")
    fov: float = number(90.0, 5, 150, "Vertical field of view of the images that rooms are lifted from.", unit="degrees")
    min_area: float = number(2e-4, 0, 1, "Share of the image below which a segment is discarded.")


@dataclasses.dataclass(frozen=True, eq=False)
class Models:
    """The backends that lift a room."""

    image: ImageBackend
    depth: DepthBackend
    segmentation: SegmentationBackend
    reconstruction: ReconstructionBackend
    folder: pathlib.Path | None = None  # the run folder


@dataclasses.dataclass(frozen=True, eq=False)
class Drawing:
    """An image of the furnished room, its depth and its segments."""

    camera: Camera
    result: ImageResult
    depth: np.ndarray  # [h, w] metres
    segments: list[Segment]


@dataclasses.dataclass(frozen=True, eq=False)
class LiftedRoom:
    """A room's furniture, and the steps on the way to it."""

    drawings: tuple[Drawing, ...]
    things: tuple[SceneObject, ...]  # the instances in world space, as reconstructed
    placement: Placement

    @property
    def objects(self) -> list[SceneObject]:
        return list(self.placement.objects)


class LiftedObjects:
    """The backend. It holds the models of the scene that it furnished last, and with them processes, until it is closed."""

    def __init__(self, config: Settings, asked: ModelSettings | None = None):
        self.config = config
        self._asked = asked
        self._held: tuple[SceneContext, Models] | None = None

    def with_models(self, models: ModelSettings) -> "LiftedObjects":
        """A backend with the same settings that asks the models that these select."""
        return LiftedObjects(self.config, models)

    def furnish(self, context: SceneContext, room: int) -> list[SceneObject]:
        """The objects of one room, placed in world space.

        Raises:
          BackendError: no models were selected, or those selected do not go together.
          ValueError: the room has no free spot for a camera, or the image model refuses the scene.
        """
        return self.lift(context, room).objects

    def lift(self, context: SceneContext, room: int) -> LiftedRoom:
        """The objects of one room, and how they came about."""
        if self._held is None or self._held[0] is not context:
            self.close()
            self._held = context, self.models(context)
        models = self._held[1]
        return lift_room(context, room, room_cameras(context, room, models.image, self.config), models, self.config)

    def models(self, context: SceneContext, image: ImageBackend | None = None) -> Models:
        """The selected models for a scene, with `image` for the image model if it is given. The caller closes them.

        Raises:
          BackendError: no models were selected (`with_models`), or those selected do not go together.
        """
        asked = self._asked
        if asked is None:
            raise BackendError("lifted furniture needs models of images, depth, segmentation, reconstruction: with_models(...)")
        if image is None:
            faults = mismatch("depth", asked.depth, asked.image) + mismatch("segmentation", asked.segmentation, asked.image)
            if faults:
                raise BackendError("; ".join(faults))
        return Models(
            image=image if image is not None else make_backend("image", asked.image, context, asked.services),
            depth=make_backend("depth", asked.depth, context, asked.services),
            segmentation=make_backend("segmentation", asked.segmentation, context, asked.services),
            reconstruction=make_backend("reconstruction", asked.reconstruction, context, asked.services),
            folder=asked.folder,
        )

    def close(self) -> None:
        """Ends the models that it holds. Furnishing again makes new ones."""
        held, self._held = self._held, None
        if held is None:
            return
        models = held[1]
        with contextlib.ExitStack() as done:
            for backend in (models.image, models.depth, models.segmentation, models.reconstruction):
                done.callback(close_backend, backend)


def room_cameras(context: SceneContext, room: int, image: ImageBackend, config: Settings) -> list[Camera]:
    """The bootstrap cameras that a room is drawn from, clear of the furniture that the image model says it will draw.

    Raises:
      ValueError: the room has no free spot for a camera.
    """
    furniture = image.imagined() if isinstance(image, ImaginingBackend) else ()
    settings = CameraSettings(width=config.image_width, height=config.image_height, fov=config.fov)
    return bootstrap_cameras(context.plan, build_ray_scene(assemble_scene(context.structure, furniture)), room, settings)


def lift_room(context: SceneContext, room: int, cameras: list[Camera], models: Models, config: Settings) -> LiftedRoom:
    """One room drawn from these cameras, segmented, reconstructed and placed."""
    bare = build_ray_scene(context.structure)
    site, number = room_site(context.plan, room, context.objects), room_number(context.plan, room)
    drawings = []
    for k, camera in enumerate(cameras):
        seed = _seed(context.seed_of("furnish"), number, k)
        drawing = draw(context, room, camera, bare, models, config, reference=drawings[0] if drawings else None, seed=seed)
        drawings += [drawing] if drawing is not None else []
    found = [[(segment, _observation(drawing, segment)) for segment in drawing.segments] for drawing in drawings]
    instances = gather([[pair for pair in pairs if in_room(pair[1], site.polygon)] for pairs in found])
    reconstructions = _reconstructed(context, room, site, instances, models.reconstruction)
    in_world = unlit(reconstructions)
    return LiftedRoom(drawings=tuple(drawings), things=tuple(in_world), placement=place_objects(in_world, site))


def _reconstructed(
    context: SceneContext, room: int, site: Site, instances: list[Instance], backend: ReconstructionBackend
) -> list[Reconstruction]:
    """Each instance in world space. Those whose reconstructions turn out to be one instance are reconstructed again together."""

    def made(instance: Instance, number: int) -> Reconstruction | None:
        seed = _seed(context.seed_of("furnish"), room_number(context.plan, room), 100 + number)
        result = backend.reconstruct(instance.label, instance.observations, site, room, seed=seed)
        if result is None:
            return None
        T_world_cam = np.linalg.inv(np.asarray(instance.observations[0].camera.T_cam_world, np.float64))
        return dataclasses.replace(result, thing=transformed(result.thing, T_world_cam))

    first = [made(instance, k) for k, instance in enumerate(instances)]
    groups = joined(instances, [box_of(levelled(result.thing)) if result is not None else None for result in first])
    results = [first[group[0]] if len(group) == 1 else made(instance, group[0]) for instance, group in groups]
    return [result for result in results if result is not None]


def draw(
    context: SceneContext, room: int, camera: Camera, bare: RayScene, models: Models, config: Settings,
    *, reference: Drawing | None, seed: int,
) -> Drawing | None:  # fmt: skip
    """One image of the room furnished, with its segments; None if its depth cannot be made metric."""
    gbuffer = cast(bare, camera)
    grey = depth_grey(gbuffer, (0.0, max(float(gbuffer.depth.max()), 1e-3)))
    condition = Condition(
        rgb=np.repeat(grey[..., None], 3, axis=-1), known=np.zeros_like(grey), depth=gbuffer.depth, objects="none",
        wall_texture=False,
    )  # fmt: skip
    plan_room = context.plan.rooms[room]
    seen = sights(camera, room_site(context.plan, room))
    request = ImageRequest(
        condition=condition,
        reference=reference.result.rgb if reference is not None else None,
        prompt=furnish_prompt(context.theme, plan_room.name, seen, has_reference=reference is not None),
        view=View(camera, room, "bootstrap", f"{plan_room.id}/furnish{0 if reference is None else 1}"),
        seed=seed,
        task="furnish",
        theme=context.theme,
        room=plan_room.name,
        sights=tuple(seen),
    )
    result = _drawn(models.image, request)
    estimate = checked_estimate(models.depth.estimate(result, camera=camera, seed=seed), request.view)
    depth = metric_depth(estimate, gbuffer.depth, seed=seed) if estimate is not None else None
    if depth is None:
        return None
    where = Surroundings(theme=context.theme, room=plan_room.name, view=request.view, folder=models.folder)
    segments = tidy_segments(models.segmentation.segment(result, where=where, seed=seed), depth, min_area=config.min_area)
    return Drawing(camera=camera, result=result, depth=depth, segments=segments)


def _drawn(image: ImageBackend, request: ImageRequest) -> ImageResult:
    """The image of the first attempt that the model does not refuse.

    Raises:
      ServiceError: it refuses every attempt.
    """
    refusals: list[str] = []
    for attempt in range(_ATTEMPTS):
        again = request if attempt == 0 else dataclasses.replace(request, seed=_seed(request.seed, attempt))
        try:
            result = image.generate(again)
        except RefusedError as refusal:
            refusals.append(str(refusal))
            continue
        return dataclasses.replace(result, rgb=checked_image(result.rgb, request.view))
    raise ServiceError(f"view {request.view.name}: the image model refused {_ATTEMPTS} attempts; the last time: {refusals[-1]}")


def _observation(drawing: Drawing, segment: Segment) -> Observation:
    return Observation(camera=drawing.camera, rgb=drawing.result.rgb, depth=drawing.depth, mask=segment.mask)


def _seed(*numbers: int) -> int:
    return int(np.random.SeedSequence([*numbers, 0x11F7]).generate_state(1)[0])


def make(config: Settings, context: SceneContext | None = None) -> LiftedObjects:
    """The image-driven backend. It furnishes nothing until `with_models` says which models it asks."""
    return LiftedObjects(config)
