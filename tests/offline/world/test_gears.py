"""Gear wheels mesh: as outlines that furniture is cut from, and as they are drawn on walls."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.offline.furniture.outlines import gear, meshed
from wm.offline.world.materials.gears import TEETH, TOOTH, wheel

COUNTS = st.integers(9, 32)
ANGLES = st.floats(-math.pi, math.pi)


@settings(deadline=None, max_examples=60)
@given(COUNTS, COUNTS, ANGLES, ANGLES)
def test_meshed_wheels_interlock_and_do_not_cut_each_other(teeth, other, turned, towards):
    """At the sum of the pitch radii the tips overlap in reach, but teeth lie in gaps: what is shared is less than a tenth of a
    tooth, and half a tooth of turning makes it more."""
    module = 0.02
    first = gear(module * teeth, teeth, turned=turned)
    reach = module * (teeth + other)
    at = (reach * math.cos(towards), reach * math.sin(towards))
    turn = meshed(turned, teeth, other, towards)
    tooth = 3.8 * module * 0.4 * (2 * math.pi * module)
    shared = first.intersection(gear(module * other, other, turned=turn, at=at)).area
    clash = first.intersection(gear(module * other, other, turned=turn + math.pi / other, at=at)).area
    assert shared < 0.1 * tooth < clash
    wheels = (first, gear(module * other, other))
    assert sum(np.hypot(*np.asarray(wheel.exterior.coords).T).max() for wheel in wheels) > reach


def test_drawn_wheels_on_a_lattice_mesh():
    radius = 0.1
    pitch = (2 - TOOTH) * radius
    g = np.linspace(-0.11, pitch + 0.11, 600, dtype=np.float32)
    x, y = np.meshgrid(g, g)
    first = wheel(x, y, radius, soft=1e-4)
    second = wheel(x - np.float32(pitch), y, radius, turned=math.pi / TEETH, soft=1e-4)
    clash = wheel(x - np.float32(pitch), y, radius, soft=1e-4)
    cell = float(g[1] - g[0]) ** 2
    tooth = TOOTH * radius * math.pi * radius / TEETH
    assert float((first * second).sum()) * cell < 0.15 * tooth < 0.3 * float((first * clash).sum()) * cell
    assert 0.3 * math.pi * radius**2 < float(first.sum()) * cell < math.pi * radius**2
