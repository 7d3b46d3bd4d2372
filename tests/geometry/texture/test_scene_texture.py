"""Parts of a scene's texture: they show the room, the anchors and reveals, and are joined the same way in any order."""

import functools

import numpy as np
import pytest

from tests.geometry.plans import two_rooms
from wm.geometry.mesh.structure import build_structure
from wm.geometry.rays.pinhole import make_camera
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.geometry.texture.accumulation import accumulate_in_place
from wm.geometry.texture.atlas import build_atlas, texel_charts, texel_positions
from wm.geometry.texture.sampling import sample_atlas
from wm.geometry.texture.scene_texture import SceneTexture
from wm.types import SurfaceKind

HALL, STUDY = 0, 1
EYES = {HALL: [(0.6, 2.0, 1.6), (2.5, 0.6, 1.5)], STUDY: [(8.5, 2.0, 1.6), (7.0, 0.6, 1.5)]}
DOOR = (5.0, 2.0, 1.1)


@functools.cache
def house():
    mesh = build_structure(two_rooms())
    return mesh, build_ray_scene(mesh)


def camera(eye):
    return make_camera(np.array(eye), np.array(DOOR), width=96, height=64, fov_deg=70.0)


def add(atlas, room, eye):
    """One view of an image whose colours depend on where it was taken."""
    one = camera(eye)
    rgb = np.broadcast_to(np.abs(np.sin(np.array(eye, np.float32))), (64, 96, 3)).astype(np.float32)
    accumulate_in_place(atlas, cast(house()[1], one), one, rgb, room)


def anchored():
    atlas = build_atlas(house()[0], 0.05)
    add(atlas, HALL, (4.4, 2.2, 1.6))
    return atlas


def painted(order, asked_late=()):
    """The joined atlas; parts are asked for at once, or when their turn comes, and finished in `order`."""
    texture = SceneTexture(anchored(), HALL)
    parts = {room: texture.part(room) for room in order if room not in asked_late}
    for room in order:
        part = parts[room] if room in parts else texture.part(room)
        for eye in EYES[room]:
            add(part, room, eye)
        texture.finish(room, part)
    return texture.join()


def test_a_part_is_the_atlas_in_which_other_rooms_have_no_surface():
    atlas = anchored()
    part = SceneTexture(atlas, HALL).part(STUDY)
    kinds, rooms = atlas.chart_kind, atlas.chart_room
    assert len(part.chart_start) == np.count_nonzero((rooms == STUDY) | (rooms == HALL) | (kinds == SurfaceKind.REVEAL))
    for eye in EYES[HALL] + EYES[STUDY]:
        one = camera(eye)
        gbuffer = cast(house()[1], one)
        for ours, theirs in zip(sample_atlas(part, gbuffer, one), sample_atlas(atlas, gbuffer, one), strict=True):
            np.testing.assert_array_equal(ours, theirs)
    add(part, STUDY, EYES[STUDY][0])
    assert (part.weight > 0).sum() > (atlas.weight > 0).sum()
    np.testing.assert_array_equal(atlas.weight, anchored().weight)  # of which the part is a copy
    other = SceneTexture(atlas, STUDY).part(STUDY)
    kept = (rooms == STUDY) | (kinds == SurfaceKind.REVEAL)
    assert len(other.chart_start) == kept.sum()
    np.testing.assert_array_equal(texel_positions(other), texel_positions(atlas, np.flatnonzero(kept)))
    np.testing.assert_array_equal(other.face_chart >= 0, np.append(kept, False)[atlas.face_chart])


@pytest.mark.parametrize("order", [(HALL, STUDY), (STUDY, HALL)])
@pytest.mark.parametrize("asked_late", [(), (HALL,), (STUDY,), (HALL, STUDY)])
def test_when_parts_are_asked_for_and_finished_does_not_matter(order, asked_late):
    ours, theirs = painted(order, asked_late), painted((HALL, STUDY))
    np.testing.assert_array_equal(ours.color, theirs.color)
    np.testing.assert_array_equal(ours.weight, theirs.weight)


def test_the_joined_atlas_is_that_of_one_view_after_the_other():
    joined, atlas = painted((STUDY, HALL)), anchored()
    before = atlas.weight.copy()
    for eye in EYES[HALL]:
        add(atlas, HALL, eye)
    hall = atlas.weight > before
    before = atlas.weight.copy()
    for eye in EYES[STUDY]:
        add(atlas, STUDY, eye)
    both = hall & (atlas.weight > before)
    assert both.sum() > 50
    assert set(atlas.chart_kind[texel_charts(atlas)[both]]) == {SurfaceKind.REVEAL}
    for name in ("weight", "color"):
        np.testing.assert_array_equal(getattr(joined, name)[~both], getattr(atlas, name)[~both])
        np.testing.assert_allclose(getattr(joined, name)[both], getattr(atlas, name)[both], rtol=1e-5)  # float32 in another order


def test_a_scene_without_surfaces_has_parts_too():
    bare = build_atlas(build_structure(two_rooms()), 0.05, np.full(len(house()[0].faces), -1))
    assert len(bare.chart_start) == 0
    texture = SceneTexture(bare, HALL)
    texture.finish(STUDY, texture.part(STUDY))
    assert len(texture.join().weight) == 0
