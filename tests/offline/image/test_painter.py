"""Laws of the offline image model: truth without drift, tone kept where it is shown, drift where it is invented, same bytes."""

import dataclasses

import numpy as np
import pytest

from tests.offline.world.boxes import COARSE, furnished
from wm.geometry.rays.pinhole import make_camera
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.offline.image import painter
from wm.offline.image.imagination import FURNISHED, SCENE, Imagination, imagined_scene, imagined_style
from wm.offline.image.painter import ProceduralImages, Scenery, lowpass
from wm.offline.image.painter import Settings as ImageSettings
from wm.offline.style.theme import style_of
from wm.offline.world.room import bake_settings
from wm.offline.world.worker import Recipe, WorkerWorld
from wm.offline.world.world import World
from wm.schema import BackendSettings
from wm.synth.backends import Condition, ImageRequest, ImaginingBackend
from wm.synth.registry import close_backend, make_backend
from wm.types import OUTSIDE, View


def look_from(eye, target):
    return make_camera(np.array(eye), np.array(target), width=72, height=48, fov_deg=70.0)


VIEW = View(look_from([0.4, 0.5, 1.5], [2.4, 2.0, 0.9]), 0, "perimeter", "living/p0")


@pytest.fixture(scope="module")
def shot():
    return scene().shoot(VIEW.camera)


def request(shot, *, rgb=None, known=0.0, depth=None, seed=3, painted=False, view=VIEW, **condition):
    condition = Condition(
        rgb=np.zeros_like(shot.rgb) if rgb is None else rgb,
        known=np.full(shot.rgb.shape[:2], known, np.float32),
        depth=shot.gbuffer.depth if depth is None else depth,
        **condition,
    )
    view = dataclasses.replace(view, kind="perimeter" if painted else "bootstrap")
    return ImageRequest(condition=condition, reference=None, prompt="", view=view, seed=seed)


WORLDS = {}  # baked once for the module


def make_world(context, which):
    if which not in WORLDS:
        style = imagined_style(furnished(), which)
        WORLDS[which] = Scenery(context, World(context, settings=COARSE, style=style))
    return WORLDS[which].world


def scene():
    return make_world(furnished(), SCENE)


def model(drift=0.0, make_world=make_world, **strengths):
    return ProceduralImages(furnished(), make_world, ImageSettings(drift=drift, **strengths))


def test_closing_ends_the_processes_of_its_worlds():
    recipe = Recipe(furnished(), supersampling=1, settings=COARSE)
    images = model(make_world=lambda context, which: WorkerWorld(recipe, lanes=1))
    world = images.scenery(SCENE).world
    assert world.shoot(VIEW.camera).rgb.shape == (48, 72, 3)
    close_backend(images)
    with pytest.raises(RuntimeError, match="ended"):
        world.shoot(VIEW.camera)


def test_without_drift_it_is_the_truth(shot):
    exact = model(0.0)
    truth = exact.truth(VIEW)
    np.testing.assert_array_equal(truth, shot.rgb)
    np.testing.assert_array_equal(exact.generate(request(shot)).rgb, truth)
    np.testing.assert_allclose(exact.generate(request(shot, rgb=truth, known=1.0)).rgb, truth, atol=1e-5)
    np.testing.assert_array_equal(exact.generate(request(shot)).drawn_depth, shot.gbuffer.depth)


def test_drift_is_seeded_moderate_and_a_view_s_own(shot):
    drifting = model(0.05)
    a, again, b = (drifting.generate(request(shot, seed=s)).rgb for s in (1, 1, 2))
    np.testing.assert_array_equal(a, again)
    assert np.abs(a - b).mean() > 1e-3
    assert np.abs(a - shot.rgb).mean() < 0.1


def test_shown_tone_is_kept(shot):
    """Low-passed output equals low-passed condition where it is known, to what a second low pass changes."""
    shown = np.clip(shot.rgb * np.array([1.15, 0.95, 0.85], np.float32), 0, 1)
    out = model(0.05).generate(request(shot, rgb=shown, known=1.0)).rgb
    structure = (shot.object == OUTSIDE).astype(np.float32)
    error = np.abs(lowpass(out, structure) - lowpass(shown, structure))[structure > 0]
    untouched = np.abs(lowpass(shot.rgb, structure) - lowpass(shown, structure))[structure > 0]
    assert error.mean() < 0.25 * untouched.mean()


def test_detail_is_restored_under_a_blurred_condition(shot):
    structure = (shot.object == OUTSIDE).astype(np.float32)
    blurred = lowpass(shot.rgb, structure)
    out = model(0.0).generate(request(shot, rgb=blurred, known=1.0)).rgb
    inside = structure > 0
    assert np.abs(out - shot.rgb)[inside].mean() < 0.7 * np.abs(blurred - shot.rgb)[inside].mean()


