"""Laws of lifted textures: what the image shows is where it shows it, the rest is the slot's, and nothing else gets in."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.things import box
from wm.geometry.mesh.object_colors import object_colors
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.placement.upright import flattened, levelled, moved_to, transformed
from wm.geometry.placement.upright_box import box_of
from wm.geometry.rays.pinhole import make_camera, unproject_depth
from wm.geometry.rays.raycast import cast
from wm.offline.reconstruction.texturing import textured
from wm.synth.backends import Observation
from wm.types import Mesh

PLAIN = np.array([0.45, 0.4, 0.35])
EMPTY = Mesh(
    vertices=np.zeros((0, 3)), faces=np.zeros((0, 3), np.int32), face_room=np.zeros(0, np.int32),
    face_kind=np.zeros(0, np.int32), face_object=np.zeros(0, np.int32),
)  # fmt: skip
SLOTS = np.array([True])
MAGENTA = (1.0, 0.0, 1.0)


def board(size=(1.2, 0.3, 0.9)):
    """A chest that faces -y, its middle at the origin."""
    half = np.array(size) / 2
    return box(-half, half, tuple(PLAIN))


def checks(points, pitch=0.2):
    """Red and blue fields of a pitch, alike about the plain colour in the logarithm of light."""
    even = (np.floor(points[..., 0] / pitch) + np.floor(points[..., 2] / pitch)) % 2 > 0
    linear = PLAIN**2.2 * np.exp(np.where(even[..., None], 1.0, -1.0) * [0.6, 0.0, -0.6])
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def view(eye=(0.0, -1.6, 0.0), at=(0.0, 0.0, 0.0), width=160):
    return make_camera(np.array(eye, float), np.array(at, float), width=width, height=width * 3 // 4, fov_deg=60.0)


def observation(thing, camera, paint=checks, motion=None):
    """What a camera shows of a thing whose surface is painted by place (before a motion); magenta beside it."""
    gbuffer = cast(assemble_scene(EMPTY, [thing]), camera)
    points = unproject_depth(camera, gbuffer.depth)
    points = points if motion is None else (points - motion[:3, 3]) @ motion[:3, :3]
    rgb = np.where(gbuffer.hit[..., None], paint(points), MAGENTA).astype(np.float32)
    return Observation(camera=camera, rgb=rgb, depth=gbuffer.depth, mask=gbuffer.hit)


def colors_at(thing, camera):
    """([h, w, 3] base colours, [h, w, 3] places, [h, w] hit) of a thing from a camera."""
    gbuffer = cast(assemble_scene(EMPTY, [thing]), camera)
    hit = gbuffer.hit
    rgb = np.zeros((*hit.shape, 3), np.float32)
    rgb[hit] = object_colors([thing], np.zeros(hit.sum(), np.int64), gbuffer.face[hit], gbuffer.barycentric[hit])
    return rgb, unproject_depth(camera, gbuffer.depth), hit


def inside_fields(points, pitch=0.2, margin=0.03):
    """Whether points lie off the borders between fields and off the board's edges."""
    off = np.abs(np.mod(points[..., [0, 2]] / pitch + 0.5, 1) - 0.5) * pitch
    return (off > margin).all(axis=-1) & (np.abs(points[..., 0]) < 0.55) & (np.abs(points[..., 2]) < 0.4)


def lifted(**kind):
    thing = board()
    return textured(thing, [observation(thing, view(), **kind)], SLOTS)


def test_what_is_seen_straight_on_has_the_images_colour_there():
    rgb, points, hit = colors_at(lifted(), view((0.2, -1.2, 0.15)))
    fields = hit & inside_fields(points) & (points[..., 1] < -0.149)
    assert fields.sum() > 1500
    error = np.abs(rgb - checks(points))[fields]
    assert np.median(error) < 0.015
    assert np.quantile(error, 0.99) < 0.05  # light's share, which is taken off, is not told apart from paint without fail


def test_sides_that_no_image_shows_have_their_slots_colour():
    rgb, _, hit = colors_at(lifted(), view((0.0, 1.6, 0.0)))
    np.testing.assert_allclose(rgb[hit], np.tile(PLAIN, (hit.sum(), 1)), atol=0.5 / 255 + 1e-6)


@given(st.integers(0, 10_000))
@settings(max_examples=8)
def test_nothing_outside_the_mask_bleeds_in(seed):
    """Whatever is drawn outside the mask, the texture is the same to the byte."""
    thing, rng = board(), np.random.default_rng(seed)
    seen = observation(thing, view())
    mask = seen.mask & (np.arange(160) + rng.uniform(0.5, 2) * np.arange(120)[:, None] < rng.uniform(100, 200))
    one = textured(thing, [dataclasses.replace(seen, mask=mask)], SLOTS)
    noise = np.where(mask[..., None], seen.rgb, rng.random(seen.rgb.shape)).astype(np.float32)
    other = textured(thing, [dataclasses.replace(seen, mask=mask, rgb=noise)], SLOTS)
    assert one.texture.image.tobytes() == other.texture.image.tobytes()
    assert one.texture.corner_uv.tobytes() == other.texture.corner_uv.tobytes()


