"""The look of objects: which finish each face of each piece has, and the coordinates its pattern is laid in.

A piece's mesh falls into parts (faces of one slot that hang together: a leg, a seat, a door). Solid materials are cut from a
block of their own for every part, the grain along the part's longest side; laid patterns use the two axes across the face's
normal. Faces with a texture of their own (things lifted from images) have its colours instead of the pattern's, and keep the
gloss of their material.
"""

import dataclasses

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from wm.color import LUMINANCE, to_linear
from wm.geometry.mesh.object_colors import object_colors
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.offline.style.finish import Finish, Style
from wm.offline.world.light.sources import glow_color
from wm.offline.world.materials import Points, evaluate
from wm.offline.world.noise import F32, random_cells
from wm.types import SceneObject

GRAINED = ("wood", "painted_wood", "metal", "panelling", "textile", "leather", "lacquer")
"""Materials with a grain, which runs along the longest side of the part; the rest keep the object's own axes."""
SHADED, EDGE = 0.2, 0.65
"""Of what glows: the share of its albedo that scatters light from outside, which would burn it out beside its own lamp, and the
share of its glow that is left at its upper and lower edge, farthest from the lamp in it."""
SPECULAR = 0.05
"""Share of the mirrored radiance that a smooth dielectric adds (normal incidence 0.04, a little more for slanting views)."""


@dataclasses.dataclass(frozen=True, eq=False)
class Pieces:
    """The faces of a room's objects, in the order of the objects."""

    finishes: tuple[Finish, ...]
    seeds: tuple[int, ...]
    face_finish: np.ndarray  # [f] int32 index into finishes
    color: np.ndarray  # [f, 3] float32 the slot's own colour, linear
    recolored: np.ndarray  # [f] bool: that colour is not the finish's, whose pattern then only gives light and dark
    corners: np.ndarray  # [f, 3, 3] float32 the face's corners in its part's frame, metres
    axis: np.ndarray  # [f] int8 the axis of that frame nearest to the face's normal
    emission: np.ndarray  # [f, 3] float32 radiance that the eye sees of a glowing face, at half the height of its part
    rise: np.ndarray  # [f, 3] float32 height of the face's corners in its part: -1 at the foot, 1 at the top
    glow: np.ndarray  # [f, 3] float32 the same as a source of light, not compressed
    thing: np.ndarray  # [f] int32 index into objects
    face: np.ndarray  # [f] int32 its number in that object
    textured: np.ndarray  # [f] bool: its colours are those of that object's texture
    objects: tuple[SceneObject, ...]


def build_pieces(objects: list[SceneObject], style: Style, *, seed: int) -> Pieces:
    """Look of the faces of `objects`, one after the other."""
    table: dict[str, tuple[int, Finish]] = {}
    columns: dict[str, list[np.ndarray]] = {name: [np.zeros(shape, kind)] for name, (shape, kind) in _COLUMNS.items()}
    for number, thing in enumerate(objects):
        for k, name in enumerate(thing.slots):
            table.setdefault(name, (len(table), finish_of(style, name, thing.slot_colors[k])))
        columns["thing"].append(np.full(len(thing.faces), number))
        columns["face"].append(np.arange(len(thing.faces)))
        textured = np.zeros(len(thing.slots), bool) if thing.texture is None else thing.texture.slots
        columns["textured"].append(textured[thing.face_slot])
        for name, values in _columns(thing, [table[name] for name in thing.slots], style, seed * 131 + number).items():
            columns[name].append(values)
    return Pieces(
        finishes=tuple(finish for _, finish in table.values()),
        seeds=tuple(seed * 17 + 3 * k for k in range(len(table))),
        objects=tuple(objects),
        **{name: np.concatenate(values).astype(_COLUMNS[name][1]) for name, values in columns.items()},
    )


_COLUMNS: dict[str, tuple[tuple[int, ...], type]] = {
    "face_finish": ((0,), np.int32),
    "color": ((0, 3), F32),
    "recolored": ((0,), bool),
    "corners": ((0, 3, 3), F32),
    "axis": ((0,), np.int8),
    "emission": ((0, 3), F32),
    "rise": ((0, 3), F32),
    "glow": ((0, 3), F32),
    "thing": ((0,), np.int32),
    "face": ((0,), np.int32),
    "textured": ((0,), bool),
}


