"""Target `scaffold`: the run's `scaffold.glb` as it is: glTF 2.0, y up, metres.

A node for each room, named by its id, with its painted texture (unlit), and one for each piece of furniture, named by its id, in
its own frame, with extras id, label, room, support. Lights (KHR_lights_punctual) beside what glows, cameras of some views. The
building's outer skin is the file's second scene, "exterior".
"""

import json
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from wm.artifacts.atomic import write_atomically
from wm.export.records import Check, ExportError
from wm.finished import FinishedRun
from wm.types import SceneObject

FILE = "scaffold.glb"
TOLERANCE = 1e-4
"""Metres by which a corner may differ after float32 and a change of frames."""
_TO_Z_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Copies the file and reads it back with trimesh.

    Raises:
      ExportError: the file is of an older version, or holds other furniture than the run.
    """
    if _rooms(glb_document(run.scaffold_file)) != set(run.rooms):
        raise ExportError(f"{run.scaffold_file}: its nodes are not called by rooms; delete it and run the run again")
    write_atomically(folder / FILE, run.scaffold_file.read_bytes())
    worst = object_deviation(folder / FILE, run.objects)
    if worst > TOLERANCE:
        raise ExportError(f"{folder / FILE}: furniture was read back {worst:.4f} m elsewhere")
    return (folder / FILE,)


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """Nodes, frames, lights and scenes are what the run says."""
    path = folder / FILE
    document = glb_document(path)
    named = {node["name"]: node for node in document.get("nodes", []) if "mesh" in node}
    there = [thing.id in named and _labelled(named[thing.id], thing, run.rooms) for thing in run.objects]
    rooms = len(_rooms(document) & set(run.rooms))
    lights = len(document.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", []))
    scenes = [scene.get("name", "") for scene in document["scenes"]]
    worst = object_deviation(path, run.objects)
    return [
        Check("scaffold", "rooms with a node", f"{rooms} of {len(run.rooms)}", "all", rooms == len(run.rooms)),
        Check("scaffold", "objects with node and extras", f"{sum(there)} of {len(there)}", "all", all(there)),
        Check("scaffold", "objects against the run", f"{1000 * worst:.3f} mm", "< 0.1 mm", worst <= TOLERANCE),
        Check("scaffold", "lights", str(lights), "1 a room or more", lights >= len(run.rooms)),
        Check("scaffold", "outer skin apart", ", ".join(scenes), "house, exterior", scenes == ["house", "exterior"]),
    ]


def glb_document(path: Path) -> dict[str, Any]:
    """The JSON of a GLB file. Raises: ExportError: it is none."""
    data = path.read_bytes()
    try:
        magic, _, length, size, kind = struct.unpack_from("<4sIII4s", data)
        if (magic, kind, length) != (b"glTF", b"JSON", len(data)):
            raise ValueError("its header is another")
        return json.loads(data[20 : 20 + size])
    except (struct.error, ValueError) as error:
        raise ExportError(f"{path}: is no GLB file ({error})") from error


def object_deviation(path: Path, objects: Sequence[SceneObject]) -> float:
    """Metres between corners of the objects and those that trimesh reads in the nodes of their ids, at most; infinite if one is
    missing."""
    import trimesh

    with path.open("rb") as file:
        scene = trimesh.load_scene(file, file_type="glb", process=False)
    parents = scene.graph.transforms.parents
    corners: dict[str, list[np.ndarray]] = {}
    for name in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[name]
        mesh: Any = scene.geometry[geometry]
        placed = (np.asarray(mesh.vertices) @ transform[:3, :3].T + transform[:3, 3]) @ _TO_Z_UP.T
        for owner in {name, parents.get(name)}:  # a node of several primitives becomes one with a child for each
            corners.setdefault(str(owner), []).append(placed)
    return max((_deviation(thing, corners.get(thing.id)) for thing in objects), default=0.0)


def _deviation(thing: SceneObject, read: list[np.ndarray] | None) -> float:
    """Both ways: no corner of the object is missing, and none is read that it has not."""
    if not read:
        return float("inf")
    used, found = thing.vertices[np.unique(thing.faces)], np.concatenate(read)
    return float(max(cKDTree(found).query(used)[0].max(), cKDTree(used).query(found)[0].max()))


def _rooms(document: dict[str, Any]) -> set[str]:
    """The rooms whose structure the file holds."""
    nodes = document.get("nodes", [])
    return {node["extras"]["room"] for node in nodes if node.get("extras", {}).get("label") == "room"}


def _labelled(node: dict[str, Any], thing: SceneObject, rooms: Sequence[str]) -> bool:
    told = node.get("extras", {})
    wanted = {"id": thing.id, "label": thing.label, "room": rooms[thing.room], "support": thing.support}
    placed = np.allclose(_TO_Z_UP.T @ thing.T_world_object[:3, 3], node.get("translation", [np.inf] * 3), atol=1e-6)
    return placed and all(told.get(name) == value for name, value in wanted.items())
