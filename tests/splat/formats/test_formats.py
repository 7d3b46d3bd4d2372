"""What a format's writer writes, `load_splats` reads back within the format's steps; damaged files are refused by name."""

import jax
import numpy as np
import pytest

from tests.splat.ply.files import some
from wm.splat import load_ply, save_ply
from wm.splat.formats import (
    SplatFileError,
    load_splats,
    save_compressed_ply,
    save_gltf_splats,
    save_splat,
)
from wm.splat.formats.compressed_ply import morton_order
from wm.splat.rasterizer.harmonics import SH_C0

SAVERS = {"a.splat": save_splat, "a.compressed.ply": save_compressed_ply, "a.glb": save_gltf_splats, "a.ply": save_ply}


def scene(k=1, n=300):
    """Gaussians whose colours lie between 0 and 1, as `.splat` has them."""
    gaussians = some(n, k)
    return gaussians.replace(sh=(gaussians.sh / 4).astype(np.float32))


def opacities(gaussians):
    return 1 / (1 + np.exp(-gaussians.opacity_logits.astype(np.float64)))


def angle(a, b):
    """Between rotations, in degrees."""
    return np.degrees(
        2 * np.arccos(np.clip(np.abs((a * b).sum(1)) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1), 0, 1))
    )


def test_splat_keeps_what_it_holds_in_floats_and_rounds_the_rest(tmp_path):
    gaussians = scene()
    save_splat(tmp_path / "a.splat", gaussians)
    loaded = load_splats(tmp_path / "a.splat")
    np.testing.assert_array_equal(loaded.means, gaussians.means)
    np.testing.assert_allclose(loaded.log_scales, gaussians.log_scales, atol=1e-6)
    np.testing.assert_allclose(opacities(loaded), opacities(gaussians), atol=0.501 / 255)
    np.testing.assert_allclose(SH_C0 * loaded.sh, SH_C0 * gaussians.sh, atol=0.501 / 255)
    assert angle(loaded.quats, gaussians.quats).max() < 2 * np.degrees(np.sqrt(3) * 1 / 128)


@pytest.mark.parametrize("k", [1, 4, 16])
def test_compressed_ply_lies_along_a_curve_within_the_steps_of_its_chunks(tmp_path, k):
    gaussians = scene(k, 700)
    save_compressed_ply(tmp_path / "a.compressed.ply", gaussians)
    loaded = load_splats(tmp_path / "a.compressed.ply")
    wanted = jax.tree.map(lambda leaf: leaf[morton_order(gaussians.means)], gaussians)
    for chunk in (slice(0, 256), slice(256, 512), slice(512, 700)):
        for field in ("means", "log_scales"):
            step = np.ptp(getattr(wanted, field)[chunk], axis=0) / 1023
            assert (np.abs(getattr(loaded, field)[chunk] - getattr(wanted, field)[chunk]) <= 0.501 * step).all()
    assert angle(loaded.quats, wanted.quats).max() < 0.25
    np.testing.assert_allclose(opacities(loaded), opacities(wanted), atol=0.501 / 255)
    np.testing.assert_allclose(loaded.sh[:, 1:], np.clip(wanted.sh[:, 1:], -4, 4), atol=8.01 / 256)
    np.testing.assert_allclose(loaded.sh[:, 0], wanted.sh[:, 0], atol=0.51 / 255 * np.ptp(wanted.sh[:, 0]))


def test_the_curve_keeps_neighbours_together():
    means = np.random.default_rng(0).random((4096, 3)).astype(np.float32)
    ordered = means[morton_order(means)].reshape(-1, 64, 3)
    assert np.ptp(ordered, axis=1).max(axis=1).mean() <= 0.5  # of the side; in random order it is nearly 1
    np.testing.assert_array_equal(morton_order(np.zeros((5, 3))), np.arange(5))


@pytest.mark.parametrize("k", [1, 4, 9, 16])
def test_gltf_keeps_all_numbers(tmp_path, k):
    gaussians = some(50, k)
    save_gltf_splats(tmp_path / "a.glb", gaussians)
    loaded = load_splats(tmp_path / "a.glb")
    np.testing.assert_array_equal(loaded.means, gaussians.means)
    np.testing.assert_array_equal(loaded.quats, gaussians.quats)
    np.testing.assert_array_equal(loaded.sh, gaussians.sh)
    np.testing.assert_allclose(loaded.log_scales, gaussians.log_scales, atol=1e-6)
    np.testing.assert_allclose(loaded.opacity_logits, gaussians.opacity_logits, atol=1e-5)


@pytest.mark.parametrize("name", sorted(SAVERS))
def test_equal_gaussians_give_equal_bytes(tmp_path, name):
    for folder in "ab":
        (tmp_path / folder).mkdir()
        SAVERS[name](tmp_path / folder / name, scene(1, 9))
    assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.parametrize("name", ["a.splat", "a.compressed.ply", "a.glb"])
def test_what_no_program_draws_is_left_out_and_the_rest_is_finite(tmp_path, name):
    gaussians = scene(1, 6)
    gaussians.means[0, 1], gaussians.opacity_logits[1] = np.nan, np.nan
    gaussians.opacity_logits[2], gaussians.opacity_logits[3] = np.inf, -np.inf
    gaussians.log_scales[4, 2], gaussians.quats[5] = -np.inf, 0
    SAVERS[name](tmp_path / name, gaussians)
    loaded = load_splats(tmp_path / name)
    assert len(loaded.means) == 4
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(loaded))


@pytest.mark.parametrize("name", sorted(SAVERS))
def test_the_content_tells_the_format_and_not_the_name(tmp_path, name):
    if name != "a.splat":
        SAVERS[name](tmp_path / name, scene(1, 5))
        (tmp_path / name).rename(tmp_path / "renamed.splat")
        assert len(load_splats(tmp_path / "renamed.splat").means) == 5


@pytest.mark.parametrize("name", sorted(SAVERS))
def test_a_file_that_is_cut_short_is_refused_wherever_it_is_cut(tmp_path, name):
    SAVERS[name](tmp_path / name, scene(4, 5))
    raw = (tmp_path / name).read_bytes()
    cuts = [k for k in (0, 3, 7, 21, 33, len(raw) // 3, len(raw) // 2, len(raw) - 1) if name != "a.splat" or k % 32 or not k]
    for cut in cuts:
        (tmp_path / name).write_bytes(raw[:cut])
        with pytest.raises(SplatFileError, match=rf"{name}.*would (be right|end there)|not a PLY file"):
            load_splats(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "raw", "says"),
    [
        ("scene.ksplat", b"\0" * 64, "of no format of gaussians"),
        ("scene.usdz", b"PK\x03\x04" + b"\0" * 60, "of no format of gaussians"),
        ("scene.splat", b"\0" * 33, "33 bytes; a multiple of 32"),
        ("scene.splat", b"\xff" * 64, "not finite"),
        ("scene.ply", b"ply\nformat ascii 1.0\nelement face 0\nend_header\n", "no element vertex"),
        ("scene.glb", b"glTF" + bytes(20), "glTF version 0"),
    ],
)
def test_other_files_are_refused_by_name(tmp_path, name, raw, says):
    (tmp_path / name).write_bytes(raw)
    with pytest.raises(SplatFileError, match=says) as caught:
        load_splats(tmp_path / name)
    assert str(tmp_path / name) in str(caught.value)


def test_a_ply_file_is_read_as_by_load_ply(tmp_path):
    save_ply(tmp_path / "a.ply", scene(9))
    jax.tree.map(np.testing.assert_array_equal, load_splats(tmp_path / "a.ply"), load_ply(tmp_path / "a.ply"))
