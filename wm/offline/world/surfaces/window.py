"""Window panes: the world outside as a soft bright picture, behind the bars that the style puts across it."""

import numpy as np

from wm.color import to_linear
from wm.offline.world.materials.wall import trim_profile
from wm.offline.world.noise import cells, edge, fbm
from wm.offline.world.surfaces.outlook import HORIZON, OUTLOOKS
from wm.offline.world.surfaces.texel_sheet import F32, Chart, Interior, TexelSheet, grid, lay, over

BARS: dict[str, tuple[int, int, float]] = {
    # family: panes across per metre of width, up per metre of height, width of a bar
    "gothic": (2, 0, 0.045),
    "victorian": (1, 1, 0.045),
    "baroque": (2, 1, 0.045),
    "roman": (2, 2, 0.045),
    "scandinavian": (1, 0, 0.05),
    "midcentury": (1, 0, 0.05),
    "coastal": (1, 1, 0.045),
    "rustic": (2, 2, 0.045),
    "industrial": (3, 2, 0.03),
    "clockwork": (2, 2, 0.035),
    "japanese": (4, 3, 0.025),
    "moroccan": (4, 4, 0.03),
}


def pane_sheet(chart: Chart, interior: Interior) -> TexelSheet:
    """The pane of one window, its light in `emission`."""
    s, t = grid(chart)
    z = t + F32(chart.origin[2])
    across = s + F32(37.0 * (interior.seed % 5)) + F32(3.1 * float(chart.normal[0]) + 7.7 * float(chart.normal[1]))
    family = interior.style.family
    glass = TexelSheet(
        albedo=np.full((3, *chart.shape), 0.03, F32),
        roughness=np.full(chart.shape, 0.1, F32),
        height=np.zeros(chart.shape, F32),
        emission=_outdoors(chart, across, z, interior),
    )
    frame = lay(chart, trim_profile(interior.surfaces.trim), z, s, seed=interior.seed + 52)
    width, height = chart.shape[1] * chart.texel, chart.shape[0] * chart.texel
    per_width, per_height, bar = BARS.get(family, (0, 0, 0.05))
    if family == "gothic":
        glass = _leaded(chart, glass, s, t, width, height)
    sides = np.minimum(np.minimum(s, F32(width) - s), np.minimum(t, F32(height) - t))
    cover = edge(F32(0.055) - sides, chart.texel)
    for coordinate, length, density in ((s, width, per_width), (t, height, per_height)):
        count = max(1, round(length * density)) if density else 1
        if count > 1:
            each = F32(length / count)
            offset = np.abs(coordinate - np.round(coordinate / each) * each)
            cover = np.maximum(cover, edge(F32(bar / 2) - offset, chart.texel))
    return over(glass, frame, cover, lift=0.02)


