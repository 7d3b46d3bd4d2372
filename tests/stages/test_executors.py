"""The executors of a configuration: each of its names makes one, for as many rooms at once as are asked for."""

import dataclasses
import threading

import pytest

from wm.host import cores
from wm.schema import RunConfig
from wm.stages.executors import EXECUTORS, room_executor, worker_count

NAMES = next(field.metadata["options"] for field in dataclasses.fields(RunConfig) if field.name == "executor")


def test_every_name_of_the_schema_makes_an_executor():
    assert tuple(EXECUTORS) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_as_many_tasks_run_at_once_as_asked_for(name):
    """Three tasks that wait for each other end, and a fourth has to wait for one of them."""
    meeting, begun = threading.Barrier(4), threading.Semaphore(0)

    def meet():
        begun.release()
        meeting.wait(timeout=60)

    with room_executor(name, 3) as executor:
        waiting = [executor.submit(meet) for _ in range(3)]
        for _ in waiting:
            assert begun.acquire(timeout=60)
        fourth = executor.submit(int)
        assert not fourth.running() and not fourth.done()
        meeting.wait(timeout=60)
        assert fourth.result(timeout=60) == 0


def test_one_room_per_core_unless_a_number_is_asked_for():
    assert worker_count(None) == cores()
    assert [worker_count(asked) for asked in (1, 5)] == [1, 5]
