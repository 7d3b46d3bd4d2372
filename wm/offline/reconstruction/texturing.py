"""Textures of reconstructed things, from the images that show them.

    texels   on every plane of the thing's seen slots, as fine as a pixel of the image where it shows the thing
    image    projected onto them as views are onto walls (wm.geometry.texture.accumulation): facing, occlusion, clean pixels first
    light    taken off image by image, for they may differ in tint (`_unlit`): what is left varies around the slot's colour
    fill     a texel that no image shows takes the colour of one beside it that one does, and else the slot's: copying the half
             of a thing that is seen onto the other, mirrored, was further from the truth (experiments/object_lifting)

Only pixels inside the mask count, and only where the depth of the image is the thing's, and where no slot next to theirs has
their colour rather: where the template is another than what was drawn, or a little beside it, nothing is smeared over it.
Tiers of work: per thing, its texels and one tree of those seen; per observation, one G-buffer of the thing alone, no larger than
its mask.
"""

import dataclasses
import itertools
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool
from scipy import ndimage
from scipy.spatial import KDTree

from wm.color import to_linear, to_srgb
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.geometry.texture.accumulation import accumulate
from wm.geometry.texture.atlas import build_atlas, texel_charts, texel_positions
from wm.geometry.texture.chart_texture import chart_texture
from wm.schema import TextureSettings
from wm.synth.backends import Observation
from wm.types import Atlas, GBuffer, Mesh, SceneObject, SurfaceKind, Texture

_TEXELS = 1 << 17
"""Texels of one thing at most, seen or not: beyond, they are coarser than the image."""
_FINEST = 2e-3
"""Metres between texels at least."""
_ASIDE = 0.003
"""Share of the image's width by which the outlines of slots may be off."""
_SLOW = 0.1
"""Metres over which light changes; what changes faster is the surface."""
_HUE, _PRINT, _GRAIN = 0.1, 0.4, 0.3
"""Logarithms of hue and of brightness that only surfaces reach, and the share of lesser brightness that is taken for theirs."""
_BESIDE = 3.0
"""Texels from one that is seen within which a hidden one takes its colour."""
_TURNED = 8.0
"""Texels that two normals a radian apart count as."""
_DARKEST = 0.01
"""Linear colour below which ratios say nothing."""


def textured(thing: SceneObject, observations: Sequence[Observation], slots: Bool[np.ndarray, "s"]) -> SceneObject:
    """The thing with what images show of it on its surface, around the colours of its slots.

    Args:
      thing: in the world of the observations' cameras, its slots in the colours that the images show.
      observations: what each image shows of it.
      slots: which slots are textured; faces of the others keep their slot's colour.
    """
    mesh = _mesh_of(thing)
    views = _views(thing, mesh, observations)
    if not (views and slots.any()):
        return thing
    empty = _atlas(mesh, np.where(slots[thing.face_slot], thing.face_slot, -1), max(_FINEST, _footprint(views)))
    chart_slot = np.zeros(len(empty.chart_start), np.int32)
    chart_slot[empty.face_chart[empty.face_chart >= 0]] = thing.face_slot[empty.face_chart >= 0]
    plain = thing.slot_colors[chart_slot]
    settings = TextureSettings(texel_size=empty.texel_size)
    seen = [accumulate(empty, g, s.camera, s.rgb, thing.room, settings, usable=usable) for s, g, usable in views]
    atlas = _mean([_unlit(one, plain, thing.T_world_object) for one in seen])
    if not atlas.weight.any():
        return thing
    atlas = _filled(atlas, chart_slot)
    color = np.where(atlas.weight[:, None] > 0, atlas.color, plain[texel_charts(atlas)])
    image, corner_uv = chart_texture(dataclasses.replace(atlas, color=color), thing.vertices[thing.faces], plain)
    return dataclasses.replace(thing, texture=Texture(image=image, corner_uv=corner_uv, slots=slots))


def _mesh_of(thing: SceneObject) -> Mesh:
    """The thing alone."""
    zero = np.zeros(len(thing.faces), np.int32)
    return Mesh(
        vertices=thing.vertices, faces=thing.faces, face_room=zero + np.int32(thing.room),
        face_kind=zero + np.int32(SurfaceKind.OBJECT), face_object=zero,
    )  # fmt: skip


