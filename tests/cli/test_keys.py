"""The keys that help and completion show are those that a run has, read without importing what they belong to."""

import dataclasses

import pytest

from tests.test_conf import CHOICES, leaves
from wm.cli.composition import CONF
from wm.cli.keys import choices_of, default_choices, sections_of
from wm.run import load_config, options
from wm.synth.registry import backend_module

DEFAULTS = default_choices(CONF)
WORDS = ("help", "bounds", "unit", "options")
LAB = """
import dataclasses
from wm.bounds import number
from wm.schema import BackendSettings

VERSION = "1"
make = print

@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    "Of a lab."

    backend: str = {module!r}
    tint: float = {declaration}
"""


def section_of(group: str, name: str, *folders):
    sections = sections_of(DEFAULTS | {group: name}, choices_of([CONF, *folders]))
    return next(section for section in sections if section.name == group)


def test_the_sections_hold_every_key_of_a_run_with_its_default():
    sections = list(sections_of(DEFAULTS, choices_of([CONF])))
    shown = {f"{section.name}.{key}".lstrip("."): section.defaults.get(key) for section in sections for key in section.keys}
    run = {key: value for key, value in leaves(load_config(["+scene=gothic"])).items() if not key.endswith(".backend")}
    assert set(shown) == set(run)
    for key, value in run.items():
        group = key.partition(".")[0]
        if group == "prices":  # a table of YAML
            continue
        if group == "scene":
            assert shown[key] is None
        elif group in CHOICES and isinstance(shown[key], str):  # as its YAML writes it
            assert type(value)(shown[key]) == value
        else:
            assert shown[key] == value


@pytest.mark.parametrize(("group", "name"), [(group, name) for group, names in CHOICES.items() for name in sorted(names)])
def test_settings_read_from_the_source_are_those_of_the_imported_record(group, name):
    section = section_of(group, name)
    alone = ("verify.enabled=false", "furnish.enabled=false")  # so that no other backend must go with it
    settings = getattr(load_config(["+scene=gothic", f"{group}={name}", *alone]), group)
    record = {field.name: field for field in dataclasses.fields(settings) if field.name != "backend"}
    assert [*section.keys] == [*record]
    for key, field in section.keys.items():
        assert field.default == record[key].default
        assert [field.metadata.get(word) for word in WORDS] == [record[key].metadata.get(word) for word in WORDS]
        said = section.defaults[key]
        assert (said if field.default is None else type(field.default)(said)) == getattr(settings, key)
    assert section.title == f"{group}={name}: {backend_module(settings.backend).Settings.__doc__.splitlines()[0].rstrip('.')}"


@pytest.mark.parametrize("declaration", ["number(0.5, 0, 1, 'Share of the tint.')", "number(1 / 2, 0, 1, 'Share of the tint.')"])
def test_settings_from_outside_are_read_too_and_imported_where_their_source_does_not_say_them(tmp_path, monkeypatch, declaration):
    module = "lab_said" if "/" not in declaration else "lab_computed"
    (tmp_path / "image").mkdir()
    (tmp_path / f"image/{module}.yaml").write_text(f"backend: {module}\ntint: 0.25 # less\n")
    (tmp_path / f"{module}.py").write_text(LAB.format(module=module, declaration=declaration))
    monkeypatch.syspath_prepend(tmp_path)
    section = section_of("image", module, tmp_path)
    assert section.title == f"image={module}: Of a lab"
    assert section.keys["tint"].metadata["help"] == "Share of the tint." and section.keys["tint"].default == 0.5
    assert dict(section.defaults) == {"tint": "0.25"}


def test_the_choices_are_the_files_of_conf():
    choices = choices_of([CONF])
    assert next(iter(choices)) == "scene"
    assert {group: tuple(names) for group, names in choices.items()} == {group: options(group) for group in choices}
    assert {"scene", "preset", "variant", "prices", *CHOICES} == set(choices)
    assert all(DEFAULTS[group] in choices[group] for group in choices if group != "scene")
