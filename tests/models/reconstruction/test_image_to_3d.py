"""The image-to-3D backend with workers that are real processes: what they are asked, and what becomes of their answers."""

import contextlib
import dataclasses
import functools
import math
import pathlib

import numpy as np
import pytest
import shapely

from tests.models.worker.scripts import PYTHON, script
from tests.synth.lifting.scenes import bare, cameras, observations, piece, site
from tests.synth.lifting.test_lifted import CONFIG, Photographs
from wm.errors import InputError
from wm.geometry.cameras.views import bootstrap_cameras
from wm.geometry.placement.laws import broken_laws
from wm.geometry.placement.upright import transformed
from wm.geometry.placement.upright_box import box_iou, box_of
from wm.geometry.rays.pinhole import unproject_depth
from wm.geometry.rays.raycast import build_ray_scene
from wm.models.reconstruction import example_worker, image_to_3d, sam3d_objects
from wm.models.reconstruction.image_to_3d import ImageTo3D, Settings, camera_points
from wm.schema import BackendSettings, CameraSettings
from wm.services.faults import ServiceError
from wm.services.retries import RetryPolicy
from wm.services.services import Services
from wm.services.store import AnswerStore
from wm.synth.backends import ClosableBackend, Observation, ReconstructionBackend, ServedBackend
from wm.synth.lifting.lifted import Models, lift_room
from wm.synth.registry import make_backend

EXAMPLE = example_worker.__file__
QUICK = RetryPolicy(first=0.01, longest=0.01)


def backend(path: pathlib.Path | str = EXAMPLE, services: Services | None = None, **settings) -> ImageTo3D:
    config = Settings(python=PYTHON, script=str(path), start_seconds=60.0, request_seconds=60.0, **settings)
    return make_backend("reconstruction", config, bare(), services or Services(retries=QUICK))


@functools.cache
def wardrobe_seen() -> tuple[Observation, ...]:
    return observations([WARDROBE], 0)


WARDROBE = piece("wardrobe", 2.6, 0.35, math.pi, (1.3, 0.6, 2.0))


def in_world(result, seen):
    return transformed(result.thing, np.linalg.inv(np.asarray(seen[0].camera.T_cam_world)))


@pytest.mark.parametrize("options", ["", "pose=no"])
def test_a_thing_stands_upright_where_its_points_are(options):
    seen = wardrobe_seen()
    with contextlib.closing(backend(options=options)) as model:
        assert (
            isinstance(model, ReconstructionBackend) and isinstance(model, ServedBackend) and isinstance(model, ClosableBackend)
        )
        result = model.reconstruct("oak wardrobe", seen, site(), 0, seed=3)
    assert result is not None and result.residual < 0.12
    thing = in_world(result, seen)
    assert (thing.label, thing.room, thing.support) == ("oak wardrobe", 0, "floor")
    np.testing.assert_allclose(thing.T_world_object[2, :3], [0, 0, 1], atol=1e-9)
    assert abs(box_of(thing).height - 2.0) < 0.15 and abs(box_of(thing).z) < 0.1
    assert box_iou(box_of(thing), box_of(WARDROBE)) > 0.3  # the box is as deep as it is wide
    np.testing.assert_allclose(thing.slot_colors[0], [0.6, 0.3, 0.2], atol=1 / 255)
    assert result.seen.all() and (result.usual == thing.slot_colors).all()


def test_points_are_in_the_cameras_own_axes():
    camera = cameras()[1]
    depth = np.random.default_rng(0).uniform(1, 4, (camera.height, camera.width)).astype(np.float32)
    depth[3, 5] = 0
    points = camera_points(Observation(camera=camera, rgb=np.zeros((*depth.shape, 3), np.float32), depth=depth, mask=depth > 0))
    assert points.dtype == np.float32 and np.isnan(points[3, 5]).all() and np.isnan(points).sum() == 3
    known = depth > 0
    np.testing.assert_allclose(points[known][:, 2], depth[known], rtol=1e-5)  # z is forward
    pixels = points[known][:, :2] / points[known][:, 2:] * camera.focal + camera.principal
    y, x = np.nonzero(known)
    np.testing.assert_allclose(pixels, np.stack([x, y], axis=1) + 0.5, atol=1e-3)
    world = unproject_depth(camera, depth)[known]
    back = points[known] @ camera.T_cam_world[:3, :3] - camera.T_cam_world[:3, :3].T @ camera.T_cam_world[:3, 3]
    np.testing.assert_allclose(back, world, atol=1e-4)