def _views(thing: SceneObject, mesh: Mesh, observations: Sequence[Observation]) -> list[tuple[Observation, GBuffer, np.ndarray]]:
    """(an observation cut to its mask, the thing alone as its camera sees it, the pixels [h, w] that show it) if there are any.

    A mask's outermost pixels are left out: they mix the thing with what is behind it, and a ragged border shows that alone.
    """
    scene = build_ray_scene(mesh)
    views = []
    for whole in (observation for observation in observations if observation.mask.any()):
        observation, aside = _cut(whole), max(1, round(_ASIDE * whole.camera.width))
        gbuffer = cast(scene, observation.camera)
        agreed = np.abs(observation.depth - gbuffer.depth) < 0.03 + 0.02 * gbuffer.depth
        inner = np.asarray(ndimage.binary_erosion(observation.mask, np.ones((3, 3), bool)), bool)
        shown = gbuffer.hit & agreed & inner & ~_of_another(thing, observation, gbuffer, aside)
        views += [(observation, gbuffer, shown)] if shown.any() else []
    return views


def _cut(observation: Observation) -> Observation:
    """The part of an image that a mask is in."""
    rows, columns = (np.flatnonzero(observation.mask.any(axis=axis)) for axis in (1, 0))
    y, x = int(rows[0]), int(columns[0])
    window = slice(y, int(rows[-1]) + 1), slice(x, int(columns[-1]) + 1)
    mask, camera = observation.mask[window], observation.camera
    height, width = mask.shape
    camera = dataclasses.replace(camera, principal=np.asarray(camera.principal) - [x, y], width=width, height=height)
    return Observation(camera=camera, rgb=observation.rgb[window], depth=observation.depth[window], mask=mask)


def _of_another(thing: SceneObject, observation: Observation, gbuffer: GBuffer, aside: int) -> np.ndarray:
    """[h, w] pixels that have rather the colour of another slot, which lies so many pixels aside."""
    colors = np.concatenate([thing.slot_colors, np.full((1, 3), np.inf, np.float32)])
    slot = np.append(thing.face_slot, np.int32(len(thing.slots)))[gbuffer.face]
    own = ((observation.rgb - colors[slot]) ** 2).sum(axis=2)
    found = np.zeros(slot.shape, bool)
    for y, x in itertools.product((0, aside, 2 * aside), repeat=2):
        other = np.pad(slot, aside, mode="edge")[y:, x:][: slot.shape[0], : slot.shape[1]]
        found |= (other != slot) & (((observation.rgb - colors[other]) ** 2).sum(axis=2) < own)
    return found


def _footprint(views: list[tuple[Observation, GBuffer, np.ndarray]]) -> float:
    """Metres across a pixel where the nearest image shows the thing."""
    return min(float(np.median(gbuffer.depth[shown]) / np.min(observation.camera.focal)) for observation, gbuffer, shown in views)


def _atlas(mesh: Mesh, surface: np.ndarray, texel: float) -> Atlas:
    """Texels of this size, or as small as the limit allows."""
    area = float(np.linalg.norm(face_crosses(mesh.vertices[mesh.faces[surface >= 0]]), axis=1).sum()) / 2
    texel = max(texel, np.sqrt(area / _TEXELS))
    atlas = build_atlas(mesh, texel, surface)
    while len(atlas.inside) > _TEXELS:  # charts are rectangles, and larger than what is on them
        texel *= 1.02 * np.sqrt(len(atlas.inside) / _TEXELS)
        atlas = build_atlas(mesh, texel, surface)
    return atlas


