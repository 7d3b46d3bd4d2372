"""Stone, brick, clay and glazed tiles."""

import dataclasses

import numpy as np

from wm.offline.style.finish import Finish
from wm.offline.world.materials.material_sample import (
    F32,
    MaterialSample,
    Points,
    ink,
    joints,
    mix,
    piece_tone,
    stains,
    tile_grid,
    vary,
)
from wm.offline.world.noise import cells, edge, fbm, random_cells, visible


def marble(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Polished marble: clouds of the base crossed by bent veins of two sizes."""
    color = _marble_color(p, finish, seed, ink(finish, 0), ink(finish, 1, shade=0.5), ink(finish, 2, shade=0.75))
    return MaterialSample(albedo=color, roughness=finish.roughness)


def stone_tiles(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Square cut stone with fine joints; every tile is cut from another place of the block."""
    side = finish.scale
    column, row, du, dv = tile_grid(p, side, side)
    offset = random_cells(column, row, seed=seed)
    body = dataclasses.replace(p, x=p.x + offset * F32(9), y=p.y + offset * F32(5))
    figure = (
        finish if len(finish.colors) < 3 else dataclasses.replace(finish, colors=(finish.colors[0], finish.colors[2]), scale=0.3)
    )
    color = _marble_color(
        body,
        dataclasses.replace(figure, scale=0.3),
        seed + 3,
        ink(finish, 0),
        ink(finish, 2, shade=0.7),
        ink(finish, 2, shade=0.8),
    )
    color = vary(color, piece_tone(column, row, seed=seed + 2, amount=0.13 * finish.contrast))
    return _jointed(p, finish, seed, color, du, dv, side, side, joint=0.008)


def checker_tiles(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Two tones of marble in squares."""
    side = finish.scale
    column, row, du, dv = tile_grid(p, side, side)
    odd = ((column + row) % 2).astype(F32)
    offset = random_cells(column, row, seed=seed)
    body = dataclasses.replace(p, x=p.x + offset * F32(9), y=p.y + offset * F32(5))
    cloud = fbm((body.x, body.y), wavelength=0.25, octaves=3, footprint=p.footprint, seed=seed + 1)
    color = vary(mix(ink(finish, 0), ink(finish, 1, shade=0.1), odd),
                 0.14 * finish.contrast * cloud + piece_tone(column, row, seed=seed + 2, amount=0.06))  # fmt: skip
    return _jointed(p, finish, seed, color, du, dv, side, side, joint=0.005, joint_color=ink(finish, 2, shade=0.5))


def stone_blocks(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Ashlar: courses half as high as the blocks are long, each shifted by about half a block, with rough dressed faces."""
    length = finish.scale
    height = 0.5 * length
    row, dv = cells(p.v, height)
    shift = (F32(0.5) * (row % 2) + F32(0.3) * random_cells(row, np.zeros_like(row), seed=seed)) * F32(length)
    column, du = cells(p.u + shift, length)
    rough = fbm((p.u, p.v), wavelength=0.18, octaves=4, footprint=p.footprint, seed=seed + 1, gain=0.6)
    tone = piece_tone(column, row, seed=seed + 2, amount=0.2 * finish.contrast)
    color = vary(ink(finish, 0), tone + 0.16 * finish.contrast * rough)
    stain = np.clip(fbm((p.u, p.v * F32(0.4)), wavelength=0.9, octaves=3, footprint=p.footprint, seed=seed + 5), 0, 1)
    color = mix(color, ink(finish, 2, shade=0.6), stain * F32(0.3 + 0.4 * finish.wear))
    return _jointed(p, finish, seed, color, du, dv, length, height, joint=0.016, relief=0.006, rough=rough * F32(2e-3))


def brick(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Running bond: three courses to a brick's length, some bricks burnt."""
    length = finish.scale
    height = length / 3
    row, dv = cells(p.v, height)
    column, du = cells(p.u + F32(0.5 * length) * (row % 2), length)
    rough = fbm((p.u, p.v), wavelength=0.08, octaves=3, footprint=p.footprint, seed=seed + 1)
    odd = np.clip((random_cells(column, row, seed=seed + 4) - F32(0.72)) * F32(12), 0, 1)
    color = mix(ink(finish, 0), ink(finish, 2, shade=0.6), odd * F32(0.7))
    color = vary(color, piece_tone(column, row, seed=seed + 2, amount=0.17 * finish.contrast) + 0.1 * rough)
    return _jointed(p, finish, seed, color, du, dv, length, height, joint=0.013, relief=0.005, rough=rough * F32(1e-3))


def terracotta(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Square clay tiles, uneven in colour from tile to tile and within each."""
    side = finish.scale
    column, row, du, dv = tile_grid(p, side, side)
    odd = random_cells(column, row, seed=seed + 4)
    fire = fbm((p.u, p.v), wavelength=0.22, octaves=3, footprint=p.footprint, seed=seed + 1)
    color = mix(ink(finish, 0), ink(finish, 2, shade=0.7), np.clip(F32(1.4) * odd - F32(0.5) + F32(0.25) * fire, 0, 1) * F32(0.8))
    color = vary(color, piece_tone(column, row, seed=seed + 2, amount=0.12 * finish.contrast) + 0.08 * fire)
    return _jointed(p, finish, seed, color, du, dv, side, side, joint=0.010)


def mosaic(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Tesserae laid as interlaced circles and lozenges a little over half a metre across, with bands of the border colour."""
    side = max(finish.scale, 0.02)
    column, row, du, dv = tile_grid(p, side, side)
    cu, cv = (column + F32(0.5)) * F32(side), (row + F32(0.5)) * F32(side)  # a tessera has one colour: the pattern at its middle
    period = 0.6
    _, mu = cells(cu, period)
    _, mv = cells(cv, period)
    radius = np.hypot(mu, mv)
    corner = np.hypot(np.abs(mu) - F32(period / 2), np.abs(mv) - F32(period / 2))
    ring = (np.abs(radius - F32(0.36 * period)) < 0.035) | (np.abs(corner - F32(0.36 * period)) < 0.035)
    star = (np.abs(mu) + np.abs(mv) < 0.14 * period) | (corner < 0.12 * period)
    color = mix(ink(finish, 0), ink(finish, 1, shade=0.5), ring.astype(F32))
    color = mix(color, ink(finish, 2, shade=0.3), star.astype(F32))
    color = vary(color, piece_tone(column, row, seed=seed + 2, amount=0.2 * finish.contrast) * visible(side, p.footprint))
    return _jointed(
        p, finish, seed, color, du, dv, side, side, joint=0.12 * side, joint_color=ink(finish, 0) * F32(0.75), relief=0.001
    )


def sectile(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Marble inlay: squares framed in the base, in them by turns a disc and a lozenge of the second and third marble."""
    side = finish.scale
    column, row, du, dv = tile_grid(p, side, side)
    odd = (column + row) % 2 == 1
    soft = np.maximum(p.footprint, F32(0.004))
    square = np.maximum(np.abs(du), np.abs(dv))
    figure = np.where(odd, np.hypot(du, dv), (np.abs(du) + np.abs(dv)) * F32(0.80))
    share = figure / F32(side)
    first, second, third = ink(finish, 0), ink(finish, 1, shade=0.45), ink(finish, 2, shade=0.6)
    ours, others = (np.where(odd, a, b) for a, b in ((second, third), (third, second)))
    color = mix(first, ours, edge(F32(0.37 * side) - figure, soft))
    color = mix(color, first * F32(1.05), edge(F32(0.25 * side) - figure, soft) * (share < 0.3))
    color = mix(color, others, edge(F32(0.12 * side) - figure, soft))
    color = mix(color, second, edge(square - F32(0.455 * side), soft))
    offset = random_cells(column * 4 + (share < 0.37) + (share < 0.25), row, seed=seed)  # every piece from its own block
    body = dataclasses.replace(p, x=p.x + offset * F32(9), y=p.y + offset * F32(5))
    stone = dataclasses.replace(finish, scale=0.35)
    color = _marble_color(body, stone, seed + 3, color, color * F32(0.45), color * F32(0.75))
    color = vary(color, piece_tone(column, row, seed=seed + 2, amount=0.08 * finish.contrast) * visible(side, p.footprint))
    return _jointed(p, finish, seed, color, du, dv, side, side, joint=0.004, joint_color=first * F32(0.5), relief=0.001)


def water_tiles(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Glazed tiles under a net of caustic light."""
    side = finish.scale
    column, row, du, dv = tile_grid(p, side, side)
    color = vary(ink(finish, 0), piece_tone(column, row, seed=seed + 2, amount=0.16 * finish.contrast))
    bend = fbm((p.u, p.v), wavelength=0.5, octaves=2, footprint=p.footprint, seed=seed + 1) * F32(0.15)
    net = fbm((p.u + bend, p.v - bend), wavelength=0.32, octaves=2, footprint=p.footprint, seed=seed + 6)
    caustic = np.exp(-np.abs(net) * F32(9)) * F32(0.55 * finish.contrast)
    color = mix(color, ink(finish, 2, shade=1.6), np.clip(caustic, 0, 1))
    return _jointed(p, finish, seed, color, du, dv, side, side, joint=0.006)


def concrete(p: Points, finish: Finish, seed: int) -> MaterialSample:
    """Board-marked concrete poured in lifts, with tie holes and slow stains."""
    lift = max(finish.scale, 0.3)
    row, dv = cells(p.v, lift)
    column, du = cells(p.u, 2 * lift)
    cloud = fbm((p.u, p.v), wavelength=0.7, octaves=4, footprint=p.footprint, seed=seed, gain=0.55)
    boards = fbm((p.u * F32(0.1), p.v), wavelength=0.12, octaves=2, footprint=p.footprint, seed=seed + 1)
    color = vary(
        ink(finish, 0), finish.contrast * (0.10 * cloud + 0.05 * boards) + piece_tone(column, row, seed=seed + 2, amount=0.04)
    )
    stain = np.clip(fbm((p.u, p.v * F32(0.25)), wavelength=0.6, octaves=3, footprint=p.footprint, seed=seed + 5) - F32(0.1), 0, 1)
    color = mix(color, ink(finish, 1, shade=0.7), stain * F32(0.2 + 0.5 * finish.wear))
    radius = F32(0.018)
    hole = edge(radius - np.hypot(np.abs(du) - F32(0.5 * lift), dv), p.footprint) * np.minimum(2 * radius / p.footprint, 1) ** 2
    seam = np.maximum(joints(dv, lift, 0.008, p.footprint), joints(du, 2 * lift, 0.008, p.footprint))
    color = color * (F32(1) - F32(0.45) * np.maximum(hole, F32(0.6) * seam))
    return MaterialSample(albedo=color.astype(F32), roughness=finish.roughness, height=F32(-2e-3) * seam)


def _marble_color(p: Points, finish: Finish, seed: int, base: np.ndarray, vein: np.ndarray, second: np.ndarray) -> np.ndarray:
    spacing = max(finish.scale, 0.05)
    warp = fbm((p.x, p.y, p.z), wavelength=1.5 * spacing, octaves=3, footprint=p.footprint, seed=seed)
    cloud = fbm((p.x, p.y, p.z), wavelength=2.0 * spacing, octaves=2, footprint=p.footprint, seed=seed + 5)

    def veins(direction: tuple[float, float, float], period: float, sharpness: float, bend: float) -> np.ndarray:
        phase = (p.x * F32(direction[0]) + p.y * F32(direction[1]) + p.z * F32(direction[2])) / F32(period) + F32(bend) * warp
        distance = np.abs(phase - np.round(phase))  # in periods, 0 on the vein
        return np.exp(-distance * F32(sharpness)) * visible(period * 4 / sharpness, p.footprint)

    color = vary(base, F32(0.10 * finish.contrast) * cloud)
    strength = F32(finish.contrast) * np.clip(F32(0.6) + F32(0.7) * cloud, 0, 1)
    color = mix(color, second, np.clip(F32(0.5) * strength * veins((0.8, -0.6, 0.4), 0.6 * spacing, 7.0, 0.5), 0, 1))
    return mix(color, vein, np.clip(F32(0.75) * strength * veins((0.55, 0.83, -0.3), 1.6 * spacing, 22.0, 0.45), 0, 1))


def _jointed(
    p: Points, finish: Finish, seed: int, color: np.ndarray, du: np.ndarray, dv: np.ndarray, width: float, height: float,
    *, joint: float, joint_color: np.ndarray | None = None, relief: float = 0.002, rough: np.ndarray | float = 0.0,
) -> MaterialSample:  # fmt: skip
    """A laid pattern's pieces with their joints drawn in and sunk by `relief`."""
    cover = np.maximum(joints(du, width, joint, p.footprint), joints(dv, height, joint, p.footprint))
    color = vary(color, 0.18 * stains(p, finish, seed=seed + 8))
    color = mix(color, ink(finish, 1, shade=0.6) if joint_color is None else joint_color, F32(0.85) * cover)
    roughness = np.clip(F32(finish.roughness) + F32(0.4) * cover, 0, 1).astype(F32)
    return MaterialSample(albedo=color, roughness=roughness, height=(rough - F32(relief) * cover).astype(F32))
