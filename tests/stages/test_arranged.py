"""Rows of an objects.json: each wrong one is named, with what would be right."""

import json

import numpy as np
import pytest

from tests.geometry.plans import two_rooms
from tests.geometry.things import box
from wm.artifacts.digests import json_text
from wm.codecs import object_summary
from wm.stages.arranged import ArrangementError, arranged
from wm.synth.object_ids import with_ids

PLAN = two_rooms()
ROOMS = [room.id for room in PLAN.rooms]
OBJECTS = with_ids([box([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]), box([3.0, 1.0, 0.0], [4.0, 2.0, 1.0])], ROOMS)


def written() -> dict:
    return json.loads(json_text(object_summary(OBJECTS, ROOMS)))


def read(document) -> tuple:
    return arranged(OBJECTS, json.dumps(document).encode(), PLAN, "objects.json")


def test_what_is_unchanged_is_the_same_object():
    assert all(a is b for a, b in zip(read(written()), OBJECTS, strict=True))
    assert all(a is b for a, b in zip(read(written()["objects"]), OBJECTS, strict=True))


def test_ids_of_a_room_do_not_depend_on_other_rooms():
    first, second = (thing.id for thing in OBJECTS)
    assert first != second
    assert with_ids([OBJECTS[1]], ROOMS)[0].id == first


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"id": "throne"}, "'objects'"),
        ({"id": None}, "id is null"),
        ({"room": "attic"}, f"choices: {', '.join(ROOMS)}"),
        ({"support": "air"}, "choices: floor"),
        ({"label": ""}, "words"),
        ({"size": [1, 2]}, "three extents"),
        ({"size": [1, 0, 1]}, "above 0"),
        ({"size": [1, float("nan"), 1]}, "three extents"),
        ({"T_world_object": [[1, 2], [3, 4]]}, "4 x 4"),
        ({"T_world_object": (2 * np.eye(4)).tolist()}, "rigid"),
        ({"T_world_object": np.diag([-1.0, 1, 1, 1]).tolist()}, "rigid"),
        ({"T_world_object": np.diag([1e300, 1, 1, 1]).tolist()}, "rigid"),
        ({"support": "a" * 5000}, f'support is "{"a" * 76}...; choices'),
        ({"id": OBJECTS[1].id}, "appears twice"),
    ],
)
def test_a_wrong_row_is_named(change, says):
    document = written()
    document["objects"][0].update(change)
    with pytest.raises(ArrangementError, match=r"objects\.json: objects\[[01]\]") as caught:
        read(document)
    assert says in str(caught.value)


def test_what_is_no_list_of_rows_is_said():
    for text in (b"{", b"3", b'{"objects": 3}', b"\xff"):
        with pytest.raises(ArrangementError, match=r"objects\.json"):
            arranged(OBJECTS, text, PLAN, "objects.json")
