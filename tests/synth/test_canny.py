"""Our Canny is OpenCV's to the pixel, and depth edges do not depend on depth's scale and shift.

fixtures/canny_opencv.npz: images and what OpenCV 5.0.0 (opencv-python-headless) `Canny(image, 25.5, 76.5)` ("edges") and
`Canny(image, 12.75, 153)` ("strict") make of them; noise, steps, waves, a ramp, one row, one pixel.
"""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.synth.canny import canny, depth_edges, normalized_depth

STORED = np.load(Path(__file__).parent / "fixtures" / "canny_opencv.npz")
NAMES = sorted(key.removeprefix("image_") for key in STORED if key.startswith("image_"))


@pytest.mark.parametrize("name", NAMES)
def test_equal_to_opencv(name):
    image = STORED[f"image_{name}"]
    np.testing.assert_array_equal(canny(image, low=0.1, high=0.3), STORED[f"edges_{name}"])
    np.testing.assert_array_equal(canny(image, low=0.05, high=0.6), STORED[f"strict_{name}"])


def canny_by_definition(image, low, high):
    """Pixel by pixel, from the definition in the module's docstring."""
    height, width = image.shape

    def at(array, i, j):
        return int(array[i, j]) if 0 <= i < height and 0 <= j < width else 0

    def gradient(i, j):
        p = [[int(image[min(max(i + a, 0), height - 1), min(max(j + b, 0), width - 1)]) for b in (-1, 0, 1)] for a in (-1, 0, 1)]
        gx = sum(w * (row[2] - row[0]) for w, row in zip((1, 2, 1), p))
        return gx, sum(w * (p[2][k] - p[0][k]) for k, w in enumerate((1, 2, 1)))

    g = {(i, j): gradient(i, j) for i in range(height) for j in range(width)}
    magnitude = np.array([[abs(g[i, j][0]) + abs(g[i, j][1]) for j in range(width)] for i in range(height)])
    ridge = set()
    for (i, j), (gx, gy) in g.items():
        m, x, y = magnitude[i, j], abs(gx), abs(gy) * 2**15
        if m <= int(255 * low):
            continue
        if y < 13573 * x:
            keep = m > at(magnitude, i, j - 1) and m >= at(magnitude, i, j + 1)
        elif y > 13573 * x + 2**16 * x:
            keep = m > at(magnitude, i - 1, j) and m >= at(magnitude, i + 1, j)
        else:
            s = -1 if (gx < 0) != (gy < 0) else 1
            keep = m > at(magnitude, i - 1, j - s) and m > at(magnitude, i + 1, j + s)
        if keep:
            ridge.add((i, j))
    found, front = set(), [p for p in ridge if magnitude[p] > int(255 * high)]
    while front:
        i, j = front.pop()
        if (i, j) not in found:
            found.add((i, j))
            front.extend((i + a, j + b) for a in (-1, 0, 1) for b in (-1, 0, 1) if (i + a, j + b) in ridge)
    return np.array([[(i, j) in found for j in range(width)] for i in range(height)])


@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.integers(1, 12), st.sampled_from([2, 40, 256]))
def test_equal_to_the_definition(seed, height, width, levels):
    image = np.random.default_rng(seed).integers(0, levels, (height, width)).astype(np.uint8) * np.uint8(255 // (levels - 1))
    np.testing.assert_array_equal(canny(image, low=0.1, high=0.3), canny_by_definition(image, 0.1, 0.3))


def rooms_depth(seed, shape=(40, 60)):
    """Slanted planes with steps between them, and some misses."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[: shape[0], : shape[1]]
    depth = 2 + 0.02 * x + 0.01 * y
    for _ in range(4):
        a, b, c = rng.uniform(-1, 1, 3)
        depth = depth + rng.uniform(0.3, 1.5) * (a * (x - 30) + b * (y - 20) > 10 * c)
    return depth.astype(np.float32), rng.uniform(size=shape) > 0.02


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.25, 1.0, 8.0]), st.sampled_from([-4.0, 0.0, 16.0]))
def test_scale_and_shift_do_not_matter(seed, scale, shift):
    depth, hit = rooms_depth(seed)
    exact = depth.astype(np.float64)
    here, there = (depth_edges(d, hit, low=0.1, high=0.3) for d in (exact, scale * exact + shift))
    assert here.any()
    np.testing.assert_array_equal(here, there)


def test_misses_stand_at_the_far_end_and_count_for_nothing():
    depth, hit = rooms_depth(3)
    wild = np.where(hit, depth, np.float32(1e37))
    broken = np.where(hit, depth, np.float32(np.nan))
    edges = depth_edges(depth, hit, low=0.1, high=0.3)
    np.testing.assert_array_equal(depth_edges(wild, hit, low=0.1, high=0.3), edges)
    np.testing.assert_array_equal(depth_edges(broken, np.ones_like(hit), low=0.1, high=0.3), edges)
    assert (normalized_depth(wild, hit)[~hit] == 255).all()


@pytest.mark.parametrize("hit", [True, False])
def test_depth_without_a_range_has_no_edges(hit):
    assert not depth_edges(np.full((5, 6), 3.0), np.full((5, 6), hit), low=0.1, high=0.3).any()
