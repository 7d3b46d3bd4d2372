"""Target `collider`: what bodies run into, few triangles and no gaps.

    collider/<room>.glb    walls, floor and ceiling of a room: one closed solid (y up, as glTF has it)
    collider/objects.json  every object as convex parts, in the world (z up)

A room's solid is the building within the room's outline, so that the solids of all rooms together are the building: doors are
open, panes and entrances closed. Outlines reach OVERLAP into their neighbours', and no crack is left between two rooms.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import shapely
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull

from wm.artifacts.atomic import write_atomically
from wm.export.records import Check, ExportError
from wm.export.simulation.house import house_names
from wm.export.simulation.hulls import Hull, convex_hull
from wm.export.simulation.parts import parts_of
from wm.finished import FinishedRun
from wm.geometry.mesh.axes import Y_UP
from wm.geometry.mesh.glb import save_glb
from wm.geometry.mesh.glb_nodes import GlbNode
from wm.geometry.mesh.labelled_solids import polygon_rings
from wm.geometry.plan.walls import room_polygons
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast_rays
from wm.geometry.rays.surface_points import surface_points
from wm.types import Mesh, SceneObject

FOLDER, OBJECTS_FILE = "collider", "objects.json"
OVERLAP = 0.02
"""Metres by which the solids of neighbouring rooms overlap, inside the wall that they share."""
SPHERE = 0.05
"""Diameter in metres of the sphere that no gap may let through."""
MOST_TRIANGLES = 200_000
_COLOR = np.array([0.9, 0.5, 0.2])  # sRGB
_REACH = 1.0  # metres of building above and below the rooms: more than its slabs
_OFF = 0.01  # metres in front of a surface from which a gap is looked for
_BESIDE = 0.001  # metres to each side of a ray that missed, of which no sphere's gap is as narrow

Solid = tuple[Float[np.ndarray, "v 3"], Int[np.ndarray, "f 3"]]


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Writes the files and reads them back.

    Raises:
      ExportError: a solid is not closed, or was read back as another.
    """
    paths = []
    for name, solid in zip(house_names(run)[0], room_solids(run)):
        path = folder / FOLDER / f"{name}.glb"
        node = GlbNode(name=name, vertices=solid[0], faces=solid[1], base_color=_COLOR)
        write_atomically(path, lambda place, node=node: save_glb(place, [node]))
        read = _read(path)
        if not read.is_watertight or len(read.faces) != len(solid[1]):
            raise ExportError(f"{path}: was read back with {len(read.faces)} triangles, closed: {read.is_watertight}")
        paths.append(path)
    path = folder / FOLDER / OBJECTS_FILE
    write_atomically(path, json.dumps(objects_json(run.objects), separators=(",", ":")) + "\n")
    return [*paths, path]


def room_solids(run: FinishedRun) -> list[Solid]:
    """The building within the outline of each room.

    Raises:
      ExportError: the kernel failed.
    """
    structure = run.structure
    whole = manifold3d.Manifold(manifold3d.Mesh64(np.array(structure.vertices), np.array(structure.faces, np.uint64)))
    solids = []
    for room, polygon in zip(run.plan.rooms, room_polygons(run.plan)):
        outline = shapely.orient_polygons(polygon.buffer(OVERLAP, join_style="mitre"))
        rings = [np.ascontiguousarray(ring) for ring in polygon_rings(outline)]
        height = room.ceiling_height + 2 * _REACH
        prism = manifold3d.Manifold.extrude(manifold3d.CrossSection(rings), height).translate((0.0, 0.0, -_REACH))
        part = whole ^ prism
        if part.status() != manifold3d.Error.NoError or part.is_empty():
            raise ExportError(f"room {room.id}: its walls could not be cut out of the building ({part.status()})")
        mesh = part.to_mesh64()
        solids.append(_in_order(np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts, np.int64)))
    return solids


