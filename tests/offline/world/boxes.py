"""A small furnished room for the tests of the offline world: two rooms, a door, a window, and boxes."""

import functools

import numpy as np

from wm.geometry import build_structure, parse_plan
from wm.geometry.mesh.scene_mesh import BOX_CORNERS, BOX_FACES
from wm.offline.world.light import BakeSettings
from wm.synth.backends import SceneContext
from wm.types import SceneObject

PLAN = """{"metadata": {"units": "meters", "wall_thickness": 0.15, "default_ceiling_height": 2.6}, "rooms": [
 {"id": "living", "name": "living room",
  "floor_polygon": [[0, 0], [3.4, 0], [3.4, 2.8], [0, 2.8]], "ceiling_height": 2.6,
  "openings": [
   {"type": "window", "wall_segment": [[0, 0], [3.4, 0]], "position": 1.0, "width": 1.2, "height": 1.3, "sill_height": 0.9},
   {"type": "door", "wall_segment": [[3.4, 0], [3.4, 2.8]], "position": 1.6, "width": 0.9, "height": 2.0, "sill_height": 0}]},
 {"id": "bath", "name": "bathroom", "floor_polygon": [[3.4, 0], [5.4, 0], [5.4, 2.8], [3.4, 2.8]], "ceiling_height": 2.6,
  "openings": []}], "objects": []}"""
COARSE = BakeSettings(cell=0.2, spacing=0.4, probe_spacing=0.3, rays=24, sun_rays=2, bounces=3)


def box(
    label: str, low: tuple[float, ...], high: tuple[float, ...], slot: str, *, room: int = 0, emission: float = 0.0
) -> SceneObject:
    """An axis-aligned box of one slot, its colour a middle red."""
    a, b = np.array(low, float), np.array(high, float)
    T_world_object = np.eye(4)
    T_world_object[:3, 3] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, a[2]]
    return SceneObject(
        label=label, room=room, support="floor", vertices=a + BOX_CORNERS * (b - a), faces=BOX_FACES.copy(),
        face_slot=np.zeros(len(BOX_FACES), np.int32), slots=(slot,), slot_colors=np.array([[0.6, 0.3, 0.25]], np.float32),
        T_world_object=T_world_object, size=b - a, emission=np.array([emission], np.float32),
    )  # fmt: skip


@functools.cache
def furnished(theme: str = "gothic library") -> SceneContext:
    """Two rooms, a window, a door; a table, a sofa and a lamp in the first room, nothing in the second."""
    plan = parse_plan(PLAN)
    objects = (
        box("table", (1.5, 1.2, 0.0), (2.3, 1.8, 0.7), "dark_wood"),
        box("sofa", (0.3, 1.9, 0.0), (1.2, 2.5, 0.4), "velvet"),
        box("lamp", (1.8, 1.4, 1.7), (2.0, 1.6, 1.9), "lamp_shade", emission=1.0),
    )
    return SceneContext(theme, 0, plan, build_structure(plan), objects)
