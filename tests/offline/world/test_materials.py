"""Laws that every material keeps: physical albedo, no randomness, no detail finer than the footprint, its own colour."""

import dataclasses

import numpy as np
import pytest

from wm.offline.style.finish import MATERIALS, Finish
from wm.offline.world.materials import evaluate, flat_points

COLORS = ((0.6, 0.4, 0.3), (0.3, 0.2, 0.15), (0.7, 0.6, 0.4))


def square(n: int = 64, size: float = 1.6, footprint: float = 0.01):
    g = ((np.arange(n) + 0.5) * size / n).astype(np.float32)
    u, v = np.meshgrid(g, g)
    return flat_points(u.ravel(), v.ravel(), footprint=footprint)


@pytest.mark.parametrize("name", MATERIALS)
def test_material_is_physical_and_repeatable(name):
    finish = Finish(name, COLORS, scale=0.2)
    points = square()
    surface, again = evaluate(points, finish, seed=4), evaluate(points, finish, seed=4)
    assert surface.albedo.shape == (3, 64 * 64)
    assert surface.albedo.dtype == np.float32
    assert np.isfinite(surface.albedo).all()
    assert surface.albedo.min() >= 0
    assert surface.albedo.max() <= 1
    assert np.all((np.asarray(surface.roughness) >= 0) & (np.asarray(surface.roughness) <= 1))
    assert np.abs(surface.height).max() < 0.05
    np.testing.assert_array_equal(surface.albedo, again.albedo)


@pytest.mark.parametrize("name", MATERIALS)
def test_material_fades_with_the_footprint(name):
    """Contrast between neighbouring samples at the spacing of the footprint falls as the footprint grows."""
    finish = Finish(name, COLORS, scale=0.06)
    fine = evaluate(square(footprint=0.005), finish, seed=4).albedo
    coarse = evaluate(square(footprint=0.3), finish, seed=4).albedo

    def detail(albedo: np.ndarray) -> float:
        return float(np.abs(np.diff(albedo.reshape(3, 64, 64), axis=2)).mean())

    assert detail(coarse) <= detail(fine) + 1e-4


@pytest.mark.parametrize("name", MATERIALS)
def test_one_colour_is_enough(name):
    surface = evaluate(square(16), Finish(name, COLORS[:1], scale=0.2), seed=1)
    assert np.isfinite(surface.albedo).all()


@pytest.mark.parametrize("name", ["plaster", "paint", "textile", "carpet", "concrete", "wood_planks", "terracotta"])
def test_material_keeps_its_colour_on_average(name):
    """A colour named by the style is the colour seen: within a third, whatever the pattern."""
    from wm.color import to_linear

    finish = dataclasses.replace(Finish(name, ((0.6, 0.5, 0.4),), scale=0.2), contrast=0.5)
    mean = evaluate(square(), finish, seed=2).albedo.mean(axis=1)
    np.testing.assert_allclose(mean, to_linear(np.array([0.6, 0.5, 0.4])), rtol=0.34)


def test_unknown_material_is_named():
    with pytest.raises(KeyError, match="unobtainium"):
        evaluate(square(4), Finish("unobtainium", COLORS), seed=0)
