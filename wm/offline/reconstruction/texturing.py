"""Textures of reconstructed things, from the images that show them.

    texels   lie on every planar surface of the visible slots; their size is that of an image pixel on the thing
    image    is projected into them as views are into walls (wm.geometry.texture.accumulation)
    light    is removed from each image separately, since images may differ in tint (`_unlit`); variation around the colour of
             the slot is left
    fill     a texel that no image shows gets the colour of a visible texel beside it, or else that of the slot. Mirroring the
             visible half of a thing onto the other half gave larger errors (experiments/object_lifting)

A pixel is used if it lies inside the mask, if its depth is that of the thing, and if its colour is not closer to that of another
slot nearby. So no wrong colours are projected where the template differs from what was drawn or is slightly displaced.
Work per thing: its texels, and one tree of the visible ones. Per observation: one G-buffer of the thing alone, of the size of the
bounding box of its mask.
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
"""Largest number of texels of one thing. If it would have more, its texels are made coarser."""
_FINEST = 2e-3
"""Smallest distance between texels, in metres."""
_ASIDE = 0.003
"""Expected displacement of the outlines of slots, as a share of the image width."""
_SLOW = 0.1
"""Metres over which light changes. Faster changes are attributed to the surface."""
_HUE, _PRINT, _GRAIN = 0.1, 0.4, 0.3
"""Differences of log hue and of log brightness that only surfaces reach, and the share of smaller ones attributed to surfaces."""
_BESIDE = 3.0
"""Largest distance, in texels, from which a hidden texel takes the colour of a visible one."""
_TURNED = 8.0
"""Distance, in texels, that an angle of one radian between normals counts as."""
_DARKEST = 0.01
"""Smallest linear colour for which a ratio is meaningful; smaller ones are replaced by it."""


def textured(thing: SceneObject, observations: Sequence[Observation], slots: Bool[np.ndarray, "s"]) -> SceneObject:
    """The thing with a texture from the images, whose colours vary around those of its slots.

    Args:
      thing: in world space; its slots have the colours that the images show.
      observations: the observations of the thing.
      slots: which slots are textured; faces of the others keep the colour of their slot.
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
    """A mesh of the thing alone."""
    zero = np.zeros(len(thing.faces), np.int32)
    return Mesh(
        vertices=thing.vertices, faces=thing.faces, face_room=zero + np.int32(thing.room),
        face_kind=zero + np.int32(SurfaceKind.OBJECT), face_object=zero,
    )  # fmt: skip


def _views(thing: SceneObject, mesh: Mesh, observations: Sequence[Observation]) -> list[tuple[Observation, GBuffer, np.ndarray]]:
    """(observation cropped to its mask, G-buffer of the thing alone, [h, w] pixels that show the thing) of each observation with
    such pixels.

    The outermost pixels of a mask are left out, since they may show what is behind the thing.
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
    """The observation cropped to the bounding box of its mask."""
    rows, columns = (np.flatnonzero(observation.mask.any(axis=axis)) for axis in (1, 0))
    y, x = int(rows[0]), int(columns[0])
    window = slice(y, int(rows[-1]) + 1), slice(x, int(columns[-1]) + 1)
    mask, camera = observation.mask[window], observation.camera
    height, width = mask.shape
    camera = dataclasses.replace(camera, principal=np.asarray(camera.principal) - [x, y], width=width, height=height)
    return Observation(camera=camera, rgb=observation.rgb[window], depth=observation.depth[window], mask=mask)


def _of_another(thing: SceneObject, observation: Observation, gbuffer: GBuffer, aside: int) -> np.ndarray:
    """[h, w] pixels whose colour is closer to that of another slot, which is visible `aside` pixels away."""
    colors = np.concatenate([thing.slot_colors, np.full((1, 3), np.inf, np.float32)])
    slot = np.append(thing.face_slot, np.int32(len(thing.slots)))[gbuffer.face]
    own = ((observation.rgb - colors[slot]) ** 2).sum(axis=2)
    found = np.zeros(slot.shape, bool)
    for y, x in itertools.product((0, aside, 2 * aside), repeat=2):
        other = np.pad(slot, aside, mode="edge")[y:, x:][: slot.shape[0], : slot.shape[1]]
        found |= (other != slot) & (((observation.rgb - colors[other]) ** 2).sum(axis=2) < own)
    return found


def _footprint(views: list[tuple[Observation, GBuffer, np.ndarray]]) -> float:
    """Size of a pixel on the thing, in metres, in the image that shows it from nearest."""
    return min(float(np.median(gbuffer.depth[shown]) / np.min(observation.camera.focal)) for observation, gbuffer, shown in views)


def _atlas(mesh: Mesh, surface: np.ndarray, texel: float) -> Atlas:
    """An atlas with texels of this size, or larger ones if there would be more than _TEXELS."""
    area = float(np.linalg.norm(face_crosses(mesh.vertices[mesh.faces[surface >= 0]]), axis=1).sum()) / 2
    texel = max(texel, np.sqrt(area / _TEXELS))
    atlas = build_atlas(mesh, texel, surface)
    while len(atlas.inside) > _TEXELS:  # the estimate was too low, since a chart is a rectangle around its surface
        texel *= 1.02 * np.sqrt(len(atlas.inside) / _TEXELS)
        atlas = build_atlas(mesh, texel, surface)
    return atlas


def _unlit(atlas: Atlas, plain: np.ndarray, T_world_object: np.ndarray) -> Atlas:
    """The atlas without the light of the image; the colours of each chart vary around its plain colour [c, 3].

    The offset of a texel's log colour from its log plain colour is split into brightness b (the mean of the channels) and hue.
    The tint of the image, which is the mean hue, is subtracted. So is the light, which is the mean brightness of the texels that
    lie within about `_SLOW` metres, face the same way, and have the hue of the slot. The brightness d that is left may still
    contain light. It is multiplied by
        g = _GRAIN + (1 - _GRAIN) e / (1 + e),  e = (hue / _HUE)^2 + (d / _PRINT)^2,
    since light changes brightness only slightly, and only surfaces change the hue too.
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
    """Atlases of one mesh merged into one: the colour of each texel is their weighted mean."""
    weight = np.sum([atlas.weight for atlas in atlases], axis=0)
    total = np.sum([atlas.weight[:, None] * atlas.color for atlas in atlases], axis=0)
    return dataclasses.replace(atlases[0], color=total / np.where(weight > 0, weight, 1)[:, None], weight=weight)


def _smooth(place: np.ndarray, side: np.ndarray, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """[n] gaussian means (standard deviation of two cells) of values [n] at places [n, 3], in cells, within each side."""
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
    """The atlas in which hidden texels have the colour and the weight of the nearest visible texel of the same slot.

    A visible texel counts as near if it lies within _BESIDE texels and faces about the same way.
    """
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
