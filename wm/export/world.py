"""Target `world`: `world.json`, which says in one place what the house holds and where to begin.

Rooms, doors and windows, every object with its pose and box, spawn points, and under which name each is found in the other
targets: GLB node, USD prim, splats. Metres, right-handed, z up. Its JSON Schema is `world.schema.json`, written beside it.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from wm.artifacts.atomic import write_atomically
from wm.export.navmesh import JSON_FILE as NAVMESH
from wm.export.records import Check, ExportError
from wm.export.scaffold import FILE as SCAFFOLD_GLB
from wm.export.simulation.house import house_names
from wm.export.simulation.usd_stage import SCAFFOLD as USD_SCAFFOLD
from wm.finished import FinishedRun
from wm.geometry.placement.navigation import body_area
from wm.geometry.placement.navmesh import Navmesh, build_navmesh
from wm.geometry.placement.spawn import Spawn, part_spawns, room_spawns
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.stages.reconstruction import BY_ROOM, SPLATS
from wm.types import SceneObject

FILE, SCHEMA_FILE = "world.json", "world.schema.json"
VERSION = 1
_SCHEMA = Path(__file__).with_name(SCHEMA_FILE)
_NEAR = 2e-3
"""Metres by which a spawn point's circle may reach beyond the floor: arcs of the floor's edge are polygons."""


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Writes both files and reads `world.json` back.

    Raises:
      ExportError: no body can stand in the house, or the file was read back as something else.
    """
    told = world_json(run)
    path, schema = folder / FILE, folder / SCHEMA_FILE
    write_atomically(schema, _SCHEMA.read_text(encoding="utf-8"))
    write_atomically(path, json.dumps(told, indent=1, ensure_ascii=False, allow_nan=False) + "\n")
    if read_world(path) != told:
        raise ExportError(f"{path}: was read back as something else")
    return path, schema


def world_json(run: FinishedRun) -> dict[str, Any]:
    """The content of `world.json`. Raises: ExportError: no body can stand in the house."""
    navmesh = build_navmesh(run.plan, run.objects, run.navigation)
    by_room = room_spawns(run.plan, navmesh)
    by_part = part_spawns(run.plan, navmesh, by_room)
    if not by_part:
        raise ExportError(f"no body of radius {run.navigation.body_radius} m (navigation.body_radius) can stand in the house")
    usd_rooms, usd_names = house_names(run)
    splats = _splats(run)
    return {
        "$schema": SCHEMA_FILE,
        "version": VERSION,
        "units": "meters",
        "axes": "right-handed, z up",
        "theme": run.theme,
        "files": {"scaffold": SCAFFOLD_GLB, "navmesh": NAVMESH, "splats": SPLATS if splats else None},
        "body": {"radius": run.navigation.body_radius, "height": run.navigation.obstacle_height},
        "spawn": _spawn(by_part[0], run),
        "parts": [_part(k, spawn, by_room, navmesh, run) for k, spawn in enumerate(by_part)],
        "rooms": [_room(run, k, by_room[k], usd_rooms[k], splats) for k in range(len(run.rooms))],
        "openings": [_opening(k, portal, run) for k, portal in enumerate(portals(run.plan))],
        "objects": [
            _object(k, thing, run, f"{USD_SCAFFOLD}/{usd_rooms[thing.room]}/{usd_names[k]}")
            for k, thing in enumerate(run.objects)
        ],
    }


def read_world(path: Path) -> dict[str, Any]:
    """`world.json` as it is written. Raises: ExportError: it is none, or of another version."""
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
        version = told["version"]
    except (ValueError, KeyError, TypeError) as error:
        raise ExportError(f"{path}: is no world file ({error})") from error
    if version != VERSION:
        raise ExportError(f"{path}: has version {version}; this is for version {VERSION}")
    return told


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """It keeps its schema, every spawn point stands free and reaches the rooms of its part, and every object is the run's."""
    told = read_world(folder / FILE)
    spawns = [told["spawn"], *(part["spawn"] for part in told["parts"]), *(r["spawn"] for r in told["rooms"] if r["spawn"])]
    area = body_area(run.plan, run.objects, run.navigation)
    free = [stands_free(spawn["position"], area) for spawn in spawns]
    reached = [_reaches(part, told, area) for part in told["parts"]]
    with_spawn = sum(room["spawn"] is not None for room in told["rooms"])
    same = [_same(row, thing) for row, thing in zip(told["objects"], run.objects)]
    complete = len(told["objects"]) == len(run.objects) and all(same)
    return [
        _schema_check(told),
        Check("world", "spawn points that stand free", f"{sum(free)} of {len(free)}", "all", all(free)),
        Check("world", "rooms with a spawn point", f"{with_spawn} of {len(run.rooms)}", "all", with_spawn == len(run.rooms)),
        Check("world", "parts whose rooms are reached", f"{sum(reached)} of {len(reached)}", "all", all(reached)),
        Check("world", "objects as in the run", f"{sum(same)} of {len(run.objects)}", "all", complete),
    ]