def objects_json(objects: Sequence[SceneObject]) -> dict[str, Any]:
    """The content of `objects.json`: for each object its convex parts; none of what lies flat, which one walks over."""
    rows = []
    for thing in objects:
        parts = [] if thing.support == "flat" else parts_of(thing)
        hulls = [convex_hull(part.corners.reshape(-1, 3)) for part in parts]
        rows.append({"id": thing.id, "parts": [_told(hull) for hull in hulls]})
    return {"version": 1, "units": "meters", "axes": "right-handed, z up", "objects": rows}


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """Closed solids, convex parts, no gap in any wall, floor or ceiling, and few triangles."""
    solids = [_read(folder / FOLDER / f"{name}.glb") for name in house_names(run)[0]]
    told = json.loads((folder / FOLDER / OBJECTS_FILE).read_text(encoding="utf-8"))["objects"]
    hulls = [part for row in told for part in row["parts"]]
    closed = sum(bool(solid.is_watertight) for solid in solids)
    convex = sum(_is_convex(np.array(part["vertices"]), np.array(part["faces"])) for part in hulls)
    count = sum(len(solid.faces) for solid in solids) + sum(len(part["faces"]) for part in hulls)
    gaps, rays = _gaps(run, solids)
    same = [row["id"] for row in told] == [thing.id for thing in run.objects]
    return [
        Check("collider", "rooms that are closed", f"{closed} of {len(solids)}", "all", closed == len(solids)),
        Check("collider", "parts of objects that are convex", f"{convex} of {len(hulls)}", "all", convex == len(hulls)),
        Check("collider", "objects as in the run", "yes" if same else "no", "yes", same),
        Check("collider", f"gaps for a sphere of {100 * SPHERE:g} cm", f"{gaps} of {rays} rays", "none", gaps == 0),
        Check("collider", "triangles", str(count), f"<= {MOST_TRIANGLES}", count <= MOST_TRIANGLES),
    ]


def _gaps(run: FinishedRun, solids: Sequence[Any]) -> tuple[int, int]:
    """Rays at the structure's inner surfaces, a sphere's radius apart, that meet no collider there; and how many were cast."""
    vertices = np.concatenate([solid.vertices @ Y_UP for solid in solids])
    offsets = np.cumsum([0, *(len(solid.vertices) for solid in solids[:-1])])
    faces = np.concatenate([np.asarray(solid.faces) + offset for solid, offset in zip(solids, offsets)])
    scene = build_ray_scene(Mesh.from_triangles(vertices, faces))
    inner = run.structure
    corners = inner.vertices[inner.faces[inner.face_room >= 0]]
    area = float(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2)
    points = surface_points(inner, int(np.ceil(area / (SPHERE / 2) ** 2)))
    missed = _misses(scene, points.position, points.normal)
    gaps = np.flatnonzero(missed)
    return int(_wide(scene, points.position[gaps], points.normal[gaps]).sum()), len(missed)


def _misses(scene: RayScene, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    hits = cast_rays(scene, points + _OFF * normals, -normals)
    return ~hits.hit | (hits.t > _OFF + SPHERE / 2)


def _wide(scene: RayScene, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Which misses are wider than a ray: one along the very edge of an opening passes the wall, a sphere does not."""
    across = np.cross(normals, np.where(np.abs(normals[:, 2:]) < 0.5, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]]))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    up = np.cross(normals, across)
    return np.all([_misses(scene, points + _BESIDE * step, normals) for step in (across, -across, up, -up)], axis=0)


def _is_convex(vertices: np.ndarray, faces: np.ndarray) -> bool:
    """Whether a part bounds the volume of its own convex hull; slivers of triangles have no plane to be held to."""
    a, b, c = (vertices[faces[:, k]] - vertices[0] for k in range(3))
    volume, hull = float(np.sum(a * np.cross(b, c))) / 6, ConvexHull(vertices).volume
    return abs(volume - hull) <= 1e-3 * hull + 1e-12


def _told(hull: Hull) -> dict[str, Any]:
    return {"vertices": np.round(hull.vertices, 6).tolist(), "faces": hull.faces.tolist()}


def _in_order(vertices: np.ndarray, faces: np.ndarray) -> Solid:
    """Vertices by place and triangles by vertex, so that bytes do not depend on the kernel's threads."""
    places, rank = np.unique(np.round(vertices, 7), axis=0, return_inverse=True)
    faces = rank.reshape(-1)[faces]
    faces = np.take_along_axis(faces, (np.argmin(faces, axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    return places, faces[np.lexsort(faces.T[::-1])].astype(np.int32)


def _read(path: Path) -> Any:
    """The one solid of a GLB, its vertices merged, as trimesh reads it."""
    import trimesh

    with path.open("rb") as file:
        scene = trimesh.load_scene(file, file_type="glb", process=False)
    (mesh,) = scene.geometry.values()
    return mesh
