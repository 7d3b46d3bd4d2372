"""PlayCanvas's compressed layout: 256 gaussians share the bounds of a `chunk`, and each packs into four words of 32 bits.

    packed_position, packed_scale  11 + 10 + 11 bits between the chunk's bounds; scales are logarithms
    packed_rotation                2 bits name the largest component of (w, x, y, z), left out; 10 bits each of the others
    packed_color                   8 bits each of red, green, blue (between the chunk's bounds if it has any) and opacity
    sh, f_rest_*                   8 bits of a coefficient between -4 and 4, all of red first

Source: the format's page in the PlayCanvas manual ("Compressed PLY"), and its reader in splat-transform (MIT).
"""

import numpy as np
from jaxtyping import Float, UInt32

from wm.splat.ply.body import Table
from wm.splat.ply.errors import PlyError

CHUNK = 256
"""Gaussians that share their bounds."""

PACKED = ("packed_position", "packed_rotation", "packed_scale", "packed_color")
_BOUNDS = tuple(f"{end}_{what}{axis}" for what in ("", "scale_") for end in ("min", "max") for axis in "xyz")


def unpacked(file: str, tables: dict[str, Table]) -> dict[str, np.ndarray]:
    """The columns of the INRIA layout by name, from the elements `chunk`, `vertex` and, where there are any, `sh`.

    Opacities of 0 and 255, of which the logarithms are infinite, take those of half a step less.

    Raises:
        PlyError: an element lacks a property, or has too few rows.
    """
    vertex, chunk = tables["vertex"], tables["chunk"]
    _require(file, "vertex", vertex, PACKED)
    _require(file, "chunk", chunk, _BOUNDS)
    if len(chunk) * CHUNK < len(vertex):
        raise PlyError(f"{file}: {len(chunk)} chunks for {len(vertex)} vertices; one for every {CHUNK} would be right")
    of = np.arange(len(vertex)) // CHUNK
    words = {name: vertex[name].astype(np.uint32) for name in PACKED}
    columns: dict[str, np.ndarray] = {}
    for what, names in (("", "xyz"), ("scale_", ("scale_0", "scale_1", "scale_2"))):
        shares = _shares(words["packed_scale" if what else "packed_position"], ((21, 11), (11, 10), (0, 11)))
        for name, axis, share in zip(names, "xyz", shares):
            columns[name] = _between(chunk[f"min_{what}{axis}"][of], chunk[f"max_{what}{axis}"][of], share)
    columns |= {f"rot_{i}": column for i, column in enumerate(_quaternions(words["packed_rotation"]))}
    *colors, opacity = _shares(words["packed_color"], ((24, 8), (16, 8), (8, 8), (0, 8)))
    bounded = "min_r" in (chunk.dtype.names or ())
    if bounded:
        _require(file, "chunk", chunk, tuple(f"{end}_{channel}" for end in ("min", "max") for channel in "rgb"))
    for name, channel, share in zip(("red", "green", "blue"), "rgb", colors):
        columns[name] = _between(chunk[f"min_{channel}"][of], chunk[f"max_{channel}"][of], share) if bounded else share
    opacity = np.clip(opacity, 0.5 / 255, 254.5 / 255)
    columns["opacity"] = np.log(opacity / (1 - opacity))
    return columns | _higher_bands(file, tables.get("sh"), len(vertex))


def _higher_bands(file: str, sh: Table | None, count: int) -> dict[str, np.ndarray]:
    if sh is None:
        return {}
    if len(sh) != count:
        raise PlyError(f"{file}: {len(sh)} rows of element sh for {count} vertices; as many would be right")
    # the middles of 256 steps, but both ends are exact
    steps = {name: sh[name].astype(np.float64) for name in sh.dtype.names or ()}
    return {name: 8 * np.where(s == 0, 0.0, np.where(s == 255, 1.0, (s + 0.5) / 256)) - 4 for name, s in steps.items()}


def _shares(word: UInt32[np.ndarray, " n"], fields: tuple[tuple[int, int], ...]) -> list[Float[np.ndarray, " n"]]:
    """Fields of (shift, bits) of every word, from 0 to 1."""
    return [((word >> np.uint32(shift)) & np.uint32(2**bits - 1)) / (2**bits - 1) for shift, bits in fields]


def _between(low: np.ndarray, high: np.ndarray, share: np.ndarray) -> np.ndarray:
    return low * (1 - share) + high * share


def _quaternions(word: UInt32[np.ndarray, " n"]) -> list[Float[np.ndarray, " n"]]:
    small = np.stack([(share - 0.5) * np.sqrt(2) for share in _shares(word, ((20, 10), (10, 10), (0, 10)))])
    largest = (word >> np.uint32(30)).astype(np.int64)
    components = np.sqrt(np.maximum(0, 1 - (small**2).sum(0)))[None].repeat(4, axis=0)
    for k in range(3):
        place = k + (largest <= k)  # the components but the largest, in order
        components[place, np.arange(len(word))] = small[k]
    return list(components)


def _require(file: str, element: str, table: Table, names: tuple[str, ...]) -> None:
    missing = [name for name in names if name not in (table.dtype.names or ())]
    if missing:
        raise PlyError(f"{file}: element {element} has no property {', '.join(missing)}; a compressed PLY has them")
