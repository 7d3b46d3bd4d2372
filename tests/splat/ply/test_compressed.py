"""PlayCanvas's compressed layout, packed here by its definition, comes back within half a step of its bits."""

import numpy as np
import pytest

from tests.splat.ply.files import binary, some
from wm.splat.ply import PlyError, load_ply
from wm.splat.rasterizer.harmonics import SH_C0


def packed(values, low, high, bits):
    """Three columns between bounds in one word."""
    word = np.zeros(len(values), np.uint64)
    for column, lo, hi, b in zip(values.T, low.T, high.T, bits):
        word = (word << np.uint64(b)) | np.round((column - lo) / np.maximum(hi - lo, 1e-9) * (2**b - 1)).astype(np.uint64)
    return word.astype(np.uint32)


def rotations(quats):
    words = []
    for q in quats.astype(np.float64):
        k = int(np.abs(q).argmax())
        rest = np.delete(q * np.sign(q[k]), k)
        word = k
        for c in rest:
            word = (word << 10) | round((c / np.sqrt(2) + 0.5) * 1023)
        words.append(word)
    return np.array(words, np.uint32)


def bounds(values, names):
    chunks = [values[i : i + 256] for i in range(0, len(values), 256)]
    low, high = (np.array([f(c, axis=0) for c in chunks], np.float32) for f in (np.min, np.max))
    columns = {f"min_{name}": low[:, i] for i, name in enumerate(names)} | {
        f"max_{name}": high[:, i] for i, name in enumerate(names)
    }
    return low.repeat(256, 0)[: len(values)], high.repeat(256, 0)[: len(values)], columns


def compressed(gaussians, colors, opacity, *, bounded, bands=None):
    place_low, place_high, chunk = bounds(gaussians.means, "xyz")
    scale_low, scale_high, more = bounds(gaussians.log_scales, ("scale_x", "scale_y", "scale_z"))
    chunk |= more
    color_low, color_high = np.zeros_like(colors), np.ones_like(colors)
    if bounded:
        color_low, color_high, more = bounds(colors, "rgb")
        chunk |= more
    rgba = (np.c_[colors, opacity], np.c_[color_low, 0 * opacity], np.c_[color_high, 0 * opacity + 1])
    vertex = {
        "packed_position": packed(gaussians.means, place_low, place_high, (11, 10, 11)),
        "packed_rotation": rotations(gaussians.quats),
        "packed_scale": packed(gaussians.log_scales, scale_low, scale_high, (11, 10, 11)),
        "packed_color": packed(*rgba, (8, 8, 8, 8)),
    }
    sh = {} if bands is None else {"sh": {f"f_rest_{i}": bands[:, i] for i in range(bands.shape[1])}}
    return binary({"chunk": chunk, "vertex": vertex, **sh})


@pytest.mark.parametrize("bounded", [False, True])
def test_it_comes_back_within_half_a_step(tmp_path, bounded):
    rng = np.random.default_rng(1)
    gaussians, colors, opacity = some(300, 1), rng.random((300, 3)), rng.random(300)
    opacity[:2] = 0, 1
    (tmp_path / "c.ply").write_bytes(compressed(gaussians, colors, opacity, bounded=bounded))
    loaded = load_ply(tmp_path / "c.ply")
    for found, wanted in ((loaded.means, gaussians.means), (loaded.log_scales, gaussians.log_scales)):
        assert np.abs(found - wanted).max() <= np.ptp(wanted) / 1023 / 2 * 1.01
    np.testing.assert_allclose(0.5 + SH_C0 * loaded.sh[:, 0], colors, atol=0.51 / 255)
    assert np.isfinite(loaded.opacity_logits).all()
    np.testing.assert_allclose(1 / (1 + np.exp(-loaded.opacity_logits)), opacity, atol=0.51 / 255)
    aligned = np.abs((loaded.quats * gaussians.quats).sum(1))
    assert aligned.min() > 1 - 1e-5


def test_higher_bands_lie_channel_by_channel(tmp_path):
    bands = np.random.default_rng(2).integers(0, 256, (5, 9)).astype(np.uint8)
    bands[0, :2] = 0, 255
    gaussians = some(5, 1)
    (tmp_path / "c.ply").write_bytes(compressed(gaussians, np.full((5, 3), 0.5), np.full(5, 0.5), bounded=False, bands=bands))
    sh = load_ply(tmp_path / "c.ply").sh
    assert sh.shape == (5, 4, 3) and sh[0, 1, 0] == -4 and sh[0, 2, 0] == 4
    np.testing.assert_allclose(sh[:, 1:].transpose(0, 2, 1).reshape(5, 9), bands / 255 * 8 - 4, atol=4 / 255)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (b"property float min_x", b"property float tin_x", "element chunk has no property min_x"),
        (b"property uint packed_scale", b"property uint packed_skill", "element vertex has no property packed_scale"),
        (b"property float min_b", b"property float tin_b", "no property min_b"),
        (b"element chunk 2", b"element chunk 1", "1 chunks for 300 vertices"),
    ],
)
def test_refusals_name_the_element(tmp_path, old, new, says):
    rng = np.random.default_rng(3)
    raw = compressed(some(300, 1), rng.random((300, 3)), rng.random(300), bounded=True)
    (tmp_path / "c.ply").write_bytes(raw.replace(old, new))
    with pytest.raises(PlyError, match=says):
        load_ply(tmp_path / "c.ply")
