"""What the page knows of a run besides splats and scaffold: rooms and where a visit of each begins, openings, objects, cameras.

Everything is in metres, right-handed, z up, as in wm's other files; the page turns it upright itself.
"""

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely

from wm.errors import ArtifactError
from wm.finished import FinishedRun
from wm.geometry import FloorPlan, portals
from wm.stages.scene import CAMERAS
from wm.types import SceneObject

EYE_HEIGHT = 1.6
"""Metres above the floor, as the training views have it."""
_HEADINGS = 16
"""Directions that are tried for the first look into a room."""
_CEILING = 1.9
"""Metres: an object whose foot is higher is not drawn in the floor plan."""


def world_record(run: FinishedRun, navmesh: Mapping[str, Any]) -> dict[str, Any]:
    """The page's `world.json`.

    Args:
      run: a finished run.
      navmesh: the content of its navmesh.json.
    """
    plan = run.plan
    corners = np.concatenate([room.polygon for room in plan.rooms])
    spawns = [_spawn(plan, index, navmesh) for index in range(len(plan.rooms))]
    return {
        "theme": run.theme or "a run of wm",
        "units": "meters",
        "axes": "right-handed, z up",
        "eye_height": EYE_HEIGHT,
        "raster": {name: getattr(run.raster, name) for name in ("blur", "alpha_min", "antialias", "near")},
        "bounds": {"low": corners.min(axis=0).tolist(), "high": corners.max(axis=0).tolist()},
        "rooms": [
            {"id": room.id, "name": room.name, "polygon": room.polygon.tolist(), "height": room.ceiling_height, "spawn": spawn}
            for room, spawn in zip(plan.rooms, spawns)
        ],
        "openings": [{"kind": portal.kind, "ends": portal.ends.tolist()} for portal in portals(plan)],
        "objects": [_object(plan, thing) for thing in run.objects],
        "cameras": _cameras(run),
    }


def _spawn(plan: FloorPlan, room: int, navmesh: Mapping[str, Any]) -> dict[str, Any] | None:
    """Where a visit of a room begins: its freest spot, looking where it is longest; None where nobody can stand in it."""
    vertices = np.asarray(navmesh["vertices"], float).reshape(-1, 3)
    triangles = [corners for corners, of in zip(navmesh["triangles"], navmesh["triangle_room"]) if of == room]
    area = shapely.union_all([shapely.Polygon(vertices[corners, :2]) for corners in triangles])
    if area.is_empty:
        return None
    largest = max(shapely.get_parts(area), key=shapely.area)
    x, y = shapely.get_coordinates(shapely.maximum_inscribed_circle(largest, tolerance=0.02))[0]
    walls = shapely.Polygon(plan.rooms[room].polygon).boundary
    headings = 2 * math.pi * np.arange(_HEADINGS) / _HEADINGS
    sights = [_sight(walls, x, y, heading) for heading in headings]
    return {"position": [float(x), float(y)], "heading": float(headings[int(np.argmax(sights))])}


def _sight(walls: shapely.Geometry, x: float, y: float, heading: float) -> float:
    """Metres from a point to a room's wall."""
    far = shapely.LineString([(x, y), (x + 1e3 * math.cos(heading), y + 1e3 * math.sin(heading))])
    return float(shapely.distance(shapely.Point(x, y), shapely.intersection(walls, far)))


def _object(plan: FloorPlan, thing: SceneObject) -> dict[str, Any]:
    """An object's row; `outline` is its convex outline from above, where it is drawn in the floor plan."""
    low = float(thing.vertices[:, 2].min())
    hull = shapely.MultiPoint(thing.vertices[:, :2]).convex_hull
    outline = np.round(shapely.get_coordinates(hull.exterior), 3).tolist() if isinstance(hull, shapely.Polygon) else None
    return {
        "id": thing.id,
        "label": thing.label,
        "room": plan.rooms[thing.room].id,
        "size": np.round(thing.size, 3).tolist(),
        "outline": outline if low < _CEILING else None,
    }


def _cameras(run: FinishedRun) -> list[dict[str, Any]]:
    """The training views; frames of cameras look along -z with y up, as in cameras.json."""
    path = run.file(CAMERAS)
    try:
        return [
            {
                "name": frame["name"],
                "room": frame["room"],
                "T_world_cam": frame["transform_matrix"],
                "focal": frame["fl_y"],
                "width": frame["w"],
                "height": frame["h"],
            }
            for frame in json.loads(path.read_bytes())["frames"]
        ]
    except (ValueError, KeyError, TypeError) as error:
        raise ArtifactError(f"{path}: is damaged ({error!r}); run it again") from error
