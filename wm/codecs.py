"""Encodes records as the bytes of files, and decodes them: images, masks and depth as PNG, arrays and objects as NPZ, cameras as
JSON.

All encoders are deterministic: equal records give equal bytes.
"""

import io
import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, UInt8
from PIL import Image

from wm.geometry import opengl_pose
from wm.types import Camera, SceneObject, Texture, View

DEPTH_UNIT = 1e-3
"""Metres per step of a 16-bit depth PNG, nerfstudio's `depth_unit_scale_factor`."""

OBJECT_AXES = (
    "right-handed, z up. T_world_object takes points of an object's frame (x to its right, y to its back, z up, origin at the "
    "middle of its foot) to the world; size is its extent along x, y and z of that frame. id names the object's node in "
    "scaffold.glb, where y is up and world (x, y, z) is (x, z, -y). Position in this list is face_object in the node's extras"
)


FAST = 1
"""zlib's compression level for images. It takes a third of the time of the default level 6; files are a tenth larger."""


def encode_png(rgb: UInt8[np.ndarray, "h w 3"]) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(rgb).save(buffer, format="PNG", compress_level=FAST)
    return buffer.getvalue()


def decode_png(data: bytes) -> UInt8[np.ndarray, "h w 3"]:
    with Image.open(io.BytesIO(data)) as image:
        return np.asarray(image.convert("RGB"))


def encode_mask(mask: Bool[np.ndarray, "h w"]) -> bytes:
    """A 1-bit PNG."""
    buffer = io.BytesIO()
    Image.fromarray(mask).save(buffer, format="PNG")
    return buffer.getvalue()


def decode_mask(data: bytes) -> Bool[np.ndarray, "h w"]:
    with Image.open(io.BytesIO(data)) as image:
        # Compared, not cast: Pillow stores True as a byte of 255, and XLA computes with that value.
        return np.asarray(image.convert("L")) > 127


def encode_depth(depth: Float[np.ndarray, "h w"]) -> bytes:
    """A 16-bit PNG of z-depth in steps of DEPTH_UNIT. What 16 bits cannot hold is 0, which means no depth to readers: beyond
    65.535 m, behind the camera, not finite."""
    steps = np.round(depth / DEPTH_UNIT)
    steps = np.where((steps > 0) & (steps <= np.iinfo(np.uint16).max), steps, 0).astype(np.uint16)
    buffer = io.BytesIO()
    Image.fromarray(steps).save(buffer, format="PNG", compress_level=FAST)
    return buffer.getvalue()


def encode_arrays(arrays: Mapping[str, np.ndarray]) -> bytes:
    """An uncompressed .npz whose arrays are sorted by name."""
    buffer = io.BytesIO()
    in_order: dict[str, Any] = {name: arrays[name] for name in sorted(arrays)}
    np.savez(buffer, **in_order)
    return buffer.getvalue()


def decode_arrays(data: bytes) -> dict[str, np.ndarray]:
    with np.load(io.BytesIO(data), allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


_OBJECT_ARRAYS = ("vertices", "faces", "face_slot", "slot_colors", "T_world_object", "size", "emission")
_TEXTURE_ARRAYS = ("image", "corner_uv", "slots")


def encode_objects(objects: Sequence[SceneObject]) -> bytes:
    """The furniture as an .npz: arrays by object, and a table of labels, rooms, supports and slots."""
    table = [{"label": o.label, "room": o.room, "support": o.support, "slots": list(o.slots), "id": o.id} for o in objects]
    arrays = {f"{k:05d}.{name}": getattr(o, name) for k, o in enumerate(objects) for name in _OBJECT_ARRAYS}
    textures = [(k, o.texture) for k, o in enumerate(objects) if o.texture is not None]
    arrays |= {f"{k:05d}.texture.{name}": getattr(texture, name) for k, texture in textures for name in _TEXTURE_ARRAYS}
    return encode_arrays({**arrays, "table": np.frombuffer(json.dumps(table).encode(), np.uint8)})


def decode_objects(data: bytes) -> tuple[SceneObject, ...]:
    arrays = decode_arrays(data)
    table = json.loads(arrays["table"].tobytes())
    objects = []
    for k, row in enumerate(table):
        fields: dict[str, Any] = {name: arrays[f"{k:05d}.{name}"] for name in _OBJECT_ARRAYS}
        if f"{k:05d}.texture.image" in arrays:
            fields["texture"] = Texture(**{name: arrays[f"{k:05d}.texture.{name}"] for name in _TEXTURE_ARRAYS})
        objects.append(SceneObject(**row | {"slots": tuple(row["slots"])}, **fields))
    return tuple(objects)


def object_summary(objects: Sequence[SceneObject], rooms: Sequence[str]) -> dict[str, Any]:
    """Ids, labels and oriented boxes, for `objects.json`; the order is that of `Mesh.face_object`."""
    rows = [
        {
            "id": o.id,
            "label": o.label,
            "room": rooms[o.room],
            "support": o.support,
            "size": [round(float(x), 4) for x in o.size],
            "T_world_object": np.round(o.T_world_object, 6).tolist(),
        }
        for o in objects
    ]
    return {"units": "meters", "axes": OBJECT_AXES, "objects": rows}


def camera_frame(view: View, room: str) -> dict[str, Any]:
    """One frame of nerfstudio's transforms.json, with its own intrinsics, its mask (white where the image counts), and our room,
    kind and name."""
    return {
        "file_path": f"views/{view.name}.png",
        "depth_file_path": f"views/{view.name}.depth.png",
        "mask_path": f"views/{view.name}.mask.png",
        **_pose(view, room),
    }


def heldout_json(views: Sequence[View], rooms: Sequence[str], images: str) -> dict[str, Any]:
    """nerfstudio's transforms.json of held-out views, whose images are `images` with the name of the view in it. They are apart
    from the training views so that no trainer learns from them."""
    frames = [{"file_path": images.format(view.name), **_pose(view, rooms[view.room])} for view in views]
    return {"camera_model": "OPENCV", "frames": frames}


def _pose(view: View, room: str) -> dict[str, Any]:
    camera = view.camera
    return {
        "transform_matrix": opengl_pose(camera).round(9).tolist(),
        **_intrinsics(camera),
        "room": room,
        "kind": view.kind,
        "name": view.name,
    }


def transforms_json(views: Sequence[View], rooms: Sequence[str]) -> dict[str, Any]:
    """nerfstudio's transforms.json of all views: opens in any tool that reads that format. `wm.geometry.load_cameras` reads it
    back."""
    return {
        "camera_model": "OPENCV",
        "depth_unit_scale_factor": DEPTH_UNIT,
        "frames": [camera_frame(view, rooms[view.room]) for view in views],
    }


def room_names(cameras: bytes) -> list[str]:
    """The id of the room of each frame of a transforms.json that `transforms_json` or `heldout_json` has made."""
    return [str(frame["room"]) for frame in json.loads(cameras)["frames"]]


def _intrinsics(camera: Camera) -> dict[str, Any]:
    focal, principal = np.asarray(camera.focal, float), np.asarray(camera.principal, float)
    return {
        "fl_x": float(focal[0]),
        "fl_y": float(focal[1]),
        "cx": float(principal[0]),
        "cy": float(principal[1]),
        "w": camera.width,
        "h": camera.height,
    }
