"""The offline objects backend on a plan of two rooms."""

import json

import numpy as np
import pytest

from wm.geometry import build_structure, interior_polygon, parse_plan
from wm.offline.objects.generator import Settings
from wm.synth.backends import SceneContext
from wm.synth.registry import make_backend

PLAN = {
    "metadata": {"units": "meters", "coordinate_system": "z_up", "wall_thickness": 0.15, "default_ceiling_height": 2.8},
    "rooms": [
        {
            "id": "a", "name": "living room", "floor_polygon": [[0, 0], [5, 0], [5, 4], [0, 4]], "ceiling_height": 2.8,
            "openings": [
                {"type": "door", "wall_segment": [[5, 0], [5, 4]], "position": 2.5, "width": 0.9,
                 "height": 2.1, "sill_height": 0},
                {"type": "window", "wall_segment": [[0, 0], [5, 0]], "position": 1, "width": 1.5,
                 "height": 1.2, "sill_height": 0.9},
            ],
        },
        {"id": "b", "name": "bathroom", "floor_polygon": [[5, 0], [8, 0], [8, 4], [5, 4]], "ceiling_height": 2.8, "openings": []},
    ],
    "objects": [],
}  # fmt: skip


def context(seed=0, theme="gothic mansion", density=1.0):
    plan = parse_plan(json.dumps(PLAN))
    return SceneContext(theme=theme, seed=seed, plan=plan, structure=build_structure(plan), objects=(), density=density)


def furnish(scene, room):
    return make_backend("objects", Settings(), scene).furnish(scene, room)


def test_objects_are_world_space_records_of_their_room():
    scene = context()
    for room in (0, 1):
        objects = furnish(scene, room)
        x0, y0, x1, y1 = interior_polygon(scene.plan, room).bounds
        assert len(objects) >= 4
        for thing in objects:
            assert thing.room == room and len(thing.slots) == len(thing.slot_colors) == len(thing.emission)
            local = (thing.vertices - thing.T_world_object[:3, 3]) @ thing.T_world_object[:3, :3]
            assert np.allclose(local.max(0) - local.min(0), thing.size) and abs(local[:, 2].min()) < 1e-9
            assert thing.vertices[:, 0].min() > x0 and thing.vertices[:, 0].max() < x1
            assert thing.vertices[:, 1].min() > y0 and thing.vertices[:, 1].max() < y1


def test_the_theme_and_the_seed_change_the_room_and_nothing_else_does():
    same = [b"".join(o.vertices.tobytes() for o in furnish(context(), 0)) for _ in range(2)]
    assert same[0] == same[1]
    for other in (context(seed=1), context(theme="minimalist loft")):
        assert b"".join(o.vertices.tobytes() for o in furnish(other, 0)) != same[0]


def test_the_room_type_chooses_the_furniture():
    scene = context()
    assert "toilet" in {o.label for o in furnish(scene, 1)} and "toilet" not in {o.label for o in furnish(scene, 0)}


def test_the_context_s_density_decides_how_much_there_is():
    counts = [sum(len(furnish(context(seed, density=share), 0)) for seed in range(3)) for share in (0.0, 0.5, 1.0)]
    assert counts[0] < counts[1] < counts[2]


def test_a_density_out_of_range_is_refused():
    with pytest.raises(ValueError, match=r"furnish\.density is 1\.5"):
        furnish(context(density=1.5), 0)