def test_pixels_whose_depth_is_not_the_things_are_not_used():
    thing = board()
    seen = observation(thing, view())
    assert textured(thing, [dataclasses.replace(seen, depth=seen.depth + np.float32(0.3))], SLOTS).texture is None


def test_smooth_light_and_the_tint_of_an_image_leave_no_trace():
    """A board of one colour under a light that falls off, and tinted: what is left varies less than a third as much."""

    def glowing(points):
        return PLAIN * [1.1, 1.0, 0.9] * (0.75 + 0.4 * points[..., :1] + 0.2 * points[..., 2:])

    seen = observation(board(), view(), glowing)
    rgb, points, hit = colors_at(textured(board(), [seen], SLOTS), view())
    inner = hit & (np.abs(points[..., 0]) < 0.5) & (np.abs(points[..., 2]) < 0.35)
    drawn = glowing(points)[inner]
    assert np.std(rgb[inner], axis=0).max() < 0.33 * np.std(drawn, axis=0).min()
    assert np.abs(rgb[inner].mean(axis=0) - PLAIN).max() < 0.03


@given(st.floats(-math.pi, math.pi), st.floats(-3, 3), st.floats(-3, 3))
@settings(max_examples=8)
def test_a_moved_thing_under_a_moved_camera_has_the_same_texture(yaw, x, y):
    motion = np.eye(4)
    motion[:2, :2] = [[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]]
    motion[:2, 3] = x, y
    camera = view()
    moved = transformed(board(), motion)
    away = dataclasses.replace(camera, T_cam_world=camera.T_cam_world @ np.linalg.inv(motion))
    there = textured(moved, [observation(moved, away, motion=motion)], SLOTS)
    rgb, _, hit = colors_at(lifted(), camera)
    other, _, other_hit = colors_at(there, away)
    both = hit & other_hit
    assert both.sum() > 0.99 * hit.sum()
    assert np.abs(rgb - other)[both].mean() < 0.01


def test_placing_a_thing_leaves_its_colours_on_its_faces():
    thing = lifted()
    placed = flattened(moved_to(levelled(thing), dataclasses.replace(box_of(thing), x=2.0, yaw=1.0)), 0.3)
    assert placed.texture is thing.texture
    assert not np.allclose(placed.vertices, thing.vertices)


def test_the_same_observations_give_the_same_bytes():
    first, second = lifted(), lifted()
    assert first.texture.image.tobytes() == second.texture.image.tobytes()
    assert first.texture.corner_uv.tobytes() == second.texture.corner_uv.tobytes()


def test_where_two_images_differ_in_exposure_they_agree_on_the_surface():
    thing = board()
    seen = observation(thing, view())
    dim = dataclasses.replace(observation(thing, view((0.3, -1.5, 0.2))))
    dim = dataclasses.replace(dim, rgb=(0.8 * dim.rgb).astype(np.float32))
    rgb, points, hit = colors_at(textured(thing, [seen, dim], SLOTS), view())
    fields = hit & inside_fields(points)
    assert np.median(np.abs(rgb - checks(points))[fields]) < 0.02


@pytest.mark.parametrize("size", [(1.2, 0.3, 0.9), (30.0, 0.3, 20.0)])
def test_textures_are_bounded(size):
    thing = board(size)
    camera = view((0.0, -0.6, 0.0), width=640)
    made = textured(thing, [observation(thing, camera)], SLOTS)
    assert 100 < made.texture.image.shape[0] * made.texture.image.shape[1] < 1 << 18
    assert made.texture.image.dtype == np.uint8
    assert 0 <= made.texture.corner_uv.min() <= made.texture.corner_uv.max() <= 1


def test_slots_that_are_not_asked_for_have_no_texture():
    thing = board()
    assert textured(thing, [observation(thing, view())], np.array([False])).texture is None
    assert textured(thing, [], SLOTS).texture is None


def test_where_the_template_is_a_little_off_a_slot_does_not_smear_over_its_neighbour():
    """A chest whose right end is of a green slot, drawn a pixel wider than the template has it."""
    thing = board()
    green = (0.1, 0.5, 0.1)
    right = thing.vertices[thing.faces][..., 0].mean(axis=1) > 0.3
    two = dataclasses.replace(
        thing, face_slot=right.astype(np.int32), slots=("paint", "felt"), emission=np.zeros(2, np.float32),
        slot_colors=np.array([PLAIN, green], np.float32),
    )  # fmt: skip
    camera = view((1.6, -1.6, 0.0))
    gbuffer = cast(assemble_scene(EMPTY, [two]), camera)
    slot = np.where(gbuffer.hit, two.face_slot[gbuffer.face], -1)
    drawn = np.maximum(slot, 0)
    drawn[:, :-1] = np.maximum(drawn[:, :-1], drawn[:, 1:])
    rgb = two.slot_colors[drawn].astype(np.float32)
    made = textured(two, [Observation(camera=camera, rgb=rgb, depth=gbuffer.depth, mask=gbuffer.hit)], np.array([True, True]))
    colors, _, hit = colors_at(made, camera)
    expected = two.slot_colors[np.maximum(slot, 0)]
    assert np.abs(colors - expected)[hit].max() < 0.03
