"""Two openings on one wall: with a centimetre of wall between them they are carved clean, with less they are refused."""

import dataclasses

import numpy as np
import pytest
import scipy.sparse.csgraph
import scipy.spatial
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.mesh.test_structure import assert_watertight
from tests.geometry.plans import checked, opening, rectangle
from wm.geometry.mesh.structure import build_structure
from wm.geometry.plan.loading import FloorPlan, PlanError
from wm.geometry.plan.openings import APART
from wm.types import Mesh

TENTHS = st.integers(1, 9)
GAPS = st.sampled_from((-1e-3, -3e-8, -3e-12, 0.0, 1e-16, 3e-12, 3e-8, 1e-5, 1e-3, 0.0099, APART, 0.0101, 0.05))


def welded(mesh: Mesh) -> Mesh:
    """The mesh with vertices within a micrometre made one: what was a film becomes a sheet of no thickness."""
    pairs = scipy.spatial.KDTree(mesh.vertices).query_pairs(1e-6, output_type="ndarray")
    count = len(mesh.vertices)
    graph = scipy.sparse.coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    _, number = scipy.sparse.csgraph.connected_components(graph, directed=False)
    _, first = np.unique(number, return_index=True)
    return dataclasses.replace(mesh, vertices=mesh.vertices[first], faces=number[mesh.faces].astype(np.int32))


def pair(position, width, sill, height, other_position, other_sill) -> FloorPlan:
    """Two windows in a wall of 6 m."""
    wall = (0, 0), (6, 0)
    first = opening("window", *wall, position, width, height, sill)
    second = opening("window", *wall, other_position, 0.7, 0.6, other_sill)
    return FloorPlan((rectangle("a", 0, 0, 6, 4, first, second),))


def check_pair(plan: FloorPlan, gap: float) -> None:
    if gap < APART - 1e-6:
        with pytest.raises(PlanError, match=r"openings\[1\].*openings\[0\]") as caught:
            checked(plan)
        assert [violation.rule for violation in caught.value.violations] == ["openings_overlap"]
        return
    mesh = build_structure(checked(plan))
    assert_watertight(mesh)
    assert_watertight(welded(mesh))


@given(TENTHS, TENTHS, GAPS, st.booleans())
@settings(max_examples=60)
def test_windows_one_above_the_other(sill, height, gap, written):
    """Heights in tenths of a metre: 0.8 + 0.4 is more than 1.2, and 0.3 + 0.6 less than 0.9."""
    sill, height = sill / 10, (height + 2) / 10
    head = round(sill + height, 1) if written else sill + height
    check_pair(pair(2.0, 0.8, sill, height, 2.05, head + gap), gap)


@given(TENTHS, TENTHS, GAPS, st.booleans())
@settings(max_examples=60)
def test_windows_side_by_side(position, width, gap, written):
    position, width = 1 + position / 10, (width + 3) / 10
    end = round(position + width, 1) if written else position + width
    check_pair(pair(position, width, 0.9, 0.6, end + gap, 1.1), gap)


@given(TENTHS, TENTHS, GAPS, GAPS)
@settings(max_examples=60)
def test_windows_corner_to_corner(sill, width, beside, above):
    sill, width = sill / 10, (width + 3) / 10
    check_pair(pair(2.0, width, sill, 0.6, 2.0 + width + beside, sill + 0.6 + above), max(beside, above))


def test_what_nearly_touches_is_told_what_would_be_right():
    with pytest.raises(PlanError, match=r"nearly touches .* make them one opening or keep 0\.01 m of wall between them"):
        checked(pair(2.0, 0.8, 0.9, 0.6, 2.8, 0.9))
    with pytest.raises(PlanError, match="overlaps"):
        checked(pair(2.0, 0.8, 0.9, 0.6, 2.7, 0.9))


def test_the_second_entry_of_a_door_may_come_near_to_the_next_door():
    doors = opening("door", (4, 0), (4, 4), 0.5), opening("door", (4, 0), (4, 4), 1.415)
    again = opening("door", (4, 0), (4, 4), 1.4)
    plan = FloorPlan((rectangle("a", 0, 0, 4, 4, *doors), rectangle("b", 4, 0, 8, 4, again)))
    assert_watertight(build_structure(checked(plan)))
