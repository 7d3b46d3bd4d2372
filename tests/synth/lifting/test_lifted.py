"""The chain from drawing to placed furniture, with the offline models, on two small rooms."""

import contextlib
import dataclasses
import functools
import math

import numpy as np
import pytest

from tests.synth.lifting.scenes import STYLE, bare, piece
from tests.synth.recording import Recording, recorded, recording
from wm.geometry.cameras.views import bootstrap_cameras
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.placement.laws import broken_laws
from wm.geometry.placement.upright import transformed
from wm.geometry.placement.upright_box import box_iou, box_of
from wm.geometry.plan.site import room_site
from wm.geometry.rays.pinhole import camera_center
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.offline.arrangement.furnishing import furnish_scene
from wm.offline.depth.estimator import Settings as DepthSettings
from wm.offline.image.painter import Settings as ImageSettings
from wm.offline.reconstruction.templates import TemplateReconstruction
from wm.schema import BackendSettings, CameraSettings
from wm.synth.backends import (
    DepthBackend,
    ImageBackend,
    ImageDrivenBackend,
    ImageRequest,
    ImageResult,
    ImaginingBackend,
    ModelSettings,
    Segment,
    SegmentationBackend,
    Surroundings,
)  # fmt: skip
from wm.synth.lifting.lifted import Models, Settings, lift_room, room_cameras
from wm.synth.registry import BackendError, make_backend
from wm.types import OUTSIDE, Camera, View

CONFIG = Settings(image_width=240, image_height=180)
COARSE = ImageSettings(texel_size=0.08)
OFFLINE = ModelSettings(
    image=COARSE,
    depth=DepthSettings(),
    segmentation=BackendSettings(backend="wm.offline.segmentation.drawn"),
    reconstruction=BackendSettings(backend="wm.offline.reconstruction.templates"),
)
MODELS = ("image", "depth", "segmentation", "reconstruction")


def recording_models(*groups):
    """The offline models, those of these groups recorded."""
    return dataclasses.replace(
        OFFLINE, **{group: recording(group, **({"texel_size": 0.08} if group == "image" else {})) for group in groups}
    )


@functools.cache
def lifted(room=1):
    with contextlib.closing(make_backend("objects", CONFIG, bare()).with_models(OFFLINE)) as backend:
        return backend.lift(bare(), room)


def test_most_of_what_was_drawn_is_found_near_where_it_was_drawn():
    near = []
    for number in (0, 1):
        room = lifted(number)
        truth = [thing for thing in furnish_scene(bare()) if thing.room == number]
        large = [thing for thing in truth if box_of(thing).volume > 0.05 and thing.support == "floor"]
        near += [max((box_iou(box_of(t), box_of(o)) for o in room.objects if o.label == t.label), default=0.0) for t in large]
        assert {thing.room for thing in room.objects} == {number}
    assert len(near) >= 8 and np.mean(np.array(near) > 0.3) >= 0.6


@dataclasses.dataclass(frozen=True)
class Photographs:
    """Pictures of a room with the depth and the masks that models found in them, by the name of their view: nothing else of
    what they show is known."""

    things: list  # what was photographed
    found: dict = dataclasses.field(default_factory=dict)  # bytes of an image -> (relative depth, segments)

    def generate(self, request: ImageRequest) -> ImageResult:
        scene = build_ray_scene(assemble_scene(bare().structure, self.things))
        gbuffer = cast(scene, request.view.camera)
        owner = np.append(scene.mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]
        rgb = np.full((*owner.shape, 3), 0.4, np.float32)
        rgb[owner >= 0] = (0.5, 0.3, 0.2)
        segments = [Segment(f"oak {thing.label}", owner == k) for k, thing in enumerate(self.things)]
        self.found[rgb.tobytes()] = (0.5 * gbuffer.depth + 0.1, segments)
        return ImageResult(rgb=rgb)

    def estimate(self, result: ImageResult, *, camera: Camera, seed: int) -> np.ndarray | None:
        return self.found[result.rgb.tobytes()][0]

    def segment(self, result: ImageResult, *, where: Surroundings, seed: int) -> list[Segment]:
        return self.found[result.rgb.tobytes()][1]


