"""Laws of the records of experiments/splat_speed: what is written is read, and the gate knows worse from better."""

import dataclasses
import importlib.util
import io
import pathlib
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

PATH = pathlib.Path(__file__).parents[2] / "experiments/splat_speed/records.py"
spec = importlib.util.spec_from_file_location("splat_speed_records", PATH)
assert spec is not None and spec.loader is not None
records = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = records
spec.loader.exec_module(records)

numbers = st.floats(1e-3, 1e6).map(lambda x: float(f"{x:.4g}"))
words = st.text("abc, |\"'0", min_size=1, max_size=8)
some_records = st.builds(
    records.Record,
    figure=st.sampled_from(["memory", "rooms"]),
    case=words,
    key=words,
    value=numbers,
    unit=st.sampled_from(["", "ms", "GB"]),
    better=st.sampled_from(["lower", "higher"]),
    wanted=st.none() | numbers,
    margin=st.none() | st.floats(0.01, 0.5).map(lambda x: round(x, 2)),
)


@given(st.lists(some_records, max_size=5))
def test_what_is_written_is_read(found):
    file = io.StringIO()
    records.write(found, file)
    assert records.read(file.getvalue().splitlines()) == found


@given(some_records)
def test_nothing_is_worse_than_itself(record):
    assert records.worse([record], [record]) == []


@given(some_records, st.floats(0.01, 0.9))
def test_the_gate_allows_the_margin_and_no_more(record, share):
    record = dataclasses.replace(record, margin=share)
    sign = 1 if record.better == "lower" else -1
    for factor, lines in ((1 + 0.99 * sign * share, 0), (1 + 1.01 * sign * share, 1), (1 - 0.5 * sign * share, 0)):
        assert len(records.worse([dataclasses.replace(record, value=factor * record.value)], [record])) == lines


@pytest.mark.parametrize(("margin", "lines"), [(0.1, 1), (None, 0)])
def test_a_gated_figure_needs_a_baseline(margin, lines):
    record = records.Record(figure="memory", case="c", key="peak", value=1.0, unit="GB", better="lower", margin=margin)
    assert len(records.worse([record], [])) == lines


def test_not_a_number_is_worse():
    record = records.Record(figure="memory", case="c", key="peak", value=1.0, unit="GB", better="lower", margin=0.1)
    assert records.worse([dataclasses.replace(record, value=float("nan"))], [record])


@given(numbers, numbers)
def test_wanted_is_a_bound_on_the_side_that_is_not_better(value, wanted):
    record = records.Record(figure="memory", case="c", key="peak", value=value, unit="GB", better="lower", wanted=wanted)
    assert record.reached == (value <= wanted)
    assert dataclasses.replace(record, better="higher").reached == (value >= wanted)
    assert ("**" in records.table([record])) == (value > wanted)
