"""Band-limited noise and pattern primitives: hashes, gradient noise, sums of octaves, filtered lines and edges.

Everything is a pure float32 function of coordinates in metres. `footprint` is the width in metres of the pixel or texel that the
value will fill (a number or one per point); whatever is finer than it has faded out before it can alias: an octave of wavelength
L is weighed by clip(L / footprint - 1, 0, 1), a line is integrated over the footprint (Source: Heidrich et al. 1998 for clamping
octaves; Quilez, "Filtering procedural textures", for the line integral).
"""

import numpy as np
from jaxtyping import Float, Int, UInt32

Scalar = float | np.floating
F32 = np.float32
GAIN = F32(1.6)
"""Brings gradient noise, whose extremes are rare, to a standard deviation of about 0.35."""


def hash_cells(
    x: Int[np.ndarray, "..."], y: Int[np.ndarray, "..."], z: Int[np.ndarray, "..."] | int, seed: int
) -> UInt32[np.ndarray, "..."]:
    """A well mixed 32-bit hash of integer cells (Source: Ellis, "hash prospector", lowbias32)."""
    offset = (int(z) * 0x27D4EB2F + seed * 0x165667B1) & 0xFFFFFFFF if isinstance(z, int) else None
    h = x.astype(np.uint32) * np.uint32(0x9E3779B1)
    h = h + y.astype(np.uint32) * np.uint32(0x85EBCA77)
    if offset is None:
        h = h + np.asarray(z).astype(np.uint32) * np.uint32(0x27D4EB2F)
        offset = (seed * 0x165667B1) & 0xFFFFFFFF
    h += np.uint32(offset)
    h ^= h >> np.uint32(16)
    h *= np.uint32(0x7FEB352D)
    h ^= h >> np.uint32(15)
    h *= np.uint32(0x846CA68B)
    h ^= h >> np.uint32(16)
    return h


def random_cells(x: Int[np.ndarray, "..."], y: Int[np.ndarray, "..."], *, seed: int) -> Float[np.ndarray, "..."]:
    """One uniform number in [0, 1) for each integer cell."""
    return (hash_cells(x, y, 0, seed) >> np.uint32(8)).astype(F32) * F32(2.0**-24)


def noise2(x: Float[np.ndarray, "..."], y: Float[np.ndarray, "..."], *, seed: int) -> Float[np.ndarray, "..."]:
    """Gradient noise of wavelength 1 in about [-1, 1], zero on average (Source: Perlin 2002, quintic fade)."""
    x0, y0 = np.floor(x), np.floor(y)
    fx, fy = (x - x0).astype(F32), (y - y0).astype(F32)
    ix, iy = x0.astype(np.int32), y0.astype(np.int32)
    sx, sy = _fade(fx), _fade(fy)

    def corner(dx: int, dy: int) -> np.ndarray:
        h = hash_cells(ix + np.int32(dx), iy + np.int32(dy), 0, seed)
        return _component(h, 0) * (fx - F32(dx)) + _component(h, 16) * (fy - F32(dy))

    low = corner(0, 0)
    low += sx * (corner(1, 0) - low)
    high = corner(0, 1)
    high += sx * (corner(1, 1) - high)
    return (low + sy * (high - low)) * GAIN


def noise3(
    x: Float[np.ndarray, "..."], y: Float[np.ndarray, "..."], z: Float[np.ndarray, "..."], *, seed: int
) -> Float[np.ndarray, "..."]:
    """`noise2` in three dimensions."""
    x0, y0, z0 = np.floor(x), np.floor(y), np.floor(z)
    fx, fy, fz = (x - x0).astype(F32), (y - y0).astype(F32), (z - z0).astype(F32)
    ix, iy, iz = x0.astype(np.int32), y0.astype(np.int32), z0.astype(np.int32)
    sx, sy, sz = _fade(fx), _fade(fy), _fade(fz)

    def corner(dx: int, dy: int, dz: int) -> np.ndarray:
        h = hash_cells(ix + np.int32(dx), iy + np.int32(dy), iz + np.int32(dz), seed)
        value = _component(h, 0, 10) * (fx - F32(dx))
        value += _component(h, 10, 10) * (fy - F32(dy))
        value += _component(h, 20, 10) * (fz - F32(dz))
        return value

    def slab(dz: int) -> np.ndarray:
        low = corner(0, 0, dz)
        low += sx * (corner(1, 0, dz) - low)
        high = corner(0, 1, dz)
        high += sx * (corner(1, 1, dz) - high)
        return low + sy * (high - low)

    near = slab(0)
    return (near + sz * (slab(1) - near)) * GAIN


