"""The mesh file that an image-to-3D model answers with, as an object with few enough faces, its colours in slots or a texture."""

import pathlib
import tempfile

import numpy as np

from wm.geometry.exchange.mesh_error import MeshError
from wm.geometry.exchange.object_file import load_object
from wm.models.access import optional_module
from wm.models.reconstruction.baking import baked
from wm.services.faults import RefusedError
from wm.types import SceneObject


def model_mesh(content: bytes, *, label: str, room: int, most_faces: int, texels: int) -> SceneObject:
    """The object of a GLB file, z up, in the file's units, where the file has it.

    Args:
      content: the file.
      label: what a person would call the object.
      room: index into FloorPlan.rooms.
      most_faces: a mesh with more is decimated to about this number, and its colours become a texture.
      texels: pixels of that texture, about.

    Raises:
      RefusedError: the file cannot be read or holds no usable mesh.
      MissingExtraError: the mesh must be decimated and the package for it is not installed.
    """
    with tempfile.TemporaryDirectory(prefix="wm-mesh-") as folder:
        path = pathlib.Path(folder) / "mesh.glb"
        path.write_bytes(content)
        try:
            thing = load_object(path, label=label, room=room)
        except MeshError as error:
            raise RefusedError(f"its mesh cannot be used: {str(error).replace(str(path), 'mesh.glb')}") from error
    if len(thing.faces) <= most_faces:
        return thing
    vertices, faces = _decimated(thing, most_faces)
    return baked(thing, vertices, faces, texels=texels)


def _decimated(thing: SceneObject, most_faces: int) -> tuple[np.ndarray, np.ndarray]:
    """(vertices [v, 3], faces [f, 3]) by collapses of the edges that change the surface least.

    Source: Garland and Heckbert, "Surface simplification using quadric error metrics", 1997, as fast-simplification has it.
    """
    fast = optional_module("fast_simplification", "sam3d")
    middle = thing.vertices.mean(axis=0)
    vertices, faces = fast.simplify(thing.vertices - middle, thing.faces, target_count=most_faces)
    return np.asarray(vertices, np.float64) + middle, np.asarray(faces, np.int32)