def _outdoors(chart: Chart, across: np.ndarray, z: np.ndarray, interior: Interior) -> np.ndarray:
    """[3, h, w] radiance: sky above hills and trees, all soft; night themes are dim and blue."""
    light = interior.style.light
    sky = to_linear(np.asarray(light.sky_color, F32))[:, None, None]
    sun = to_linear(np.asarray(light.sun_color, F32))[:, None, None]
    brightness = F32(0.55 + 0.55 * light.sky_strength + 0.2 * light.sun_strength)
    if light.outlook in OUTLOOKS:
        return (OUTLOOKS[light.outlook](across, z, sky, chart.texel, interior.seed + 80) * brightness).astype(F32)
    up = np.clip((z - F32(HORIZON)) / F32(1.6), -1, 1)
    glow = np.exp(-np.abs(up) * F32(2.2))
    cloud = fbm((across, z * F32(2.2)), wavelength=1.1, octaves=4, footprint=chart.texel, seed=interior.seed + 80)
    deep = sky ** F32(1.0 + 0.6 * light.sun_strength)  # the day's sky is bluer overhead than at the horizon
    air = deep * F32(0.95) + (sky * F32(0.55) + sun * F32(0.35) - deep * F32(0.5)) * glow * F32(0.8)
    air = air + (F32(0.95) * sky + F32(0.2) - air) * np.clip(F32(1.1) * cloud + F32(0.05), 0, 0.7)
    haze = sky * F32(0.5) + F32(0.12)
    ridge = [
        fbm((across, across * 0), wavelength=length, octaves=octaves, footprint=chart.texel, seed=interior.seed + seed)
        for length, octaves, seed in ((2.4, 3, 81), (1.5, 4, 84), (0.55, 5, 82))
    ]
    green = np.array([0.13, 0.22, 0.09], F32)[:, None, None] * (F32(0.5) + sun)
    ground = np.array([0.26, 0.33, 0.14], F32)[:, None, None] * (F32(0.5) + sun)
    leaves = fbm((across, z), wavelength=0.16, octaves=4, footprint=chart.texel, seed=interior.seed + 83)
    lit = F32(1) + F32(0.75) * leaves
    soft = max(chart.texel, 0.015)
    view = air + (F32(0.75) * haze + F32(0.15) * green - air) * edge(F32(HORIZON + 0.12) + F32(0.14) * ridge[0] - z, soft)
    middle = F32(0.4) * haze + F32(0.65) * green * (F32(1) + F32(0.3) * leaves)
    view = view + (middle - view) * edge(F32(HORIZON) + F32(0.12) * ridge[1] - z, soft)
    crowns = F32(HORIZON - 0.16) + F32(0.22) * ridge[2] + F32(0.05) * leaves
    view = view + (green * lit * F32(1.05) + F32(0.05) * haze - view) * edge(crowns - z, soft)
    lawn = F32(HORIZON - 0.42) + F32(0.03) * leaves
    view = view + (ground * (F32(0.95) + F32(0.25) * leaves) + F32(0.06) * haze - view) * edge(lawn - z, 0.04)
    return (view * brightness).astype(F32)


def _leaded(chart: Chart, glass: TexelSheet, s: np.ndarray, t: np.ndarray, width: float, height: float) -> TexelSheet:
    """Diamond quarries in lead, a coloured border, and a roundel at the head of the window."""
    a, da = cells(s * F32(1.35) + t * F32(0.78), 0.26)
    b, db = cells(s * F32(1.35) - t * F32(0.78), 0.26)
    tint = F32(0.88) + F32(0.24) * ((a * 7 + b * 13) % 5).astype(F32) / F32(4)
    assert glass.emission is not None
    emission = glass.emission * F32(1.05) * tint
    ruby, blue, amber = (np.array(c, F32)[:, None, None] for c in ((0.85, 0.16, 0.12), (0.14, 0.28, 0.75), (0.95, 0.66, 0.2)))
    sides = np.minimum(np.minimum(s, F32(width) - s), np.minimum(t, F32(height) - t))
    block = (np.floor(t / F32(0.18)) + np.floor(s / F32(0.18))) % 2
    edging = edge(F32(0.15) - sides, chart.texel)
    bright = emission.mean(axis=0, keepdims=True)
    emission = emission + (bright * np.where(block == 0, ruby, amber) * F32(1.1) - emission) * edging
    r = np.hypot(s - F32(width / 2), t - F32(height - 0.26 * width - 0.18)) / F32(0.26 * width)
    angle = np.arctan2(t - F32(height - 0.26 * width - 0.18), s - F32(width / 2))
    petal = np.where(np.cos(F32(6) * angle) > 0, blue, ruby)
    rose = np.where(r < 0.3, amber, petal)
    emission = emission + (bright * rose * F32(1.2) - emission) * edge((F32(1) - r) * F32(0.26 * width), chart.texel)
    lead = edge(F32(0.011) - (F32(0.13) - np.abs(da)) * F32(0.64), chart.texel)
    lead = np.maximum(lead, edge(F32(0.011) - (F32(0.13) - np.abs(db)) * F32(0.64), chart.texel)) * edge(
        sides - F32(0.15), chart.texel
    )
    lead = lead * edge((r - F32(1)) * F32(0.26 * width), chart.texel)
    ring = edge(F32(0.014) - np.abs(r - F32(1)) * F32(0.26 * width), chart.texel)
    lead = np.maximum(np.maximum(lead, ring), edge(F32(0.012) - np.abs(sides - F32(0.15)), chart.texel))
    return TexelSheet(
        albedo=glass.albedo,
        roughness=glass.roughness,
        height=glass.height,
        emission=(emission * (1 - F32(0.62) * lead)).astype(F32),
    )
