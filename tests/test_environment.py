"""What comes out of the environment is used as it is and shown as where it comes from."""

import json
import pickle

import pytest

from wm.artifacts.digests import digest
from wm.environment import EnvironmentText, environment_values, masked, shown, shown_identity
from wm.run import load_config
from wm.validate import ConfigError

KEY = "hunter2-very-secret"


@pytest.fixture(autouse=True)
def environment(monkeypatch):
    monkeypatch.setenv("WM_TEST_KEY", KEY)


def test_a_text_is_its_value_and_shows_its_source():
    text = EnvironmentText(KEY, "${oc.env:X}")
    assert text == KEY and f"{text}" == KEY and json.dumps(text) == json.dumps(KEY)
    assert repr(text) == "'${oc.env:X}'" and shown(text) == "${oc.env:X}" and shown("plain") == "plain"
    copy = pickle.loads(pickle.dumps(text))
    assert copy == KEY and copy.source == text.source
    assert digest(text) == digest(KEY)  # a stage's key goes by the value


def test_a_manifest_holds_the_source_and_still_tells_a_change():
    first, second = (shown_identity({"a": [EnvironmentText(value, "${oc.env:X}")]}) for value in (KEY, "other"))
    assert KEY not in json.dumps(first) and first != second
    assert all("${oc.env:X}" in json.dumps(one) for one in (first, second))


@pytest.mark.parametrize(
    "arguments",
    [
        ["scene.theme=${oc.env:WM_TEST_KEY}"],
        ["scene.theme='a ${variant} of ${oc.env:WM_TEST_KEY}'"],
        ["scene.theme=${plan.file}", "plan.file=${oc.env:WM_TEST_KEY}"],
    ],
)
def test_a_configuration_knows_which_of_its_texts_come_from_there(arguments):
    config = load_config(["+scene=gothic", *arguments])
    assert KEY in config.scene.theme and KEY not in shown(config.scene.theme) and KEY not in repr(config)


def test_texts_that_are_the_users_own_are_shown():
    config = load_config(["+scene=gothic", "scene.theme='a ${variant} house'"])
    assert shown(config.scene.theme) == "a full house"


KEYS = ("fit.steps", "fit.init", "seed", "variant", "preset", "+scene", "image.backend", "scene.rooms")


@pytest.mark.parametrize("argument", KEYS)
def test_no_message_holds_it(argument):
    with pytest.raises(ConfigError) as caught:
        load_config(["+scene=gothic"] * (argument != "+scene") + [f"{argument}=${{oc.env:WM_TEST_KEY}}", "cameras.fov=0"])
    assert KEY not in str(caught.value) and caught.value.__cause__ is None


def test_short_values_are_masked_where_they_are_quoted(monkeypatch):
    monkeypatch.setenv("WM_TEST_KEY", "ab")
    values = environment_values(["${oc.env:WM_TEST_KEY}", "${oc.env:WM_TEST_UNSET,default}", "text"])
    assert masked("cab 'ab'", values) == "cab '${oc.env:WM_TEST_KEY}'"
