"""The condition X: what the image model is shown of the scaffold (paper, "Mesh-Conditioned Image Synthesis").

Objects have their own colours, shaded as by a light at the camera so that their form is visible. Structure shows the texture
accumulated so far, blended over depth by its alpha. Everything else is depth in grey, brighter where nearer, over one range for
the whole scene, so that a grey value means the same depth in every view. The variants of the paper's modality ablation leave out
the wall texture, show objects as grey boxes, or show no objects.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from wm.bounds import check_settings
from wm.geometry.mesh.object_colors import object_colors
from wm.geometry.mesh.scene_mesh import BOX_COLOR
from wm.geometry.rays.pinhole import ray_basis
from wm.geometry.texture.sampling import sample_atlas
from wm.schema import ConditionConfig, TextureSettings
from wm.synth.backends import Condition
from wm.types import OUTSIDE, Atlas, Camera, GBuffer, Mesh, SceneObject, SurfaceKind

_DEFAULTS = ConditionConfig()
_TEXTURE_DEFAULTS = TextureSettings()
_AMBIENT = 0.4  # brightness of a surface seen edge-on, as a factor of its own colour; seen head-on the factor is 1


def make_condition(
    gbuffer: GBuffer,
    camera: Camera,
    atlas: Atlas | None,
    mesh: Mesh,
    objects: Sequence[SceneObject],
    depth_range: tuple[float, float],
    settings: ConditionConfig = _DEFAULTS,
    texture: TextureSettings = _TEXTURE_DEFAULTS,
) -> Condition:
    """The condition X of one camera.

    Args:
      gbuffer: the G-buffer of the conditioning scaffold from the camera.
      camera: the camera of that G-buffer.
      atlas: the texture accumulated so far; None if there is none yet.
      mesh: the mesh of the conditioning scaffold: structure faces first, then those of `objects` in order (`assemble_scene`).
      objects: the scaffold's objects: their colours are shown in the textured variant, and mirrors are among them.
      depth_range: (near, far) of the scene, metres.
      settings: which signals are shown.
      texture: how the atlas is read.

    Raises:
      ValueError: an unknown objects mode, an empty depth range, or objects other than those of the mesh.
    """
    check_settings("condition", settings)
    grey = depth_grey(gbuffer, depth_range)
    rgb = np.repeat(grey[..., None], 3, axis=-1)
    known = np.zeros(grey.shape, np.float32)
    if settings.wall_texture and atlas is not None:
        seen, known = sample_atlas(atlas, gbuffer, camera, texture)
        rgb += known[..., None] * (seen - rgb)
    shown = gbuffer.hit & (mesh.face_object[gbuffer.face] != OUTSIDE)
    if settings.objects != "none":
        light = _headlight(gbuffer, camera, shown)[:, None]
        if settings.objects == "textured":
            rgb[shown] = light * _object_colors(mesh, objects, gbuffer.face[shown], gbuffer.barycentric[shown])
            known[shown] = 1.0
        else:
            rgb[shown] = light * np.float32(BOX_COLOR)
    return Condition(
        rgb=rgb, known=known, depth=gbuffer.depth, objects=settings.objects, object=shown, wall_texture=settings.wall_texture,
        glass=glass(gbuffer, mesh, objects),
    )  # fmt: skip


def depth_grey(gbuffer: GBuffer, depth_range: tuple[float, float]) -> Float[np.ndarray, "h w"]:
    """Depth as grey: 1 at the near end of the range, 0 at its far end, beyond it, and where nothing is hit."""
    near, far = depth_range
    if not near < far:
        raise ValueError(f"the scene's depth range must have near < far, got {near} .. {far}")
    grey = np.clip((far - gbuffer.depth) / (far - near), 0, 1)
    return np.where(gbuffer.hit, grey, 0).astype(np.float32)


def glass(gbuffer: GBuffer, mesh: Mesh, objects: Sequence[SceneObject]) -> Bool[np.ndarray, "h w"]:
    """Where a view shows a window pane or a mirror (by its label): an estimate may tell the depth of what is behind or in it."""
    mirrors = [index for index, thing in enumerate(objects) if "mirror" in thing.label.lower()]
    faces = (mesh.face_kind == SurfaceKind.PANE) | np.isin(mesh.face_object, mirrors)
    return gbuffer.hit & np.append(faces, False)[gbuffer.face]


def _headlight(gbuffer: GBuffer, camera: Camera, shown: np.ndarray) -> np.ndarray:
    """[n] float32 brightness of the pixels of a mask, lit from the camera."""
    columns, rows = ray_basis(camera)
    y, x = np.nonzero(shown)
    rays = (columns[x] + rows[y]).astype(np.float32)
    facing = np.abs(np.einsum("ni,ni->n", gbuffer.normal[shown], rays)) / np.linalg.norm(rays, axis=1)
    return np.float32(_AMBIENT) + np.float32(1 - _AMBIENT) * facing


def _object_colors(mesh: Mesh, objects: Sequence[SceneObject], face: np.ndarray, barycentric: np.ndarray) -> np.ndarray:
    """[n, 3] float32 base colours at points of the mesh's object faces."""
    counts = [len(o.faces) for o in objects]
    owner = np.repeat(np.arange(len(objects), dtype=np.int32), counts)
    structure = len(mesh.faces) - len(owner)
    ordered = structure >= 0 and np.array_equal(mesh.face_object[structure:], owner)
    if not ordered or (mesh.face_object[:structure] != OUTSIDE).any():
        raise ValueError("the objects are not those of the mesh: it must hold structure faces, then each object's faces in order")
    first = np.cumsum([structure, *counts])
    thing = mesh.face_object[face]
    return object_colors(objects, thing, face - first[thing], barycentric)
