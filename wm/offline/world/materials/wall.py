"""What is put on walls: plaster, paint, wallpaper."""

import dataclasses

import numpy as np

from wm.offline.style.finish import Finish
from wm.offline.world.materials.material_sample import F32, MaterialSample, Points, ink, mix, stains, vary
from wm.offline.world.noise import cells, edge, fbm, line, visible


def plaster(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Trowelled lime plaster: soft blotches, long trowel strokes, a little relief."""
    size = max(finish.scale, 0.1)
    blotch = fbm((p.u, p.v), wavelength=size, octaves=4, footprint=p.footprint, seed=seed, gain=0.55)
    stroke = fbm((p.u + F32(0.4) * p.v, p.v * F32(1.7)), wavelength=0.22, octaves=3, footprint=p.footprint, seed=seed + 3)
    weight = np.clip(F32(0.35) + F32(0.5) * blotch, 0, 1) * F32(finish.contrast)
    color = vary(mix(ink(finish, 0), ink(finish, 1, shade=0.86), weight), 0.035 * finish.contrast * stroke)
    color = vary(color, 0.12 * stains(p, finish, seed=seed + 6, size=1.2))
    return MaterialSample(albedo=color, roughness=finish.roughness, height=stroke * F32(1.2e-3) + blotch * F32(1e-3))


def paint(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Flat paint with the roller's faint texture."""
    roller = fbm((p.u, p.v), wavelength=0.06, octaves=2, footprint=p.footprint, seed=seed)
    slow = fbm((p.u, p.v), wavelength=0.9, octaves=2, footprint=p.footprint, seed=seed + 3)
    color = vary(
        ink(finish, 0), finish.contrast * (0.012 * roller + 0.025 * slow) + 0.08 * stains(p, finish, seed=seed + 6, size=1.2)
    )
    return MaterialSample(albedo=color, roughness=finish.roughness, height=roller * F32(3e-4))


def wallpaper_damask(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """A half-drop repeat of an ogee frame round a symmetric flower."""
    height = max(finish.scale, 0.1)
    width = 0.6 * height
    column, du = cells(p.u, width)
    _, dv = cells(p.v + F32(0.5 * height) * (column % 2), height)
    x, y = np.abs(du) / F32(width / 2), dv / F32(height / 2)  # in [0, 1] and [-1, 1]
    soft = np.maximum(p.footprint / F32(width / 2), F32(0.02))
    figure = np.maximum(_ogee(x, y, soft), _flower(x, y, soft))
    thread = fbm((p.u * F32(4), p.v), wavelength=0.03, octaves=1, footprint=p.footprint, seed=seed)
    color = mix(ink(finish, 0), ink(finish, 1, shade=1.25), F32(0.8 * finish.contrast) * figure)
    color = vary(color, 0.02 * thread + 0.12 * stains(p, finish, seed=seed + 6, size=1.0))
    roughness = (F32(finish.roughness) - F32(0.15) * figure).astype(F32)
    return MaterialSample(albedo=color, roughness=roughness, height=figure * F32(4e-4))


def wallpaper_stripe(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Broad stripes with a pin line at each side."""
    width = max(finish.scale, 0.03)
    stripe = line(p.u, period=2 * width, width=width, footprint=p.footprint)
    pin = line(p.u + F32(0.5 * width + 0.18 * width), period=2 * width, width=0.1 * width, footprint=p.footprint)
    pin = np.maximum(pin, line(p.u - F32(0.5 * width + 0.18 * width), period=2 * width, width=0.1 * width, footprint=p.footprint))
    color = mix(ink(finish, 0), ink(finish, 1, shade=0.8), F32(finish.contrast) * np.maximum(stripe, F32(0.7) * pin))
    return MaterialSample(albedo=vary(color, 0.1 * stains(p, finish, seed=seed + 6, size=1.0)), roughness=finish.roughness)


FRESCO_BAND = 0.24
"""Metres of the upright bands that part the fields of a fresco."""


def fresco(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Painted plaster after Pompeii: fields of two colours by turns, a fine line and a medallion in each, bands between."""
    pitch = max(finish.scale, 0.5)
    column, du = cells(p.u, pitch)
    soft = np.maximum(p.footprint, F32(0.006))
    off = F32(pitch / 2) - np.abs(du)  # metres from the middle of the nearest band
    field = mix(ink(finish, 0), ink(finish, 1), (column % 2).astype(F32))
    pale = ink(finish, 2, shade=1.6)
    inset = off - F32(FRESCO_BAND / 2 + 0.09)
    color = mix(field, pale, F32(0.8) * edge(F32(0.006) - np.abs(inset), soft))
    radius = np.hypot(du, (p.v - F32(1.75)) * F32(0.9))
    ring = np.maximum(edge(F32(0.008) - np.abs(radius - F32(0.19)), soft), edge(F32(0.12) - radius, soft) * F32(0.5))
    petals = F32(0.10) + F32(0.03) * np.cos(F32(6) * np.arctan2(p.v - F32(1.75), du))
    here = F32(0.55) * (column % 3 == 0)
    color = mix(color, pale, here * np.maximum(ring, edge(petals - radius, soft)))
    round_ = np.clip(off / F32(FRESCO_BAND / 2), 0, 1)  # a painted column: lit in its middle, fluted
    flute = np.cos(np.clip(off, 0, FRESCO_BAND) * F32(2 * np.pi / 0.045))
    shaft = pale * (F32(0.72) + F32(0.10) * flute - F32(0.30) * round_**2)
    color = mix(color, shaft, edge(F32(FRESCO_BAND / 2) - off, soft) * visible(0.12, p.footprint))
    blotch = fbm((p.u, p.v), wavelength=0.7, octaves=4, footprint=p.footprint, seed=seed, gain=0.55)
    grain = fbm((p.u, p.v), wavelength=0.05, octaves=2, footprint=p.footprint, seed=seed + 3)
    color = vary(color, finish.contrast * (0.12 * blotch + 0.04 * grain) + 0.12 * stains(p, finish, seed=seed + 6, size=1.2))
    return MaterialSample(albedo=color, roughness=finish.roughness, height=blotch * F32(8e-4))


def painting(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """A painted canvas: a pale sky over hills, and shapes in the accent colour, in loose strokes."""
    size = max(finish.scale, 0.1)
    stroke = fbm((p.u, p.v * F32(1.6)), wavelength=0.07, octaves=2, footprint=p.footprint, seed=seed + 2)
    hills = fbm((p.u, p.v * F32(0.2)), wavelength=2 * size, octaves=3, footprint=p.footprint, seed=seed)
    ground = edge(hills * F32(0.35 * size) - p.v + F32(0.06) * stroke, np.maximum(p.footprint, F32(0.015)))
    shapes = fbm((p.u, p.v), wavelength=size, octaves=2, footprint=p.footprint, seed=seed + 5)
    color = mix(ink(finish, 0), ink(finish, 1, shade=0.5), F32(finish.contrast) * ground)
    color = mix(color, ink(finish, 2, shade=0.3), np.clip((shapes - F32(0.25)) * F32(5), 0, 1) * F32(0.75 * finish.contrast))
    return MaterialSample(albedo=vary(color, 0.14 * stroke), roughness=finish.roughness)


def paper(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Paper and card; print shows as faint lines where pixels are fine enough."""
    print_ = line(p.v, period=0.012, width=0.005, footprint=p.footprint) * F32(0.35 * finish.contrast)
    slow = fbm((p.x, p.y, p.z), wavelength=0.1, octaves=2, footprint=p.footprint, seed=seed)
    return MaterialSample(
        albedo=vary(mix(ink(finish, 0), ink(finish, 1, shade=0.5), print_), 0.05 * slow), roughness=finish.roughness
    )


def trim_profile(finish: Finish) -> Finish:
    """The same finish with less contrast, for mouldings and skirtings, so that their relief shows."""
    return dataclasses.replace(finish, contrast=0.5 * finish.contrast)


def _ogee(x: np.ndarray, y: np.ndarray, soft: np.ndarray | np.floating | float) -> np.ndarray:
    """The onion-shaped frame that damask repeats hang in."""
    bow = F32(0.5) + F32(0.42) * np.cos(np.pi * y) + F32(0.06) * np.cos(3 * np.pi * y)
    distance = np.abs(x - bow)
    leaf = F32(0.07) + F32(0.035) * np.cos(6 * np.pi * y)
    return edge(leaf - distance, soft)


def _flower(x: np.ndarray, y: np.ndarray, soft: np.ndarray | np.floating | float) -> np.ndarray:
    """A palmette: petals round a bud, on a stem with two leaves."""
    radius, angle = np.hypot(x * F32(1.15), y * F32(1.5) - F32(0.05)), np.arctan2(y * F32(1.5) - F32(0.05), x * F32(1.15))
    petals = F32(0.34) + F32(0.14) * np.abs(np.cos(F32(3.5) * (angle - F32(np.pi / 2))))
    bloom = edge(petals - radius, soft) - edge(F32(0.5) * petals - radius, soft) + edge(F32(0.15) - radius, soft)
    stem = edge(F32(0.045) - np.abs(x), soft) * edge(y + F32(0.8), soft) * edge(-F32(0.25) - y, soft)
    leaves = edge(F32(0.085) - np.hypot((x - F32(0.2)) * F32(0.55), y + F32(0.52) - F32(0.5) * (x - F32(0.2))), soft)
    return np.clip(bloom + stem + leaves, 0, 1)
