"""Small changes stay small: what a room's draws depend on, and what they do not."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import random_plan
from wm.geometry import build_structure
from wm.offline.language.building import building_of
from wm.offline.language.grammar import Grammar
from wm.offline.language.programme import read_programme
from wm.schema import FinishConfig, FurnishConfig, LightConfig, PlanConfig, RunConfig
from wm.synth.backends import SceneContext
from wm.synth.seeds import PARTS, numbered_name, room_number, seed_of


@pytest.fixture(scope="module")
def plan():
    return random_plan(3, rooms=3)


def named(plan, names):
    return dataclasses.replace(plan, rooms=tuple(dataclasses.replace(room, name=name) for room, name in zip(plan.rooms, names)))


def test_a_room_in_front_leaves_the_numbers_of_others(plan):
    before, after = named(plan, ("bedroom", "kitchen", "bedroom")), named(plan, ("hall", "bedroom", "kitchen"))
    assert room_number(after, 1) == room_number(before, 0)
    assert room_number(after, 2) == room_number(before, 1)


def test_rooms_of_one_name_differ(plan):
    numbers = [room_number(named(plan, ("Bedroom", "bedroom", "bed_room")), room) for room in range(3)]
    assert len(set(numbers)) == 3


@given(st.text(max_size=20), st.integers(0, 50))
def test_a_number_seeds(name, before):
    number = numbered_name(name, before)
    assert 0 <= number < 2**32
    assert number == numbered_name(f"  {name.casefold()} ", before)


def test_every_part_has_the_seed_of_the_run_unless_it_has_its_own():
    assert [seed_of(RunConfig(seed=7), part) for part in PARTS] == [7, 7, 7, 7]
    own = RunConfig(
        seed=7, plan=PlanConfig(seed=1), furnish=FurnishConfig(seed=0), finish=FinishConfig(seed=3), light=LightConfig(seed=4)
    )
    assert [seed_of(own, part) for part in PARTS] == [1, 0, 3, 4]


def test_a_context_without_seeds_draws_from_its_own(plan):
    context = SceneContext(theme="", seed=5, plan=plan, structure=build_structure(plan), objects=(), seeds=(("finish", 2),))
    assert context.seed_of("finish") == 2
    assert context.seed_of("light") == 5


def test_words_that_say_nothing_of_the_building_leave_the_plan():
    def asked(theme):
        return Grammar().propose(theme, ["hall", "kitchen", "bedroom"], seed=2, violations=[], previous=None).text

    assert asked("gothic mansion") == asked("gothic mansion and a green sofa") == asked("Gothic mansion, in mauve")
    assert asked("gothic mansion") != asked("snug cabin")


def test_areas_of_rooms_do_not_depend_on_the_rooms_beside_them():
    few, many = (
        read_programme(rooms, building_of(""), np.random.default_rng(3))
        for rooms in (["kitchen", "bedroom"], ["hall", "kitchen", "study", "bedroom"])
    )
    assert {s.name: s.area for s in few}.items() <= {s.name: s.area for s in many}.items()
