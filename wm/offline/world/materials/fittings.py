"""Metal, glass, glaze, and the small things of a room: leaves, soil, wax, light sources."""

import numpy as np

from wm.offline.style.finish import Finish
from wm.offline.world.materials.material_sample import F32, MaterialSample, Points, ink, mix, vary
from wm.offline.world.noise import fbm, line


def metal(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Brushed or polished metal with a breath of patina."""
    brush = fbm((p.x * F32(0.05), p.y, p.z), wavelength=max(finish.scale, 0.01), octaves=2, footprint=p.footprint, seed=seed)
    patina = fbm((p.x, p.y, p.z), wavelength=0.12, octaves=3, footprint=p.footprint, seed=seed + 4)
    color = vary(ink(finish, 0), finish.contrast * 0.08 * brush - F32(0.5 * finish.wear) * np.clip(patina, 0, 1))
    return MaterialSample(albedo=color, roughness=finish.roughness, metallic=0.8)


def glass(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Tinted glass as an opaque body sees it: pale, very glossy."""
    slow = fbm((p.x, p.y, p.z), wavelength=0.2, octaves=2, footprint=p.footprint, seed=seed)
    return MaterialSample(albedo=vary(ink(finish, 0), 0.1 * slow), roughness=min(finish.roughness, 0.1), metallic=0.3)


def mirror(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Silvered glass: nearly all of it is reflection."""
    cloud = fbm((p.x, p.y, p.z), wavelength=0.4, octaves=2, footprint=p.footprint, seed=seed)
    return MaterialSample(albedo=vary(ink(finish, 0), 0.05 * cloud), roughness=0.05, metallic=0.95)


def ceramic(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Glaze that pools a little."""
    pool = fbm((p.x, p.y, p.z), wavelength=0.15, octaves=2, footprint=p.footprint, seed=seed)
    return MaterialSample(albedo=vary(ink(finish, 0), 0.07 * finish.contrast * pool), roughness=min(finish.roughness, 0.3))


def leaf(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Foliage: leaf to leaf variation and paler veins."""
    clump = fbm((p.x, p.y, p.z), wavelength=max(finish.scale, 0.05), octaves=3, footprint=p.footprint, seed=seed, gain=0.7)
    veins = line(p.u, period=max(0.4 * finish.scale, 0.02), width=0.004, footprint=p.footprint)
    color = mix(vary(ink(finish, 0), 0.35 * finish.contrast * clump), ink(finish, 1, shade=1.4), F32(0.3) * veins)
    return MaterialSample(albedo=color, roughness=finish.roughness)


def soil(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Crumbs of earth."""
    crumb = fbm((p.x, p.y, p.z), wavelength=max(2 * finish.scale, 0.03), octaves=3, footprint=p.footprint, seed=seed)
    return MaterialSample(albedo=mix(ink(finish, 0), ink(finish, 1, shade=0.5), np.clip(F32(0.4) + crumb, 0, 1)), roughness=1.0)


def wax(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Candle wax, uneven where it ran."""
    run = fbm((p.x, p.y, p.z * F32(0.3)), wavelength=0.03, octaves=2, footprint=p.footprint, seed=seed)
    return MaterialSample(albedo=vary(ink(finish, 0), 0.08 * run), roughness=0.5)


def glow(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """The body of a light source: its own colour with little variation."""
    flicker = fbm((p.x, p.y, p.z), wavelength=0.08, octaves=2, footprint=p.footprint, seed=seed)
    return MaterialSample(albedo=vary(ink(finish, 0), 0.06 * flicker), roughness=0.8)
