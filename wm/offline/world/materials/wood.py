"""Wood, solid and laid: boards, herringbone, basket weave, frames and panels, paint and lacquer over it."""

import dataclasses

import numpy as np

from wm.offline.style.finish import Finish
from wm.offline.world.materials.material_sample import (
    F32,
    MaterialSample,
    Points,
    border,
    ink,
    joints,
    mix,
    piece_tone,
    stains,
    vary,
)
from wm.offline.world.noise import cells, fbm, random_cells, visible

NARROW = 0.3
"""Metres: panels narrower than this are boards, for a frame would leave nothing of them."""


def wood(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Solid wood: growth rings about an axis near the surface, stretched eightfold along the grain."""
    base, grain = ink(finish, 0), ink(finish, 1, shade=0.55)
    figure = _grain(p, max(finish.scale, 0.012), seed)
    tint = fbm((p.x * F32(0.25), p.y, p.z), wavelength=0.35, octaves=2, footprint=p.footprint, seed=seed + 40)
    color = vary(
        mix(base, grain, np.clip(0.28 + 0.42 * figure, 0, 1) * F32(finish.contrast)),
        0.14 * tint + 0.15 * stains(p, finish, seed=seed + 9),
    )
    return MaterialSample(albedo=color, roughness=finish.roughness, height=figure * F32(2e-4))


def wood_planks(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Long boards along u, ends staggered at random, each with its own tone, figure and a fine joint."""
    width = finish.scale
    length = 12.0 * width
    row, dv = cells(p.v, width)
    shift = random_cells(row, np.zeros_like(row), seed=seed) * F32(length)
    column, du = cells(p.u + shift, length)
    return _laid(p, finish, seed, column, row, du, dv, length, width, along=p.u, across=p.v)


def herringbone(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Herringbone parquet at 45 degrees to the walls: blocks five times as long as wide."""
    n, width = 5, finish.scale / 5
    u, v = (p.u + p.v) * F32(np.sqrt(0.5)), (p.v - p.u) * F32(np.sqrt(0.5))
    i, du = cells(u, width)
    j, dv = cells(v, width)
    k = np.mod(i - j, 2 * n)
    lying = k < n
    index = np.where(lying, k, 2 * n - 1 - k)  # place along the block
    middle = (index - F32((n - 1) / 2)) * F32(width)
    along, across = np.where(lying, du, dv) + middle, np.where(lying, dv, du)
    column, row = np.where(lying, i - k, i), np.where(lying, j, j - index)
    tone_shift = np.where(lying, F32(0.05), F32(-0.05))  # the two directions catch the light differently
    return _laid(p, finish, seed, column * 2 + lying, row, along.astype(F32), across.astype(F32), n * width, width,
                 along=np.where(lying, u, v), across=np.where(lying, v, u), tone=tone_shift)  # fmt: skip


def parquet(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Basket weave: squares of four strips, turned by a quarter from square to square."""
    side, strips = finish.scale, 4
    i, du = cells(p.u, side)
    j, dv = cells(p.v, side)
    lying = (i + j) % 2 == 0
    along, across = np.where(lying, du, dv), np.where(lying, dv, du)
    strip, offset = cells(across + F32(side / 2), side / strips)
    tone_shift = np.where(lying, F32(0.06), F32(-0.06))
    return _laid(p, finish, seed, i * 8 + strip, j, along.astype(F32), offset, side, side / strips,
                 along=np.where(lying, p.u, p.v), across=np.where(lying, p.v, p.u), tone=tone_shift)  # fmt: skip


def panelling(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Stiles and rails with recessed fielded panels, a third taller than wide; the mouldings are relief, lit by the room.

    Too narrow for a frame, the panels are upright tongue-and-groove boards.
    """
    width = finish.scale
    if width < NARROW:
        return _matchboard(p, finish, seed)
    height = 1.35 * width
    column, du = cells(p.u, width)
    row, dv = cells(p.v, height)
    inset = np.minimum(width / 2 - np.abs(du), height / 2 - np.abs(dv)) - F32(0.075)  # metres inside the frame's inner edge
    return _panel(p, finish, seed, inset, column, row)


def _matchboard(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Upright boards of the finish's width, a V groove between them."""
    column, du = cells(p.u, finish.scale)
    upright = dataclasses.replace(p, x=p.v, y=p.u + random_cells(column, column, seed=seed) * F32(2))
    figure = _grain(upright, 0.02, seed + 3)
    tone = piece_tone(column, np.zeros_like(column), seed=seed + 2, amount=0.035) + F32(0.03 * finish.contrast) * figure
    groove = joints(du, finish.scale, 0.014, p.footprint)
    color = mix(vary(ink(finish, 0), tone), ink(finish, 1, shade=0.6), F32(0.7) * groove)
    return MaterialSample(albedo=color, roughness=finish.roughness, height=F32(-0.006) * groove)


def framed_panel(p: Points, finish: Finish, seed: int, inset: np.ndarray, column: np.ndarray) -> MaterialSample:
    """Panelling whose frame is given: `inset` is metres inside the frame's inner edge, negative on the frame."""
    return _panel(p, finish, seed, inset.astype(F32), column, np.zeros_like(column))


def painted_wood(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Paint over wood: faint brush marks along the grain, worn to the wood in places."""
    paint, below = ink(finish, 0), ink(finish, 1, shade=0.5)
    brush = fbm((p.x * F32(0.08), p.y, p.z), wavelength=0.03, octaves=2, footprint=p.footprint, seed=seed)
    bend = F32(0.1) * fbm((p.x, p.y, p.z), wavelength=0.3, octaves=2, footprint=p.footprint, seed=seed + 5)
    worn = fbm((p.x * F32(0.4) + bend, p.y + bend, p.z), wavelength=0.25, octaves=4, footprint=p.footprint, seed=seed + 7)
    share = np.clip((worn - F32(0.95 - 0.6 * finish.wear)) * F32(3), 0, 1) * F32(finish.wear)
    color = mix(vary(paint, 0.035 * finish.contrast * brush), below, share)
    return MaterialSample(albedo=color, roughness=finish.roughness, height=brush * F32(1e-4))


def lacquer(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """A deep glossy coat: even colour, slow unevenness."""
    slow = fbm((p.x, p.y, p.z), wavelength=0.5, octaves=2, footprint=p.footprint, seed=seed)
    return MaterialSample(albedo=vary(ink(finish, 0), 0.06 * finish.contrast * slow), roughness=min(finish.roughness, 0.25))


def _grain(p: Points, spacing: float, seed: int) -> np.ndarray:
    """Rings and streaks in about [-1, 1], of the given spacing across the grain."""
    long = p.x * F32(0.09)
    wobble = fbm((p.x * F32(0.35), p.y, p.z), wavelength=0.5, octaves=2, footprint=p.footprint, seed=seed) * F32(0.06)
    radius = np.sqrt((p.y + wobble) ** 2 + (p.z * F32(0.6) + F32(0.13) + wobble) ** 2) + F32(0.25) * wobble
    ring_spacing = 2.2 * spacing
    rings = np.sin(radius * F32(2 * np.pi / ring_spacing)) * visible(ring_spacing, p.footprint)
    streaks = fbm((long, p.y, p.z), wavelength=2.0 * spacing, octaves=3, footprint=p.footprint, seed=seed + 11, gain=0.6)
    bands = fbm((long, p.y, p.z), wavelength=6.0 * spacing, octaves=1, footprint=p.footprint, seed=seed + 21)
    return (F32(0.45) * rings * (F32(0.6) + F32(0.4) * bands) + F32(0.65) * streaks + F32(0.5) * bands).astype(F32)


def _laid(
    p: Points, finish: Finish, seed: int, column: np.ndarray, row: np.ndarray, du: np.ndarray, dv: np.ndarray,
    length: float, width: float, *, along: np.ndarray, across: np.ndarray, tone: np.ndarray | float = 0.0,
) -> MaterialSample:  # fmt: skip
    """Pieces of wood laid in any pattern, given each point's piece and its place in it."""
    body = random_cells(column, row, seed=seed + 1)
    piece = dataclasses.replace(p, x=along.astype(F32), y=(across + body * F32(3.1)).astype(F32), z=(body * F32(0.9)).astype(F32))
    base, dark, grain = ink(finish, 0), ink(finish, 1, shade=0.35), ink(finish, 2, shade=0.55)
    figure = _grain(piece, 0.014, seed + 3)
    color = mix(base, grain, np.clip(0.22 + 0.34 * figure, 0, 1) * F32(finish.contrast))
    color = vary(
        color,
        piece_tone(column, row, seed=seed + 2, amount=0.17 * finish.contrast) + tone + 0.2 * stains(p, finish, seed=seed + 5),
    )
    gap = 0.004 + 0.004 * finish.wear
    joint = np.maximum(joints(dv, width, gap, p.footprint), joints(du, length, gap, p.footprint))
    roughness = np.clip(F32(finish.roughness) + F32(0.08) * figure + F32(0.3) * joint, 0.05, 1).astype(F32)
    return MaterialSample(albedo=mix(color, dark, F32(0.8) * joint), roughness=roughness, height=F32(-1.5e-3) * joint)


def _panel(p: Points, finish: Finish, seed: int, inset: np.ndarray, column: np.ndarray, row: np.ndarray) -> MaterialSample:
    base, groove = ink(finish, 0), ink(finish, 1, shade=0.4)
    turned = dataclasses.replace(p, x=p.v, y=p.u + random_cells(column, row, seed=seed) * F32(2), z=p.z)  # grain runs upwards
    figure = _grain(turned, 0.02, seed + 3)
    color = vary(mix(base, groove, np.clip(0.2 + 0.3 * figure, 0, 1) * F32(0.7 * finish.contrast)),
                 piece_tone(column, row, seed=seed + 2, amount=0.06) + 0.2 * stains(p, finish, seed=seed + 5))  # fmt: skip
    bead, field = F32(0.02), F32(0.07)  # metres: width of the moulding, and where the raised field begins
    shadow = border(inset, 0.02, p.footprint) + F32(0.6) * border(inset - field, 0.014, p.footprint)
    slope_in = np.clip(inset / bead, 0, 1)
    raised = np.clip((inset - field + F32(0.03)) / F32(0.03), 0, 1)
    height = F32(-0.012) * slope_in + F32(0.009) * raised
    return MaterialSample(
        albedo=mix(color, groove, np.clip(F32(0.55) * shadow, 0, 1)), roughness=finish.roughness, height=height.astype(F32)
    )
