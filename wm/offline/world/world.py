"""The exact offline world of a scene: every room dressed and lit, seen from any camera.

What a surface looks like does not depend on where it is seen from (glosses reflect for the middle of the room), so that gaussians
without view-dependence can show it. Tiers of work: per scene one BVH; per room, when first seen, one bake
(wm.offline.world.room); per view one cast, a texture look-up per pixel, and more samples in the pixels where surfaces meet.
"""

import collections
import copy
import dataclasses
import functools
import threading
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Int

from wm.color import LUMINANCE, to_linear, to_srgb
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.pinhole import camera_center, camera_rays
from wm.geometry.rays.raycast import build_ray_scene, cast, cast_rays
from wm.offline.style.finish import Style
from wm.offline.style.theme import style_of
from wm.offline.world.edit import Edit, edited_mesh
from wm.offline.world.light import BakeSettings, chart_places, facet_weights, look_up, sun_direction
from wm.offline.world.pieces import finish_of, look
from wm.offline.world.pyramid import sample_pyramid
from wm.offline.world.room import BakedRoom, bake_room
from wm.offline.world.tone import tone
from wm.synth.backends import SceneContext
from wm.types import OUTSIDE, Camera, GBuffer, Mesh, SceneObject, SurfaceKind

KEPT = 32
"""Rooms whose bake is kept; the least recently seen are dropped first."""
VISIBLE = 0.02
"""Difference of sRGB values between neighbours from which a pixel is worth more samples."""
POLISHED = 0.1
"""Share of mirrored radiance from which a reflection is looked up at the hit and not mixed from light points."""


MIRROR_DETAIL = 0.004
"""Width of what one look-up in a mirror covers, per metre of its way: finer than any texture that is made of the picture."""


@dataclasses.dataclass(frozen=True, eq=False)
class Shot:
    """What the world shows a camera."""

    rgb: np.ndarray  # [h, w, 3] float32 sRGB
    gbuffer: GBuffer  # of pixel centres
    object: np.ndarray  # [h, w] int32 object at each pixel, OUTSIDE for structure


@dataclasses.dataclass(frozen=True, eq=False)
class Sight:
    """Hits of rays, and how the rays meet them."""

    face: np.ndarray  # [n] int32 of the lit mesh
    barycentric: np.ndarray  # [n, 2] float32
    across: np.ndarray  # [n] float32 metres that a pixel spans there, seen straight on
    cosine: np.ndarray  # [n] float32 between ray and normal
    directions: np.ndarray  # [n, 3] float32

    def of(self, which: np.ndarray) -> "Sight":
        """The hits that `which` indexes."""
        return Sight(*(getattr(self, field.name)[which] for field in dataclasses.fields(self)))


