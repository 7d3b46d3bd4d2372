"""The image-driven objects backend: an image model draws each room furnished, and what it drew is lifted into the scaffold.

    D0      depth of the empty room from its two bootstrap cameras (the paper has one: what stands behind it is lost)
    I_obj   what the image model makes of D0
    D       the depth of I_obj by a depth model, made metric where the image still shows the room
    things  segments of each image, those of both that show one thing together
    mesh    each thing reconstructed in its first camera's frame
    room    all of them placed

The offline image model draws the generator's furniture in the exact world; where its furniture would stand in a camera's way,
the camera gives way.
Source: WorldMesh, "Object Instantiation" and supplement, "Object Segmentation", "Object Placement".
"""

import contextlib
import dataclasses

import numpy as np

from wm.errors import InputError
from wm.geometry.cameras.views import bootstrap_cameras
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.placement.placing import Placement, place_objects
from wm.geometry.placement.upright import levelled, transformed
from wm.geometry.placement.upright_box import box_of
from wm.geometry.plan.site import Site, room_site
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast
from wm.offline.objects.generator import ProceduralObjects
from wm.schema import CameraSettings, DepthConfig, ImageConfig, ObjectsConfig
from wm.synth.backends import (
    Condition,
    DepthBackend,
    ImageBackend,
    ImageRequest,
    ImageResult,
    Observation,
    Reconstruction,
    ReconstructionBackend,
    SceneContext,
    Segment,
    SegmentationBackend,
    close_backend,
    make_backend,
    mismatch,
)
from wm.synth.checked import checked_estimate, checked_image
from wm.synth.condition import depth_grey
from wm.synth.lifting.metric_depth import metric_depth
from wm.synth.lifting.observations import Instance, gather, in_room, joined
from wm.synth.lifting.segments import tidy_segments
from wm.synth.lifting.unlit import unlit
from wm.synth.prompts import furnish_prompt
from wm.synth.sights import sights
from wm.types import Camera, SceneObject, View

_COARSE = 0.04
"""Metres between texels of the offline world that a room is lifted from: only colours are read off it."""


@dataclasses.dataclass(frozen=True, eq=False)
class Models:
    """What a room is lifted with."""

    image: ImageBackend
    depth: DepthBackend
    segmentation: SegmentationBackend
    reconstruction: ReconstructionBackend


@dataclasses.dataclass(frozen=True, eq=False)
class Drawing:
    """An image of the furnished room and what was made of it."""

    camera: Camera
    result: ImageResult
    depth: np.ndarray  # [h, w] metres
    segments: list[Segment]


@dataclasses.dataclass(frozen=True, eq=False)
class LiftedRoom:
    """A room's furniture, and the steps on the way to it."""

    drawings: tuple[Drawing, ...]
    things: tuple[SceneObject, ...]  # in the world, as reconstructed
    placement: Placement

    @property
    def objects(self) -> list[SceneObject]:
        return list(self.placement.objects)


class LiftedObjects:
    """The backend. It holds the models of the scene that it furnished last, and with them processes, until it is closed."""

    def __init__(self, config: ObjectsConfig, *, image: ImageConfig | None = None, depth: DepthConfig | None = None):
        self.config = config
        self._image = image or ImageConfig()
        self._depth = depth or DepthConfig()
        self._latest: _Imagined | None = None
        self._models: Models | None = None  # of the latest scene

    def with_models(self, image: ImageConfig, depth: DepthConfig) -> "LiftedObjects":
        """A backend with the same settings, its images drawn and their depth estimated by these."""
        return LiftedObjects(self.config, image=image, depth=depth)

    def furnish(self, context: SceneContext, room: int, *, density: float = 1.0) -> list[SceneObject]:
        """The objects of one room, placed in world space.

        Raises:
          ValueError: the density is not a share, or the room has no free spot for a camera.
        """
        return self.lift(context, room, density=density).objects

    def lift(self, context: SceneContext, room: int, *, density: float = 1.0) -> LiftedRoom:
        """The objects of one room, and how they came about."""
        imagined = self.imagined(context, density)
        if self._models is None:
            self._models = self.models(imagined)
        settings = CameraSettings(width=self.config.image_width, height=self.config.image_height, fov=self.config.fov)
        scene = build_ray_scene(assemble_scene(imagined.structure, imagined.objects))
        cameras = bootstrap_cameras(context.plan, scene, room, settings)
        return lift_room(context, room, cameras, self._models, self.config)

    def imagined(self, context: SceneContext, density: float) -> SceneContext:
        """The scene that the offline image model has in mind: the generator's furniture in every room."""
        latest = self._latest
        if latest is None or latest.context is not context or latest.density != density:
            self.close()
            generator = ProceduralObjects(self.config)
            rooms = range(len(context.plan.rooms))
            objects = [thing for room in rooms for thing in generator.furnish(context, room, density=density)]
            latest = _Imagined(context, density, furnished=dataclasses.replace(context, objects=tuple(objects)))
            self._latest = latest
        return latest.furnished

    def models(self, imagined: SceneContext, image: ImageBackend | None = None) -> Models:
        """The selected models, of images the one given if there is one. Whoever asks for them closes them.

        Raises:
          InputError: the selected ones do not go together.
        """
        if image is None:
            faults = mismatch("depth", self._depth, self._image) + mismatch("segmentation", self.config, self._image)
            if faults:
                raise InputError("; ".join(faults))
        return Models(
            image=image if image is not None else _image_model(self._image, imagined),
            depth=make_backend("depth", self._depth, imagined),
            segmentation=make_backend("segmentation", self.config, imagined),
            reconstruction=make_backend("reconstruction", self.config, imagined),
        )

    def close(self) -> None:
        """Ends what it holds; furnishing again makes it anew."""
        models, self._latest, self._models = self._models, None, None
        with contextlib.ExitStack() as done:
            for backend in () if models is None else (models.image, models.depth, models.segmentation, models.reconstruction):
                done.callback(close_backend, backend)


