"""Prompts in files: ours, a user's in their place, and what is said of files that cannot be used."""

import pytest

from wm.artifacts.digests import digest
from wm.models import prompt_files
from wm.models.image.nano_banana_pro import Settings
from wm.models.prompt_files import PromptError, Prompts
from wm.synth.registry import backend_key

OURS = """{#
About this place.

    theme   the scene in words
    sights  what is in view, a list of texts
#}
{% include "rules.md" %}
Place: {{ theme }}.
{% if sights %}
In view: {{ sights | join("; ") }}.
{% endif %}
"""


@pytest.fixture(autouse=True)
def shipped(tmp_path, monkeypatch):
    """Prompts of a family, and one that it shares with another."""
    folder = tmp_path / "shipped"
    (folder / "group" / "family").mkdir(parents=True)
    (folder / "group" / "family" / "place.md").write_text(OURS)
    (folder / "group" / "rules.md").write_text("Be exact.\n")
    monkeypatch.setattr(prompt_files, "PROMPTS", folder)
    return folder


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "mine").mkdir()
    return tmp_path / "mine"


def test_a_prompt_is_filled_in_with_what_it_includes():
    prompts = Prompts("group/family")
    assert prompts.write("place", theme="a mill", sights=[]) == "Be exact.\nPlace: a mill."
    assert prompts.write("place", theme="a mill", sights=["a door", "a window"]).endswith("In view: a door; a window.")


def test_values_are_put_in_as_they_are():
    text = '{{ 1 }} <b> & "x" {% endif %} ${y} é'
    assert f"Place: {text}." in Prompts("group/family").write("place", theme=text, sights=[])


def test_a_file_of_the_family_goes_before_one_that_it_shares(shipped):
    (shipped / "group" / "family" / "rules.md").write_text("Be quick.")
    assert Prompts("group/family").write("place", theme="x", sights=[]).startswith("Be quick.")


def test_a_file_of_the_users_takes_the_place_of_ours(folder):
    (folder / "rules.md").write_text("Be brief.")
    (folder / "notes.txt").write_text("not a prompt")
    assert Prompts("group/family", str(folder)).write("place", theme="x", sights=[]).startswith("Be brief.\nPlace: x.")
    (folder / "place.md").write_text("Only {{ theme }}")
    assert Prompts("group/family", str(folder)).write("place", theme="x", sights=[]) == "Only x"


@pytest.mark.parametrize(
    "name, text, fault",
    [
        ("place.md", "{% if sights %}{{ them }}{% endif %}", "place.md uses them; its variables are sights, theme"),
        ("rules.md", "{{ theme }}", "rules.md uses theme; its variables are none"),
        ("place.md", "a\n{% if %}", "place.md, line 2: "),
        ("palce.md", "x", "palce.md takes the place of no prompt of group/family; it has place.md, rules.md"),
        ("place.md", b"\xff", "place.md: cannot be read"),
        ("notes.txt", "x", r"\.prompts=.*mine: no file such as place\.md is there"),
    ],
)
def test_a_file_that_cannot_be_used_is_named_before_anything_is_asked(folder, name, text, fault):
    (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(PromptError, match=fault):
        Prompts("group/family", str(folder))


def test_a_folder_that_is_not_there_is_named(folder):
    with pytest.raises(PromptError, match=r"\.prompts=.*nowhere: no such folder"):
        Prompts("group/family", str(folder / "nowhere"))


@pytest.mark.parametrize("text", ["{{ theme / 2 }}", "{{ theme.strip.__globals__ }}", '{% include "other.md" %}'])
def test_a_prompt_that_cannot_be_filled_in_is_named(folder, text):
    (folder / "place.md").write_text(text)
    with pytest.raises(PromptError, match=r"place\.md: cannot be filled in"):
        Prompts("group/family", str(folder)).write("place", theme="x", sights=[])


@pytest.mark.parametrize("values", [{"theme": "x"}, {"theme": "x", "sights": [], "more": 1}])
def test_a_caller_gives_all_variables_and_no_others(values):
    with pytest.raises(ValueError, match=r"place\.md is not there with the variables"):
        Prompts("group/family").write("place", **values)


def test_the_caller_is_told_of_a_prompt_that_is_not_there():
    with pytest.raises(ValueError, match=r"family/door\.md is not there"):
        Prompts("group/family").write("door")


def test_a_changed_prompt_of_the_users_own_makes_stages_again(tmp_path):
    def key():
        return digest(*backend_key(Settings(prompts=str(tmp_path))))

    (tmp_path / "paint.md").write_text("A room.")
    first = key()
    assert key() == first
    (tmp_path / "paint.md").write_text("A bright room.")
    assert key() != first
