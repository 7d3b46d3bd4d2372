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

import dataclasses

import numpy as np

from wm.bounds import number, setting
from wm.geometry.cameras.views import bootstrap_cameras
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.placement.placing import Placement, place_objects
from wm.geometry.placement.upright import levelled, transformed
from wm.geometry.placement.upright_box import box_of
from wm.geometry.plan.site import Site, room_site
from wm.geometry.rays.raycast import build_ray_scene
from wm.schema import CameraSettings, ObjectsSettings
from wm.synth.backends import (
    ImageBackend,
    ImaginingBackend,
    ModelSettings,
    Observation,
    PreparedSegmentation,
    Reconstruction,
    ReconstructionBackend,
    SceneContext,
    Segment,
)
from wm.synth.lifting.drawing import Drawing, draw_room, drawing_seed
from wm.synth.lifting.drawings import drop_drawings
from wm.synth.lifting.models import Models, make_models
from wm.synth.lifting.observations import Instance, gather, in_room, joined
from wm.synth.lifting.segments import tidy_segments
from wm.synth.lifting.unlit import unlit
from wm.synth.registry import BackendError
from wm.synth.seeds import room_number
from wm.types import Camera, SceneObject

VERSION = "2"
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
        self._drawn: dict[int, list[Drawing]] = {}
        """By room, those that were drawn ahead."""

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
        models = self._held[1] if self._held is not None and self._held[0] is context else self._begin(context)
        drawings = self._drawn.pop(room) if room in self._drawn else self._draw(context, room, models)
        return lift_drawings(context, room, drawings, models, self.config)

    def models(self, context: SceneContext, image: ImageBackend | None = None) -> Models:
        """The selected models for a scene, with `image` for the image model if it is given. The caller closes them.

        Raises:
          BackendError: no models were selected (`with_models`), or those selected do not go together.
        """
        if self._asked is None:
            raise BackendError("lifted furniture needs models of images, depth, segmentation, reconstruction: with_models(...)")
        return make_models(self._asked, context, image)

    def close(self) -> None:
        """Ends the models that it holds. Furnishing again makes new ones."""
        held, self._held, self._drawn = self._held, None, {}
        if held is not None:
            held[1].close()

    def _begin(self, context: SceneContext) -> Models:
        """The models for a scene. A segmentation that wants to be told of all images first is told."""
        self.close()
        models = self.models(context)
        self._held = context, models
        if models.folder is not None:
            rooms = {room.id for room in context.plan.rooms}
            drop_drawings(models.folder, lambda name: name.rpartition("/")[0] not in rooms)
        if isinstance(models.segmentation, PreparedSegmentation):
            drawn = {room: self._draw(context, room, models) for room in range(len(context.plan.rooms))}
            models.segmentation.prepare([(image.result, image.where) for images in drawn.values() for image in images])
            self._drawn = drawn
        return models

    def _draw(self, context: SceneContext, room: int, models: Models) -> list[Drawing]:
        return draw_room(context, room, room_cameras(context, room, models.image, self.config), models)


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
    return lift_drawings(context, room, draw_room(context, room, cameras, models), models, config)


def lift_drawings(context: SceneContext, room: int, drawings: list[Drawing], models: Models, config: Settings) -> LiftedRoom:
    """What these drawings of a room show, segmented, reconstructed and placed."""
    site = room_site(context.plan, room, context.objects)
    found = [[(one, _observation(drawing, one)) for one in _segments(drawing, models, config)] for drawing in drawings]
    instances = gather([[pair for pair in pairs if in_room(pair[1], site.polygon)] for pairs in found])
    reconstructions = _reconstructed(context, room, site, instances, models.reconstruction)
    in_world = unlit(reconstructions)
    return LiftedRoom(drawings=tuple(drawings), things=tuple(in_world), placement=place_objects(in_world, site))


def _reconstructed(
    context: SceneContext, room: int, site: Site, instances: list[Instance], backend: ReconstructionBackend
) -> list[Reconstruction]:
    """Each instance in world space. Those whose reconstructions turn out to be one instance are reconstructed again together."""

    def made(instance: Instance, number: int) -> Reconstruction | None:
        seed = drawing_seed(context.seed_of("furnish"), room_number(context.plan, room), 100 + number)
        result = backend.reconstruct(instance.label, instance.observations, site, room, seed=seed)
        if result is None:
            return None
        T_world_cam = np.linalg.inv(np.asarray(instance.observations[0].camera.T_cam_world, np.float64))
        return dataclasses.replace(result, thing=transformed(result.thing, T_world_cam))

    first = [made(instance, k) for k, instance in enumerate(instances)]
    groups = joined(instances, [box_of(levelled(result.thing)) if result is not None else None for result in first])
    results = [first[group[0]] if len(group) == 1 else made(instance, group[0]) for instance, group in groups]
    return [result for result in results if result is not None]


def _segments(drawing: Drawing, models: Models, config: Settings) -> list[Segment]:
    segments = models.segmentation.segment(drawing.result, where=drawing.where, seed=drawing.seed)
    return tidy_segments(segments, drawing.depth, min_area=config.min_area)


def _observation(drawing: Drawing, segment: Segment) -> Observation:
    return Observation(camera=drawing.camera, rgb=drawing.result.rgb, depth=drawing.depth, mask=segment.mask)


def make(config: Settings, context: SceneContext | None = None) -> LiftedObjects:
    """The image-driven backend. It furnishes nothing until `with_models` says which models it asks."""
    return LiftedObjects(config)
