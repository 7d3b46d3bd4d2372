"""Each imperfection is nothing at strength 0, its own at others, and the same for one seed."""

import numpy as np
import pytest

from wm.offline.image.imperfections import drifted, drifted_apart, exposed, softened, strayed

SHAPE = (48, 80)


def picture():
    return np.random.default_rng(0).uniform(0.2, 0.8, (*SHAPE, 3)).astype(np.float32)


SURFACES = np.repeat((np.arange(SHAPE[1]) > 40)[None].astype(np.int64), SHAPE[0], axis=0)
FLAWS = {
    "drifted": lambda image, amount, rng: drifted(image, amount, rng),
    "drifted_apart": lambda image, amount, rng: drifted_apart(image, SURFACES, amount, rng),
    "exposed": lambda image, amount, rng: exposed(image, amount, rng),
    "strayed": lambda image, amount, rng: strayed(image, SURFACES, 100 * amount, rng),
    "softened": lambda image, amount, rng: softened(image, 100 * amount),
}


@pytest.mark.parametrize("name", FLAWS)
def test_at_no_strength_the_image_is_as_it_was(name):
    np.testing.assert_array_equal(FLAWS[name](picture(), 0.0, np.random.default_rng(1)), picture())


@pytest.mark.parametrize("name", FLAWS)
def test_a_seed_gives_one_image_and_strength_makes_it_worse(name):
    def error(amount):
        a, b = (FLAWS[name](picture(), amount, np.random.default_rng(1)) for _ in range(2))
        np.testing.assert_array_equal(a, b)
        return np.abs(a - picture()).mean()

    assert 0 < error(0.05) < error(0.2)


def test_detail_strays_within_its_surface_only():
    image = np.where(SURFACES[..., None] == 0, np.float32(0.2), np.float32(0.9)).repeat(3, axis=-1)
    np.testing.assert_allclose(strayed(image, SURFACES, 60.0, np.random.default_rng(2)), image, atol=1e-6)


def test_exposure_is_one_gain_for_the_whole_image():
    ratio = exposed(picture(), 0.1, np.random.default_rng(3)) / picture()
    np.testing.assert_allclose(ratio, np.broadcast_to(ratio[:1, :1], ratio.shape), rtol=1e-5)
