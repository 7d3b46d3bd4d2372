"""Laws of colour: round trips, and a tone curve that is monotone, bounded and faithful below its shoulder."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wm.synth.procedural.color import to_linear, to_srgb, tone


@given(st.floats(0, 1))
def test_srgb_round_trip(x):
    np.testing.assert_allclose(to_srgb(to_linear(np.array([x]))), x, atol=1e-6)


def test_tone_is_monotone_bounded_and_faithful():
    radiance = np.linspace(0, 50, 20001).astype(np.float32)
    shown = tone(radiance)
    assert np.all(np.diff(shown) >= 0)
    assert shown.max() <= 1
    below = radiance <= 0.5
    np.testing.assert_allclose(shown[below], to_srgb(radiance[below]), atol=1e-6)
