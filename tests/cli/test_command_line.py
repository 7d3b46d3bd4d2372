"""What people type arrives as they typed it, whatever form it is typed in, and what is wrong is said in one line."""

import re

import pytest
from hydra._internal.utils import get_args_parser
from hydra.core.override_parser.overrides_parser import OverridesParser
from hypothesis import example, given, settings
from hypothesis import strategies as st
from omegaconf import OmegaConf

from wm.cli.command_line import FLAGS, HYDRA_FLAGS, OWN_ANSWERS, literal, quoted, scene_name, translated
from wm.run import load_config
from wm.validate import ConfigError

PARSER = OverridesParser.create()
PRINTABLE = st.text(st.characters(exclude_categories=["C"]), max_size=60)
TRICKY = st.text("ab'\"\\${}[]()<>#=:;,@!%~+|&^* ", max_size=20)  # what shells, Hydra and OmegaConf take for their own
TEXTS = PRINTABLE | TRICKY
ROOMS = st.lists(TEXTS.map(lambda text: text.replace(",", "").strip()).filter(bool), max_size=6)


def arrived(*arguments: str) -> dict:
    """The scene that Hydra and OmegaConf make of arguments, also when a sweeper has written them once more."""
    config = OmegaConf.create({"scene": {"theme": "", "rooms": []}})
    for argument in translated(arguments):
        override = PARSER.parse_override(argument)
        again = PARSER.parse_override(f"{override.get_key_element()}={override.get_value_element_as_str()}")
        assert again.value() == override.value()
        OmegaConf.update(config, override.key_or_group, override.value())
    resolved = OmegaConf.to_container(config, resolve=True)
    assert isinstance(resolved, dict)
    return resolved["scene"]


def hydras(text: str) -> bool:
    """Whether the text could be a form that stays Hydra's in scene.theme=."""
    bare = text.strip()
    return "${" in text or (len(bare) > 1 and bare[0] == bare[-1] and bare[0] in "'\"") or bool(re.match(r"[a-z]+\(.*\)$", bare))


@settings(max_examples=100, deadline=None)
@given(TEXTS)
@example("${scene.name} \\${x} \\\\")
@example("it's \\")
@example("two\nlines\tof 'text'")
def test_a_theme_after_its_flag_arrives_whatever_it_is(text):
    assert arrived(f"--theme={text}")["theme"] == text


@settings(max_examples=100, deadline=None)
@given(TEXTS)
@example("'tis oak, 'twas brass")
@example("[a, b]")
@example("null")
def test_a_theme_in_an_override_arrives_as_typed_unless_it_is_one_of_hydras_forms(text):
    if not hydras(text):
        assert arrived(f"scene.theme={text}")["theme"] == text
        assert arrived(f"++scene.theme={text}")["theme"] == text


@settings(max_examples=100, deadline=None)
@given(ROOMS)
def test_rooms_arrive_in_order_whatever_their_names_are(rooms):
    assert arrived("--rooms", ", ".join(rooms))["rooms"] == rooms
    plain = [room for room in rooms if not hydras(room) and not re.search(r"""^['"\[]|['"\]]$""", room)]
    assert arrived(f"scene.rooms={', '.join(plain)}")["rooms"] == plain
    assert arrived(f"scene.rooms=[{','.join(plain)}]")["rooms"] == plain


@settings(max_examples=15, deadline=None)
@given(TEXTS.filter(str.strip), ROOMS.filter(bool))
def test_words_arrive_in_the_configuration(theme, rooms):
    config = load_config(["--theme", theme, "--rooms", ",".join(rooms)])
    assert (config.scene.theme, config.scene.rooms) == (theme, rooms)
    if not hydras(theme):
        assert load_config([f"scene.theme={theme}", "--rooms", ",".join(rooms)]) == config


@pytest.mark.parametrize(
    "forms",
    [
        (["gothic", "seed=3", "preset=draft"], ["--seed", "3", "+scene=gothic", "--preset=draft"]),
        (
            ["--theme", "a children's library, bright", "--rooms", "hall, kitchen, bedroom"],
            ["scene.theme=a children's library, bright", "scene.rooms=hall, kitchen, bedroom"],
            [r"scene.theme='a children\'s library, bright'", "scene.rooms=['hall',\"kitchen\", bedroom]"],
            ["--name=a_childrens_library_bright", 'scene.theme="a children\'s library, bright"', "--rooms=hall,kitchen,bedroom,"],
        ),
        (["gothic", "--plan", "(b), c's.json"], ["gothic", "plan.file=(b), c's.json"], ["gothic", r"plan.file='(b), c\'s.json'"]),
        (["gothic", "--output", "runs/${preset}, new"], ["gothic", "output=runs/${preset}, new"]),
        (["gothic", "--output", "maison d'été #2=a"], ["gothic", "output=maison d'été #2=a"]),
    ],
)  # fmt: skip
def test_every_form_is_the_same_run(forms):
    first, *others = map(load_config, forms)
    assert all(other == first for other in others)


