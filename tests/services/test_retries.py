"""Retries: bounded in time, growing waits with jitter, as long as the service asks for, nothing but what can pass."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.services.faults import RefusedError, ServiceError, TransientError
from wm.services.retries import RetryPolicy, with_retries


class Clock:
    """Time that passes only while somebody sleeps."""

    def __init__(self):
        self.now, self.waits = 0.0, []

    def sleep(self, seconds: float) -> None:
        self.waits.append(seconds)
        self.now += seconds


def asked(faults, policy, clock, draw=lambda: 0.5):
    left = list(faults)

    def send():
        if left:
            raise left.pop(0)
        return "answer"

    return with_retries(send, policy, "lab", sleep=clock.sleep, clock=lambda: clock.now, draw=draw)


@given(tries=st.integers(0, 30), u=st.floats(0, 1, exclude_max=True))
def test_waits_grow_up_to_the_longest_and_keep_within_the_patience(tries, u):
    policy, clock = RetryPolicy(first=1.0, longest=30.0, patience=200.0), Clock()
    try:
        assert asked([TransientError("503")] * tries, policy, clock, draw=lambda: u) == "answer"
    except ServiceError:
        assert clock.now + 30.0 > 200.0 - 30.0
    assert clock.now <= 200.0
    full = [min(30.0, 2.0**k) for k in range(len(clock.waits))]
    assert all(0.5 * most <= wait <= most for wait, most in zip(clock.waits, full))


def test_a_server_that_is_gone_for_ten_minutes_is_waited_for():
    clock = Clock()

    def send():
        if clock.now < 600:
            raise TransientError("connection refused")
        return "answer"

    assert with_retries(send, RetryPolicy(), "lab", sleep=clock.sleep, clock=lambda: clock.now, draw=lambda: 0.0) == "answer"
    assert len(clock.waits) < 40


def test_what_the_service_asks_for_is_waited():
    clock = Clock()
    assert asked([TransientError("429", after=17.0)], RetryPolicy(), clock) == "answer"
    assert clock.waits == [17.0]


def test_a_wait_beyond_the_patience_is_not_begun():
    clock = Clock()
    with pytest.raises(ServiceError, match=r"lab: no answer after 1 try in 0 s: 429, and asks to wait for 3600 s; .* kept"):
        asked([TransientError("429", after=3600.0)], RetryPolicy(patience=900.0), clock)
    assert clock.waits == []


@pytest.mark.parametrize("fault", [ServiceError("401"), RefusedError("blocked"), ValueError("x")])
def test_other_faults_are_not_tried_again(fault):
    clock = Clock()
    with pytest.raises(type(fault)):
        asked([fault], RetryPolicy(), clock)
    assert clock.waits == []
