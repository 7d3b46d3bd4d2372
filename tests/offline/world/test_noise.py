"""Laws of the noise: bounded, centred, continuous, repeatable, and gone where it is finer than the footprint."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.offline.world.noise import cells, edge, fbm, line, random_cells, visible

SEEDS = st.integers(0, 2**31 - 1)


def grid(n: int = 200, size: float = 20.0, offset: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    g = (np.linspace(0, size, n) + offset).astype(np.float32)
    x, y = np.meshgrid(g, g)
    return x.ravel(), y.ravel()


def noise(*coordinates: np.ndarray, seed: int) -> np.ndarray:
    """One octave of wavelength 1, seen at points without extent."""
    return fbm(coordinates, wavelength=1.0, octaves=1, footprint=0.0, seed=seed)


@given(SEEDS, st.floats(-1000, 1000))
def test_noise_is_bounded_centred_and_repeatable(seed, offset):
    x, y = grid(offset=offset)
    for value in (noise(x, y, seed=seed), noise(x, y, x * np.float32(0.3), seed=seed)):
        assert np.abs(value).max() < 2.5
        assert abs(value.mean()) < 0.1
        assert 0.15 < value.std() < 0.6
    np.testing.assert_array_equal(noise(x, y, seed=seed), noise(x.copy(), y.copy(), seed=seed))


@given(SEEDS)
def test_noise_is_continuous_across_cells(seed):
    x, y = grid(60, 6.0)
    step = np.float32(1e-3)
    assert np.abs(noise(x + step, y, seed=seed) - noise(x, y, seed=seed)).max() < 0.02
    assert np.abs(noise(x, y, y + step, seed=seed) - noise(x, y, y, seed=seed)).max() < 0.02


def test_seeds_differ():
    x, y = grid()
    a, b = noise(x, y, seed=1), noise(x, y, seed=2)
    assert abs(np.corrcoef(a, b)[0, 1]) < 0.1


@given(SEEDS, st.sampled_from([0.05, 0.1, 0.2, 0.4, 0.8, 1.6]))
def test_variance_falls_with_the_footprint_and_is_gone_at_the_wavelength(seed, footprint):
    x, y = grid(120, 8.0)
    fine = fbm((x, y), wavelength=1.0, octaves=4, footprint=footprint / 2, seed=seed).std()
    coarse = fbm((x, y), wavelength=1.0, octaves=4, footprint=footprint, seed=seed).std()
    assert coarse <= fine + 1e-6
    assert footprint < 1.0 or coarse == 0


@given(SEEDS, st.integers(0, 5000), st.integers(1, 5000))
def test_a_point_has_its_value_whatever_stands_beside_it(seed, first, count):
    x, y = grid(100, 9.0)
    every = fbm((x, y, y), wavelength=0.7, octaves=3, footprint=0.01, seed=seed)
    part = slice(first, first + count)
    alone = fbm((x[part], y[part], y[part]), wavelength=0.7, octaves=3, footprint=0.01, seed=seed)
    np.testing.assert_allclose(alone, every[part], atol=1e-6)


def test_more_points_than_one_array_are_compiled_for():
    x = np.linspace(0, 50, 140_000, dtype=np.float32)
    whole = noise(x, x, seed=4)
    np.testing.assert_allclose(whole[135_000:], noise(x[135_000:], x[135_000:], seed=4), atol=1e-6)
    assert noise(x[:0], x[:0], seed=4).shape == (0,)


def test_one_footprint_a_point_agrees_with_one_for_all():
    x, y = grid(50, 3.0)
    one = fbm((x, y), wavelength=0.5, octaves=3, footprint=0.15, seed=3)
    each = fbm((x, y), wavelength=0.5, octaves=3, footprint=np.full_like(x, 0.15), seed=3)
    np.testing.assert_allclose(one, each, atol=1e-6)


@given(st.floats(0.05, 1.0), st.floats(0.05, 0.9), st.floats(1e-3, 3.0))
def test_a_line_covers_its_share_at_any_footprint(period, share, footprint):
    x = (np.arange(2000) + 0.5).astype(np.float32) * np.float32(period / 100)  # 20 whole periods
    cover = line(x, period=period, width=share * period, footprint=footprint)
    assert cover.min() >= 0
    assert cover.max() <= 1
    assert cover.mean() == pytest.approx(share, abs=0.01)


def test_a_line_much_finer_than_the_footprint_is_its_mean():
    cover = line(np.linspace(0, 3, 500, dtype=np.float32), period=0.1, width=0.03, footprint=5.0)
    assert np.ptp(cover) < 0.01


def test_edges_and_visibility():
    np.testing.assert_allclose(edge(np.array([-1, 0, 1], np.float32), 0.1), [0, 0.5, 1])
    np.testing.assert_allclose(visible(1.0, np.array([0.25, 0.5, 0.75, 1.0, 2.0], np.float32)), [1, 1, 1 / 3, 0, 0], atol=1e-6)


@given(SEEDS)
def test_random_cells_are_uniform(seed):
    i, _ = cells(np.linspace(-50, 50, 5000, dtype=np.float32), 0.01)
    value = random_cells(i, -i, seed=seed)
    assert value.min() >= 0
    assert value.max() < 1
    assert value.mean() == pytest.approx(0.5, abs=0.03)