def _columns(thing: SceneObject, finishes: list[tuple[int, Finish]], style: Style, seed: int) -> dict[str, np.ndarray]:
    """The per-face fields of Pieces for one object, given the number and finish of each of its slots."""
    color = np.asarray(thing.slot_colors, F32)
    base = np.array([finish.colors[0] for _, finish in finishes], F32)
    grained = np.array([finish.material in GRAINED for _, finish in finishes])
    corners, axis, rise = _part_frames(thing, grained, seed)
    strength = np.asarray(thing.emission, F32)[:, None]
    light = np.stack([glow_color(thing, k, style.light) for k in range(len(thing.slots))])
    seen = np.where(strength > 0, light * (F32(0.65) + F32(0.35) * np.minimum(strength, 2)), 0)
    by_slot = {
        "face_finish": np.array([number for number, _ in finishes]),
        "color": to_linear(color),
        "recolored": np.abs(color - base).max(axis=1) > 0.02,
        "emission": seen,
        "glow": light * strength,
    }
    return {name: values[thing.face_slot] for name, values in by_slot.items()} | {"corners": corners, "axis": axis, "rise": rise}


@dataclasses.dataclass(frozen=True, eq=False)
class Look:
    """What light meets at samples of objects."""

    albedo: np.ndarray  # [n, 3] float32 linear: what scatters
    mirror: np.ndarray  # [n, 3] float32 share of the mirrored radiance
    emission: np.ndarray  # [n, 3] float32


def look(pieces: Pieces, face: np.ndarray, barycentric: np.ndarray, footprint: np.ndarray) -> Look:
    """Albedo, gloss and glow at hits: face [n] int, barycentric [n, 2], footprint [n] metres."""
    a, b = barycentric[:, :1], barycentric[:, 1:]
    corner = pieces.corners[face]
    place = ((1 - a - b) * corner[:, 0] + a * corner[:, 1] + b * corner[:, 2]).astype(F32)
    albedo, mirror = np.empty((len(face), 3), F32), np.empty((len(face), 3), F32)
    own = pieces.textured[face]
    colors = np.zeros((len(face), 3), F32)
    colors[own] = to_linear(object_colors(pieces.objects, pieces.thing[face[own]], pieces.face[face[own]], barycentric[own]))
    finish_of = pieces.face_finish[face]
    order = np.argsort(finish_of.astype(np.uint16), kind="stable")
    bounds = np.searchsorted(finish_of[order], np.arange(len(pieces.finishes) + 1))
    for k, finish in enumerate(pieces.finishes):
        chosen = order[bounds[k] : bounds[k + 1]]
        if len(chosen) == 0:
            continue
        p, axis = place[chosen], pieces.axis[face[chosen]]
        u, v = np.where(axis == 0, p[:, 1], p[:, 0]), np.where(axis == 2, p[:, 1], p[:, 2])
        points = Points(u=u, v=v, x=p[:, 0], y=p[:, 1], z=p[:, 2], footprint=footprint[chosen])
        surface = evaluate(points, finish, seed=pieces.seeds[k])
        color = _recolored(surface.albedo.T, finish, pieces, face[chosen])
        color = np.clip(np.where(own[chosen, None], colors[chosen], color), 0, 0.92)
        gloss = np.clip(1 - np.asarray(surface.roughness, F32), 0, 1) ** 2
        gloss = np.broadcast_to(gloss, len(chosen))[:, None]
        albedo[chosen] = color * F32(1 - surface.metallic)
        mirror[chosen] = F32(surface.metallic) * color + F32((1 - surface.metallic) * SPECULAR) * (F32(0.3) + F32(1.7) * gloss)
    rise = np.sum(np.concatenate([1 - a - b, a, b], axis=1).astype(F32) * pieces.rise[face], axis=1, keepdims=True)
    emission = pieces.emission[face] * (1 - F32(1 - EDGE) * rise**2)
    albedo[emission.any(axis=1)] *= F32(SHADED)
    return Look(albedo=albedo, mirror=mirror, emission=emission)


