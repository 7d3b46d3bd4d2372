"""SPZ and SOG come back from gaussforge within their steps, finite, and damaged files are refused by name."""

import gzip
import struct

import jax
import numpy as np
import pytest
from scipy.spatial import KDTree

from tests.splat.formats.test_formats import angle, opacities, scene
from wm.splat.formats import SplatFileError, load_splats, save_packed

pytest.importorskip("gaussforge", reason="needs the extra splats")


@pytest.mark.parametrize("k", [1, 4, 16])
def test_spz_comes_back_within_its_steps(tmp_path, k):
    gaussians = scene(k)
    save_packed(tmp_path / "a.spz", gaussians, "spz")
    loaded = load_splats(tmp_path / "a.spz")
    np.testing.assert_allclose(loaded.means, gaussians.means, atol=0.51 / 4096)  # 12 bits of fraction
    np.testing.assert_allclose(loaded.log_scales, gaussians.log_scales, atol=0.51 / 16)
    np.testing.assert_allclose(opacities(loaded), opacities(gaussians), atol=0.51 / 255)
    np.testing.assert_allclose(loaded.sh[:, :1], gaussians.sh[:, :1], atol=0.51 / 255 / 0.15)
    np.testing.assert_allclose(loaded.sh[:, 1:], np.clip(gaussians.sh[:, 1:], -1, 1), atol=16 / 128)  # 4 or 5 bits
    assert angle(loaded.quats, gaussians.quats).max() < 0.25


def test_spz_is_written_in_the_version_that_viewers_read(tmp_path):
    save_packed(tmp_path / "a.spz", scene(1, 7), "spz")
    magic, version, count = struct.unpack_from("<4sII", gzip.decompress((tmp_path / "a.spz").read_bytes()))
    assert (magic, version, count) == (b"NGSP", 3, 7)


def nearest(loaded, gaussians):
    """What was loaded in the order of the gaussians whose means lie nearest: SOG has an order of its own."""
    order = KDTree(loaded.means).query(gaussians.means)[1]
    assert sorted(order) == list(range(len(order)))
    return jax.tree.map(lambda leaf: leaf[order], loaded)


@pytest.mark.parametrize("k", [1, 4])
def test_sog_comes_back_within_its_steps(tmp_path, k):
    gaussians = scene(k, 500)
    save_packed(tmp_path / "a.sog", gaussians, "sog")
    loaded = nearest(load_splats(tmp_path / "a.sog"), gaussians)
    np.testing.assert_allclose(loaded.means, gaussians.means, atol=1e-3)  # 16 bits of log(1 + |x|)
    assert np.abs(loaded.log_scales - gaussians.log_scales).mean() < np.ptp(gaussians.log_scales) / 256
    np.testing.assert_allclose(opacities(loaded), opacities(gaussians), atol=0.51 / 255)
    assert angle(loaded.quats, gaussians.quats).max() < 1.2
    assert np.abs(loaded.sh - gaussians.sh).mean() < 0.01


@pytest.mark.parametrize("kind", ["spz", "sog"])
def test_bytes_repeat_and_nothing_is_printed(tmp_path, kind, capfd):
    for name in "ab":
        save_packed(tmp_path / name, scene(1, 50), kind)
        load_splats(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("kind", ["spz", "sog"])
def test_discs_and_what_is_not_finite_spoil_nothing(tmp_path, kind):
    gaussians = scene(1, 50)
    gaussians.log_scales[:25, 2], gaussians.means[30], gaussians.opacity_logits[31] = -np.inf, np.nan, np.inf
    save_packed(tmp_path / "a", gaussians, kind)
    kept = jax.tree.map(lambda leaf: np.delete(leaf, 30, axis=0), gaussians)
    loaded = nearest(load_splats(tmp_path / "a"), kept)
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(loaded))
    np.testing.assert_allclose(loaded.means, kept.means, atol=1e-3)
    assert (loaded.log_scales[:25, 2] < -9.5).all()


@pytest.mark.parametrize("kind", ["spz", "sog"])
def test_a_file_that_is_cut_short_or_overwritten_is_refused(tmp_path, kind):
    save_packed(tmp_path / "a", scene(1, 200), kind)
    raw = (tmp_path / "a").read_bytes()
    for broken in (raw[: len(raw) // 2], raw[:30], raw[:4] + b"\x7f" * 40):
        (tmp_path / "a").write_bytes(broken)
        with pytest.raises(SplatFileError, match=rf"{tmp_path}/a.*would be right|{tmp_path}/a: no"):
            load_splats(tmp_path / "a")


def test_no_gaussians_cannot_be_written(tmp_path):
    with pytest.raises(SplatFileError, match="no gaussians"):
        save_packed(tmp_path / "a.sog", scene(1, 0), "sog")
