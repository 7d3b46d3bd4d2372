"""Cloth, carpet, leather, rush and cane."""

import numpy as np

from wm.offline.style.finish import Finish
from wm.offline.world.materials.material_sample import F32, MaterialSample, Points, border, ink, mix, piece_tone, stains, vary
from wm.offline.world.noise import cells, fbm, visible


def textile(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Plain weave: crossing threads where pixels are fine enough, slubs and soft folds where they are not."""
    size = max(finish.scale, 0.004)
    slub = fbm((p.x * F32(0.15), p.y, p.z), wavelength=0.04, octaves=2, footprint=p.footprint, seed=seed)
    cross = fbm((p.x, p.y * F32(0.15), p.z * F32(0.15)), wavelength=0.04, octaves=2, footprint=p.footprint, seed=seed + 4)
    weave = np.sin(p.u * F32(2 * np.pi / size)) * np.sin(p.v * F32(2 * np.pi / size)) * visible(size, p.footprint)
    fold = fbm((p.x, p.y, p.z), wavelength=0.3, octaves=2, footprint=p.footprint, seed=seed + 8)
    weight = np.clip(F32(0.3) + F32(0.3) * (slub - cross) + F32(0.25) * weave, 0, 1) * F32(0.35 * finish.contrast)
    color = vary(mix(ink(finish, 0), ink(finish, 1, shade=0.75), weight), 0.07 * fold + 0.1 * stains(p, finish, seed=seed + 9))
    return MaterialSample(albedo=color, roughness=finish.roughness)


def velvet(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Pile brushed this way and that: broad patches take the sheen colour."""
    brushed = fbm((p.x, p.y, p.z), wavelength=0.22, octaves=3, footprint=p.footprint, seed=seed)
    color = mix(
        ink(finish, 0), ink(finish, 1, shade=1.5), np.clip(F32(0.18) + F32(0.35) * brushed, 0, 1) * F32(0.6 * finish.contrast)
    )
    return MaterialSample(albedo=color, roughness=finish.roughness)


def carpet(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Pile with flecks, and the tracks that feet leave."""
    tuft = max(finish.scale, 0.01)
    fleck = fbm((p.u, p.v), wavelength=2 * tuft, octaves=2, footprint=p.footprint, seed=seed)
    track = fbm((p.u, p.v * F32(0.6)), wavelength=0.5, octaves=2, footprint=p.footprint, seed=seed + 5)
    color = mix(
        ink(finish, 0), ink(finish, 1, shade=0.75), np.clip(F32(0.3) + F32(0.45) * fleck, 0, 1) * F32(0.6 * finish.contrast)
    )
    return MaterialSample(
        albedo=vary(color, 0.08 * track + 0.12 * stains(p, finish, seed=seed + 9)), roughness=1.0, height=fleck * F32(1e-3)
    )


def tatami(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Rush mats twice as long as wide, woven across, bound in cloth along the long sides, laid in turned pairs."""
    width = max(finish.scale, 0.3)
    i, du = cells(p.u, 2 * width)
    j, dv = cells(p.v, 2 * width)
    turned = (i + j) % 2 == 1
    along, across = np.where(turned, dv, du), np.where(turned, du, dv)
    half = (across > 0).astype(np.int32)
    inner = np.abs(across) - F32(width / 2)  # metres from the middle line of the mat
    rush = fbm((along, across * F32(0.06)), wavelength=0.03, octaves=2, footprint=p.footprint, seed=seed)
    slow = fbm((along, across), wavelength=0.6, octaves=2, footprint=p.footprint, seed=seed + 3)
    color = vary(
        ink(finish, 0), finish.contrast * (0.06 * rush + 0.06 * slow) + piece_tone(2 * i + half, j, seed=seed, amount=0.06)
    )
    edge_ = border(width / 2 - np.abs(inner), 0.07, p.footprint)
    return MaterialSample(albedo=mix(color, ink(finish, 1, shade=0.3), F32(0.9) * edge_), roughness=0.9, height=F32(1e-3) * edge_)


def woven(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Cane and rope: strands over and under."""
    size = max(finish.scale, 0.01)
    column, du = cells(p.u, size)
    row, dv = cells(p.v, size)
    over = (column + row) % 2 == 0
    bulge = np.where(over, np.cos(dv * F32(np.pi / size)), np.cos(du * F32(np.pi / size)))
    shadow = (F32(1) - bulge) * visible(size, p.footprint) + F32(0.35) * (F32(1) - visible(size, p.footprint))
    color = mix(ink(finish, 0), ink(finish, 1, shade=0.4), F32(0.6 * finish.contrast) * shadow.astype(F32))
    return MaterialSample(
        albedo=vary(color, piece_tone(column, row, seed=seed, amount=0.1) * visible(size, p.footprint)),
        roughness=finish.roughness,
    )


def leather(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Hide with creases and a worn, lighter bloom."""
    size = max(finish.scale, 0.02)
    crease = fbm((p.x, p.y, p.z), wavelength=size, octaves=3, footprint=p.footprint, seed=seed)
    bloom = fbm((p.x, p.y, p.z), wavelength=0.3, octaves=2, footprint=p.footprint, seed=seed + 5)
    folds = np.exp(-np.abs(crease) * F32(10)) * visible(0.5 * size, p.footprint)
    color = mix(
        vary(ink(finish, 0), 0.13 * finish.contrast * bloom), ink(finish, 1, shade=0.5), F32(0.45 * finish.contrast) * folds
    )
    return MaterialSample(albedo=color, roughness=finish.roughness)
