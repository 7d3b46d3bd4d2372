"""Furniture of the user's own stands where the plan says, and the generator keeps clear of it."""

import dataclasses

import numpy as np
import pytest
import shapely

from tests.geometry.mesh.test_scene_mesh import wedge
from tests.geometry.plans import two_rooms
from wm.geometry import MeshError, object_nodes, save_glb
from wm.geometry.exchange.plan_objects import plan_objects
from wm.geometry.plan.records import FloorPlan, PlanObject
from wm.offline.arrangement.furnishing import furnish_room
from wm.offline.style.theme import style_of

CHEST = PlanObject("chest", 0, (2.5, 2.0, 0.0), 30.0, (1.6, 0.8, 0.9), None)


def listing(*things: PlanObject) -> FloorPlan:
    return dataclasses.replace(two_rooms(), objects=things)


def test_a_box_has_its_size_place_and_turn():
    (thing,) = plan_objects(listing(CHEST))
    local = (thing.vertices - thing.T_world_object[:3, 3]) @ thing.T_world_object[:3, :3]
    np.testing.assert_allclose([local.min(axis=0), local.max(axis=0)], [[-0.8, -0.4, 0], [0.8, 0.4, 0.9]], atol=1e-12)
    np.testing.assert_allclose(thing.T_world_object[:3, 3], CHEST.position)
    np.testing.assert_allclose(thing.T_world_object[:2, 0], [np.cos(np.pi / 6), 0.5], atol=1e-12)
    assert (thing.label, thing.room, thing.support) == ("chest", 0, "floor")


def test_a_mesh_file_is_stretched_to_the_size(tmp_path):
    save_glb(tmp_path / "thing.glb", object_nodes([wedge(0)]))
    own = dataclasses.replace(CHEST, mesh=str(tmp_path / "thing.glb"))
    (thing,) = plan_objects(listing(own))
    local = (thing.vertices - thing.T_world_object[:3, 3]) @ thing.T_world_object[:3, :3]
    np.testing.assert_allclose(np.ptp(local, axis=0), CHEST.size, atol=1e-6)
    with pytest.raises(MeshError):
        plan_objects(listing(dataclasses.replace(CHEST, mesh=str(tmp_path / "none.glb"))))


@pytest.mark.parametrize("seed", range(3))
def test_the_generator_fills_around_it(seed):
    plan = listing(CHEST)
    (own,) = plan_objects(plan)
    outline = shapely.convex_hull(shapely.multipoints(own.vertices[:, :2]))
    style = style_of("a plain cabin")
    around = furnish_room(plan, 0, style, seed=seed, around=(own,))
    assert len(around) >= 3

    def overlaps(things) -> list[str]:
        hulls = [
            (t.label, shapely.convex_hull(shapely.multipoints(t.vertices[:, :2])).intersection(outline).area)
            for t in things
            if t.support not in ("flat", "ceiling")
        ]
        return [label for label, area in hulls if area > 1e-6]

    assert not overlaps(around)
    assert furnish_room(plan, 0, style, seed=seed)  # without it, the middle of the room is anybody's