class World:
    """A scene's appearance. Thread-safe; the same context gives the same bytes whatever was asked before."""

    def __init__(
        self,
        context: SceneContext,
        *,
        supersampling: int = 2,
        settings: BakeSettings | None = None,
        style: Style | None = None,
    ):
        """A world in the style of the context's theme, or in another `style`."""
        self._plan, self._objects = context.plan, context.objects
        self._seeds = context.seed_of("finish"), context.seed_of("light")
        self._settings = settings if settings is not None else BakeSettings()
        self._style = style if style is not None else style_of(context.theme)
        self._supersampling = supersampling
        self.mesh = assemble_scene(context.structure, context.objects)
        self._scene = self._lit = build_ray_scene(self.mesh)
        self._sun = sun_direction(self.mesh, self._style.light)
        self._surface = np.append(surface_ids(self.mesh, self._objects), -1)  # the last is for misses
        self._silvered = np.append(mirror_faces(self.mesh, self._objects, self._style), False)  # of the unedited mesh
        self._source: np.ndarray | None = None  # face of the unedited mesh that each face looks like; None: itself
        self._rooms: collections.OrderedDict[int, BakedRoom] = collections.OrderedDict()
        self._lock = threading.RLock()

    @property
    def labels(self) -> tuple[str, ...]:
        """What the objects are, in the order of `Shot.object`."""
        return tuple(thing.label for thing in self._objects)

    def room(self, index: int) -> BakedRoom:
        """A room's textures and light, baked now unless they are kept."""
        with self._lock:
            if index not in self._rooms:
                self._rooms[index] = bake_room(
                    self._lit, self._plan, index, self._objects, self._style,
                    sun=self._sun, seeds=self._seeds, settings=self._settings,
                )  # fmt: skip
                while len(self._rooms) > KEPT:
                    self._rooms.popitem(last=False)
            self._rooms.move_to_end(index)
            return self._rooms[index]

    def edited(self, edit: Edit) -> "World":
        """The world with some things moved, removed or closed, in the light that was baked before the change."""
        other = copy.copy(self)
        other.mesh, other._source = edited_mesh(self.mesh, self._plan, edit)
        other._scene = build_ray_scene(other.mesh)
        other._surface = np.append(self._surface[other._source], -1)
        return other

    def shoot(self, camera: Camera, edit: Edit | None = None) -> Shot:
        """The image of a camera: one sample per pixel, supersampling^2 of them where surfaces meet."""
        if edit is not None:
            return self.edited(edit).shoot(camera)
        gbuffer = cast(self._scene, camera)
        shape = gbuffer.depth.shape
        directions = camera_rays(camera).reshape(-1, 3).astype(np.float32)
        face = gbuffer.face.ravel()
        rgb = self._shade(camera, face, gbuffer.barycentric.reshape(-1, 2), gbuffer.depth.ravel(), directions)
        if self._supersampling > 1:
            edges = np.flatnonzero((self._edges(gbuffer) & _contrasting(rgb.reshape(*shape, 3))).ravel())
            rgb[edges] = self._supersampled(camera, edges)
        thing = np.append(self.mesh.face_object, np.int32(OUTSIDE))[face]
        return Shot(rgb=rgb.reshape(*shape, 3), gbuffer=gbuffer, object=thing.reshape(shape))

    def _supersampled(self, camera: Camera, pixels: np.ndarray) -> np.ndarray:
        """[k, 3] mean colour of a regular grid of samples in each pixel."""
        n = self._supersampling
        row, column = np.divmod(pixels, camera.width)
        offset = (np.arange(n) + 0.5) / n
        x = (column[:, None, None] + offset[None, None, :] - camera.principal[0]) / camera.focal[0]
        y = (row[:, None, None] + offset[None, :, None] - camera.principal[1]) / camera.focal[1]
        x, y = np.broadcast_arrays(x, y)
        R_world_cam = np.asarray(camera.T_cam_world)[:3, :3].T
        directions = np.stack([x.ravel(), y.ravel(), np.ones(x.size)], axis=1) @ R_world_cam.T
        origins = np.broadcast_to(camera_center(camera), directions.shape)
        hits = cast_rays(self._scene, np.ascontiguousarray(origins), directions)
        depth = np.where(hits.hit, hits.t, 0).astype(np.float32)
        colors = self._shade(camera, hits.face, hits.barycentric, depth, directions.astype(np.float32))
        return colors.reshape(len(pixels), n * n, 3).mean(axis=1)

    def _shade(
        self, camera: Camera, face: np.ndarray, barycentric: np.ndarray, depth: np.ndarray, directions: np.ndarray
    ) -> np.ndarray:
        """[n, 3] colour of hits; black where nothing or no room is hit."""
        rgb = np.zeros((len(face), 3), np.float32)
        room = np.append(self.mesh.face_room, np.int32(OUTSIDE))[face]
        normal = self._scene.normals[face]
        length = np.sqrt(np.einsum("ni,ni->n", directions, directions))
        cosine = np.clip(np.abs(np.einsum("ni,ni->n", directions, normal)) / length, 0.05, 1)
        across = depth * length * np.float32(1 / camera.focal[1])  # metres that a pixel spans, seen straight on
        face = face if self._source is None else self._source[face]
        for index in np.unique(room[room >= 0]):
            here = np.flatnonzero(room == index)
            seen = Sight(face[here], barycentric[here], across[here], cosine[here], directions[here])
            rgb[here] = self._surfaces(self.room(int(index)), seen, mirrors=True)
        return rgb

    def _surfaces(self, baked: BakedRoom, sight: Sight, *, mirrors: bool) -> np.ndarray:
        """[n, 3] colour of hits on the surfaces of one room; black on what is none of it. `mirrors` show the room."""
        rgb = np.zeros((len(sight.face), 3), np.float32)
        flat = np.flatnonzero(baked.charts.face_slot[sight.face] >= 0)
        rgb[flat] = self._structure(baked, sight.of(flat))
        solid = np.flatnonzero(baked.facet_faces[sight.face] >= 0)
        rgb[solid] = self._solid(baked, sight.of(solid), mirrors=mirrors)
        return rgb

    def _structure(self, baked: BakedRoom, sight: Sight) -> np.ndarray:
        """Textures of walls and floors: two probes along the direction in which a slanting pixel is long."""
        face, barycentric, across = sight.face, sight.barycentric, sight.across
        cosine, directions = sight.cosine, sight.directions
        chart, s, t = chart_places(baked.charts, face, barycentric)
        atlas = baked.charts.atlas
        along_u = np.einsum("ni,ni->n", directions, atlas.chart_u.astype(np.float32)[chart])
        along_v = np.einsum("ni,ni->n", directions, atlas.chart_v.astype(np.float32)[chart])
        length = np.maximum(np.hypot(along_u, along_v), 1e-6)
        major = across / cosine
        footprint = np.maximum(across, 0.5 * major)
        step = 0.25 * np.maximum(major - across, 0) / length
        near = sample_pyramid(baked.textures, chart, s - step * along_u, t - step * along_v, footprint)
        slanting = np.flatnonzero(cosine < 0.8)
        far = sample_pyramid(
            baked.textures, chart[slanting], (s + step * along_u)[slanting], (t + step * along_v)[slanting], footprint[slanting]
        )
        near[slanting] = 0.5 * (near[slanting] + far)
        return near

    def _solid(self, baked: BakedRoom, sight: Sight, *, mirrors: bool) -> np.ndarray:
        """Objects: material evaluated at the hit, light from the corners of the facet around it."""
        face, barycentric = sight.face, sight.barycentric
        if len(face) == 0:
            return np.zeros((0, 3), np.float32)
        local = baked.facet_faces[face]
        points, weights = facet_weights(baked.facets, local, barycentric)
        light = np.einsum("nk,nkc->nc", weights, baked.light[points])
        seen = look(baked.pieces, local, barycentric, sight.across / np.sqrt(sight.cosine))
        mirrored = light[:, 3:]
        polished = np.flatnonzero(functools.reduce(np.maximum, seen.mirror.T) > POLISHED)
        mirrored[polished] = self._reflected(baked, face[polished], barycentric[polished], light[polished])
        rgb = tone(seen.albedo * light[:, :3] + seen.mirror * mirrored + seen.emission)
        silvered = np.flatnonzero(self._silvered[face]) if mirrors else np.zeros(0, np.int64)
        inside, shown = self._in_mirror(baked, face[silvered], barycentric[silvered])
        shown = to_srgb(seen.mirror[silvered[inside]] * to_linear(shown))
        rgb[silvered[inside]] = np.maximum(shown, tone(seen.albedo * light[:, :3])[silvered[inside]])
        return rgb

    def _in_mirror(self, baked: BakedRoom, face: np.ndarray, barycentric: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which points of mirrors show the room itself to an eye in its middle, [k] indices, and what they show it, [k, 3]."""
        place, normal = self._places(face, barycentric)
        view = place - baked.eye
        distance = np.linalg.norm(view, axis=1)
        view = view / np.maximum(distance, 1e-6)[:, None]
        away = np.einsum("ni,ni->n", view, normal)[:, None]
        # For an eye behind it the mirror shows what is straight before it.
        directions = np.where(away < 0, view - 2 * away * normal, normal).astype(np.float32)
        hits = cast_rays(self._lit, place + 1e-3 * normal, directions)
        inside = np.flatnonzero(hits.hit & (np.append(self._lit.mesh.face_room, OUTSIDE)[hits.face] == baked.room))
        face, directions = hits.face[inside], directions[inside]
        cosine = np.clip(np.abs(np.einsum("ni,ni->n", directions, self._lit.normals[face])), 0.05, 1)
        across = (MIRROR_DETAIL * (distance[inside] + hits.t[inside])).astype(np.float32)
        return inside, self._surfaces(baked, Sight(face, hits.barycentric[inside], across, cosine, directions), mirrors=False)

    def _places(self, face: np.ndarray, barycentric: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """World points [n, 3] on faces of the lit mesh, and the faces' normals [n, 3]."""
        a, b = barycentric[:, :1], barycentric[:, 1:]
        corners = self._lit.mesh.vertices[self._lit.mesh.faces[face]].astype(np.float32)
        return (1 - a - b) * corners[:, 0] + a * corners[:, 1] + b * corners[:, 2], self._lit.normals[face]

    def _reflected(self, baked: BakedRoom, face: np.ndarray, barycentric: np.ndarray, light: np.ndarray) -> np.ndarray:
        """[n, 3] what polished points show an eye in the middle of the room, dimmer where little light arrives."""
        a, b = barycentric[:, :1], barycentric[:, 1:]
        c = 1 - a - b
        view = self._places(face, barycentric)[0] - baked.eye
        view /= np.maximum(np.linalg.norm(view, axis=1, keepdims=True), 1e-6)
        normals = baked.facets.corner_normal[baked.facet_faces[face]]
        normal = c * normals[:, 0] + a * normals[:, 1] + b * normals[:, 2]
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-6)
        mirror = view - 2 * np.einsum("ni,ni->n", view, normal)[:, None] * normal
        reached = np.clip((light[:, :3] @ LUMINANCE) / 0.45, 0.25, 1.3)[:, None]
        return look_up(baked.environment, mirror) * reached

    def _edges(self, gbuffer: GBuffer) -> np.ndarray:
        """[h, w] bool: pixels beside another surface, a crease, or a jump in depth; and mirrors, which show such places."""
        ids = self._surface[gbuffer.face]
        edges = np.zeros(ids.shape, bool)
        for axis in (0, 1):
            first, second = ([slice(None)] * 2 for _ in range(2))
            first[axis], second[axis] = slice(None, -1), slice(1, None)
            a, b = tuple(first), tuple(second)
            crease = np.einsum("hwc,hwc->hw", gbuffer.normal[a], gbuffer.normal[b]) < 0.97
            jump = np.abs(gbuffer.depth[a] - gbuffer.depth[b]) > 0.1 * np.minimum(gbuffer.depth[a], gbuffer.depth[b])
            differ = (ids[a] != ids[b]) | crease | jump
            edges[a] |= differ
            edges[b] |= differ
        face = gbuffer.face if self._source is None else np.append(self._source, -1)[gbuffer.face]
        return edges | self._silvered[face]