def mean_albedo(pieces: Pieces, face: np.ndarray) -> np.ndarray:
    """[n, 3] albedo of faces at their middles, without fine pattern: what bounced light sees."""
    middle = np.full((len(face), 2), 1 / 3, F32)
    seen = look(pieces, face, middle, np.full(len(face), 0.2, F32))
    return np.clip(seen.albedo + 0.6 * seen.mirror, 0, 0.92)


def _recolored(albedo: np.ndarray, finish: Finish, pieces: Pieces, face: np.ndarray) -> np.ndarray:
    """[n, 3] the albedo, or where the slot has a colour of its own that colour, as light or dark as the pattern makes it."""
    changed = pieces.recolored[face]
    if not changed.any():
        return albedo
    base = float(to_linear(np.asarray(finish.colors[0], F32)) @ LUMINANCE)
    shade = np.clip((albedo @ LUMINANCE) / max(base, 0.005), 0.3, 1.8)
    return np.where(changed[:, None], pieces.color[face] * shade[:, None], albedo)


def finish_of(style: Style, slot: str, color: np.ndarray) -> Finish:
    """The finish of a slot in a style, or for a slot that the style does not know paint of this sRGB colour, [3]."""
    try:
        return style.slot(slot)
    except KeyError:  # a slot that the style does not know: painted in the slot's own colour
        return Finish("paint", ((float(color[0]), float(color[1]), float(color[2])),))


def _part_frames(thing: SceneObject, grained: np.ndarray, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners of every face in its part's frame [f, 3, 3], the frame's axis nearest to its normal [f], and `Pieces.rise`."""
    rotation, origin = thing.T_world_object[:3, :3], thing.T_world_object[:3, 3]
    local = (thing.vertices - origin) @ rotation
    corners = local[thing.faces]
    part = _parts(local, thing.faces, thing.face_slot)
    count = int(part.max()) + 1 if len(part) else 0
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, part, corners.min(axis=1))
    np.maximum.at(high, part, corners.max(axis=1))
    longest = np.argmax(high - low, axis=1)
    slot_of = np.zeros(count, np.int64)
    slot_of[part] = thing.face_slot
    turn = np.where(grained[slot_of], longest, 0)
    middle = (low + high) / 2
    shift = np.stack([random_cells(np.arange(count), np.full(count, k), seed=seed) for k in range(3)], axis=1) * 2.0
    shift[~grained[slot_of]] *= np.array([0.0, 0.0, 1.0])  # laid patterns stay centred on their part
    axes = (turn[:, None] + np.arange(3)) % 3
    centred = corners - middle[part][:, None]
    framed = np.take_along_axis(centred, axes[part][:, None].repeat(3, axis=1), axis=2)
    normal = np.abs(face_crosses(framed))
    keep = np.where(grained[slot_of], 1.0, 0.0)[:, None]
    rise = centred[..., 2] / np.maximum((high - low)[part, 2:] / 2, 1e-6)
    return framed + (shift * keep)[part][:, None], np.argmax(normal, axis=1), rise


def _parts(local: np.ndarray, faces: np.ndarray, slot: np.ndarray) -> np.ndarray:
    """Number of the part of each face: faces of one slot that share corners, by place."""
    cell = np.round(local / 1e-4).astype(np.int64)
    cell = (cell - cell.min(axis=0)) & 0x1FFFFF
    _, place = np.unique(cell[:, 0] | (cell[:, 1] << 21) | (cell[:, 2] << 42), return_inverse=True)
    node = place.ravel()[faces] * (int(slot.max(initial=0)) + 1) + slot[:, None]
    _, node = np.unique(node, return_inverse=True)
    node = node.reshape(-1, 3)
    n = int(node.max()) + 1
    graph = coo_array((np.ones(2 * len(node), bool), (node[:, [0, 0]].ravel(), node[:, [1, 2]].ravel())), shape=(n, n))
    return connected_components(graph, directed=False)[1][node[:, 0]]