def stands_free(position: Sequence[float], area: shapely.Geometry) -> bool:
    """Whether a body stands on the floor in the area in which its centre can be."""
    return abs(position[2]) < 1e-6 and bool(area.buffer(_NEAR).contains(shapely.Point(position[:2])))


def _schema_check(told: dict[str, Any]) -> Check:
    try:
        from jsonschema import Draft202012Validator
    except ImportError:
        return Check("world", "schema", "not checked: pip install 'wm[world]'", "valid", False)
    schema = json.loads(_SCHEMA.read_text(encoding="utf-8"))
    faults = sorted(error.json_path for error in Draft202012Validator(schema).iter_errors(told))
    return Check("world", "schema", f"wrong at {', '.join(faults[:3])}" if faults else "valid", "valid", not faults)


def _reaches(part: dict[str, Any], told: dict[str, Any], area: shapely.Geometry) -> bool:
    """Whether one connected piece of the area holds a part's spawn point and those of all its rooms."""
    mine = [room["spawn"]["position"][:2] for room in told["rooms"] if room["id"] in part["rooms"] and room["spawn"]]
    points = shapely.points([part["spawn"]["position"][:2], *mine])
    return any(bool(shapely.covers(piece.buffer(_NEAR), points).all()) for piece in shapely.get_parts(area))


def _same(row: dict[str, Any], thing: SceneObject) -> bool:
    return row["id"] == thing.id and bool(np.allclose(row["T_world_object"], thing.T_world_object, atol=1e-5))


def _spawn(spawn: Spawn, run: FinishedRun) -> dict[str, Any]:
    return {"position": list(spawn.position), "yaw": spawn.yaw, "room": run.rooms[spawn.room]}


def _part(number: int, spawn: Spawn, by_room: Sequence[Spawn | None], navmesh: Navmesh, run: FinishedRun) -> dict[str, Any]:
    """A part of the house that cannot be left on foot: the rooms whose spawn points are in it."""
    rooms = [run.rooms[k] for k, one in enumerate(by_room) if one is not None and one.part == number]
    area = float(navmesh.areas[navmesh.part == number].sum())
    return {"rooms": rooms, "spawn": _spawn(spawn, run), "area": round(area, 4)}


def _room(run: FinishedRun, k: int, spawn: Spawn | None, usd: str, splats: list[tuple[int, int]] | None) -> dict[str, Any]:
    room, floor = run.plan.rooms[k], interior_polygon(run.plan, k)
    return {
        "id": room.id,
        "name": room.name,
        "polygon": _points(shapely.get_coordinates(floor.exterior)[:-1]),
        "holes": [_points(shapely.get_coordinates(hole)[:-1]) for hole in floor.interiors],
        "ceiling_height": room.ceiling_height,
        "area": round(floor.area, 4),
        "spawn": None if spawn is None else _spawn(spawn, run),
        "glb_node": room.id,
        "usd_path": f"{USD_SCAFFOLD}/{usd}",
        "splats": None if splats is None else list(splats[k]),
    }


def _opening(number: int, portal: Portal, run: FinishedRun) -> dict[str, Any]:
    outside = portal.rooms[1] < 0
    kind = "entrance" if outside and portal.kind == "door" else portal.kind
    return {
        "id": f"{kind}_{number}",
        "kind": kind,
        "rooms": [run.rooms[room] for room in portal.rooms if room >= 0],
        "ends": _points(portal.ends),
        "sill": portal.sill,
        "head": portal.head,
        "width": round(portal.width, 6),
        "walkable": portal.is_way,
    }


def _object(index: int, thing: SceneObject, run: FinishedRun, usd: str) -> dict[str, Any]:
    return {
        "id": thing.id,
        "index": index,
        "label": thing.label,
        "room": run.rooms[thing.room],
        "support": thing.support,
        "T_world_object": np.round(thing.T_world_object, 6).tolist(),
        "size": np.round(thing.size, 6).tolist(),
        "bounds": [_rounded(thing.vertices.min(axis=0)), _rounded(thing.vertices.max(axis=0))],
        "glb_node": thing.id,
        "usd_path": usd,
    }


def _splats(run: FinishedRun) -> list[tuple[int, int]] | None:
    """For each room the first of its gaussians in `splats.ply` and the one after its last; None of a run that is not fitted."""
    if not (run.folder / BY_ROOM).is_file():
        return None
    counts = np.bincount(run.gaussian_room, minlength=len(run.rooms))
    ends = np.cumsum(counts)
    return [(int(end - count), int(end)) for count, end in zip(counts, ends)]


def _points(points: np.ndarray) -> list[list[float]]:
    return [_rounded(point) for point in points]


def _rounded(values: np.ndarray) -> list[float]:
    return np.round(np.asarray(values, np.float64), 6).tolist()
