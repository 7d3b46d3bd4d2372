"""Prompts carry what they were given, and do not contradict it."""

from wm.synth.prompts import furnish_prompt, image_prompt


def test_prompts_name_theme_room_and_sights():
    for prompt in (image_prompt, furnish_prompt):
        text = prompt("a moss castle", "library", ["a doorway on the left"])
        assert "a moss castle" in text and "library" in text and "In view: a doorway on the left." in text
        assert "In view" not in prompt("a moss castle", "library")


def test_prompts_speak_of_a_second_picture_only_where_there_is_one():
    for prompt in (image_prompt, furnish_prompt):
        assert "second picture" in prompt("x", "hall", has_reference=True)
        assert "second picture" not in prompt("x", "hall", has_reference=False)


def test_image_prompt_says_what_the_guide_shows_of_furniture():
    texts = {objects: image_prompt("x", "hall", objects=objects) for objects in ("textured", "boxes", "none")}
    assert "exactly where the guide shows it" in texts["textured"]
    assert "box" in texts["boxes"] and "empty" in texts["none"]
    assert all("exactly where the guide shows it" not in texts[objects] for objects in ("boxes", "none"))


def test_no_prompt_both_asks_for_furniture_and_forbids_it():
    for text in (image_prompt("x", "hall", objects="none"), furnish_prompt("x", "hall", has_reference=True)):
        assert "Furnish" in text and "take no object" not in text
    assert "take no object" in image_prompt("x", "hall", objects="textured")
