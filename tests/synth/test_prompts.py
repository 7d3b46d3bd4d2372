"""Prompts carry what they were given."""

from wm.geometry import parse_plan
from wm.synth.prompts import PLAN_SAMPLE, image_prompt, plan_prompt


def test_image_prompt_names_theme_room_and_sights():
    text = image_prompt("a moss castle", "library", ["a doorway to the hall"])
    assert "a moss castle" in text and "library" in text and "a doorway to the hall" in text


def test_image_prompt_speaks_of_a_second_picture_only_where_there_is_one():
    assert "second picture" in image_prompt("x", "hall")
    assert "second picture" not in image_prompt("x", "hall", has_reference=False)


def test_image_prompt_says_what_the_guide_shows_of_furniture():
    texts = {objects: image_prompt("x", "hall", objects=objects) for objects in ("textured", "boxes", "none")}
    assert "exactly where the guide shows it" in texts["textured"]
    assert "box" in texts["boxes"] and "empty" in texts["none"]
    assert all("exactly where the guide shows it" not in texts[objects] for objects in ("boxes", "none"))


def test_plan_prompt_lists_rooms_and_violations():
    text = plan_prompt("a moss castle", ["hall", "bedroom", "bedroom"], ["room hall: unreachable: no doors"])
    assert text.count("- bedroom") == 2 and "- room hall: unreachable: no doors" in text
    assert "broke these rules" not in plan_prompt("a moss castle", ["hall"])


def test_the_sample_that_models_are_shown_is_valid():
    assert [room.id for room in parse_plan(PLAN_SAMPLE).rooms] == ["hall", "kitchen"]
    assert PLAN_SAMPLE in plan_prompt("x", ["hall"])
