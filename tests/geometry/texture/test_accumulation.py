"""What is projected into the atlas comes back, from the right surfaces only, whatever the order of views."""

import dataclasses
import functools
import inspect

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.plans import one_room, two_rooms
from tests.geometry.things import box
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.mesh.structure import build_structure
from wm.geometry.rays.pinhole import camera_center, make_camera, scale_camera, unproject_depth
from wm.geometry.rays.raycast import build_ray_scene, cast, occluded
from wm.geometry.texture.accumulation import accumulate, accumulate_in_place
from wm.geometry.texture.atlas import build_atlas, texel_charts, texel_positions
from wm.geometry.texture.sampling import pixel_charts, sample_atlas
from wm.schema import TextureSettings
from wm.types import SurfaceKind

TEXEL = 0.04
SIZE = {"width": 172, "height": 96, "fov_deg": 60.0}


def pattern(p):
    """A smooth texture of space: its slope is at most 0.75 a metre in each channel."""
    x, y, z = np.moveaxis(p, -1, 0)
    return np.stack([0.5 + 0.3 * np.sin(2 * x + y), 0.5 + 0.3 * np.cos(2 * y - z), 0.5 + 0.3 * np.sin(2 * z + x)], axis=-1)


def camera(eye, target=(2.5, 2.0, 1.2)):
    return make_camera(np.array(eye, float), np.array(target, float), **SIZE)


@functools.cache
def furnished():
    """A closed room with a table, a picture 2 cm thick on one wall and a screen 8 cm off another."""
    things = [
        box([1.8, 1.5, 0.3], [3.0, 2.5, 0.75]),
        box([1, 0.16, 1.2], [2, 0.17, 1.9]),
        box([4.70, 1, 1], [4.77, 2.2, 1.7]),
    ]
    mesh = assemble_scene(build_structure(one_room()), things)
    return mesh, build_ray_scene(mesh), build_atlas(mesh, TEXEL)


EYES = ([0.5, 0.5, 1.6], [4.5, 3.5, 1.6], [0.6, 3.4, 1.2], [4.4, 0.6, 2.2])


def painted(atlas, scene, cameras, room=0, image=pattern, **options):
    for view in cameras:
        gbuffer = cast(scene, view)
        rgb = image(unproject_depth(view, gbuffer.depth)).astype(np.float32)
        atlas = accumulate(atlas, gbuffer, view, rgb, room, **options)
    return atlas


def test_a_known_texture_comes_back():
    _, scene, atlas = furnished()
    views = [camera(eye) for eye in EYES]
    atlas = painted(atlas, scene, views)
    known = atlas.weight > 0
    assert known[atlas.inside].mean() > 0.8
    assert not known[~atlas.inside].any()
    error = np.abs(atlas.color - pattern(texel_positions(atlas)))[known]
    assert error.mean() < 1e-3  # curvature over a pixel of 5 cm
    assert np.quantile(error, 0.999) < 0.04  # outlines: colour from up to a pixel (5 cm) beside the texel
    held_out = camera([1.0, 2.0, 1.5], [4.5, 2.5, 1.0])
    gbuffer = cast(scene, held_out)
    rgb, alpha = sample_atlas(atlas, gbuffer, held_out)
    seen = alpha > 0.2
    assert seen.mean() > 0.5
    error = np.abs(rgb - pattern(unproject_depth(held_out, gbuffer.depth)))[seen]
    assert error.mean() < 2e-3
    assert error.max() < 0.1


def test_a_constant_image_comes_back_exactly():
    _, scene, atlas = furnished()
    atlas = painted(atlas, scene, [camera(eye) for eye in EYES[:2]], image=lambda p: np.full(p.shape, 0.25))
    np.testing.assert_allclose(atlas.color[atlas.weight > 0], 0.25, atol=1e-7)
    view = camera(EYES[0])
    rgb, alpha = sample_atlas(atlas, cast(scene, view), view)
    np.testing.assert_allclose(rgb[alpha > 0], 0.25, atol=1e-6)


def test_the_order_of_views_does_not_matter():
    _, scene, atlas = furnished()
    views = [camera(eye) for eye in EYES[:3]]
    one, other = painted(atlas, scene, views), painted(atlas, scene, views[::-1])
    np.testing.assert_allclose(one.weight, other.weight, rtol=1e-6)
    np.testing.assert_allclose(one.color, other.color, atol=1e-6)


def test_the_given_atlas_is_not_changed_and_alpha_only_grows():
    _, scene, atlas = furnished()
    view = camera(EYES[0])
    gbuffer = cast(scene, view)
    before = np.zeros(gbuffer.depth.shape, np.float32)
    for eye in EYES:
        following = painted(atlas, scene, [camera(eye)])
        assert (following.weight >= atlas.weight).all()
        assert not np.shares_memory(following.weight, atlas.weight)
        alpha = sample_atlas(following, gbuffer, view)[1]
        assert (alpha >= before - 1e-6).all()
        assert alpha.max() <= 1
        atlas, before = following, alpha
    assert furnished()[2].weight.max() == 0


