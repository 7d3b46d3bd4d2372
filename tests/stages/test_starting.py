"""The start of a room's fit leaves no hole in what anyone may see of it, and is coloured by those who see it."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial import KDTree

from tests.test_pipeline import SMALL
from wm.artifacts.run_folder import open_run_folder
from wm.geometry import cast, unproject_depth
from wm.geometry.cameras.exposed_surface import room_surface
from wm.meter import StageMeter
from wm.run import load_config
from wm.schema import FitSettings
from wm.splat.optimization.cloud import SH_C0, initial_gaussians, surface_cloud
from wm.stages.reconstruction import training_view
from wm.stages.run_context import RunContext
from wm.stages.scene import build_scene
from wm.stages.starting import _of_the_same_surface, _surface_numbers, starting_gaussians

SETTINGS = FitSettings(spacing=0.1, detail_spacing=0.05)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    config = load_config([*SMALL[:2], "scene.rooms=[bedroom,hall]", *SMALL[3:]])
    with open_run_folder(tmp_path_factory.mktemp("run"), {}, overwrite=False) as folder:
        yield build_scene(RunContext(config=config, folder=folder, meter=StageMeter()))


def own_views(scene, room, most=None):
    """The room's views, painted grey; of many only the first."""
    for view in [view for view in scene.views if view.room == room][:most]:
        size = (view.camera.height, view.camera.width)
        rgb, mask = np.full((*size, 3), 128, np.uint8), np.ones(size, bool)
        yield training_view(scene, view, rgb, mask, cast(scene.rays, view.camera))


def start(scene, room, picture=None, most=None):
    size = scene.views[0].camera
    cameras = dataclasses.replace(load_config(SMALL).cameras, width=size.width, height=size.height)
    return starting_gaussians(
        scene, room, own_views(scene, room, most), picture, cameras=cameras, settings=SETTINGS, rng=np.random.default_rng(0)
    )


def bare_share(scene, means):
    """Share of what held-out views see, through doors and all, that has no gaussian of its room within two cells."""
    trees = [KDTree(mean) for mean in means]
    far = []
    for view in scene.heldout:
        gbuffer = cast(scene.rays, view.camera)
        points, room = unproject_depth(view.camera, gbuffer.depth), scene.mesh.face_room[gbuffer.face]
        far += [trees[k].query(points[gbuffer.hit & (room == k)])[0] > 2 * SETTINGS.spacing for k in range(len(trees))]
    return float(np.concatenate(far).mean())


def test_no_held_out_view_sees_a_bare_surface(scene):
    rooms = range(len(scene.rooms))
    before = [initial_gaussians(own_views(scene, k, 1), settings=SETTINGS, rng=np.random.default_rng(0)).means for k in rooms]
    after = [start(scene, k, most=1).means for k in rooms]
    assert bare_share(scene, before) > 0.01 and bare_share(scene, after) < 0.003


def test_added_gaussians_come_last_in_the_colours_of_onlookers_or_of_what_is_near(scene):
    plain = initial_gaussians(own_views(scene, 0), settings=SETTINGS, rng=np.random.default_rng(0))
    n, asked = len(plain.means), []

    def red(view):
        asked.append(view.room)
        size = (view.camera.height, view.camera.width)
        return np.tile(np.array([255, 0, 0], np.uint8), (*size, 1)), np.ones(size, bool)

    grey, seen, again = start(scene, 0), start(scene, 0, red), start(scene, 0, red)
    assert len(grey.means) > n and set(asked) == {1}
    np.testing.assert_array_equal(grey.means[:n], plain.means)
    np.testing.assert_array_equal(grey.means, seen.means)
    np.testing.assert_allclose(0.5 + SH_C0 * grey.sh[:, 0], 128 / 255, atol=1e-5)
    colors = 0.5 + SH_C0 * seen.sh[:, 0]
    told = np.abs(colors - [1.0, 0.0, 0.0]).max(axis=1) < 1e-5
    assert told[n:].any() and not told[:n].any()
    assert seen.sh.tobytes() == again.sh.tobytes() and seen.means.tobytes() == again.means.tobytes()


def test_added_gaussians_take_the_colour_of_their_own_object_and_material(scene):
    """Views paint each material of each object in a colour of its own: what no view shows has none but those."""
    number = _surface_numbers(scene)
    palette = np.random.default_rng(0).integers(0, 256, (int(number.max()) + 1, 3), dtype=np.uint8)
    views = []
    for view in [view for view in scene.views if view.room == 0]:
        gbuffer = cast(scene.rays, view.camera)
        rgb = np.where(gbuffer.hit[..., None], palette[number[gbuffer.face]], np.uint8(0))
        views.append(training_view(scene, view, rgb, gbuffer.hit, gbuffer))
    cloud = surface_cloud(views, SETTINGS.spacing, SETTINGS.detail_spacing)
    surface = room_surface(scene.mesh, 0, spacing=SETTINGS.spacing, detail_spacing=SETTINGS.detail_spacing)
    colors = _of_the_same_surface(scene, surface, cloud, surface)
    known = ~np.isnan(colors[:, 0])
    off = np.abs(colors[known] - palette[number[surface.face[known]]] / 255).max(axis=1)
    assert known.mean() > 0.9
    assert np.median(off) < 0.05 and (off < 0.25).mean() > 0.85  # cells at edges average two materials
