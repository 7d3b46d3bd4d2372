"""Laws that an image of gaussians obeys whatever they are: crops, motions, units, colours, and what opacity hides.

Most under cuts too small to see and a clamp of the projection too wide to meet: a crop moves the clamp, rounding the cuts.
"""

import dataclasses

import jax
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.scenes import SMOOTH, camera, cloud, jit_project
from wm.schema import RasterSettings
from wm.splat import render

WIDE = dataclasses.replace(SMOOTH, frustum_margin=10.0)
SEEDS = st.integers(0, 10**6)
SH_C0 = 0.28209479177387814


def close(a, b, atol=2e-5):
    np.testing.assert_allclose(a.rgb, b.rgb, atol=atol)
    np.testing.assert_allclose(a.alpha, b.alpha, atol=atol)
    np.testing.assert_allclose(a.depth * a.alpha, b.depth * b.alpha, atol=4 * atol)


def turn(rng) -> tuple[np.ndarray, np.ndarray]:
    """A random rotation: unit quaternion and matrix."""
    q = rng.normal(size=4)
    w, x, y, z = q = q / np.linalg.norm(q)
    matrix = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return q, np.array(matrix)


@given(SEEDS, st.integers(0, 12), st.integers(0, 6))
@settings(max_examples=10)
def test_a_crop_is_the_same_pixels(seed, left, top):
    gaussians, view = cloud(seed=seed, degree=1), camera(seed=seed)
    crop = dataclasses.replace(view, principal=view.principal - [left, top], width=9, height=7)
    whole, part = render(gaussians, view, settings=WIDE), render(gaussians, crop, settings=WIDE)
    close(jax.tree.map(lambda x: x[top : top + 7, left : left + 9], whole), part)


@given(SEEDS)
@settings(max_examples=10)
def test_moving_world_and_camera_together_changes_nothing(seed):
    # harmonics of degree 1 are the components (-y, z, -x) of the direction, so they turn as a vector does
    gaussians, view, rng = cloud(seed=seed, degree=1), camera(seed=seed), np.random.default_rng(seed)
    (w, *axis), R = turn(rng)
    shift = rng.normal(size=3)
    v, u = np.array(axis), gaussians.quats[:, 1:]
    quats = [w * gaussians.quats[:, 0] - u @ v, *(w * u + gaussians.quats[:, :1] * v + np.cross(v, u)).T]
    vectors = np.stack([-gaussians.sh[:, 3], -gaussians.sh[:, 1], gaussians.sh[:, 2]])  # x, y, z
    x, y, z = np.einsum("ij,jnc->inc", R, vectors)
    moved = gaussians.replace(
        means=gaussians.means @ R.T + shift,
        quats=np.stack(quats, 1),
        sh=np.stack([gaussians.sh[:, 0], -y, z, -x], 1),
    )
    T_world_moved = np.eye(4)
    T_world_moved[:3, :3], T_world_moved[:3, 3] = R.T, -R.T @ shift
    close(
        render(moved, dataclasses.replace(view, T_cam_world=view.T_cam_world @ T_world_moved), settings=WIDE),
        render(gaussians, view, settings=WIDE),
    )


@given(SEEDS, st.sampled_from((0.2, 3.7)))  # each is compiled anew
@settings(max_examples=10)
def test_other_units_of_length_change_the_depth_only(seed, factor):
    # blur is in pixels and stays; `near`, which depths are kept from, is in the same unit as all else
    gaussians, view = cloud(seed=seed, degree=1), camera(seed=seed)
    scaled = gaussians.replace(means=gaussians.means * factor, log_scales=gaussians.log_scales + np.log(factor))
    T = view.T_cam_world.copy()
    T[:3, 3] *= factor
    image = render(scaled, dataclasses.replace(view, T_cam_world=T), settings=dataclasses.replace(WIDE, near=WIDE.near * factor))
    close(image.replace(depth=image.depth / factor), render(gaussians, view, settings=WIDE))


@given(SEEDS, st.floats(-2.0, 2.0))
@settings(max_examples=10)
def test_colour_is_linear_where_it_is_positive(seed, t):
    gaussians, view = cloud(seed=seed, degree=1), camera(seed=seed)
    rng = np.random.default_rng(seed)
    ends, behind = (gaussians.sh, rng.normal(size=gaussians.sh.shape)), rng.random((2, 3))
    for sh in ends:
        sh[:, 0] += 10  # above all that the first band takes away
    mix = (1 - t) * ends[0] + t * ends[1], (1 - t) * behind[0] + t * behind[1]
    a, b, c = (
        np.asarray(render(gaussians.replace(sh=sh), view, background=back, settings=WIDE).rgb)
        for sh, back in (*zip(ends, behind), mix)
    )
    np.testing.assert_allclose(c, (1 - t) * a + t * b, atol=2e-5)


@given(SEEDS, st.floats(-2.0, 20.0))
@settings(max_examples=10)
def test_premultiplied_colour_lies_between_the_extreme_colours(seed, opaque):
    gaussians, view = cloud(seed=seed, degree=1, opaque=opaque), camera(seed=seed)
    image, color = render(gaussians, view, settings=WIDE), np.asarray(jit_project(gaussians, view, settings=WIDE).color)
    rgb, alpha = np.asarray(image.rgb), np.asarray(image.alpha)[..., None]
    assert (rgb <= alpha * color.max(1) + 1e-5).all() and (rgb >= alpha * color.min(1) - 1e-5).all()


@given(SEEDS, st.integers(0, 23), st.floats(0.1, 10.0))
@settings(max_examples=10)
def test_more_opacity_in_front_never_reveals_more_behind(seed, which, more):
    # what lies behind is white, all else black, so that the image is the weight of what lies behind; under the default cuts
    gaussians, view = cloud(seed=seed, degree=1, opaque=6.0), camera(seed=seed)
    depth = np.asarray(jit_project(gaussians, view, settings=WIDE).depth)
    behind = depth > depth[which]
    sh = np.zeros_like(gaussians.sh)
    sh[:, 0] = np.where(behind, 0.5, -0.5)[:, None] / SH_C0
    logits = gaussians.opacity_logits.copy()
    logits[which] += more
    before = render(gaussians.replace(sh=sh), view, background=np.ones(3))
    after = render(gaussians.replace(sh=sh, opacity_logits=logits), view, background=np.ones(3))
    assert (after.rgb <= before.rgb + 1e-6).all() and (after.alpha >= before.alpha - 1e-4).all()


@given(SEEDS, st.sampled_from([(1, 2, 40), (3, 1, 2), (5, 7, 64), (16, 4, 1)]))
@settings(max_examples=8)
def test_tile_chunk_and_block_change_nothing(seed, sizes):
    gaussians, view = cloud(seed=seed, degree=1, opaque=9.0), camera(seed=seed)
    tile, chunk, block = sizes
    split = render(gaussians, view, settings=RasterSettings(tile=tile, chunk=chunk, block=block))
    plain = render(gaussians, view)
    np.testing.assert_allclose(split.alpha, plain.alpha, atol=2e-6)
    np.testing.assert_allclose(split.rgb, plain.rgb, atol=4e-6)
