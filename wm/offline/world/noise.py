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
PART = 1 << 12
"""Points for which noise is computed at once."""
_PRIMES = (0x9E3779B1, 0x85EBCA77, 0x27D4EB2F)


def hash_cells(
    x: Int[np.ndarray, "..."], y: Int[np.ndarray, "..."], z: Int[np.ndarray, "..."] | int, seed: int
) -> UInt32[np.ndarray, "..."]:
    """A well mixed 32-bit hash of integer cells (Source: Ellis, "hash prospector", lowbias32)."""
    offset = np.uint32((seed * 0x165667B1) & 0xFFFFFFFF)
    parts = (np.asarray(c).astype(np.uint32) * np.uint32(prime) for c, prime in zip((x, y, z), _PRIMES))
    return _mixed(np.asarray(sum(parts, start=offset)))


def _mixed(h: UInt32[np.ndarray, "..."]) -> UInt32[np.ndarray, "..."]:
    """h with every bit depending on all others; the array h is overwritten."""
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
    return _noise((x, y), seed)


def noise3(
    x: Float[np.ndarray, "..."], y: Float[np.ndarray, "..."], z: Float[np.ndarray, "..."], *, seed: int
) -> Float[np.ndarray, "..."]:
    """`noise2` in three dimensions."""
    return _noise((x, y, z), seed)


def _noise(coordinates: tuple[np.ndarray, ...], seed: int) -> np.ndarray:
    """Gradient noise, PART points at a time, so that what all corners of a cell need together stays in the cache."""
    arrays = np.broadcast_arrays(*coordinates)
    flat = [array.reshape(-1) for array in arrays]
    parts = [_part([array[i : i + PART] for array in flat], seed) for i in range(0, max(len(flat[0]), 1), PART)]
    return (parts[0] if len(parts) == 1 else np.concatenate(parts)).reshape(arrays[0].shape)


def _part(coordinates: list[np.ndarray], seed: int) -> np.ndarray:
    """Gradient noise at n points: the corners of their cells, 2 x 2 or 2 x 2 x 2, are leading axes of every array here."""
    dimensions = len(coordinates)
    bits = 16 if dimensions == 2 else 10
    h, offsets, fades = np.asarray((seed * 0x165667B1) & 0xFFFFFFFF, np.uint32), [], []
    for axis, x in enumerate(coordinates):
        whole = np.floor(x)
        f = (x - whole).astype(F32)
        fades.append(_fade(f))
        shape = [1] * dimensions + [-1]
        shape[axis] = 2
        offsets.append(np.stack([f, f - F32(1)]).reshape(shape))
        prime = np.uint32(_PRIMES[axis])
        first = whole.astype(np.int32).astype(np.uint32) * prime
        h = np.asarray(h + np.stack([first, first + prime]).reshape(shape))
    h = _mixed(h)
    value = _component(h, 0, bits) * offsets[0]
    for axis in range(1, dimensions):
        value += _component(h, axis * bits, bits) * offsets[axis]
    for fade in fades:
        value = value[0] + fade * (value[1] - value[0])
    return value * GAIN


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


def _component(h: np.ndarray, shift: int, bits: int) -> np.ndarray:
    mask = (1 << bits) - 1
    value = ((h >> np.uint32(shift)) & np.uint32(mask)).astype(F32)
    value *= F32(2.0 / mask)
    value -= F32(1)
    return value


def _pulse_integral(t: np.ndarray, share: np.floating) -> np.ndarray:
    whole = np.floor(t)
    return whole * share + np.minimum(t - whole, share)