def test_photographs_with_depth_and_masks_are_lifted_without_knowing_what_was_drawn():
    things = [piece("wardrobe", 2.4, 0.45, math.pi, (1.3, 0.6, 2.0)), piece("sofa", 2.4, 3.3, 0.0, (2.0, 0.9, 0.85))]
    camera = Photographs(things)
    assert isinstance(camera, ImageBackend) and isinstance(camera, DepthBackend) and isinstance(camera, SegmentationBackend)
    models = Models(image=camera, depth=camera, segmentation=camera, reconstruction=TemplateReconstruction(STYLE))
    structure = build_ray_scene(bare().structure)
    views = bootstrap_cameras(bare().plan, structure, 0, CameraSettings(width=240, height=180, fov=90.0))
    room = lift_room(bare(), 0, views, models, CONFIG)
    assert all(drawing.result.drawn_object is drawing.result.drawn_depth is None for drawing in room.drawings)
    assert sorted(thing.label for thing in room.objects) == ["oak sofa", "oak wardrobe"]
    for truth in things:
        made = next(thing for thing in room.objects if thing.label == f"oak {truth.label}")
        assert box_iou(box_of(truth), box_of(made)) > 0.7


def test_the_room_obeys_the_laws():
    room = lifted()
    assert broken_laws(room.objects, room_site(bare().plan, 1)) == []


def shape(thing):
    """[v, 3] the vertices with place, turn and size taken off: in the thing's frame, 0 to 1 along each axis."""
    local = (thing.vertices - thing.T_world_object[:3, 3]) @ thing.T_world_object[:3, :3]
    return (local - local.min(axis=0)) / np.maximum(np.ptp(local, axis=0), 1e-9)


def copied(thing, others):
    """Whether a thing has the shape of another, to a thousandth of its sides."""
    return any(np.allclose(shape(thing), shape(o), atol=1e-3) for o in others if thing.vertices.shape == o.vertices.shape)


def test_nothing_is_copied_from_the_generator():
    """Not even at another place and size. What is of one kind is built by one template, but for proportions and dice."""
    room, truth = lifted(), furnish_scene(bare())
    assert not any(copied(thing, truth) for thing in room.objects)
    one, turn = truth[0], np.array([[0.6, -0.8, 0.0, 3.0], [0.8, 0.6, 0.0, -1.0], [0.0, 0.0, 1.0, 0.2], [0.0, 0.0, 0.0, 1.0]])
    larger = dataclasses.replace(one, vertices=1.3 * (one.vertices - one.T_world_object[:3, 3]) + one.T_world_object[:3, 3])
    assert copied(transformed(larger, turn), truth)  # it would be found


def test_its_models_end_with_it_and_with_the_scene_they_are_of():
    small = dataclasses.replace(CONFIG, image_width=24, image_height=18)
    backend = make_backend("objects", small, bare()).with_models(OFFLINE)
    backend.lift(bare(), 1)
    first = backend._held[1]
    backend.lift(bare(), 0)
    assert backend._held[1] is first
    backend.lift(dataclasses.replace(bare()), 1)
    view = View(bootstrap_cameras(bare().plan, build_ray_scene(bare().structure), 1, CameraSettings())[0], 1, "bootstrap", "v")
    with pytest.raises(RuntimeError, match="shutdown"):
        first.image.prefetch([view])
    backend.close()
    backend.close()
    assert backend._held is None


def test_all_of_its_models_are_the_selected_ones_and_closed(monkeypatch):
    small = dataclasses.replace(CONFIG, image_width=60, image_height=45)
    with contextlib.closing(make_backend("objects", small, bare()).with_models(OFFLINE)) as backend:
        offline = backend.lift(bare(), 1).objects
    log = recorded(monkeypatch, *MODELS)
    backend = make_backend("objects", small, bare()).with_models(recording_models(*MODELS))
    own = backend.lift(bare(), 1).objects
    backend.close()
    backend.close()
    assert {f"{group} asked" for group in MODELS} <= set(log)
    assert [entry for entry in log if "closed" in entry] == [f"{group} closed" for group in reversed(MODELS)] == log[-4:]
    assert [thing.vertices.tobytes() for thing in own] == [thing.vertices.tobytes() for thing in offline] != []


@pytest.mark.parametrize(("groups", "named"), [(["image"], "depth backend 'wm.*"), (["image", "depth"], "")])
def test_an_image_model_that_tells_nothing_is_refused_before_it_is_made(monkeypatch, groups, named):
    log = recorded(monkeypatch, "image", "depth", draws=False)
    backend = make_backend("objects", CONFIG, bare()).with_models(recording_models(*groups))
    with pytest.raises(BackendError, match=rf"^{named}segmentation backend 'wm\.offline.*image backend 'recording_image'"):
        backend.furnish(bare(), 1)
    assert log == []


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bytes():
    room = lifted()
    again = make_backend("objects", CONFIG, bare()).with_models(OFFLINE).furnish(bare(), 1)
    assert [thing.vertices.tobytes() for thing in again] == [thing.vertices.tobytes() for thing in room.objects]
    assert [thing.slot_colors.tobytes() for thing in again] == [thing.slot_colors.tobytes() for thing in room.objects]