def fbm(
    coordinates: tuple[np.ndarray, ...],
    *,
    wavelength: float,
    octaves: int,
    footprint: Float[np.ndarray, "..."] | Scalar,
    seed: int,
    gain: float = 0.5,
) -> Float[np.ndarray, "..."]:
    """Sum of `octaves` of gradient noise, the first of `wavelength` metres, those finer than the footprint left out.

    Args:
      coordinates: two or three arrays, metres (stretch them for anisotropy; then the wavelength is that of the unstretched axis).
      gain: amplitude of an octave relative to the one before.
    """
    total = np.zeros(np.broadcast(*coordinates).shape, F32)
    amplitude, coarsest = 1.0, np.max(footprint)
    for octave in range(octaves):
        weight = visible(wavelength, footprint)
        if wavelength <= np.min(footprint):
            break
        scaled = [c * F32(1.0 / wavelength) + F32(17.13 * octave) for c in coordinates]
        value = noise2(scaled[0], scaled[1], seed=seed + octave) if len(scaled) == 2 else noise3(*scaled, seed=seed + octave)
        total += value * F32(amplitude) if wavelength >= 2 * coarsest else value * (F32(amplitude) * weight)
        wavelength, amplitude = 0.5 * wavelength, amplitude * gain
    return total


def visible(wavelength: float, footprint: Float[np.ndarray, "..."] | Scalar) -> np.ndarray:
    """How much of a pattern of this wavelength survives the footprint: 1 from two footprints on, 0 at one."""
    return np.asarray(np.clip(F32(wavelength) / np.maximum(footprint, F32(1e-6)) - F32(1), F32(0), F32(1)), F32)


def line(
    x: Float[np.ndarray, "..."], *, period: float, width: float, footprint: Float[np.ndarray, "..."] | Scalar
) -> Float[np.ndarray, "..."]:
    """Coverage in [0, 1] of a box of size `footprint` at x by lines of `width` centred on the multiples of `period`."""
    box = np.maximum(footprint, F32(1e-4)).astype(F32) if isinstance(footprint, np.ndarray) else F32(max(footprint, 1e-4))
    share = F32(width / period)
    t = x * F32(1.0 / period) + F32(0.5) * share
    half = box * F32(0.5 / period)
    return np.clip((_pulse_integral(t + half, share) - _pulse_integral(t - half, share)) / (2 * half), 0, 1).astype(F32)


def edge(distance: Float[np.ndarray, "..."], footprint: Float[np.ndarray, "..."] | Scalar) -> Float[np.ndarray, "..."]:
    """Coverage of a pixel by the side where distance > 0: a ramp one footprint wide."""
    return np.clip(distance / np.maximum(footprint, F32(1e-4)) + F32(0.5), F32(0), F32(1)).astype(F32)


def cells(x: Float[np.ndarray, "..."], period: float) -> tuple[Int[np.ndarray, "..."], Float[np.ndarray, "..."]]:
    """Index of the cell of length `period` that holds x, and metres from the cell's middle."""
    index = np.floor(x * F32(1.0 / period))
    return index.astype(np.int32), (x - (index + F32(0.5)) * F32(period)).astype(F32)


def _fade(t: np.ndarray) -> np.ndarray:
    return t * t * t * (t * (t * F32(6) - F32(15)) + F32(10))


def _component(h: np.ndarray, shift: int, bits: int = 16) -> np.ndarray:
    mask = (1 << bits) - 1
    return ((h >> np.uint32(shift)) & np.uint32(mask)).astype(F32) * F32(2.0 / mask) - F32(1)


def _pulse_integral(t: np.ndarray, share: np.floating) -> np.ndarray:
    whole = np.floor(t)
    return whole * share + np.minimum(t - whole, share)
