"""The points at which a material is sampled, what it gives there, and the few operations that all materials share."""

import dataclasses
from collections.abc import Callable

import numpy as np
from jaxtyping import Float, Int

from wm.color import to_linear
from wm.offline.style.finish import Finish
from wm.offline.world.noise import F32, cells, fbm, random_cells


@dataclasses.dataclass(frozen=True, eq=False)
class Points:
    """Where a material is evaluated. Laid patterns read (u, v) on the surface, solid ones (x, y, z) in the body; metres."""

    u: np.ndarray  # [n] float32
    v: np.ndarray  # [n] float32
    x: np.ndarray  # [n] float32 along the grain
    y: np.ndarray  # [n] float32
    z: np.ndarray  # [n] float32
    footprint: np.ndarray | float  # width of the pixel or texel, one number or one per point


@dataclasses.dataclass(frozen=True, eq=False)
class MaterialSample:
    """What light meets of a material at n points."""

    albedo: np.ndarray  # [3, n] float32 linear, in [0, 1]
    roughness: np.ndarray | float  # 0 mirror .. 1 matt
    height: np.ndarray | float = 0.0  # metres of relief along the normal
    metallic: float = 0.0  # 1: reflects its albedo and scatters nothing


Material = Callable[[Points, Finish, int], MaterialSample]
"""A material: (points, finish, seed) -> MaterialSample. Pure; equal arguments give equal bytes."""


def flat_points(
    u: Float[np.ndarray, "n"], v: Float[np.ndarray, "n"], *, footprint: float | Float[np.ndarray, "n"], depth: float = 0.0
) -> Points:
    """Points of a plane cut through the body at `depth`, the grain along u."""
    u, v = u.astype(F32), v.astype(F32)
    return Points(u=u, v=v, x=u, y=v, z=np.full_like(u, depth), footprint=footprint)


def ink(finish: Finish, index: int, *, shade: float = 0.6) -> Float[np.ndarray, "3 1"]:
    """Linear colour `index` of a finish as a column; a colour it does not name is its base times `shade`."""
    if index < len(finish.colors):
        return to_linear(np.asarray(finish.colors[index], F32))[:, None]
    return to_linear(np.asarray(finish.colors[0], F32))[:, None] * F32(shade)


def mix(a: Float[np.ndarray, "3 _"], b: Float[np.ndarray, "3 _"], weight: Float[np.ndarray, "n"]) -> Float[np.ndarray, "3 n"]:
    """a where weight is 0, b where it is 1; either may be one colour or one per point."""
    return (a + (b - a) * weight).astype(F32)


def vary(color: Float[np.ndarray, "3 _"], amount: Float[np.ndarray, "n"]) -> Float[np.ndarray, "3 n"]:
    """A colour made lighter (amount > 0) or darker by about that share, never beyond [0, 1]."""
    return np.clip(color * np.maximum(F32(1) + amount, F32(0.05)), 0, 1).astype(F32)


def border(distance: Float[np.ndarray, "n"], width: float, footprint: float | Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    """Coverage of a box one footprint wide, `distance` from the middle of a line of `width`."""
    box = np.maximum(footprint, F32(1e-4))
    overlap = np.minimum(distance + box / 2, width / 2) - np.maximum(distance - box / 2, -width / 2)
    return np.clip(overlap / box, 0, 1).astype(F32)


def joints(
    across: Float[np.ndarray, "n"], size: float, width: float, footprint: float | Float[np.ndarray, "n"]
) -> Float[np.ndarray, "n"]:
    """Coverage by the joints of a row of pieces of `size`, given metres from the piece's middle."""
    return border(size / 2 - np.abs(across), width, footprint)


def tile_grid(
    p: Points, width: float, height: float
) -> tuple[Int[np.ndarray, "n"], Int[np.ndarray, "n"], Float[np.ndarray, "n"], Float[np.ndarray, "n"]]:
    """Column and row of the tile at each point and metres from the tile's middle."""
    column, du = cells(p.u, width)
    row, dv = cells(p.v, height)
    return column, row, du, dv


def piece_tone(column: Int[np.ndarray, "n"], row: Int[np.ndarray, "n"], *, seed: int, amount: float) -> Float[np.ndarray, "n"]:
    """A tone in [-amount, amount] for each piece of a laid pattern."""
    return (random_cells(column, row, seed=seed) * F32(2) - F32(1)) * F32(amount)


def stains(p: Points, finish: Finish, *, seed: int, size: float = 0.6) -> Float[np.ndarray, "n"]:
    """Slow uneven darkening in [-1, 1] times the finish's wear: what age does to every surface."""
    return fbm((p.u, p.v), wavelength=size, octaves=3, footprint=p.footprint, seed=seed) * F32(finish.wear)