def _unlit(atlas: Atlas, plain: np.ndarray, T_world_object: np.ndarray) -> Atlas:
    """The atlas without the light on it, its charts around their plain colours [c, 3].

    In logarithms, a texel's offset from its plain colour is brightness b (the mean of the channels) and hue. The image's tint,
    the mean hue, is taken off; and so is the light: the mean brightness of the texels around, `_SLOW` metres wide, that face the
    same way and have the slot's hue. Of the brightness d that is left, light may still have made some: it is kept by
        g = _GRAIN + (1 - _GRAIN) e / (1 + e),  e = (hue / _HUE)^2 + (d / _PRINT)^2,
    for light changes brightness, by little, and only surfaces change hue as well.
    Source: Grosse, Johnson, Adelson and Freeman, "Ground truth dataset and baseline evaluations for intrinsic images", 2009
    (colour Retinex), with means for thresholds on gradients.
    """
    seen = np.flatnonzero(atlas.weight > 0)
    if len(seen) == 0:
        return atlas
    chart, weight = texel_charts(atlas)[seen], atlas.weight[seen]
    usual = _logs(plain)[chart]
    offset = _logs(atlas.color[seen]) - usual
    bright = offset.mean(axis=1)
    hue = offset - bright[:, None]
    hue -= np.average(hue, axis=0, weights=weight)
    colored = (hue**2).sum(axis=1) / _HUE**2
    normal = atlas.chart_normal @ T_world_object[:3, :3]
    axis = np.argmax(np.abs(normal), axis=1)
    side = (2 * axis + (normal[np.arange(len(axis)), axis] > 0))[chart]
    place = texel_positions(atlas)[seen] @ T_world_object[:3, :3] / (_SLOW / 2)
    left = bright - _smooth(place - place.min(axis=0), side, bright, weight / (1 + colored))
    evidence = colored + (left / _PRINT) ** 2
    kept = left * (_GRAIN + (1 - _GRAIN) * evidence / (1 + evidence))
    color = atlas.color.copy()
    color[seen] = to_srgb(np.exp(usual + hue + kept[:, None])).astype(np.float32)
    return dataclasses.replace(atlas, color=color)


def _logs(colors: np.ndarray) -> np.ndarray:
    return np.log(np.maximum(to_linear(colors), _DARKEST))


def _mean(atlases: list[Atlas]) -> Atlas:
    """Atlases of one mesh as one, each texel's colour the mean by their weights."""
    weight = np.sum([atlas.weight for atlas in atlases], axis=0)
    total = np.sum([atlas.weight[:, None] * atlas.color for atlas in atlases], axis=0)
    return dataclasses.replace(atlases[0], color=total / np.where(weight > 0, weight, 1)[:, None], weight=weight)


def _smooth(place: np.ndarray, side: np.ndarray, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """[n] gaussian means, two cells wide, of values [n] at places [n, 3] in cells, among those of one side."""
    cell = place.astype(np.int64)
    shape = (6, *(cell.max(axis=0) + 2))
    index, size = np.ravel_multi_index((side, *cell.T), shape), int(np.prod(shape))
    at = np.concatenate([side[None], place.T - 0.5])
    found = []
    for column in (weight * values, weight):
        cells = np.bincount(index, column, size).reshape(shape)
        spread = ndimage.gaussian_filter(cells, (0, 2, 2, 2), truncate=2, mode="constant")
        found.append(ndimage.map_coordinates(spread, at, order=1, mode="nearest"))
    return found[0] / found[1]


def _filled(atlas: Atlas, chart_slot: np.ndarray) -> Atlas:
    """The atlas with the colour and the weight of the nearest texel that is seen where none is, if there is one beside it, of
    the same slot and turn."""
    chart = texel_charts(atlas)
    turn, slot = (_TURNED * atlas.chart_normal)[chart], 1e3 * chart_slot[chart]
    key = np.column_stack([texel_positions(atlas) / atlas.texel_size, turn, slot])
    seen, hidden = (np.flatnonzero(atlas.inside & known) for known in (atlas.weight > 0, atlas.weight == 0))
    away, found = KDTree(key[seen]).query(key[hidden], distance_upper_bound=_BESIDE)
    near = np.flatnonzero(np.isfinite(away))
    source, filled = seen[np.asarray(found)[near]], hidden[near]
    color, weight = atlas.color.copy(), atlas.weight.copy()
    color[filled], weight[filled] = atlas.color[source], atlas.weight[source]
    return dataclasses.replace(atlas, color=color, weight=weight)
