"""Objects as trimesh's meshes, for its tools and its exporters. `wm.types.Mesh.to_trimesh` does the same for scaffolds."""

from typing import Any

import numpy as np

from wm.geometry.texture.image_sheet import image_sheet, sheet_uv
from wm.types import SceneObject, Texture


def object_to_trimesh(thing: SceneObject) -> Any:
    """A `trimesh.Trimesh` of an object, z up and in world metres, with `face_attributes["slot"]` and the label in its metadata.

    An object with a texture comes with `TextureVisuals`: the image, and in it a pixel of colour for each slot without a texture.
    A vertex whose faces look up different places becomes several. An object without a texture comes with vertex colours, and a
    vertex at which slots meet becomes one for each of them.

    trimesh's exporters keep these colours in GLB and OBJ; in PLY they keep vertex colours, and of a texture only its coordinates.
    Its GLB is not what viewers want: its z axis is up, it does not glow, and its vertex colours are sRGB where they should be
    linear. `load_object(path, up="z")` reads it back; for viewers there is `save_glb(path, object_nodes([thing]))`.
    """
    import trimesh
    from trimesh.visual.color import ColorVisuals
    from trimesh.visual.texture import TextureVisuals

    if thing.texture is None:
        vertices, faces, (slot,) = _split(thing, thing.face_slot[:, None, None].repeat(3, axis=1))
        visual = ColorVisuals(vertex_colors=_rgba(thing.slot_colors[slot.astype(np.int64)]))
    else:
        image, corner_uv = _everywhere(thing, thing.texture)
        vertices, faces, (u, v) = _split(thing, corner_uv)
        visual = TextureVisuals(uv=np.stack([u, 1.0 - v], axis=1), material=_material(image))
    return trimesh.Trimesh(
        vertices, faces, visual=visual, face_attributes={"slot": thing.face_slot}, metadata={"label": thing.label}, process=False
    )


def _split(thing: SceneObject, corner: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(vertices, faces, values [c, v]) with a vertex for every place and values [f, 3, c] of corners that meet there."""
    key = np.concatenate([thing.faces.reshape(-1, 1), corner.reshape(len(thing.faces) * 3, -1)], axis=1).astype(np.float64)
    key, index = np.unique(key, axis=0, return_inverse=True)
    return thing.vertices[key[:, 0].astype(np.int64)], index.reshape(-1, 3), key[:, 1:].T


def _everywhere(thing: SceneObject, texture: Texture) -> tuple[np.ndarray, np.ndarray]:
    """The texture with a pixel for each slot that has none, and corner coordinates of all faces in it."""
    plain = [slot for slot in np.flatnonzero(~texture.slots) if (thing.face_slot == slot).any()]
    swatches = [_rgba(thing.slot_colors[slot])[None, None, :3] for slot in plain]
    images = [texture.image, *swatches]
    image, corner = image_sheet(images)
    uv = sheet_uv(texture.corner_uv.astype(np.float64), texture.image, corner[0], image.shape)
    for slot, swatch, at in zip(plain, swatches, corner[1:]):
        uv[thing.face_slot == slot] = sheet_uv(np.full(2, 0.5), swatch, at, image.shape)
    return image, uv


def _material(image: np.ndarray) -> Any:
    from PIL import Image
    from trimesh.visual.material import PBRMaterial

    return PBRMaterial(
        baseColorTexture=Image.fromarray(np.ascontiguousarray(image)), baseColorFactor=[255, 255, 255, 255], metallicFactor=0.0,
        roughnessFactor=1.0, doubleSided=True,
    )  # fmt: skip


def _rgba(color: np.ndarray) -> np.ndarray:
    """Colours [..., 3] in [0, 1] as opaque 8-bit ones [..., 4]."""
    rgb = np.round(np.clip(color, 0, 1) * 255).astype(np.uint8)
    return np.concatenate([rgb, np.full((*rgb.shape[:-1], 1), 255, np.uint8)], axis=-1)
