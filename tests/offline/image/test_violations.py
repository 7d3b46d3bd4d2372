"""A violation changes what is drawn and its depth alike, where it says so, at the share that was asked for."""

import dataclasses
import functools

import numpy as np
import pytest

from tests.offline.world.boxes import furnished
from wm.geometry import assemble_scene, build_ray_scene, cast, place_cameras
from wm.geometry.rays.pinhole import make_camera
from wm.offline.depth.estimator import Settings as DepthSettings
from wm.offline.image.painter import Settings as ImageSettings
from wm.offline.image.violations import KINDS, PLAIN, draw_violation, violation
from wm.offline.world.edit import Edit, edited_mesh
from wm.schema import CameraSettings, VerifySettings
from wm.synth.backends import ImageResult
from wm.synth.canny import depth_edges
from wm.synth.registry import make_backend
from wm.synth.verify import verify
from wm.types import OUTSIDE, View

CAMERA = make_camera(np.array([0.4, 0.5, 1.5]), np.array([2.6, 2.0, 0.8]), width=96, height=64, fov_deg=80.0)
VIEW = View(CAMERA, 0, "perimeter", "living/p0")


@functools.cache
def seen():
    mesh = assemble_scene(furnished().structure, furnished().objects)
    gbuffer = cast(build_ray_scene(mesh), CAMERA)
    return mesh, gbuffer, np.append(mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]


def drawn(edit):
    mesh, _ = edited_mesh(seen()[0], furnished().plan, edit)
    gbuffer = cast(mesh, CAMERA)
    return gbuffer.depth, np.append(mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]


def wrong(kind, seed=0):
    _, gbuffer, thing = seen()
    return violation(kind, furnished(), VIEW, gbuffer, thing, np.random.default_rng(seed))


def test_an_edit_of_nothing_is_the_mesh():
    mesh, source = edited_mesh(seen()[0], furnished().plan, Edit())
    np.testing.assert_array_equal(mesh.faces, seen()[0].faces)
    np.testing.assert_array_equal(source, np.arange(len(mesh.faces)))


@pytest.mark.parametrize("kind", KINDS)
def test_a_violation_changes_depth(kind):
    found = wrong(kind)
    assert found is not None
    depth = drawn(found.edit)[0]
    assert (np.abs(depth - seen()[1].depth) > 0.02).mean() > 0.003


@pytest.mark.parametrize("seed", range(4))
def test_what_is_missing_is_seen_through_and_what_stood_on_it_is_gone_too(seed):
    found = wrong("missing", seed)
    depth, thing = drawn(found.edit)
    assert not np.isin(thing, found.edit.removed).any()
    assert (depth >= seen()[1].depth - 1e-5).all()
    same = ~np.isin(seen()[2], found.edit.removed)
    np.testing.assert_allclose(depth[same], seen()[1].depth[same], atol=1e-5)


def test_a_shut_door_hides_what_lies_behind_it_and_nothing_else():
    depth, _ = drawn(wrong("closed").edit)
    nearer = depth < seen()[1].depth - 1e-4
    assert nearer.any()
    np.testing.assert_allclose(depth[~nearer], seen()[1].depth[~nearer], atol=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_what_is_added_is_there_twice(seed):
    found = wrong("added", seed)
    depth, _ = drawn(found.edit)
    assert (depth <= seen()[1].depth + 1e-5).all()


def verdict(view, mesh, gbuffer, wrong, seed):
    """Of an image with a violation or none: whether it counts as one, as in experiments/verification, and whether it passes."""
    settings = VerifySettings()
    depth = gbuffer.depth if wrong is None else cast(edited_mesh(mesh, furnished().plan, wrong.edit)[0], view.camera).depth
    changed = np.abs(depth - gbuffer.depth) > settings.tolerance * gbuffer.depth
    image = ImageResult(rgb=np.zeros((*depth.shape, 3), np.float32), drawn_depth=depth)
    estimate = make_backend("depth", DepthSettings()).estimate(image, seed=seed)
    edges = depth_edges(gbuffer.depth, gbuffer.hit, low=settings.low, high=settings.high)
    return changed.mean() >= PLAIN, verify(edges, estimate, settings, depth=gbuffer.depth).passed


def test_verification_catches_violations_and_accepts_good_images():
    """From every view of the rooms, one of each kind; experiments/verification measures it on whole scenes."""
    mesh, scene = seen()[0], build_ray_scene(seen()[0])
    views = place_cameras(furnished().plan, scene, CameraSettings(width=344, height=192, perimeter=6, overhead=3))
    good, counted = [], {kind: [] for kind in KINDS}
    for k, view in enumerate(views):
        gbuffer = cast(scene, view.camera)
        thing = np.append(mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]
        good.append(verdict(view, mesh, gbuffer, None, k)[1])
        for kind in KINDS:
            found = violation(kind, furnished(), view, gbuffer, thing, np.random.default_rng(k))
            counts, passes = (False, True) if found is None else verdict(view, mesh, gbuffer, found, k)
            counted[kind] += [passes] if counts else []
    assert len(good) >= 20 and all(good)
    assert all(len(passed) >= 5 for passed in counted.values())
    assert np.mean([passes for passed in counted.values() for passes in passed]) <= 0.05


def test_shares_are_shares():
    _, gbuffer, thing = seen()
    config = ImageSettings(missing=0.3, moved=0.2)

    def drawn_kind(seed, settings, **options):
        shares = {kind: getattr(settings, kind) for kind in KINDS}
        found = draw_violation(shares, furnished(), VIEW, gbuffer, thing, np.random.default_rng(seed), **options)
        return None if found is None else found.kind

    kinds = [drawn_kind(seed, config) for seed in range(300)]
    assert abs(kinds.count("missing") / 300 - 0.3) < 0.08  # three standard deviations
    assert abs(kinds.count("moved") / 300 - 0.2) < 0.07
    assert kinds.count("closed") == kinds.count("added") == 0
    assert all(drawn_kind(seed, ImageSettings()) is None for seed in range(50))
    assert all(drawn_kind(seed, config, objects=False) is None for seed in range(50))  # none are shown, none can be missing


def test_a_view_without_a_doorway_draws_none_shut():
    away = dataclasses.replace(VIEW, camera=make_camera(np.array([2.0, 1.4, 1.5]), np.array([0.1, 1.4, 1.4]), width=48, height=32,
                                                        fov_deg=60.0))  # fmt: skip
    mesh, *_ = seen()
    gbuffer = cast(mesh, away.camera)
    thing = np.append(mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]
    assert violation("closed", furnished(), away, gbuffer, thing, np.random.default_rng(0)) is None


def test_an_unknown_kind_is_named():
    with pytest.raises(ValueError, match="closed, missing, added, moved"):
        wrong("melted")