@pytest.mark.parametrize(
    "argument",
    [
        "scene.theme='a snug cabin'",
        'scene.theme="oak, brass"',
        "scene.theme=choice(oak,brass)",
        "scene.theme='oak','brass, old'",
        "scene.rooms=[a,b],[c]",
        "scene.rooms=choice([a,b],[c])",
        "scene.rooms=${other.rooms}",
        "plan.file=a.json,b.json",
        "plan.file=null",
        "output='runs/${preset}'",
        "output=runs/${preset}",
        "output=choice(a,b)",
        "fit.steps=1,2",
        "+scene=gothic,scandinavian",
        "~plan.file",
        "hydra.run.dir=/x",
    ],
)
def test_forms_of_hydra_stay_as_they_are_in_a_sweep(argument):
    assert translated(["-m", argument]) == [argument, "-m"]


def test_an_interpolation_in_words_stays_one():
    assert load_config(["gothic", "scene.theme=oak, and ${scene.rooms.0}'s brass"]).scene.theme == "oak, and great hall's brass"


def test_brackets_with_names_that_hydra_quotes():
    assert translated(["scene.rooms=['a, b', children's room,\"c\"]"]) == [r"scene.rooms=['a, b','children\'s room'," + '"c"]']
    assert translated(["scene.rooms=[]"]) == ["scene.rooms=[]"]


def test_the_flags_of_hydra_are_all_known_with_their_values():
    actions = [action for action in get_args_parser()._actions if action.option_strings]
    wants = {
        flag: None if action.nargs == 0 else tuple(action.choices or ()) for action in actions for flag in action.option_strings
    }
    assert {flag: values for flag, values in wants.items() if flag not in OWN_ANSWERS} == HYDRA_FLAGS
    assert not set(FLAGS) & {*wants, *OWN_ANSWERS}


@pytest.mark.parametrize("flags", [["--cfg", "job", "-cd", "mine"], ["--info", "searchpath"], ["--info"], ["-m", "-cd=mine"]])
def test_flags_of_hydra_stand_anywhere_and_their_values_are_no_scenes(flags):
    for arguments in ([*flags, "gothic", "--seed=1"], ["gothic", *flags, "seed=1"], ["gothic", "--seed", "1", *flags]):
        made = translated(arguments)
        assert made == ["+scene=gothic", "seed=1", *flags]
        assert get_args_parser().parse_args(made).overrides == ["+scene=gothic", "seed=1"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--sed", "3"], "--sed: no such flag; did you mean --seed"),
        (["--theme"], "--theme lacks its value: write --theme TEXT"),
        (["--theme", "--rooms", "a"], "--theme lacks its value"),
        (["--config-dir"], "--config-dir lacks its value"),
        (["--cfg", "jobs"], "--cfg jobs: choose one of job, hydra, all"),
        (["--info=everything"], "--info everything: choose one of all, config"),
        (["gothic", "draft"], "'draft': the scene is 'gothic' already; settings are KEY=VALUE"),
        (["--theme", "a", "snug", "cabin"], "text of several words is quoted"),
        (["a snug cabin"], "'a snug cabin': no name of a scene; a theme in words is --theme"),
        (["seed", "2"], "seed: write seed=VALUE; `wm --help seed`"),
        (["fit.steps", "2"], "fit.steps: write fit.steps=VALUE"),
        (["-x"], "-x: no such flag"),
        (["gothic", "-m", "--cfg=job"], "-m and --cfg=job ask for different things"),
    ],
)
def test_what_is_wrong_is_said_in_a_line_with_what_is_right(arguments, said):
    with pytest.raises(ConfigError, match=said) as caught:
        translated(arguments)
    assert "\n" not in str(caught.value)


@settings(max_examples=100, deadline=None)
@given(st.text(max_size=200))
def test_a_scenes_name_is_safe_short_and_settled(theme):
    name = scene_name(theme)
    assert re.fullmatch(r"[a-z0-9][a-z0-9_]{0,47}", name)
    assert name == scene_name(theme)


@pytest.mark.parametrize(
    ("theme", "name"),
    [
        ("a children's library, bright", "a_childrens_library_bright"),
        ("gemütliche Hütte", "gemutliche_hutte"),
        ("Straße", "strasse"),
        ("x" * 60, "x" * 48),
        ("one two three four five six seven eight nine ten eleven", "one_two_three_four_five_six_seven_eight_nine_ten"),
    ],
)
def test_a_scenes_name_is_the_words_of_its_theme(theme, name):
    assert scene_name(theme) == name


def test_themes_without_latin_letters_have_names_of_their_own():
    assert len({scene_name(theme) for theme in ("ラーメン屋", "寿司屋", "", "!")}) == 4


@settings(max_examples=100, deadline=None)
@given(TEXTS)
def test_quoting_is_what_hydra_reads_back(text):
    assert PARSER.parse_override(f"key={quoted(text)}").value() == text
    assert OmegaConf.create({"a": PARSER.parse_override(f"key={literal(text)}").value()}).a == text
