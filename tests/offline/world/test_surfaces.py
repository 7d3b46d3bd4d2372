"""Laws of dressed surfaces: every family dresses every kind of surface physically; openings get casings; panes glow."""

import numpy as np
import pytest

from wm.geometry.plan.site import WallOpening
from wm.offline.style.families import FAMILIES
from wm.offline.style.theme import style_of
from wm.offline.world.surfaces import Chart, Interior, dress, grid
from wm.offline.world.surfaces.frieze import frieze
from wm.offline.world.surfaces.texel_sheet import lay
from wm.types import SurfaceKind

KINDS = [SurfaceKind.WALL, SurfaceKind.FLOOR, SurfaceKind.CEILING, SurfaceKind.REVEAL, SurfaceKind.PANE]


def interior(theme: str, kind: str = "living") -> Interior:
    style = style_of(theme)
    polygon = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)
    return Interior(name=kind, kind=kind, polygon=polygon, height=2.8, style=style, surfaces=style.surfaces(kind), seed=5)


def chart(kind: SurfaceKind, texel: float = 0.04) -> Chart:
    if kind in (SurfaceKind.FLOOR, SurfaceKind.CEILING):
        up = 1.0 if kind == SurfaceKind.FLOOR else -1.0
        u, v = np.array([1.0, 0, 0]), np.array([0, up, 0.0])
        origin = np.array([0.0, 0.0 if up > 0 else 3.0, 0.0 if up > 0 else 2.8])
        return Chart(kind, origin, u, v, np.array([0, 0, up]), (round(3 / texel), round(4 / texel)), texel)
    width, height, base = (4.0, 2.8, 0.0) if kind == SurfaceKind.WALL else (1.2, 1.4, 0.9)
    axes = np.array([1.0, 0, 0]), np.array([0, 0, 1.0]), np.array([0, -1.0, 0])
    return Chart(kind, np.array([0, 3.0, base]), *axes, (round(height / texel), round(width / texel)), texel)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("kind", KINDS)
def test_every_family_dresses_every_surface(family, kind):
    openings = (WallOpening("door", 0.5, 1.4, 0.0, 2.0), WallOpening("window", 2.2, 3.4, 0.9, 2.1))
    flat = chart(kind)
    for room in ("living", "hall"):
        sheet = dress(flat, openings, interior(family, room))
        assert sheet.albedo.shape == (3, *flat.shape)
        assert np.isfinite(sheet.albedo).all()
        assert sheet.albedo.min() >= 0
        assert sheet.albedo.max() <= 1
        assert np.isfinite(sheet.height).all()
        assert (sheet.emission is not None) == (kind == SurfaceKind.PANE)
        if sheet.emission is not None:
            assert sheet.emission.min() >= 0
            assert 0.2 < sheet.emission.mean() < 5


def test_a_door_gets_a_raised_casing():
    inside = interior("coastal")  # a style without panels, which would divide the wall anew
    door = WallOpening("door", 1.5, 2.5, 0.0, 2.0)
    bare, cased = (dress(chart(SurfaceKind.WALL), openings, inside) for openings in ((), (door,)))
    column = int(1.45 / 0.04)
    assert cased.height[40, column] > bare.height[40, column] + 0.01
    np.testing.assert_array_equal(cased.albedo[:, :, -5], bare.albedo[:, :, -5])  # far from the door nothing changes


@pytest.mark.parametrize("theme", ["roman", "clockwork"])
def test_a_frieze_runs_below_the_cornice_and_nowhere_else(theme):
    """Every wall has it at the same height; bathrooms and families that own none have none."""
    flat, inside = chart(SurfaceKind.WALL), interior(theme)
    s, t = grid(flat)
    bare = lay(flat, inside.surfaces.wall, s, t, seed=5)
    drawn = frieze(flat, bare, s, t, inside, top=2.6)
    changed = np.flatnonzero(np.abs(drawn.albedo - bare.albedo).max(axis=(0, 2)) > 0.05) * flat.texel
    assert 2.2 < changed.min() < changed.max() < 2.65
    assert frieze(flat, bare, s, t, interior(theme, "bathroom"), top=2.6) is bare
    assert frieze(flat, bare, s, t, interior("gothic"), top=2.6) is bare


def test_doors_of_ornate_styles_stand_under_a_cap():
    inside = interior("roman")
    door = WallOpening("door", 1.5, 2.5, 0.0, 2.0)
    bare, capped = (dress(chart(SurfaceKind.WALL), openings, inside) for openings in ((), (door,)))
    row, column = int(2.17 / 0.04), int(2.0 / 0.04)
    assert capped.height[row, column] > bare.height[row, column] + 0.02


def test_a_closed_door_has_sunken_panels_within_a_frame_and_a_handle():
    texel = 0.01
    axes = np.array([1.0, 0, 0]), np.array([0, 0, 1.0]), np.array([0, -1.0, 0])
    leaf = dress(Chart(SurfaceKind.REVEAL, np.zeros(3), *axes, (210, 90), texel), (), interior("coastal"))
    assert leaf.height[40, 45] < leaf.height[40, 4] - 0.005 and leaf.height[150, 45] < leaf.height[150, 4] - 0.005
    assert leaf.albedo[:, 105, 15].mean() < 0.5 * leaf.albedo[:, 98, 4].mean()


def test_jambs_carry_a_stop_and_thresholds_none():
    x, y, z = np.eye(3)
    upright = Chart(SurfaceKind.REVEAL, np.zeros(3), y, z, x, (200, 30), 0.01)
    level = Chart(SurfaceKind.REVEAL, np.zeros(3), x, y, z, (30, 90), 0.01)
    jamb, threshold = (dress(flat, (), interior("gothic")) for flat in (upright, level))
    assert jamb.height[100, 15] > jamb.height[100, 3] + 0.008
    assert np.ptp(threshold.height) < 0.005
