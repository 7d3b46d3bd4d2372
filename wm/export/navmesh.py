"""Target `navmesh`: where a body can walk, as `navmesh.json` (z up) and `navmesh.glb` (y up, as glTF has it).

JSON: version, units, axes, radius, vertices [[x, y, z]], triangles [[i, j, k]] counter-clockwise from above, triangle_room (index
into rooms, -1 in a doorway), triangle_part (which triangles are connected), rooms (ids). The body is that of the run's
`navigation` settings.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from jaxtyping import Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from wm.artifacts.atomic import write_atomically
from wm.export.records import Check, ExportError
from wm.finished import FinishedRun
from wm.geometry.mesh.glb import GlbNode, save_glb
from wm.geometry.placement.navigation import body_area
from wm.geometry.placement.navmesh import Navmesh, build_navmesh
from wm.geometry.plan.openings import portals

JSON_FILE, GLB_FILE = "navmesh.json", "navmesh.glb"
AREA_TOLERANCE = 0.05
"""Share by which the area may differ from that of `navigability_body`."""
_COLOR = np.array([0.25, 0.6, 0.9])  # sRGB


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Writes both files and reads them back.

    Raises:
      ExportError: no body can stand anywhere, or a file was read back as something else.
    """
    navmesh = build_navmesh(run.plan, run.objects, run.navigation)
    if not len(navmesh.triangles):
        raise ExportError(f"no body of radius {run.navigation.body_radius} m (navigation.body_radius) can stand in the house")
    told, glb = folder / JSON_FILE, folder / GLB_FILE
    write_atomically(told, json.dumps(navmesh_json(navmesh, run.rooms), separators=(",", ":")) + "\n")
    floor = GlbNode(name="navmesh", vertices=navmesh.vertices, faces=navmesh.triangles, base_color=_COLOR, unlit=True)
    write_atomically(glb, lambda path: save_glb(path, [floor]))
    for file, vertices in ((told, read_navmesh(told).vertices), (glb, _glb_vertices(glb))):
        if vertices.shape != navmesh.vertices.shape or np.abs(vertices - navmesh.vertices).max() > 1e-5:
            raise ExportError(f"{file}: was read back as another mesh")
    return told, glb


def navmesh_json(navmesh: Navmesh, rooms: Sequence[str]) -> dict[str, Any]:
    """The content of `navmesh.json`."""
    return {
        "version": 1,
        "units": "meters",
        "axes": "right-handed, z up",
        "radius": navmesh.radius,
        "vertices": np.round(navmesh.vertices, 6).tolist(),
        "triangles": navmesh.triangles.tolist(),
        "triangle_room": navmesh.room.tolist(),
        "triangle_part": navmesh.part.tolist(),
        "rooms": list(rooms),
    }


def read_navmesh(path: Path) -> Navmesh:
    """`navmesh.json` as a record. Raises: ExportError: it is none."""
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
        arrays = {name: np.array(told[f"triangle_{name}"], np.int32) for name in ("room", "part")}
        vertices, triangles = np.array(told["vertices"], np.float64), np.array(told["triangles"], np.int32)
        return Navmesh(radius=float(told["radius"]), vertices=vertices, triangles=triangles, **arrays)
    except (ValueError, KeyError, TypeError) as error:
        raise ExportError(f"{path}: is no navmesh ({error})") from error


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """Connected through every door, on the floor, of the area that a body has, and the same in both files."""
    navmesh = read_navmesh(folder / JSON_FILE)
    parts = triangle_components(navmesh.triangles)
    area = body_area(run.plan, run.objects, run.navigation).area
    share = float(navmesh.areas.sum()) / area
    doors = [_joins(portal.rooms, navmesh, parts) for portal in portals(run.plan) if portal.is_way]
    height = float(np.abs(navmesh.vertices[:, 2]).max())
    stray = _off_floor(run, navmesh)
    glb = _glb_vertices(folder / GLB_FILE)
    same = glb.shape == navmesh.vertices.shape and bool(np.allclose(glb, navmesh.vertices, atol=1e-5))
    count, wanted = int(parts.max()) + 1, int(navmesh.part.max()) + 1
    return [
        Check("navmesh", "doors and passages that it leads through", f"{sum(doors)} of {len(doors)}", "all", all(doors)),
        Check("navmesh", "connected pieces", str(count), f"{wanted}", count == wanted),
        Check("navmesh", "height above the floor", f"{height:.3f} m", "0", height < 1e-3),
        Check("navmesh", "area against the floor of a body", f"{share:.1%}", "95 to 105 %", abs(share - 1) <= AREA_TOLERANCE),
        Check("navmesh", "area nearer to walls or obstacles than the radius", f"{stray:.4f} m2", "0", stray < 1e-3 * area),
        Check("navmesh", "GLB equals JSON", "yes" if same else "no", "yes", same),
    ]


def triangle_components(triangles: Int[np.ndarray, "t 3"]) -> Int[np.ndarray, " t"]:
    """For each triangle the number of its connected piece; triangles are neighbours where they share an edge."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, index = np.unique(edges, axis=0, return_inverse=True)
    order = np.argsort(index, kind="stable")
    same = index[order][1:] == index[order][:-1]
    owner = order // 3
    count = len(triangles)
    pairs = coo_array((np.ones(int(same.sum())), (owner[:-1][same], owner[1:][same])), shape=(count, count))
    return np.asarray(connected_components(pairs, directed=False)[1], np.int32)


def _joins(rooms: tuple[int, int], navmesh: Navmesh, parts: np.ndarray) -> bool:
    """Whether both rooms of a way have floor of one connected piece."""
    a, b = (set(parts[navmesh.room == room].tolist()) for room in rooms)
    return bool(a & b)


def _off_floor(run: FinishedRun, navmesh: Navmesh) -> float:
    """Square metres of the mesh where the body would not fit."""
    covered = shapely.union_all(shapely.polygons(navmesh.vertices[navmesh.triangles, :2]))
    return float(covered.difference(body_area(run.plan, run.objects, run.navigation)).area)


def _glb_vertices(path: Path) -> np.ndarray:
    """The vertices of the one mesh of a GLB, in our axes, read by trimesh."""
    import trimesh

    with path.open("rb") as file:
        scene = trimesh.load_scene(file, file_type="glb", process=False)
    (mesh,) = scene.geometry.values()
    x, y, z = np.asarray(mesh.vertices, np.float64).T
    return np.stack([x, -z, y], axis=1)
