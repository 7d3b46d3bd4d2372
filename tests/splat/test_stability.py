"""Every row of experiments/stability keeps its promise."""

import pytest

from tests.splat.stability import CASES


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.slow] * case.slow) for name, case in CASES.items()])
def test_the_promise_is_kept(name):
    case = CASES[name]
    errors = case.measure()
    assert errors.value <= case.value and errors.gradient <= case.gradient, errors
    assert errors.undecided <= 0.1, "rounding explains so many pixels that nothing is shown"
