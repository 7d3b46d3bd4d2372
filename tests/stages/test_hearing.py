"""Which words of a theme a run says that it used."""

import dataclasses
import types

import pytest

from wm.run import load_config
from wm.stages.hearing import told
from wm.synth import registry
from wm.synth.backends import HeardTheme
from wm.synth.registry import heard_theme


def config_of(theme, *overrides):
    return load_config(["scene.name=x", "scene.rooms=[hall]", f"scene.theme='{theme}'", *overrides])


def test_words_of_all_backends_are_told_in_the_order_of_the_theme():
    heard = heard_theme(config_of("gothic mansion, yellow walls, frobnicated"))
    assert heard == HeardTheme(used=("gothic", "mansion", "yellow walls"), idle=(), unknown=("frobnicated",))


def test_a_word_of_the_building_is_not_known_where_the_plan_is_given(tmp_path):
    heard = heard_theme(config_of("gothic mansion", f"plan.file={tmp_path / 'plan.json'}"))
    assert heard.unknown == ("mansion",)


def test_backends_that_cannot_tell_are_not_asked(monkeypatch):
    config = config_of("gothic")
    silent = types.SimpleNamespace()
    real = registry.backend_module
    monkeypatch.setattr(registry, "backend_module", lambda path: silent if "grammar" not in path else real(path))
    assert heard_theme(config).unknown == ()
    monkeypatch.setattr(registry, "backend_module", lambda path: silent)
    assert heard_theme(config) is None


@pytest.mark.parametrize(
    ("heard", "line"),
    [
        (HeardTheme(("igloo",)), "used igloo"),
        (HeardTheme(("igloo", "night"), ("modern",), ("frob",)), "used igloo, night; without effect: modern; not known: frob"),
        (HeardTheme((), (), ("frob",)), "no word used; not known: frob"),
    ],
)
def test_one_line(heard, line):
    assert told(heard) == line
    assert "\n" not in told(dataclasses.replace(heard, idle=("x",)))