@dataclasses.dataclass(frozen=True, eq=False)
class _Imagined:
    """What a scene was furnished with at a density."""

    context: SceneContext
    density: float
    furnished: SceneContext


def _image_model(config: ImageConfig, imagined: SceneContext) -> ImageBackend:
    coarse = dataclasses.replace(config, texel_size=max(config.texel_size, _COARSE), supersampling=1)
    return make_backend("image", coarse, imagined)


def lift_room(context: SceneContext, room: int, cameras: list[Camera], models: Models, config: ObjectsConfig) -> LiftedRoom:
    """One room, drawn from these cameras, segmented, reconstructed and placed."""
    bare = build_ray_scene(context.structure)
    site = room_site(context.plan, room)
    drawings = []
    for k, camera in enumerate(cameras):
        seed = _seed(context.seed, room, k)
        drawing = draw(context, room, camera, bare, models, config, reference=drawings[0] if drawings else None, seed=seed)
        drawings += [drawing] if drawing is not None else []
    found = [[(segment, _observation(drawing, segment)) for segment in drawing.segments] for drawing in drawings]
    things = gather([[pair for pair in pairs if in_room(pair[1], site.polygon)] for pairs in found])
    reconstructions = _reconstructed(context, room, site, things, models.reconstruction)
    in_world = unlit(reconstructions)
    return LiftedRoom(drawings=tuple(drawings), things=tuple(in_world), placement=place_objects(in_world, site))


def _reconstructed(
    context: SceneContext, room: int, site: Site, things: list[Instance], backend: ReconstructionBackend
) -> list[Reconstruction]:
    """Each thing in the world; those that turn out to be one are reconstructed again, together."""

    def made(thing: Instance, number: int) -> Reconstruction | None:
        seed = _seed(context.seed, room, 100 + number)
        result = backend.reconstruct(thing.label, thing.observations, site, room, seed=seed)
        if result is None:
            return None
        T_world_cam = np.linalg.inv(np.asarray(thing.observations[0].camera.T_cam_world, np.float64))
        return dataclasses.replace(result, thing=transformed(result.thing, T_world_cam))

    first = [made(thing, k) for k, thing in enumerate(things)]
    groups = joined(things, [box_of(levelled(result.thing)) if result is not None else None for result in first])
    results = [first[group[0]] if len(group) == 1 else made(thing, group[0]) for thing, group in groups]
    return [result for result in results if result is not None]


def draw(
    context: SceneContext, room: int, camera: Camera, bare: RayScene, models: Models, config: ObjectsConfig,
    *, reference: Drawing | None, seed: int,
) -> Drawing | None:  # fmt: skip
    """One image of the room with its segments; None where its depth cannot be told."""
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
    )
    result = models.image.generate(request)
    result = dataclasses.replace(result, rgb=checked_image(result.rgb, request.view))
    estimate = checked_estimate(models.depth.estimate(result, seed=seed), request.view)
    depth = metric_depth(estimate, gbuffer.depth, seed=seed) if estimate is not None else None
    if depth is None:
        return None
    segments = tidy_segments(models.segmentation.segment(result, seed=seed), depth, min_area=config.min_area)
    return Drawing(camera=camera, result=result, depth=depth, segments=segments)


def _observation(drawing: Drawing, segment: Segment) -> Observation:
    return Observation(camera=drawing.camera, rgb=drawing.result.rgb, depth=drawing.depth, mask=segment.mask)


def _seed(*numbers: int) -> int:
    return int(np.random.SeedSequence([*numbers, 0x11F7]).generate_state(1)[0])


def make(config: ObjectsConfig, context: SceneContext | None = None) -> LiftedObjects:
    """The image-driven backend, with the offline image and depth models until it is given others."""
    return LiftedObjects(config)
