"""Several rooms at once: results in order, the first failure ends all, Ctrl-C waits for nobody."""

import os
import signal
import threading

import pytest

from wm.services.faults import TransientError
from wm.services.retries import RetryPolicy, with_retries
from wm.synth.backends import ImageRequest
from wm.synth.side_by_side import ImagesUntilStopped, RoomStoppedError, Turns, side_by_side


@pytest.mark.parametrize("at_once", [1, 2, 5, 50])
def test_results_are_in_order(at_once):
    assert side_by_side(lambda k: k * k, range(20), Turns(), at_once=at_once) == [k * k for k in range(20)]
    assert side_by_side(lambda k: k, (), Turns(), at_once=at_once) == []


def test_so_many_are_under_way_and_no_more():
    full, under_way, most, lock = threading.Barrier(3, timeout=30), [], [], threading.Lock()

    def work(k):
        with lock:
            under_way.append(k)
            most.append(len(under_way))
        full.wait()  # passes only if three are here
        with lock:
            under_way.remove(k)

    side_by_side(work, range(9), Turns(), at_once=3)
    assert max(most) == 3


def test_one_at_a_time_is_the_calling_thread():
    threads = side_by_side(lambda _: threading.current_thread(), range(3), Turns(), at_once=1)
    assert set(threads) == {threading.current_thread()}


def test_the_first_failure_is_raised_when_the_others_have_come_to_an_end():
    turns, both, failed, ended = Turns(), threading.Barrier(2, timeout=30), threading.Event(), []

    def work(k):
        if k == 0:
            both.wait()
            raise OSError("room 0")
        both.wait()
        while True:  # under way until it wants its next turn
            try:
                with turns.turn():
                    pass
            except RoomStoppedError:
                failed.set()
                ended.append(k)
                raise

    with pytest.raises(OSError, match="room 0"):
        side_by_side(work, range(9), turns, at_once=2)
    assert failed.is_set()
    assert ended == [1]  # no further one began


def test_a_failure_in_a_turn_is_raised():
    turns = Turns()

    def work(k):
        with turns.turn():
            raise ValueError(f"room {k}")

    with pytest.raises(ValueError, match="room "):
        side_by_side(work, range(4), turns, at_once=4)


def test_a_room_that_waits_to_send_again_ends_when_another_fails():
    """Without it a limit that one room reaches is said a quarter of an hour later, and requests are sent for nothing."""
    turns, waits, sent = Turns(), threading.Event(), []

    class Overloaded:
        def generate(self, request):
            return with_retries(self.send, RetryPolicy(first=60.0), "lab", waiting=lambda line: waits.set())

        def send(self):
            sent.append(1)
            raise TransientError("503")

    def work(k):
        if k == 0:
            waits.wait(30)
            raise OSError("room 0")
        ImagesUntilStopped(Overloaded(), turns).generate(object.__new__(ImageRequest))  # nobody reads it

    rooms = threading.Thread(target=lambda: failed.append(outcome(work, turns)), daemon=True)
    failed = []
    rooms.start()
    rooms.join(20)  # its first wait alone is 30 s or more
    assert failed == ["room 0"] and len(sent) == 1


def outcome(work, turns):
    try:
        side_by_side(work, range(2), turns, at_once=2)
    except OSError as error:
        return str(error)


def test_ctrl_c_waits_for_nobody_and_leaves_no_turn():
    turns, answered, under_way, refused = Turns(), threading.Event(), threading.Semaphore(0), threading.Event()

    def work(k):
        under_way.release()
        answered.wait()  # a request without an answer
        try:
            turns.check()
        except RoomStoppedError:
            refused.set()
            raise

    def interrupt():
        for _ in range(2):
            under_way.acquire()
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            side_by_side(work, range(2), turns, at_once=2)
        assert not answered.is_set()
        with pytest.raises(RoomStoppedError), turns.turn():
            pytest.fail("a turn after the end")
    finally:
        answered.set()
    assert refused.wait(30)
