"""What else than hills and trees may lie outside of a window: space, the deep sea, the open sea, ice, dunes, a city at night."""

from collections.abc import Callable

import numpy as np

from wm.color import to_linear
from wm.offline.world.noise import cells, edge, fbm, random_cells

F32 = np.float32
HORIZON = 1.35
"""Metres above the floor where the painted outdoors has its horizon: about eye level."""

View = Callable[[np.ndarray, np.ndarray, np.ndarray, float, int], np.ndarray]
"""(across, height, sky, texel, seed) -> [3, h, w] radiance; `across` and `height` in metres, `sky` a linear colour [3, 1, 1]."""


def _color(code: tuple[float, float, float]) -> np.ndarray:
    return to_linear(np.asarray(code, F32))[:, None, None]


def space(across: np.ndarray, z: np.ndarray, sky: np.ndarray, texel: float, seed: int) -> np.ndarray:
    """Black with stars, and the lit limb of a planet."""
    i, du = cells(across, 0.11)
    j, dv = cells(z, 0.11)
    bright = random_cells(i, j, seed=seed) ** 5
    star = edge(F32(0.004) + F32(0.006) * bright - np.hypot(du, dv), max(texel, 0.006)) * bright
    view = _color((0.03, 0.04, 0.09)) + star * F32(1.5)
    distance = np.hypot(across - np.round(across / F32(3.4)) * F32(3.4), z + F32(0.25)) - F32(1.75)
    cloud = fbm((across, z * F32(2.5)), wavelength=0.6, octaves=4, footprint=texel, seed=seed + 2)
    planet = _color((0.3, 0.6, 0.95)) + (_color((0.97, 0.98, 1.0)) - _color((0.3, 0.6, 0.95))) * np.clip(F32(0.3) + cloud, 0, 1)
    view = view + (planet * F32(1.5) - view) * edge(-distance, max(texel, 0.01))
    return view + _color((0.4, 0.7, 1.0)) * np.exp(-np.abs(distance) / F32(0.06)) * F32(0.6)


def deep_sea(across: np.ndarray, z: np.ndarray, sky: np.ndarray, texel: float, seed: int) -> np.ndarray:
    """Water that darkens downwards, shafts of light, weed."""
    shaft = fbm((across + F32(0.35) * z, z * F32(0.05)), wavelength=0.5, octaves=3, footprint=texel, seed=seed)
    depth = np.clip((z - F32(0.5)) / F32(1.3), 0, 1)
    view = _color((0.02, 0.22, 0.3)) + (_color((0.3, 0.85, 0.88)) - _color((0.02, 0.22, 0.3))) * depth
    view = view * (F32(1) + F32(0.5) * shaft * depth)
    weed = fbm((across, z * F32(0.15)), wavelength=0.25, octaves=3, footprint=texel, seed=seed + 3)
    return view + (_color((0.03, 0.2, 0.15)) - view) * edge(F32(1.05) + F32(0.5) * weed - z, 0.03)


def open_sea(across: np.ndarray, z: np.ndarray, sky: np.ndarray, texel: float, seed: int) -> np.ndarray:
    """Sky over waves."""
    cloud = fbm((across, z * F32(2.2)), wavelength=1.0, octaves=4, footprint=texel, seed=seed)
    wave = fbm((across, z * F32(5)), wavelength=0.5, octaves=4, footprint=texel, seed=seed + 2)
    air = sky + (F32(0.3) + F32(0.8) * sky - sky) * np.clip(F32(0.3) + cloud, 0, 0.8)
    water = _color((0.1, 0.32, 0.42)) * (F32(1) + F32(0.7) * wave)
    return air + (water - air) * edge(F32(HORIZON) - z, 0.012)


def ice(across: np.ndarray, z: np.ndarray, sky: np.ndarray, texel: float, seed: int) -> np.ndarray:
    """Snow fields and sharp white peaks."""
    ridge = np.abs(fbm((across, across * 0), wavelength=1.3, octaves=4, footprint=texel, seed=seed))
    shade = fbm((across + z, z), wavelength=0.3, octaves=3, footprint=texel, seed=seed + 2)
    peaks = _color((0.75, 0.86, 0.95)) * (F32(1) + F32(0.35) * shade)
    view = sky + (peaks - sky) * edge(F32(HORIZON + 0.05) + F32(0.6) * ridge - z, 0.01)
    return view + (_color((0.93, 0.96, 0.99)) - view) * edge(F32(HORIZON - 0.1) + F32(0.04) * shade - z, 0.03)


def dunes(across: np.ndarray, z: np.ndarray, sky: np.ndarray, texel: float, seed: int) -> np.ndarray:
    """Dunes under a clear sky."""
    view = sky
    for k, (lift, tone) in enumerate(((0.12, 0.8), (-0.05, 1.0), (-0.25, 0.85))):
        crest = fbm((across, across * 0), wavelength=2.2 - 0.5 * k, octaves=2, footprint=texel, seed=seed + k)
        view = view + (_color((0.87, 0.66, 0.4)) * F32(tone) - view) * edge(F32(HORIZON + lift) + F32(0.18) * crest - z, 0.02)
    return view


def city(across: np.ndarray, z: np.ndarray, sky: np.ndarray, texel: float, seed: int) -> np.ndarray:
    """Towers at night, some of their windows lit, a few in neon."""
    haze = sky + _color((0.72, 0.45, 0.85))  # lamps below colour the clouds
    view = haze * (F32(0.45) + F32(0.6) * np.exp(-np.abs(z - F32(HORIZON)) * F32(1.5)))
    for k, (width, low) in enumerate(((0.5, 1.75), (0.34, 1.35))):
        tower, _ = cells(across + F32(0.17 * k), width)
        top = F32(low) + F32(0.55) * random_cells(tower, np.full_like(tower, k), seed=seed)
        i, du = cells(across, 0.07)
        j, dv = cells(z, 0.085)
        lit = (
            (random_cells(i, j, seed=seed + 5 + k) > F32(0.62))
            * edge(F32(0.02) - np.abs(du), 0.01)
            * edge(F32(0.026) - np.abs(dv), 0.01)
        )
        hue = random_cells(tower, tower, seed=seed + 9 + k)
        glow = np.where(
            hue < 0.25, _color((1.0, 0.3, 0.7)), np.where(hue < 0.45, _color((0.3, 0.9, 1.0)), _color((1.0, 0.8, 0.5)))
        )
        wall = F32(0.3) * haze + glow * lit * F32(1.8)
        view = view + (wall - view) * edge(top - z, 0.01)
    return view


OUTLOOKS: dict[str, View] = {
    "space": space, "deep_sea": deep_sea, "open_sea": open_sea, "ice": ice, "dunes": dunes, "city": city,
}  # fmt: skip
"""Keys of finish.OUTLOOKS, besides "country"."""