@dataclasses.dataclass
class Counting(Services):
    """Services that count what is sent."""

    sent: int = 0

    def ask(self, request, send):
        def counted():
            self.sent += 1
            return send()

        return super().ask(request, counted)


def test_an_answer_is_kept_and_asked_for_once(tmp_path):
    """By the same seed, image, options and script; the kept one gives the same bytes, without a worker if its model is named."""
    seen, store = wardrobe_seen(), AnswerStore(tmp_path / "answers")

    def asked(seed=3, **settings):
        services = Counting(store=store, retries=QUICK, replay=settings.pop("replay", "auto"))
        with contextlib.closing(backend(services=services, **settings)) as model:
            result = model.reconstruct("wardrobe", seen, site(), 0, seed=seed)
            assert model.quote().usd == 0
        assert result is not None
        return services.sent, result.thing.vertices.tobytes()

    first = asked()
    assert first[0] == 1 and asked(faces=5000) == (0, first[1])  # read anew, not asked anew
    assert asked(seed=4)[0] == 1
    named = dataclasses.replace(Settings(), python="/not/here/python", script=EXAMPLE, serves="box of points 1")
    model = make_backend("reconstruction", named, bare(), Services(store=store, replay="only"))
    result = model.reconstruct("wardrobe", seen, site(), 0, seed=3)
    model.close()
    assert result is not None and result.thing.vertices.tobytes() == first[1]


@pytest.mark.slow
def test_a_changed_script_is_asked_anew(tmp_path):
    seen, store, text = wardrobe_seen(), AnswerStore(tmp_path / "answers"), pathlib.Path(EXAMPLE).read_text()
    sent = []
    for change in (text, text, text + "# another\n"):
        services = Counting(store=store, retries=QUICK)
        (tmp_path / "own.py").write_text(change)
        with contextlib.closing(backend(tmp_path / "own.py", services)) as model:
            model.reconstruct("wardrobe", seen, site(), 0, seed=3)
        sent.append(services.sent)
    assert sent == [1, 0, 1]


def test_another_model_than_the_named_one_is_told(tmp_path):
    with (
        contextlib.closing(backend(serves="box of points 2")) as model,
        pytest.raises(InputError, match="serves 'box of points 1'"),
    ):
        model.reconstruct("wardrobe", wardrobe_seen(), site(), 0, seed=3)


EXAMPLE_TEXT = pathlib.Path(EXAMPLE).read_text()
RETURN = "    return result\n"
REFUSED = {
    "broken GLB": 'result["mesh.glb"] = result["mesh.glb"][:100]',
    "no GLB at all": 'result["mesh.glb"] = b"Internal error"',
    "scale not finite": 'result["scale"] = float("nan")',
    "a mirrored pose": 'result["rotation"] = -result["rotation"]',
    "a pose of the wrong shape": 'result["rotation"] = np.eye(4)',
    "half a pose": 'del result["scale"]',
    "refuses": 'result = {"refused": "an unsafe chair"}',
    "once": 'if request["seed"] == 3:\n            result["scale"] = float("inf")',
    "far away": 'result["translation"] = result["translation"] + 3.0',
}


@pytest.fixture(scope="module")
def faulty(tmp_path_factory):
    """A worker that commits the fault that the label names, and what its backend has said."""
    faults = "".join(f"    if request['label'] == {name!r}:\n        {text}\n" for name, text in REFUSED.items())
    path = script(tmp_path_factory.mktemp("faulty"), EXAMPLE_TEXT.replace(RETURN, faults + RETURN))
    said: list[str] = []
    with contextlib.closing(backend(path, Counting(retries=QUICK, say=said.append))) as model:
        yield model, said


@pytest.mark.parametrize("fault", list(REFUSED)[:-2])
def test_an_answer_that_cannot_be_used_is_tried_by_another_seed_and_then_left_out(faulty, fault):
    model, said = faulty
    said.clear()
    before = model.model.services.sent
    assert model.reconstruct(fault, wardrobe_seen(), site(), 0, seed=3) is None
    assert model.model.services.sent - before == 2 and len(said) == 1 and f"{fault}: left out after 2 attempts" in said[0]


def test_the_next_seed_may_do_better(faulty):
    result = faulty[0].reconstruct("once", wardrobe_seen(), site(), 0, seed=3)
    assert result is not None and result.residual < 0.1


