"""Gear wheels drawn on a surface, and the paper that is covered with them."""

import numpy as np
from jaxtyping import Float

from wm.offline.style.finish import Finish
from wm.offline.world.materials.material_sample import F32, MaterialSample, Points, ink, mix, stains, vary
from wm.offline.world.noise import Scalar, cells, edge, fbm

TEETH = 16
"""Teeth of a drawn wheel: a multiple of 4, so that wheels on a square lattice mesh with all four neighbours."""
TOOTH = 0.13
"""Height of a tooth as a share of the wheel's outer radius."""


def wheel(
    x: Float[np.ndarray, "..."],
    y: Float[np.ndarray, "..."],
    radius: float,
    *,
    turned: Float[np.ndarray, "..."] | Scalar = 0.0,
    soft: Float[np.ndarray, "..."] | Scalar,
    teeth: int = TEETH,
    spokes: int = 6,
) -> Float[np.ndarray, "..."]:
    """Coverage in [0, 1] of points by a spoked gear wheel about the origin, its outer `radius` at the teeth's tips, metres.

    Args:
      turned: radians that its first tooth is away from the x axis; meshing neighbours differ by half a tooth, pi / teeth.
      soft: width of the ramp at its edges, metres.
    """
    r, angle = np.hypot(x, y), np.arctan2(y, x) - turned
    flank = F32(2.2 * TOOTH * radius) * np.cos(F32(teeth) * angle)  # a cosine as steep as a flank, cut at tip and root
    tips = F32((1 - 0.5 * TOOTH) * radius) + np.clip(flank, -F32(0.5 * TOOTH * radius), F32(0.5 * TOOTH * radius))
    rim = np.minimum(tips - r, r - F32(0.66 * radius))
    hub = np.minimum(F32(0.24 * radius) - r, r - F32(0.09 * radius))
    beside = r * np.abs(np.sin(F32(spokes / 2) * angle)) * F32(2 / spokes)  # metres off the nearest spoke's middle, nearly
    spoke = np.minimum(F32(0.05 * radius) - beside, np.minimum(F32(0.7 * radius) - r, r - F32(0.2 * radius)))
    return edge(np.maximum(np.maximum(rim, hub), spoke), soft)


def wallpaper_gears(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Gear wheels in mesh on a square lattice, pinions in the gaps between them."""
    pitch = max(finish.scale, 0.08)
    radius = pitch / (2 - TOOTH)  # a tooth reaches the neighbour's root
    column, du = cells(p.u, pitch)
    row, dv = cells(p.v, pitch)
    odd = ((column + row) % 2).astype(F32)
    soft = np.maximum(p.footprint, F32(0.004))
    figure = wheel(du, dv, radius, turned=odd * F32(np.pi / TEETH), soft=soft)
    sideways = np.abs(du) > np.abs(dv)  # of the neighbours only the nearest reaches over the cell's edge
    across = np.where(sideways, np.abs(du) - F32(pitch), du).astype(F32)
    up = np.where(sideways, dv, np.abs(dv) - F32(pitch)).astype(F32)
    neighbour = wheel(across, up, radius, turned=(1 - odd) * F32(np.pi / TEETH), soft=soft)
    figure = np.maximum(figure, neighbour)
    cu, cv = F32(pitch / 2) - np.abs(du), F32(pitch / 2) - np.abs(dv)
    figure = np.maximum(figure, wheel(cu, cv, 0.19 * pitch, soft=soft, teeth=8, spokes=4))
    figure = figure * np.clip(F32(0.12 * pitch) / np.maximum(p.footprint, F32(1e-4)) - F32(0.5), 0, 1)
    thread = fbm((p.u * F32(4), p.v), wavelength=0.03, octaves=1, footprint=p.footprint, seed=seed)
    color = mix(ink(finish, 0), ink(finish, 1, shade=1.25), F32(0.8 * finish.contrast) * figure)
    color = vary(color, 0.02 * thread + 0.12 * stains(p, finish, seed=seed + 6, size=1.0))
    return MaterialSample(
        albedo=color, roughness=(F32(finish.roughness) - F32(0.2) * figure).astype(F32), height=figure * F32(1e-3)
    )
