"""Round trips, and equal records give equal bytes."""

import dataclasses
import io

import numpy as np
import pytest
from PIL import Image

from wm import codecs
from wm.types import Camera, SceneObject, Texture, View


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def _thing(rng, label):
    return SceneObject(
        label=label,
        room=1,
        support="floor",
        vertices=rng.normal(size=(5, 3)),
        faces=np.array([[0, 1, 2], [2, 3, 4]], np.int32),
        face_slot=np.array([0, 1], np.int32),
        slots=("dark_wood", "velvet"),
        slot_colors=rng.random((2, 3)).astype(np.float32),
        T_world_object=np.eye(4),
        size=np.ones(3),
        emission=np.zeros(2, np.float32),
    )


def test_png_round_trip_is_exact_and_bytes_are_stable(rng):
    image = rng.integers(0, 256, (17, 31, 3), dtype=np.uint8)
    assert np.array_equal(codecs.decode_png(codecs.encode_png(image)), image)
    assert codecs.encode_png(image) == codecs.encode_png(image.copy())


def test_mask_round_trip_is_exact(rng):
    mask = rng.random((17, 31)) < 0.5
    back = codecs.decode_mask(codecs.encode_mask(mask))
    assert np.array_equal(back, mask)
    assert np.array_equal(back.view(np.uint8), mask.view(np.uint8))  # true is a byte of 1: anything else breaks sums on devices


def test_depth_is_stored_within_half_a_step_and_misses_stay_zero(rng):
    depth = rng.uniform(0.1, 60, (9, 13)).astype(np.float32)
    depth[0, 0] = 0
    with Image.open(io.BytesIO(codecs.encode_depth(depth))) as image:
        back = np.asarray(image) * codecs.DEPTH_UNIT
    assert back[0, 0] == 0
    assert np.abs(back - depth).max() <= codecs.DEPTH_UNIT / 2 + 1e-5


def test_depth_that_16_bits_cannot_say_is_no_depth():
    depth = np.array([[1, 65.535, 65.6, 70, 1e9, np.inf, np.nan, -1]], np.float32)
    with Image.open(io.BytesIO(codecs.encode_depth(depth))) as image:
        np.testing.assert_array_equal(np.asarray(image), [[1000, 65535, 0, 0, 0, 0, 0, 0]])


def test_objects_round_trip(rng):
    things = (_thing(rng, "armchair"), _thing(rng, "Büste"))
    data = codecs.encode_objects(things)
    assert data == codecs.encode_objects(things)
    for before, after in zip(things, codecs.decode_objects(data), strict=True):
        assert (before.label, before.slots, before.support, before.room) == (after.label, after.slots, after.support, after.room)
        for name in ("vertices", "faces", "face_slot", "slot_colors", "T_world_object", "size", "emission"):
            assert np.array_equal(getattr(before, name), getattr(after, name))


def test_textures_round_trip_and_things_without_stay_without(rng):
    image, corner_uv = rng.integers(0, 256, (4, 6, 3), dtype=np.uint8), rng.random((2, 3, 2)).astype(np.float32)
    texture = Texture(image=image, corner_uv=corner_uv, slots=np.array([True, False]))
    things = (_thing(rng, "rug"), dataclasses.replace(_thing(rng, "picture"), texture=texture))
    plain, textured = codecs.decode_objects(codecs.encode_objects(things))
    assert plain.texture is None and textured.texture is not None
    for name in ("image", "corner_uv", "slots"):
        assert np.array_equal(getattr(texture, name), getattr(textured.texture, name))
        assert getattr(texture, name).dtype == getattr(textured.texture, name).dtype


def test_no_objects_round_trip():
    assert codecs.decode_objects(codecs.encode_objects(())) == ()


def test_camera_frame_is_nerfstudios_convention():
    # An OpenCV camera at (1, 2, 3) with identity rotation looks along world +z with y down.
    T_cam_world = np.eye(4)
    T_cam_world[:3, 3] = [-1, -2, -3]
    camera = Camera(T_cam_world=T_cam_world, focal=np.array([10.0, 10.0]), principal=np.array([8.0, 4.0]), width=16, height=8)
    view = View(camera=camera, room=0, kind="bootstrap", name="hall/bootstrap0")
    frame = codecs.transforms_json([view], ["hall"])
    matrix = np.array(frame["frames"][0]["transform_matrix"])
    assert np.allclose(matrix[:3, 3], [1, 2, 3])
    assert np.allclose(-matrix[:3, 2], [0, 0, 1])  # looks along -z of its own axes
    assert np.allclose(matrix[:3, 1], [0, -1, 0])  # its y is up