def test_a_pose_that_the_points_contradict_is_fitted_instead(faulty):
    seen = wardrobe_seen()
    result = faulty[0].reconstruct("far away", seen, site(), 0, seed=3)
    assert result is not None and box_iou(box_of(in_world(result, seen)), box_of(WARDROBE)) > 0.3


def test_what_stands_outside_the_room_or_is_hardly_seen_is_left_out(faulty):
    seen = wardrobe_seen()
    elsewhere = dataclasses.replace(site(), polygon=shapely.box(10, 10, 12, 12))
    hidden = tuple(dataclasses.replace(one, depth=np.zeros_like(one.depth)) for one in seen)
    assert faulty[0].reconstruct("wardrobe", seen, elsewhere, 0, seed=3) is None
    assert faulty[0].reconstruct("wardrobe", hidden, site(), 0, seed=3) is None


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"mesh.glb": mesh.export', '"model.glb": mesh.export', r"an answer has no mesh\.glb, but values\.json, model\.glb"),
        ("import trimesh", "import sam3d", r"(?s)answer\(\) raised ModuleNotFoundError: No module named 'sam3d'"),
        pytest.param(RETURN, "    import os; os._exit(9)\n", r"(?s)3 times in succession", marks=pytest.mark.slow),
    ],
)
def test_a_script_that_is_wrong_is_one_clear_error(tmp_path, old, new, said):
    wrong = backend(script(tmp_path, EXAMPLE_TEXT.replace(old, new)))
    with contextlib.closing(wrong), pytest.raises(ServiceError, match=said):
        wrong.reconstruct("wardrobe", wardrobe_seen(), site(), 0, seed=3)


@pytest.mark.parametrize(
    ("module", "settings", "said"),
    [
        (image_to_3d, {}, "script=FILE must name"),
        (image_to_3d, {"script": "nowhere.py"}, "script=nowhere.py is not there"),
        (image_to_3d, {"script": EXAMPLE}, "python=PATH must name the interpreter"),
        (image_to_3d, {"script": EXAMPLE, "python": "/not/here/python"}, "python=/not/here/python is no program"),
        (image_to_3d, {"script": EXAMPLE, "python": PYTHON, "options": "steps"}, "'steps' is not"),
        (image_to_3d, {"script": EXAMPLE, "python": PYTHON, "serves": "box"}, "must be 'NAME VERSION'"),
        (sam3d_objects, {}, r"sam3d_objects: python=PATH must name"),
    ],
)
def test_settings_that_cannot_work_are_told_before_anything_is_asked(module, settings, said):
    with pytest.raises(InputError, match=said):
        make_backend("reconstruction", module.Settings(**settings), bare())


def test_the_script_for_sam3d_names_what_it_lacks(tmp_path):
    config = sam3d_objects.Settings(python=PYTHON, repository=str(tmp_path))
    model = make_backend("reconstruction", config, bare())
    with contextlib.closing(model), pytest.raises(ServiceError, match="must be a clone of sam-3d-objects"):
        model.reconstruct("wardrobe", wardrobe_seen(), site(), 0, seed=3)


def test_a_room_is_lifted_with_a_worker_of_another_process():
    things = [WARDROBE, piece("ottoman", 2.4, 2.8, 0.0, (0.7, 0.55, 0.44))]
    camera = Photographs(things)
    views = bootstrap_cameras(bare().plan, build_ray_scene(bare().structure), 0, CameraSettings(width=240, height=180, fov=90.0))
    with contextlib.closing(backend()) as reconstruction:
        models = Models(image=camera, depth=camera, segmentation=camera, reconstruction=reconstruction)
        room = lift_room(bare(), 0, views, models, CONFIG)
    assert sorted(thing.label for thing in room.objects) == ["oak ottoman", "oak wardrobe"]
    assert broken_laws(room.objects, site()) == []
    for truth in things:
        made = next(thing for thing in room.objects if thing.label == f"oak {truth.label}")
        assert box_iou(box_of(truth), box_of(made)) > 0.25  # of a box around what one camera sees
        assert abs(box_of(made).height - truth.size[2]) < 0.15


def test_the_settings_name_their_backend():
    assert isinstance(sam3d_objects.Settings(), BackendSettings) and sam3d_objects.Settings().backend == sam3d_objects.__name__
