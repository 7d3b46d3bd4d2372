"""The condition shows each signal where the variant says so, and `known` tells appearance from depth."""

import dataclasses
import functools

import numpy as np
import pytest

from tests.geometry.plans import two_rooms
from tests.geometry.things import box
from wm.geometry.mesh.scene_mesh import assemble_scene, object_boxes
from wm.geometry.mesh.structure import build_structure
from wm.geometry.rays.pinhole import make_camera
from wm.geometry.rays.raycast import cast
from wm.geometry.texture.accumulation import accumulate
from wm.geometry.texture.atlas import build_atlas
from wm.geometry.texture.sampling import sample_atlas
from wm.schema import ConditionConfig
from wm.synth.condition import depth_grey, make_condition
from wm.types import Texture

RANGE = (0.3, 9.0)
RED, BLUE = (0.9, 0.1, 0.1), (0.1, 0.2, 0.9)


@functools.cache
def scene():
    things = (box([1, 2, 0], [2, 3, 1], RED, label="chest"), box([3.5, 0.6, 0], [4.2, 1.2, 2], BLUE, label="tower"))
    mesh = assemble_scene(build_structure(two_rooms()), things)
    camera = make_camera(np.array([0.6, 0.7, 1.6]), np.array([3.5, 2.2, 0.8]), width=120, height=80, fov_deg=60.0)
    gbuffer = cast(mesh, camera)
    green = np.broadcast_to(np.array([0.2, 0.7, 0.3], np.float32), (80, 120, 3))
    atlas = accumulate(build_atlas(mesh, 0.05), gbuffer, camera, green, 0)
    return mesh, things, camera, gbuffer, atlas, gbuffer.hit & (mesh.face_object[gbuffer.face] >= 0)


def condition(atlas="own", **settings):
    mesh, things, camera, gbuffer, own, _ = scene()
    return make_condition(gbuffer, camera, own if atlas == "own" else atlas, mesh, things, RANGE, ConditionConfig(**settings))


def test_full_condition():
    mesh, _, camera, gbuffer, atlas, objects = scene()
    x = condition()
    texture, alpha = sample_atlas(atlas, gbuffer, camera)
    grey = depth_grey(gbuffer, RANGE)[..., None]
    blend = alpha[..., None] * texture + (1 - alpha[..., None]) * grey
    np.testing.assert_allclose(x.rgb[~objects], blend[~objects], atol=1e-6)
    np.testing.assert_array_equal(x.known[~objects], alpha[~objects])
    assert (x.known[objects] == 1).all()
    for index, color in enumerate((RED, BLUE)):
        shown = gbuffer.hit & (mesh.face_object[gbuffer.face] == index)
        shade = x.rgb[shown] / np.array(color)
        assert shown.any()
        np.testing.assert_allclose(shade, shade[:, :1] * np.ones(3), rtol=1e-5)  # its own hue
        assert shade.min() >= 0.4 - 1e-6
        assert shade.max() <= 1 + 1e-6
        assert np.ptp(shade) > 0.05  # and its form
    np.testing.assert_array_equal(x.depth, gbuffer.depth)
    assert x.rgb.dtype == x.known.dtype == np.float32


def test_before_anything_is_painted_structure_is_depth():
    *_, gbuffer, _, objects = scene()
    x = condition(atlas=None)
    np.testing.assert_array_equal(x.rgb[~objects], np.repeat(depth_grey(gbuffer, RANGE)[..., None], 3, -1)[~objects])
    assert (x.known[~objects] == 0).all()


def test_without_wall_texture_structure_is_depth():
    one, other = condition(wall_texture=False), condition(atlas=None)
    np.testing.assert_array_equal(one.rgb, other.rgb)
    np.testing.assert_array_equal(one.known, other.known)


def test_boxes_are_grey_and_known_for_nothing():
    _, things, camera, _, atlas, _ = scene()
    boxes = object_boxes(things)
    boxed = assemble_scene(build_structure(two_rooms()), boxes)
    gbuffer = cast(boxed, camera)
    x = make_condition(gbuffer, camera, atlas, boxed, boxes, RANGE, ConditionConfig(objects="boxes"))
    shown = gbuffer.hit & (boxed.face_object[gbuffer.face] >= 0)
    assert shown.any()
    assert (np.ptp(x.rgb[shown], axis=-1) == 0).all()
    assert (x.known[shown] == 0).all()
    assert x.known[~shown].max() > 0


def test_depth_only_is_depth_only():
    _, _, camera, _, atlas, _ = scene()
    bare = build_structure(two_rooms())
    gbuffer = cast(bare, camera)
    x = make_condition(gbuffer, camera, atlas, bare, (), RANGE, ConditionConfig(objects="none", wall_texture=False))
    np.testing.assert_array_equal(x.rgb, np.repeat(depth_grey(gbuffer, RANGE)[..., None], 3, -1))
    assert x.known.max() == 0 and not x.wall_texture


def test_nearer_is_brighter_over_one_range():
    *_, gbuffer, _, _ = scene()
    grey = depth_grey(gbuffer, RANGE)
    order = np.argsort(gbuffer.depth.ravel())
    assert (np.diff(grey.ravel()[order]) <= 0).all()
    np.testing.assert_allclose(grey, (9.0 - gbuffer.depth) / 8.7, atol=1e-6)
    missed = dataclasses.replace(gbuffer, hit=np.zeros_like(gbuffer.hit))
    assert depth_grey(missed, RANGE).max() == 0


def test_what_cannot_be_shown_is_refused():
    mesh, things, camera, gbuffer, atlas, _ = scene()
    with pytest.raises(ValueError, match="textured, boxes, none"):
        condition(objects="ghosts")
    with pytest.raises(ValueError, match="near < far"):
        make_condition(gbuffer, camera, atlas, mesh, things, (2.0, 2.0))
    with pytest.raises(ValueError, match="not those of the mesh"):
        make_condition(gbuffer, camera, atlas, mesh, things[:1], RANGE)


def test_textured_objects_show_their_texture():
    """The chest's texture is half green, half yellow, by the columns of its image."""
    mesh, things, camera, gbuffer, _, _ = scene()
    image = np.zeros((2, 8, 3), np.uint8)
    image[:, :4], image[:, 4:] = (0, 200, 0), (200, 200, 0)
    corner_uv = np.full((len(things[0].faces), 3, 2), 0.2, np.float32)
    corner_uv[6:] = 0.8
    painted = dataclasses.replace(things[0], texture=Texture(image=image, corner_uv=corner_uv, slots=np.array([True])))
    x = make_condition(gbuffer, camera, None, mesh, (painted, things[1]), RANGE)
    plain = make_condition(gbuffer, camera, None, mesh, things, RANGE)
    chest = gbuffer.hit & (mesh.face_object[gbuffer.face] == 0)
    second = gbuffer.face - int((mesh.face_object < 0).sum()) >= 6
    for part, color in ((chest & ~second, (0, 1, 0)), (chest & second, (1, 1, 0))):
        assert part.any()
        hue = x.rgb[part] / x.rgb[part].max(axis=1, keepdims=True)
        np.testing.assert_allclose(hue, np.tile(color, (len(hue), 1)), atol=1e-5)
    np.testing.assert_array_equal(x.rgb[~chest], plain.rgb[~chest])
