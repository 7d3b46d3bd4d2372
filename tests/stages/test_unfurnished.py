"""Rooms that stay empty are named, with what became of their drawings."""

import numpy as np

from tests.synth.lifting.scenes import bare
from wm.stages.unfurnished import unfurnished
from wm.synth.lifting.drawings import keep_drawing
from wm.types import SceneObject


def standing_in(room):
    return SceneObject(
        label="stool", room=room, support="floor", vertices=np.zeros((3, 3)), faces=np.array([[0, 1, 2]], np.int32),
        face_slot=np.zeros(1, np.int32), slots=("dark_wood",), slot_colors=np.ones((1, 3), np.float32),
        T_world_object=np.eye(4), size=np.ones(3), emission=np.zeros(1, np.float32),
    )  # fmt: skip


def test_each_empty_room_is_named_with_its_reason(tmp_path):
    plan = bare().plan
    first, second = plan.rooms[0], plan.rooms[1]
    lines = unfurnished(tmp_path, plan, [])
    assert lines == [f"{first.name}, {second.name} without furniture: the depth of none of its drawings fits the empty room"]
    keep_drawing(tmp_path, f"{first.id}/furnish1", first.name, np.zeros((4, 4, 3), np.uint8))
    assert [line.partition(" without")[0] for line in unfurnished(tmp_path, plan, [])] == [second.name, first.name]
    assert "nothing was found" in unfurnished(tmp_path, plan, [standing_in(1)])[0]
    assert unfurnished(tmp_path, plan, [standing_in(0), standing_in(1)]) == []