def surface_ids(mesh: Mesh, objects: Sequence[SceneObject]) -> Int[np.ndarray, "f"]:
    """A number per surface of a scene's mesh, of no other surface: structure by room and kind, objects by object and slot."""
    structure = (mesh.face_room.astype(np.int64) + 1) * len(SurfaceKind) + mesh.face_kind
    slots = 1 + max((len(thing.slots) for thing in objects), default=0)
    slot = np.concatenate([np.zeros(int((mesh.face_object == OUTSIDE).sum()), np.int64), *(thing.face_slot for thing in objects)])
    first = structure.max(initial=0) + 1
    return np.where(mesh.face_object == OUTSIDE, structure, first + mesh.face_object.astype(np.int64) * slots + slot)


def mirror_faces(mesh: Mesh, objects: Sequence[SceneObject], style: Style) -> Bool[np.ndarray, "f"]:
    """Which faces of a scene's mesh are silvered glass, and not a texture that shows some."""
    parts = [np.zeros(int((mesh.face_object == OUTSIDE).sum()), bool)]
    for thing in objects:
        silvered = [finish_of(style, slot, color).material == "mirror" for slot, color in zip(thing.slots, thing.slot_colors)]
        painted = np.zeros(len(silvered), bool) if thing.texture is None else thing.texture.slots
        parts.append((np.array(silvered, bool) & ~painted)[thing.face_slot])
    return np.concatenate(parts)


def _contrasting(rgb: np.ndarray) -> np.ndarray:
    """[h, w] bool: pixels that differ visibly from a neighbour, so that more samples would show."""
    out = np.zeros(rgb.shape[:2], bool)
    for axis in (0, 1):
        channels = np.abs(np.diff(rgb, axis=axis)) > VISIBLE
        differ = channels[..., 0] | channels[..., 1] | channels[..., 2]  # any() along the last axis takes many times as long
        out[: -1 if axis == 0 else None, : -1 if axis == 1 else None] |= differ
        out[1 if axis == 0 else 0 :, 1 if axis == 1 else 0 :] |= differ
    return out
