"""Every setting says what it may hold, and the command line and Python callers are held to the same."""

import dataclasses
import math
import re
from collections.abc import Iterator
from operator import attrgetter
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.artifacts.digests import identity
from wm.bounds import Bounds, check_settings, choice, number, setting
from wm.run import load_config
from wm.schema import BESIDE, RunConfig
from wm.splat.optimization.checks import check_fit
from wm.splat.rasterizer.checks import check_raster
from wm.validate import ConfigError, validate_config


def settings_of(record: Any, prefix: str = "") -> Iterator[tuple[str, dataclasses.Field, Any]]:
    """Key, field and value of every setting of a record and of the records that it holds."""
    for field in dataclasses.fields(record):
        value = getattr(record, field.name)
        if dataclasses.is_dataclass(value):
            yield from settings_of(value, f"{prefix}{field.name}.")
        else:
            yield f"{prefix}{field.name}", field, value


CONFIG = load_config(["+scene=gothic"])
SETTINGS = {key: (field, value) for key, field, value in settings_of(CONFIG)}
BOUNDED = {key: field.metadata["bounds"] for key, (field, _) in SETTINGS.items() if "bounds" in field.metadata}
WHOLE = {int: True, int | None: True, float: False, float | None: False}
"""The types of numbers, and whether they are integers."""
ENGINE = {"raster": (check_raster, "settings"), "fit": (check_fit, "fit")}
"""The records that the splat engine checks, how, and what it calls them."""
OF_ENGINE = [key for key in BOUNDED if key.partition(".")[0] in ENGINE]


def holder(key: str) -> tuple[Any, str]:
    """The record that has a setting, and its name there."""
    path, _, name = key.rpartition(".")
    return (attrgetter(path)(CONFIG) if path else CONFIG), name


def with_value(record: Any, key: str, value: Any) -> Any:
    """A record with one value changed, which may be of a type that its constructor would not take."""
    head, _, rest = key.partition(".")
    record = dataclasses.replace(record)
    object.__setattr__(record, head, with_value(getattr(record, head), rest, value) if rest else value)
    return record


@st.composite
def refused(draw: st.DrawFn, keys: tuple[str, ...]) -> tuple[str, Any]:
    """The key of a number, and one that it must not be."""
    key = draw(st.sampled_from(keys))
    bounds = BOUNDED[key]
    if bounds.whole:
        return key, draw(st.integers(max_value=int(bounds.low) - 1) | st.integers(min_value=int(bounds.high) + 1))
    above = st.floats(min_value=bounds.high, exclude_min=not bounds.below)
    return key, draw(st.floats(max_value=bounds.low, exclude_max=True) | above | st.just(math.nan))


def test_every_number_has_bounds_of_its_kind_and_nothing_else_has():
    numbers = {key: WHOLE[field.type] for key, (field, _) in SETTINGS.items() if field.type in WHOLE}
    assert {key: bounds.whole for key, bounds in BOUNDED.items()} == numbers


def test_defaults_and_the_ends_of_a_range_are_allowed():
    for key, bounds in BOUNDED.items():
        assert bounds.low < bounds.high and bounds.allow(SETTINGS[key][0].default), key
        assert bounds.allow((int if bounds.whole else float)(bounds.low)), key
        assert bounds.allow(bounds.high) is not bounds.below, key
    assert all(field.default in field.metadata["options"] for field, _ in SETTINGS.values() if "options" in field.metadata)


def test_every_setting_says_in_a_sentence_what_it_is_for():
    assert [key for key, (field, _) in SETTINGS.items() if not re.fullmatch(r"[A-Z].+\.", field.metadata["help"])] == []


@given(refused(tuple(BOUNDED)))
def test_the_configuration_and_a_record_refuse_the_same_numbers(wrong):
    key, value = wrong
    with pytest.raises(ConfigError, match=re.escape(f"{key}={value!r}: must be a number from {BOUNDED[key].span}")):
        validate_config(with_value(CONFIG, key, value))
    record, name = holder(key)
    said = f"it.{name} is {value!r}; a number in {BOUNDED[key].interval} would be right"
    with pytest.raises(ValueError, match=re.escape(said)):
        check_settings("it", with_value(record, name, value))


@given(refused(tuple(OF_ENGINE)))
def test_the_engine_refuses_what_the_configuration_refuses(wrong):
    key, value = wrong
    record, name = holder(key)
    check, label = ENGINE[key.partition(".")[0]]
    with pytest.raises(ValueError, match=re.escape(f"{label}.{name} is {value!r}; ")):
        check(with_value(record, name, value))


@pytest.mark.parametrize("key", [key for key in OF_ENGINE if ".alpha_" not in key])  # which are held against each other
def test_the_engine_takes_all_that_the_configuration_takes(key):
    bounds, (record, name) = BOUNDED[key], holder(key)
    for value in (bounds.low, math.nextafter(bounds.high, bounds.low) if bounds.below else bounds.high):
        value = type(getattr(record, name))(value)
        validate_config(with_value(CONFIG, key, value))
        ENGINE[key.partition(".")[0]][0](with_value(record, name, value))


@pytest.mark.parametrize("value", [True, "3", None, math.inf, math.nan, 3j, [3]])
@pytest.mark.parametrize("whole", [False, True])
def test_what_is_no_number_is_never_allowed(value, whole):
    assert not Bounds(low=0, high=5, whole=whole).allow(value)


def test_an_integer_is_asked_for_where_only_integers_will_do():
    record = with_value(CONFIG.fit, "batch", 1.0)
    with pytest.raises(ValueError, match=re.escape("fit.batch is 1.0; an integer in [1, 1000] would be right")):
        check_fit(record)
    with pytest.raises(ConfigError, match=r"fit\.batch=1\.0: must be an integer from 1 to 1000"):
        validate_config(with_value(CONFIG, "fit.batch", 1.0))
    check_raster(with_value(CONFIG.raster, "blur", np.float32(0.5)))


def test_none_stands_for_a_number_only_where_it_means_something():
    validate_config(with_value(CONFIG, "workers", None))
    with pytest.raises(ConfigError, match="seed=None: must be"):
        validate_config(with_value(CONFIG, "seed", None))


def test_faults_are_found_in_records_of_any_class_that_a_configuration_holds():
    @dataclasses.dataclass(kw_only=True)
    class Inner:
        shape: str = choice("round", ("round", "flat"), "A shape.")

    @dataclasses.dataclass(kw_only=True)
    class Backend:
        name: str = setting("procedural", "A name.")
        size: float = number(0.5, 0, 1, "A size.", unit="m", below=True)
        inner: Inner = dataclasses.field(default_factory=Inner)

    config = with_value(CONFIG, "depth", Backend(size=1.0, inner=Inner(shape="square")))
    said = "depth.size=1.0: must be a number from 0 to below 1; depth.inner.shape='square': choose one of round, flat"
    with pytest.raises(ConfigError, match=f"^{re.escape(said)}$"):
        validate_config(config)


def test_a_number_that_changes_no_result_keeps_its_bounds():
    workers = {field.name: field for field in dataclasses.fields(RunConfig)}["workers"]
    assert BESIDE.items() <= workers.metadata.items() and "bounds" in workers.metadata
    assert "workers" not in identity(RunConfig())