def test_occluded_texels_get_nothing_but_the_width_of_an_outline():
    _, scene, atlas = furnished()
    normal = atlas.chart_normal[texel_charts(atlas)]
    points = texel_positions(atlas) + 2e-4 * normal
    hidden_total = leaked_total = leaked_weight = weight = 0.0
    for eye in EYES:
        after = painted(atlas, scene, [camera(eye)])
        towards = camera_center(camera(eye)) - points
        hidden = occluded(scene, points, towards, 0.9999) & (np.einsum("ti,ti->t", towards, normal) > 0) & atlas.inside
        hidden_total += hidden.sum()
        leaked_total += (after.weight[hidden] > 0.05).sum()
        leaked_weight += after.weight[hidden].sum()
        weight += after.weight.sum()
    assert hidden_total > 1000
    assert leaked_total / hidden_total < 0.02  # 5 cm pixels; at 688 wide 0.4 %, where the paper's 0.10 m lets 15 % through
    assert leaked_weight / weight < 0.005


def test_only_surfaces_of_the_room_are_painted_and_reveals_from_both_sides():
    mesh = build_structure(two_rooms())
    scene, atlas = build_ray_scene(mesh), build_atlas(mesh, TEXEL)
    view = camera([0.6, 2.0, 1.6], [8.5, 2.0, 1.2])  # through the door into the study
    seen = np.unique(pixel_charts(atlas, cast(scene, view)))
    assert set(atlas.chart_room[seen[seen >= 0]]) == {0, 1}
    for room in (0, 1):
        known = painted(atlas, scene, [view], room).weight > 0
        assert known.any()
        charts = texel_charts(atlas)[known]
        reveal = atlas.chart_kind[charts] == SurfaceKind.REVEAL
        assert reveal.any() and set(atlas.chart_room[charts[~reveal]]) == {room}


def test_reveals_and_panes_are_surfaces_too():
    mesh = build_structure(two_rooms())
    scene, atlas = build_ray_scene(mesh), build_atlas(mesh, TEXEL)
    atlas = painted(atlas, scene, [camera([2.5, 2.0, 1.6], [2.5, 0.0, 1.5]), camera([3.0, 2.2, 1.6], [5.0, 2.0, 1.0])])
    kinds = atlas.chart_kind[texel_charts(atlas)[atlas.weight > 0]]
    assert set(kinds) >= {SurfaceKind.WALL, SurfaceKind.REVEAL, SurfaceKind.PANE, SurfaceKind.FLOOR}


def test_unusable_pixels_are_not_used():
    _, scene, atlas = furnished()
    view = camera(EYES[0])
    gbuffer = cast(scene, view)
    usable = np.zeros(gbuffer.hit.shape, bool)
    usable[:, : SIZE["width"] // 2] = True
    rgb = np.where(usable[..., None], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]).astype(np.float32)
    after = accumulate(atlas, gbuffer, view, rgb, 0, usable=usable)
    used = after.color[after.weight > 0]
    assert len(used) > 0
    np.testing.assert_allclose(used, np.broadcast_to([0.0, 1.0, 0.0], used.shape), atol=1e-6)
    nothing = accumulate(atlas, gbuffer, view, rgb, 0, usable=np.zeros_like(usable))
    assert nothing.weight.max() == 0


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_pixels_without_a_finite_colour_are_not_used_whether_marked_or_not(value):
    _, scene, atlas = furnished()
    view = camera(EYES[0])
    gbuffer = cast(scene, view)
    rng = np.random.default_rng(0)
    rgb = rng.uniform(0, 1, (*gbuffer.depth.shape, 3)).astype(np.float32)
    usable = rng.uniform(size=gbuffer.depth.shape) < 0.9
    broken = rgb.copy()
    broken[~usable, rng.integers(0, 3, (~usable).sum())] = value
    expected = accumulate(atlas, gbuffer, view, rgb, 0, usable=usable)
    for mask in (usable, None):
        after = accumulate(atlas, gbuffer, view, broken, 0, usable=mask)
        np.testing.assert_array_equal(after.color, expected.color)
        np.testing.assert_array_equal(after.weight, expected.weight)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"rgb": np.zeros((96, 172, 4), np.float32)}, "rgb must be floating .96, 172, 3. .*float32 .96, 172, 4."),
        ({"rgb": np.zeros((96, 172), np.float32)}, "rgb"),
        ({"rgb": np.zeros((96, 172, 1), np.float32)}, "rgb"),
        ({"rgb": np.zeros((48, 86, 3), np.float32)}, "rgb"),
        ({"rgb": np.zeros((96, 172, 3), np.uint8)}, "rgb .*uint8"),
        ({"usable": np.ones(172, bool)}, "usable must be bool .96, 172."),
        ({"usable": np.ones((96, 172), np.uint8)}, "usable"),
        ({"room": 7}, "room 7 has no surface .*rooms .0."),
        ({"settings": TextureSettings(min_facing=1.0)}, "min_facing"),
        ({"camera": scale_camera(camera(EYES[0]), 0.5)}, "96 x 172 pixels, the camera 48 x 86"),
    ],
)
def test_what_does_not_fit_the_view_is_named_and_paints_nothing(changed, said):
    _, scene, atlas = furnished()
    view = camera(EYES[0])
    given = {"camera": view, "rgb": np.zeros((96, 172, 3), np.float32), "room": 0} | changed
    with pytest.raises(ValueError, match=said):  # past jaxtyping, as a user calls it
        inspect.unwrap(accumulate_in_place)(atlas, cast(scene, view), **given)
    assert atlas.weight.max() == 0


