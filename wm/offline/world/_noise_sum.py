"""Octaves of gradient noise, compiled by XLA: one pass over the points, block by block, with all octaves of a block in turn.

NumPy needs some fifty passes over arrays of every corner of every cell, and holds Python's interpreter lock between them. This
takes an eighth of its time and lets other threads run.
"""

import functools
from collections.abc import Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from wm.compiler_options import UNPARTITIONED

PRIMES = (0x9E3779B1, 0x85EBCA77, 0x27D4EB2F)
"""Of the three coordinates of a cell in its hash."""
GAIN = 1.6
"""Brings gradient noise, whose extremes are rare, to a standard deviation of about 0.35."""
SEED_PRIME = 0x165667B1
SHIFT = 17.13
"""Cells by which an octave is moved against the one before, so that their zeros do not meet."""
BLOCK = 2048
"""Points of which all octaves are computed before the next: their temporaries stay in the cache."""
_SIZES = (2048, 8192, 32768, 131072)
"""Lengths of arrays that are compiled for; only the blocks that hold points cost time."""


def noise_sum(
    coordinates: Sequence[np.ndarray], footprint: np.ndarray, wavelength: float, octaves: int, gain: float, seed: int
) -> np.ndarray:
    """[n] float32: see `wm.offline.world.noise.fbm`; arrays are float32 of one length n."""
    n, parts = len(footprint), []
    for first in range(0, n, _SIZES[-1]):
        count = min(n - first, _SIZES[-1])
        size = next(size for size in _SIZES if size >= count)
        padded = [_padded(array[first : first + count], size) for array in (*coordinates, footprint)]
        summed = _summed(
            tuple(padded[:-1]), padded[-1], np.int32(-(-count // BLOCK)), np.float32(wavelength), np.int32(octaves),
            np.float32(gain), np.uint32(seed & 0xFFFFFFFF),
        )  # fmt: skip
        parts.append(np.asarray(summed)[:count])
    return parts[0] if len(parts) == 1 else np.concatenate(parts) if parts else np.zeros(0, np.float32)


def _padded(array: np.ndarray, size: int) -> np.ndarray:
    if len(array) == size:
        return np.ascontiguousarray(array)
    out = np.zeros(size, np.float32)
    out[: len(array)] = array
    return out


def _blocks(coordinates, footprint, blocks, wavelength, octaves, gain, seed):
    def block(k, out):
        here = [jax.lax.dynamic_slice(array, (k * BLOCK,), (BLOCK,)) for array in (*coordinates, footprint)]
        value = _octaves(here[:-1], here[-1], wavelength, octaves, gain, seed)
        return jax.lax.dynamic_update_slice(out, value, (k * BLOCK,))

    return jax.lax.fori_loop(0, blocks, block, jnp.zeros_like(footprint))


_summed = jax.jit(_blocks, compiler_options=UNPARTITIONED)


def _octaves(coordinates, footprint, wavelength, octaves, gain, seed):
    def octave(k, carry):
        total, length, amplitude = carry
        weight = jnp.clip(length / jnp.maximum(footprint, 1e-6) - 1, 0, 1)
        cells = [c * (1 / length) + SHIFT * k for c in coordinates]
        noise = gradient_noise(cells, seed + k.astype(jnp.uint32))
        return total + noise * (amplitude * weight), 0.5 * length, amplitude * gain

    start = (jnp.zeros_like(footprint), wavelength, jnp.float32(1))
    return jax.lax.fori_loop(0, octaves, octave, start)[0]


def gradient_noise(coordinates: Sequence[jax.Array], seed: jax.Array) -> jax.Array:
    """Gradient noise of wavelength 1 (Source: Perlin 2002, quintic fade), from hashed gradients of every corner of a cell."""
    dimensions = len(coordinates)
    bits = 16 if dimensions == 2 else 10  # of the hash, for each component of a gradient
    whole = [jnp.floor(c) for c in coordinates]
    offset = [c - w for c, w in zip(coordinates, whole)]
    fade = [f * f * f * (f * (f * 6 - 15) + 10) for f in offset]
    hashed = [w.astype(jnp.int32).astype(jnp.uint32) * jnp.uint32(p) for w, p in zip(whole, PRIMES)]
    origin = seed * jnp.uint32(SEED_PRIME)

    def corner(place: tuple[int, ...]) -> jax.Array:
        h = origin
        for axis, step in enumerate(place):
            h = h + hashed[axis] + jnp.uint32(PRIMES[axis] * step & 0xFFFFFFFF)
        h = mixed(h)
        components = (_component(h, axis * bits, bits) * (offset[axis] - step) for axis, step in enumerate(place))
        return functools.reduce(jnp.add, components)

    def interpolated(place: tuple[int, ...]) -> jax.Array:
        axis = len(place)
        if axis == dimensions:
            return corner(place)
        low, high = interpolated((*place, 0)), interpolated((*place, 1))
        return low + fade[axis] * (high - low)

    return interpolated(()) * jnp.float32(GAIN)


def mixed(h: Any) -> Any:
    """uint32 numbers with every bit depending on all others, of NumPy or JAX (Source: Ellis, "hash prospector", lowbias32)."""
    h = h ^ (h >> np.uint32(16))
    h = h * np.uint32(0x7FEB352D)
    h = h ^ (h >> np.uint32(15))
    h = h * np.uint32(0x846CA68B)
    return h ^ (h >> np.uint32(16))


def _component(h: jax.Array, shift: int, bits: int) -> jax.Array:
    """A number in [-1, 1] from some bits of a hash."""
    mask = (1 << bits) - 1
    return ((h >> shift) & jnp.uint32(mask)).astype(jnp.float32) * jnp.float32(2.0 / mask) - 1
