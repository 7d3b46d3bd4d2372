"""Laws of colour: round trips, and a tone curve that is monotone, bounded and faithful below its shoulder."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wm.color import LUMINANCE, to_linear, to_srgb
from wm.offline.world.tone import adapted, tone


@given(st.floats(0, 1))
def test_srgb_round_trip(x):
    np.testing.assert_allclose(to_srgb(to_linear(np.array([x]))), x, atol=1e-6)


def test_tone_is_monotone_bounded_and_faithful():
    radiance = np.linspace(0, 50, 20001).astype(np.float32)
    shown = tone(radiance)
    assert np.all(np.diff(shown) >= -np.finfo(np.float32).eps)  # expm1 and power round either way in the last place
    assert shown.max() <= 1
    below = radiance <= 0.5
    np.testing.assert_allclose(shown[below], to_srgb(radiance[below]), atol=1e-6)


@given(st.floats(0.0, 1.0))
def test_an_eye_gets_used_to_a_share_of_the_cast_and_to_nothing_of_the_brightness(share):
    light = np.random.default_rng(0).uniform(0.2, 0.6, (50, 1)).astype(np.float32)
    grey, warm = np.tile(light, 3), light * np.array([1.6, 0.9, 0.4], np.float32)
    np.testing.assert_allclose(adapted(grey, grey.mean(axis=0), share), grey, rtol=1e-5)
    seen = adapted(warm, warm.mean(axis=0), share)
    np.testing.assert_allclose((seen @ LUMINANCE).mean(), (warm @ LUMINANCE).mean(), rtol=1e-5)
    before, after = (np.log(x.mean(axis=0) / x.mean(axis=0)[1]) for x in (warm, seen))
    np.testing.assert_allclose(after, (1 - share) * before, atol=1e-4)