def test_reading_with_another_camera_is_refused():
    _, scene, atlas = furnished()
    view = camera(EYES[0])
    with pytest.raises(ValueError, match="96 x 172 pixels, the camera 48 x 86"):
        sample_atlas(atlas, cast(scene, view), scale_camera(view, 0.5))


def test_an_atlas_of_the_structure_serves_the_furnished_scene():
    mesh, scene, whole = furnished()
    structure = build_atlas(build_structure(one_room()), TEXEL)
    view = camera(EYES[1])
    ours, theirs = painted(structure, scene, [view]), painted(whole, scene, [view])
    np.testing.assert_array_equal(ours.weight, theirs.weight)
    gbuffer = cast(scene, view)
    rgb, alpha = sample_atlas(ours, gbuffer, view)
    np.testing.assert_array_equal(rgb, sample_atlas(theirs, gbuffer, view)[0])
    objects = mesh.face_object[gbuffer.face] >= 0
    assert objects.any()
    assert alpha[objects].max() == 0


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_reading_is_bilinear_and_renormalised(seed):
    """A texture that is affine on each plane is read exactly where all texels are known, and never mixed with unknown ones."""
    _, scene, atlas = furnished()
    rng = np.random.default_rng(seed)
    slope = rng.uniform(-0.1, 0.1, (3, 3))
    color = (0.5 + texel_positions(atlas) @ slope).astype(np.float32)
    weight = np.where(atlas.inside, rng.choice([0.1, 0.5, 3.0], atlas.inside.shape), 0).astype(np.float32)
    known = dataclasses.replace(atlas, color=color, weight=np.where(weight > 0, np.float32(3), weight))
    view = camera([2.5, 2.0, 1.6], rng.uniform([0, 0, 0.5], [5, 4, 2]) + 1e-3)
    gbuffer = cast(scene, view)
    points = unproject_depth(view, gbuffer.depth)
    shown = pixel_charts(atlas, gbuffer) >= 0
    rgb, alpha = sample_atlas(known, gbuffer, view)
    np.testing.assert_allclose(alpha[shown], 1, atol=1e-6)
    assert (np.abs(rgb - (0.5 + points @ slope))[shown] < 0.35 * TEXEL).all()  # half a texel where an edge leaves no neighbour
    assert np.median(np.abs(rgb - (0.5 + points @ slope))[shown]) < 1e-5

    partly = dataclasses.replace(known, color=np.where(weight[:, None] > 0.3, np.full(3, 0.7, np.float32), np.float32(99)))
    partly = dataclasses.replace(partly, weight=np.where(weight > 0.3, weight, 0).astype(np.float32))
    rgb, alpha = sample_atlas(partly, gbuffer, view)
    np.testing.assert_allclose(rgb[alpha > 0], 0.7, atol=1e-5)
    assert (rgb[alpha == 0] == 0).all()


@pytest.mark.parametrize("eye", [[0.5, 0.5, 1.6], [2.5, 0.35, 0.3]])
def test_grazing_views_add_nothing(eye):
    _, scene, atlas = furnished()
    view = camera(eye)
    after = painted(atlas, scene, [view], settings=TextureSettings(min_facing=0.4))
    towards = camera_center(view) - texel_positions(atlas)
    cosine = np.einsum("ti,ti->t", towards, atlas.chart_normal[texel_charts(atlas)]) / np.linalg.norm(towards, axis=1)
    assert (after.weight[cosine < 0.399] == 0).all()
    assert (after.weight > 0).any()


def test_a_view_that_sees_nothing_changes_nothing():
    _, scene, atlas = furnished()
    outside = camera([50, 50, 50], [60, 60, 50])
    after = painted(atlas, scene, [outside])
    np.testing.assert_array_equal(after.weight, atlas.weight)
    rgb, alpha = sample_atlas(atlas, cast(scene, outside), outside)
    assert rgb.max() == 0
    assert alpha.max() == 0
