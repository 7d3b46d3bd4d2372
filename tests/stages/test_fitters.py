"""How many processes fit a scene: one a core, never more than rooms, none where they would not help."""

import jax
import pytest

from wm.stages import fitters
from wm.stages.fitters import worker_count


@pytest.mark.parametrize(
    ("asked", "cores", "rooms", "expected"),
    [
        (None, 2, 6, 2),
        (None, 16, 6, 6),
        (None, 1, 6, 0),  # one core has nothing to share
        (None, 8, 1, 0),  # nor have the cores of one room
        (0, 2, 6, 0),
        (1, 2, 6, 1),
        (4, 2, 6, 4),
        (9, 2, 6, 6),
        (2, 2, 0, 0),
    ],
)
def test_as_many_as_asked_for_but_no_more_than_rooms(monkeypatch, asked, cores, rooms, expected):
    monkeypatch.setattr(fitters, "cores", lambda: cores)
    assert worker_count(asked, rooms) == expected


def test_none_on_an_accelerator(monkeypatch):
    monkeypatch.setattr(jax, "default_backend", lambda: "gpu")
    assert worker_count(None, 6) == worker_count(2, 6) == 0