def camera_keys(cameras):
    return [np.asarray(camera.T_cam_world).tobytes() for camera in cameras]


@dataclasses.dataclass(frozen=True)
class Imagining:
    """An image model that says what it will draw."""

    furniture: tuple

    def generate(self, request: ImageRequest) -> ImageResult:
        return ImageResult(rgb=np.full((request.view.camera.height, request.view.camera.width, 3), 0.5, np.float32))

    def imagined(self):
        return self.furniture


def test_cameras_give_way_to_furniture_that_the_image_model_imagines_and_to_no_other():
    structure = build_ray_scene(bare().structure)
    settings = CameraSettings(width=CONFIG.image_width, height=CONFIG.image_height, fov=CONFIG.fov)
    empty = bootstrap_cameras(bare().plan, structure, 0, settings)
    x, y, _ = camera_center(empty[0])
    wardrobe = piece("wardrobe", float(x), float(y), math.pi, (1.3, 0.6, 2.0))
    moved = room_cameras(bare(), 0, Imagining((wardrobe,)), CONFIG)
    assert camera_keys(moved) != camera_keys(empty)
    inside = np.abs(camera_center(moved[0])[:2] - box_of(wardrobe).center) < [0.65, 0.3]
    assert not inside.all()
    assert camera_keys(room_cameras(bare(), 0, Imagining(()), CONFIG)) == camera_keys(empty)
    furnished = dataclasses.replace(bare(), objects=(wardrobe,))
    assert camera_keys(room_cameras(furnished, 0, Photographs([wardrobe]), CONFIG)) == camera_keys(empty)


def test_an_image_model_that_imagines_nothing_and_tells_nothing_is_shown_the_empty_room(monkeypatch):
    """Its requests show the bare structure, from the cameras of the empty room, and it is made for a scene without furniture."""
    log = recorded(monkeypatch, "image", "depth", "segmentation", draws=False)
    monkeypatch.setattr(Recording, "estimate", lambda self, result, *, camera, seed: None)
    models = recording_models("image", "depth", "segmentation")
    small = dataclasses.replace(CONFIG, image_width=24, image_height=18)
    with contextlib.closing(make_backend("objects", small, bare()).with_models(models)) as backend:
        for room in (0, 1):
            assert backend.lift(bare(), room).objects == []
        assert not isinstance(backend._held[1].image, ImaginingBackend)
        assert backend._held[1].image.inner.scene.objects == ()
    settings = CameraSettings(width=24, height=18, fov=CONFIG.fov)
    structure = build_ray_scene(bare().structure)
    empty = [camera for room in (0, 1) for camera in bootstrap_cameras(bare().plan, structure, room, settings)]
    assert camera_keys(request.view.camera for request in log.requests) == camera_keys(empty)
    for request in log.requests:
        np.testing.assert_array_equal(request.condition.depth, cast(bare().structure, request.view.camera).depth)
        assert request.reference is None


def test_what_a_model_is_asked_is_what_it_is_shown(monkeypatch):
    """An empty room, said to be empty and shown so; to the second camera also the room as the first shows it furnished."""
    log = recorded(monkeypatch, "image")
    small = dataclasses.replace(CONFIG, image_width=24, image_height=18)
    backend = make_backend("objects", small, bare()).with_models(recording_models("image"))
    room = backend.lift(bare(), 1)
    backend.close()
    first, second = log.requests
    for request in (first, second):
        condition = request.condition
        assert (request.task, condition.objects, condition.object, condition.wall_texture) == ("furnish", "none", None, False)
        np.testing.assert_array_equal(condition.depth, cast(bare().structure, request.view.camera).depth)
        assert not condition.known.any() and np.ptp(condition.rgb, axis=-1).max() == 0
        assert "empty" in request.prompt and "Furnish the room" in request.prompt and "take no object" not in request.prompt
        assert ("second picture" in request.prompt) == (request.reference is not None)
    assert first.reference is None
    np.testing.assert_array_equal(second.reference, room.drawings[0].result.rgb)
    assert any("In view: a doorway" in request.prompt for request in (first, second))


def test_it_is_image_driven_and_refuses_a_density_that_is_no_share():
    backend = make_backend("objects", CONFIG, bare())
    assert isinstance(backend, ImageDrivenBackend)
    with pytest.raises(BackendError, match="with_models"):
        backend.furnish(bare(), 0)
    backend = backend.with_models(OFFLINE)
    with contextlib.closing(backend), pytest.raises(ValueError, match=r"furnish\.density is 1\.5"):
        backend.furnish(dataclasses.replace(bare(), density=1.5), 0)
