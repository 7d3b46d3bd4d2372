"""Point lights of a furnished house: where things glow, and in rooms where nothing does.

glTF's emission lights nothing by itself in most renderers, so that furniture would be black. A glowing thing has one light beside
it, in front of what glows or below what hangs from a ceiling, where its own shade does not stand in the way. A room without one
has a light below its ceiling.
"""

from collections.abc import Sequence

import numpy as np

from wm.geometry.mesh.glb_nodes import GlbLight
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.records import FloorPlan
from wm.types import SceneObject

LUMINANCE = 1000.0
"""Candela per square metre of a slot of emission 1, about that of a lampshade. A convex body shows a quarter of its area."""
BRIGHTEST = 400.0
"""Candela of a light at most: a large window or screen is no floodlight."""
FAINTEST = 1.0
"""Candela below which a glow (a pilot lamp) has no light of its own."""
CEILING_LIGHT = 80.0
"""Candela of the light in a room where nothing glows: a bulb of 1000 lumens."""
_BESIDE = 0.05  # metres between a thing and its light
_WHITE = np.array([1.0, 0.95, 0.88])  # sRGB of that bulb


def house_lights(plan: FloorPlan, objects: Sequence[SceneObject]) -> list[GlbLight]:
    """One light for each thing that glows, named after it and moving with it, and one for each room without such a thing."""
    lamps = [(thing.room, light) for thing in objects if (light := _lamp(thing)) is not None]
    dark = set(range(len(plan.rooms))) - {room for room, _ in lamps}
    return [*(light for _, light in lamps), *(_ceiling_light(plan, room) for room in sorted(dark))]


def _lamp(thing: SceneObject) -> GlbLight | None:
    area = np.linalg.norm(face_crosses(thing.vertices[thing.faces]), axis=1) / 2
    power = area * np.asarray(thing.emission, np.float64)[thing.face_slot]
    intensity = LUMINANCE * float(power.sum()) / 4
    if not thing.id or intensity < FAINTEST:
        return None
    middle = power @ thing.vertices[thing.faces].mean(axis=1) / power.sum()
    color = power @ np.asarray(thing.slot_colors, np.float64)[thing.face_slot] / power.sum()
    rotation, origin = thing.T_world_object[:3, :3], thing.T_world_object[:3, 3]
    local, place = (thing.vertices - origin) @ rotation, (middle - origin) @ rotation
    if thing.support == "ceiling":
        place[2] = local[:, 2].min() - _BESIDE
    else:
        place[1] = local[:, 1].min() - _BESIDE
    position = rotation @ place + origin
    return GlbLight(f"{thing.id} light", position, np.clip(color, 0, 1), min(intensity, BRIGHTEST), parent=thing.id)


def _ceiling_light(plan: FloorPlan, room: int) -> GlbLight:
    place = interior_polygon(plan, room).representative_point()
    position = np.array([place.x, place.y, plan.rooms[room].ceiling_height - 0.3])
    return GlbLight(f"{plan.rooms[room].id} light", position, _WHITE, CEILING_LIGHT)
