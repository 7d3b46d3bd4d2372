"""Writes PlayCanvas's compressed PLY. `wm.splat.ply.compressed` says what is in it, and reads it.

Gaussians that lie near each other share a chunk, so the file has its own order: along a Morton curve. Written here since the
library that has the format (gaussforge 0.6) keeps the order, and then a chunk is as large as a room.
"""

from pathlib import Path

import numpy as np
from jaxtyping import Float, Float32, Int64, UInt32, UInt64

from wm.splat.ply.compressed import CHUNK, PACKED
from wm.splat.ply.standard import packable
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

_PLACE, _COLOR = (11, 10, 11), (8, 8, 8)  # bits
_CURVE = 10  # bits of the Morton curve along each axis


def save_compressed_ply(path: str | Path, gaussians: Gaussians) -> None:
    """Write gaussians as a compressed PLY file; their order becomes that of `morton_order`, their axes stay."""
    g = packable(gaussians)
    order = morton_order(g.means)
    colors, opacity = 0.5 + SH_C0 * g.sh[order, 0], 1 / (1 + np.exp(-g.opacity_logits[order].astype(np.float64)))
    chunk, words = [], []
    for values, bits in ((g.means[order], _PLACE), (g.log_scales[order], _PLACE), (colors, _COLOR)):
        low, high, word = _packed(values, bits)
        chunk += [low, high]
        words.append(word)
    rgba = (words[2] << np.uint32(8)) | np.round(opacity * 255).astype(np.uint32)
    vertex = np.stack([words[0], _rotations(g.quats[order]), words[1], rgba], axis=1).astype("<u4")
    bands = np.swapaxes(g.sh[order, 1:], 1, 2).reshape(len(order), -1)  # all of red first
    steps = np.clip(np.floor((bands / 8 + 0.5) * 256), 0, 255).astype(np.uint8)
    head = _header(len(chunk[0]), len(order), bands.shape[1])
    Path(path).write_bytes(head + np.concatenate(chunk, axis=1).astype("<f4").tobytes() + vertex.tobytes() + steps.tobytes())


def morton_order(means: Float[np.ndarray, "n 3"]) -> Int64[np.ndarray, " n"]:
    """The order along a Morton curve through the box around all means; ties keep their order."""
    return np.argsort(morton_codes(means, bits=_CURVE), kind="stable")


def morton_codes(means: Float[np.ndarray, "n 3"], *, bits: int) -> UInt64[np.ndarray, " n"]:
    """The place of each mean on a Morton curve of 2^bits cells along each side of the box around all (in float32)."""
    code = np.zeros(len(means), np.uint64)
    if not len(means):
        return code
    low, most = means.min(axis=0), np.float32(2**bits - 1)
    size = means.max(axis=0) - low
    factor = np.where(size > 1e-8, most / np.where(size > 1e-8, size, 1), 0).astype(means.dtype)
    cells = np.minimum((means - low) * factor, most).astype(np.uint64)
    for bit in range(bits):
        for axis in range(3):
            code |= ((cells[:, axis] >> np.uint64(bit)) & np.uint64(1)) << np.uint64(3 * bit + axis)
    return code


def chunk_extents(values: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """How far the bounds of each row's chunk lie apart."""
    low, high = _bounds(values)
    return (high - low)[np.arange(len(values)) // CHUNK]


def _bounds(values: Float[np.ndarray, "n 3"]) -> tuple[Float32[np.ndarray, "chunks 3"], Float32[np.ndarray, "chunks 3"]]:
    """The least and the largest values of each chunk."""
    if not len(values):
        return np.zeros((0, 3), np.float32), np.zeros((0, 3), np.float32)
    starts = np.arange(0, len(values), CHUNK)
    return np.minimum.reduceat(values, starts).astype(np.float32), np.maximum.reduceat(values, starts).astype(np.float32)


def _packed(
    values: Float[np.ndarray, "n 3"], bits: tuple[int, int, int]
) -> tuple[np.ndarray, np.ndarray, UInt32[np.ndarray, " n"]]:
    """The bounds of every chunk [chunks, 3], and each row in one word between those of its chunk."""
    low, high = _bounds(values)
    of = np.arange(len(values)) // CHUNK
    size = np.where(high > low, high - low, 1)
    share = np.clip((values - low[of]) / size[of], 0, 1).astype(np.float64)
    word = np.zeros(len(values), np.uint32)
    for axis, count in enumerate(bits):
        word = (word << np.uint32(count)) | np.round(share[:, axis] * (2**count - 1)).astype(np.uint32)
    return low, high, word


def _rotations(quats: Float[np.ndarray, "n 4"]) -> UInt32[np.ndarray, " n"]:
    """The index of the largest component of wxyz, made positive and left out, then 10 bits of each of the others."""
    rows = np.arange(len(quats))
    largest = np.abs(quats).argmax(axis=1)
    q = quats * np.where(quats[rows, largest] < 0, -1, 1)[:, None]
    word = largest.astype(np.uint32)
    for k in range(3):
        component = q[rows, k + (largest <= k)]
        word = (word << np.uint32(10)) | np.round(np.clip(component / np.sqrt(2) + 0.5, 0, 1) * 1023).astype(np.uint32)
    return word


def _header(chunks: int, count: int, bands: int) -> bytes:
    bounds = [f"{end}_{what}{axis}" for what in ("", "scale_") for end in ("min", "max") for axis in "xyz"]
    bounds += [f"{end}_{channel}" for end in ("min", "max") for channel in "rgb"]
    lines = ["ply", "format binary_little_endian 1.0", f"element chunk {chunks}", *(f"property float {name}" for name in bounds)]
    lines += [f"element vertex {count}", *(f"property uint {name}" for name in PACKED)]
    if bands:
        lines += [f"element sh {count}", *(f"property uchar f_rest_{k}" for k in range(bands))]
    return "\n".join([*lines, "end_header\n"]).encode("ascii")
