"""What vessels and caves are lined with: moulded panels, riveted plates, living rock."""

import numpy as np

from wm.offline.style.finish import Finish
from wm.offline.world.materials.material_sample import (
    F32,
    MaterialSample,
    Points,
    border,
    ink,
    mix,
    piece_tone,
    stains,
    tile_grid,
    vary,
)
from wm.offline.world.noise import edge, fbm


def capsule(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Moulded panels with rounded corners and a swelling face, a dark seam between them."""
    height = max(finish.scale, 0.2)
    width = 0.72 * height
    column, row, du, dv = tile_grid(p, width, height)
    inside = _rounded_box(du, dv, width / 2 - 0.02, height / 2 - 0.02, radius=0.3 * width)  # metres to the rim, positive inside
    face = edge(inside, p.footprint)
    swell = np.clip(inside / F32(0.14), 0, 1)
    slow = fbm((p.u, p.v), wavelength=0.8, octaves=2, footprint=p.footprint, seed=seed)
    color = mix(ink(finish, 2, shade=0.8), ink(finish, 0), np.sqrt(swell))
    color = mix(ink(finish, 1, shade=0.4), color, face)
    inset = border(inside - F32(0.10), 0.012, p.footprint) * F32(0.35 * finish.contrast)
    color = mix(color, ink(finish, 1, shade=0.4), inset)
    color = vary(
        color, piece_tone(column, row, seed=seed + 2, amount=0.02) + 0.015 * slow + 0.1 * stains(p, finish, seed=seed + 6)
    )
    return MaterialSample(albedo=color, roughness=finish.roughness, height=(F32(0.02) * np.sqrt(swell)).astype(F32))


def riveted(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Metal plates in courses, a row of rivets along every edge, rust where they are old."""
    width = max(finish.scale, 0.15)
    height = 0.75 * width
    column, row, du, dv = tile_grid(p, width, height)
    rim = np.minimum(F32(width / 2) - np.abs(du), F32(height / 2) - np.abs(dv))
    pitch = width / max(round(width / 0.11), 2)
    along_u = du - np.round(du / F32(pitch)) * F32(pitch)
    along_v = dv - np.round(dv / F32(pitch)) * F32(pitch)
    edge_u, edge_v = F32(height / 2 - 0.035) - np.abs(dv), F32(width / 2 - 0.035) - np.abs(du)
    reach = np.minimum(np.hypot(along_u, edge_u), np.hypot(along_v, edge_v))
    rivet = edge(F32(0.013) - reach, p.footprint)
    joint = edge(F32(0.004) - rim, p.footprint)
    rust = fbm((p.u, p.v), wavelength=0.5, octaves=4, footprint=p.footprint, seed=seed, gain=0.6)
    tone = piece_tone(column, row, seed=seed + 2, amount=0.07 * finish.contrast)
    tone = tone - F32(0.35 * finish.wear) * np.clip(rust, 0, 1)
    color = vary(mix(ink(finish, 0), ink(finish, 2, shade=0.85), np.clip(F32(0.5) + rust, 0, 1)), tone)
    color = mix(vary(color, F32(0.25) * rivet), ink(finish, 1, shade=0.3), F32(0.85) * joint)
    height_map = F32(0.006) * np.sqrt(np.clip(F32(1) - (reach / F32(0.014)) ** 2, 0, 1)) - F32(0.004) * joint
    return MaterialSample(albedo=color, roughness=finish.roughness, metallic=0.35, height=height_map.astype(F32))


def rock(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Living rock: bulges of several sizes, cracks between them, darker where it is deep."""
    size = max(finish.scale, 0.2)
    bulge = fbm((p.u, p.v), wavelength=size, octaves=5, footprint=p.footprint, seed=seed, gain=0.55)
    bent = (p.u + F32(0.25 * size) * bulge, p.v * F32(1.3) + F32(0.2 * size) * bulge)
    ridge = np.abs(fbm(bent, wavelength=0.8 * size, octaves=4, footprint=p.footprint, seed=seed + 3))
    crack = np.clip(F32(1) - ridge / F32(0.06), 0, 1) * F32(finish.contrast)
    grain = fbm((p.u, p.v), wavelength=0.06, octaves=2, footprint=p.footprint, seed=seed + 5)
    color = mix(ink(finish, 0), ink(finish, 2, shade=0.75), np.clip(F32(0.5) + F32(0.9) * bulge, 0, 1))
    color = mix(vary(color, 0.10 * grain + 0.25 * bulge), ink(finish, 1, shade=0.4), F32(0.7) * crack)
    height = F32(0.10 * size) * bulge + F32(0.004) * grain - F32(0.02) * crack
    return MaterialSample(albedo=color, roughness=finish.roughness, height=height.astype(F32))


def _rounded_box(u: np.ndarray, v: np.ndarray, half_u: float, half_v: float, *, radius: float) -> np.ndarray:
    """Metres inside the rim of a rectangle with rounded corners; negative outside."""
    over_u, over_v = np.abs(u) - F32(half_u - radius), np.abs(v) - F32(half_v - radius)
    outside = np.hypot(np.maximum(over_u, 0), np.maximum(over_v, 0))
    return (F32(radius) - outside - np.minimum(np.maximum(over_u, over_v), 0)).astype(F32)