def test_objects_that_are_not_shown_are_invented_more_strongly(shot):
    drifting = model(0.03)
    empty = np.where(shot.object == OUTSIDE, shot.gbuffer.depth, shot.gbuffer.depth * 1.5).astype(np.float32)
    invented = np.stack([drifting.generate(request(shot, depth=empty, seed=s)).rgb for s in range(6)])
    shown = np.stack([drifting.generate(request(shot, seed=s)).rgb for s in range(6)])
    objects = shot.object != OUTSIDE
    assert invented.std(axis=0)[objects].mean() > 3 * shown.std(axis=0)[objects].mean()
    np.testing.assert_array_equal(shown[0][objects], shot.rgb[objects])


def test_a_condition_of_another_size_is_refused(shot):
    small = request(shot)
    wrong = dataclasses.replace(small, condition=dataclasses.replace(small.condition, known=np.zeros((5, 5), np.float32)))
    with pytest.raises(ValueError, match="asks for"):
        model(0.0).generate(wrong)


def test_the_registry_finds_it():
    backend = make_backend("image", ImageSettings(), furnished())
    assert isinstance(backend, ProceduralImages)


@pytest.mark.parametrize("size", [0.0, -0.01, float("nan")])
def test_a_texel_size_that_is_no_length_is_named(size):
    with pytest.raises(ValueError, match=r"image\.texel_size"):
        make_backend("image", ImageSettings(texel_size=size), furnished())


def open_walls(shot, **more):
    return request(shot, painted=True, object=shot.object != OUTSIDE, **more)


def test_a_bootstrap_view_that_settles_the_finish_and_one_that_shows_texture_are_finished_as_the_scene(shot):
    exact = model()
    np.testing.assert_array_equal(exact.generate(request(shot, seed=1)).rgb, exact.truth(VIEW))
    shown = exact.generate(open_walls(shot, rgb=shot.rgb, known=1.0, seed=1)).rgb
    np.testing.assert_allclose(shown, exact.truth(VIEW), atol=1e-5)


def test_walls_that_are_not_shown_are_finished_anew_from_view_to_view(shot):
    exact = model()
    images = [exact.generate(open_walls(shot, seed=seed)).rgb for seed in range(8)]
    walls = shot.object == OUTSIDE
    looks = {image[walls].tobytes() for image in images}
    assert 2 <= len(looks) <= ImageSettings().imaginations
    for image in images:
        assert np.abs(image - shot.rgb)[walls].mean() > 0.03
    np.testing.assert_array_equal(images[3], model().generate(open_walls(shot, seed=3)).rgb)  # whatever was asked before


def test_a_bootstrap_view_whose_finish_nobody_will_see_invents_one_as_any_other_view(shot):
    """It settles nothing: with the same condition and seed it is the image that a later view would have been."""
    for seed in range(4):
        later = open_walls(shot, seed=seed, wall_texture=False)
        first = model().generate(dataclasses.replace(later, view=dataclasses.replace(VIEW, kind="bootstrap")))
        np.testing.assert_array_equal(first.rgb, model().generate(later).rgb)
        assert np.abs(first.rgb - shot.rgb)[shot.object == OUTSIDE].mean() > 0.03


def test_things_that_are_shown_stay_where_walls_are_finished_anew(shot):
    result = model().generate(open_walls(shot, seed=2))
    np.testing.assert_array_equal(result.drawn_depth, shot.gbuffer.depth)
    np.testing.assert_array_equal(result.drawn_object, shot.object)
    assert result.drawn_labels == ("table", "sofa", "lamp")


def test_a_box_is_filled_with_something_else_that_stays_within_it(shot):
    boxed = [model().generate(request(shot, seed=seed, objects="boxes", painted=True)) for seed in range(6)]
    mine = furnished().objects
    for result in boxed:
        assert not set(result.drawn_labels) & {"table", "sofa", "lamp"}
        assert (result.drawn_depth >= shot.gbuffer.depth - 1e-4).all()  # the scene's own things are boxes and fill theirs
    for which, scenery in WORLDS.items():
        if which.boxed:
            for own, other in zip(mine, scenery.context.objects):
                np.testing.assert_allclose(other.vertices.min(axis=0), own.vertices.min(axis=0), atol=1e-9)
                np.testing.assert_allclose(other.vertices.max(axis=0), own.vertices.max(axis=0), atol=1e-9)
    assert len({result.drawn_depth.tobytes() for result in boxed}) > 1


