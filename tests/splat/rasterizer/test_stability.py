"""Every row of experiments/stability keeps its promise."""

import pytest

from tests.splat.stability import CASES


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_promise_is_kept(name):
    case = CASES[name]
    errors = case.measure()
    assert errors.value <= case.value and errors.gradient <= case.gradient, errors
    assert errors.undecided <= 0.1, "rounding explains so many pixels that nothing is shown"
