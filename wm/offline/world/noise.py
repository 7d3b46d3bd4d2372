"""Band-limited noise and pattern primitives: hashes, gradient noise, sums of octaves, filtered lines and edges.

Everything is a pure float32 function of coordinates in metres. `footprint` is the width in metres of the pixel or texel that the
value will fill (a number or one per point); whatever is finer than it has faded out before it can alias: an octave of wavelength
L is weighed by clip(L / footprint - 1, 0, 1), a line is integrated over the footprint (Source: Heidrich et al. 1998 for clamping
octaves; Quilez, "Filtering procedural textures", for the line integral).
"""

import numpy as np
from jaxtyping import Float, Int, UInt32

from wm.offline.world._noise_sum import PRIMES, SEED_PRIME, mixed, noise_sum

Scalar = float | np.floating
F32 = np.float32


def hash_cells(
    x: Int[np.ndarray, "..."], y: Int[np.ndarray, "..."], z: Int[np.ndarray, "..."] | int, seed: int
) -> UInt32[np.ndarray, "..."]:
    """A well mixed 32-bit hash of integer cells."""
    offset = np.uint32((seed * SEED_PRIME) & 0xFFFFFFFF)
    parts = (np.asarray(c).astype(np.uint32) * np.uint32(prime) for c, prime in zip((x, y, z), PRIMES))
    return mixed(np.asarray(sum(parts, start=offset)))


def random_cells(x: Int[np.ndarray, "..."], y: Int[np.ndarray, "..."], *, seed: int) -> Float[np.ndarray, "..."]:
    """One uniform number in [0, 1) for each integer cell."""
    return (hash_cells(x, y, 0, seed) >> np.uint32(8)).astype(F32) * F32(2.0**-24)


def fbm(
    coordinates: tuple[np.ndarray, ...],
    *,
    wavelength: float,
    octaves: int,
    footprint: Float[np.ndarray, "..."] | Scalar,
    seed: int,
    gain: float = 0.5,
) -> Float[np.ndarray, "..."]:
    """Sum of `octaves` of gradient noise, the first of `wavelength` metres, those finer than the footprint left out. The first is
    in about [-1, 1] and zero on average.

    Args:
      coordinates: two or three arrays, metres (stretch them for anisotropy; then the wavelength is that of the unstretched axis).
      gain: amplitude of an octave relative to the one before.
    """
    arrays = np.broadcast_arrays(*coordinates, footprint)
    flat = [np.ascontiguousarray(array, F32).reshape(-1) for array in arrays]
    finest = float(np.min(footprint, initial=np.inf))
    seen = next((k for k in range(octaves) if wavelength * 0.5**k <= finest), octaves)
    if seen == 0:
        return np.zeros(arrays[0].shape, F32)
    return noise_sum(flat[:-1], flat[-1], wavelength, seen, gain, seed).reshape(arrays[0].shape)


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


def _pulse_integral(t: np.ndarray, share: np.floating) -> np.ndarray:
    whole = np.floor(t)
    return whole * share + np.minimum(t - whole, share)