def test_without_objects_in_the_condition_the_room_is_furnished_anew(shot):
    middle = dataclasses.replace(VIEW, camera=look_from([1.9, 1.3, 1.5], [0.2, 0.2, 0.5]))  # where there is air in most worlds
    bare = [model().generate(request(shot, seed=seed, objects="none", painted=True, view=middle)) for seed in range(3)]
    assert len({result.drawn_depth.tobytes() for result in bare}) > 1
    first = [model().generate(request(shot, seed=seed, objects="none", view=middle)) for seed in range(3)]  # bootstrap views
    assert [one.drawn_depth.tobytes() for one in first] == [one.drawn_depth.tobytes() for one in bare]
    assert all((one.drawn_depth != scene().shoot(middle.camera).gbuffer.depth).any() for one in first)


def test_a_world_is_made_only_if_a_view_is_shown_it_and_its_furniture_once_for_all_finishes(shot):
    """Each may be a process of its own; which of them a view is shown is told by where their furniture stands."""
    made = {}

    def noted(context, which):
        made[which] = context
        return make_world(context, which)

    images, middle = model(make_world=noted), dataclasses.replace(VIEW, camera=look_from([1.9, 1.3, 1.5], [0.2, 0.2, 0.5]))
    for count, settled in enumerate((True, False), start=1):  # in the scene's finish, in another
        images.generate(request(shot, objects="none", view=middle, wall_texture=settled))
        assert len(made) == count
    (first, one), (second, other) = made.items()
    assert first.surfaces != second.surfaces and first.furniture == second.furniture
    assert one is other


def test_without_imaginations_everything_is_the_scene(shot):
    exact = model(imaginations=0)
    for objects in ("textured", "boxes", "none"):
        np.testing.assert_array_equal(exact.generate(request(shot, objects=objects, painted=True)).rgb, exact.truth(VIEW))


def test_the_scene_is_the_scene_and_each_other_world_its_own():
    assert imagined_scene(furnished(), SCENE) is furnished()
    style = imagined_style(furnished(), SCENE)
    assert style == style_of(furnished().theme)
    other = [imagined_style(furnished(), Imagination(surfaces=k)).surfaces("library") for k in range(1, 6)]
    assert all(finish.wall.material != style.surfaces("library").wall.material for finish in other)
    assert len(set(other)) == 5


def bare(**changes):
    """The scene without furniture, sparsely furnished if it were."""
    return dataclasses.replace(furnished(), objects=(), density=0.3, **changes)


def same(things, others):
    return [(a.label, a.room, a.vertices.tobytes()) for a in things] == [(b.label, b.room, b.vertices.tobytes()) for b in others]


def test_what_it_imagines_in_empty_rooms_is_what_the_generator_furnishes_them_with():
    for scene in (bare(), bare(seed=5)):
        generator = make_backend("objects", BackendSettings(backend="wm.offline.objects.generator"), scene)
        images = make_backend("image", ImageSettings(), scene)
        assert isinstance(images, ImaginingBackend)
        generated = [thing for room in range(len(scene.plan.rooms)) for thing in generator.furnish(scene, room)]
        assert generated and same(images.imagined(), generated)
        close_backend(images)
    assert not same(imagined_scene(bare(), FURNISHED).objects, imagined_scene(bare(seed=5), FURNISHED).objects)


def test_asked_to_furnish_it_draws_what_it_imagines():
    """Shown the empty room, whatever the seed, and whoever looks: its violations too are those of a furnished room."""
    scene = imagined_scene(bare(), FURNISHED)
    world = World(scene, settings=COARSE)
    images, forgetful = (
        ProceduralImages(bare(), lambda context, which: world, ImageSettings(drift=0.0, missing=missing))
        for missing in (0.0, 1.0)
    )
    shot, empty = world.shoot(VIEW.camera), cast(build_ray_scene(bare().structure), VIEW.camera)
    shown = {"depth": empty.depth, "objects": "none", "wall_texture": False}
    asked = [
        dataclasses.replace(request(shot, seed=seed, painted=seed % 2 == 0, **shown), task="furnish") for seed in range(4)
    ]
    assert (shot.object != OUTSIDE).any()
    for one in asked:
        result = images.generate(one)
        np.testing.assert_array_equal(result.drawn_object, shot.object)
        np.testing.assert_array_equal(result.rgb, shot.rgb)
        assert result.drawn_labels == tuple(thing.label for thing in images.imagined())
    assert any((forgetful.generate(one).drawn_object != shot.object).any() for one in asked)


@pytest.mark.parametrize(("texel_size", "furnishing"), [(0.01, painter.COARSE), (0.08, 0.08)])
def test_the_world_that_it_furnishes_rooms_in_is_coarser(texel_size, furnishing):
    images = make_backend("image", ImageSettings(texel_size=texel_size, worker=False), bare())
    with_furniture, without = images.scenery(FURNISHED).world, images.scenery(SCENE).world
    assert with_furniture.labels and not without.labels
    assert (with_furniture._supersampling, with_furniture._settings) == (1, bake_settings(furnishing))
    assert (without._supersampling, without._settings) == (2, bake_settings(texel_size))
