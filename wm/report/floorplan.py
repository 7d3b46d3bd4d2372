"""The floor plan as an inline SVG: walls, doors, windows, furniture, cameras."""

import dataclasses
from collections.abc import Iterable, Sequence

import numpy as np
from jaxtyping import Float
from markupsafe import Markup

from wm.geometry import FloorPlan, interior_polygon, portals
from wm.report.templating import fill
from wm.types import SceneObject, View

PIXELS_PER_METRE = 44
MARGIN = 0.8
"""Metres around the plan."""
CAMERA_LENGTH = 0.35
"""Metres of the line that shows where a camera looks."""

CAMERA_COLOURS = {
    "bootstrap": "#d1495b",
    "perimeter": "#30638e",
    "overhead": "#7a9e7e",
    "doorway": "#edae49",
    "heldout": "#8d6a9f",
}
"""Colours of the cameras by the kind of their view."""


@dataclasses.dataclass(frozen=True, eq=False)
class _Sheet:
    """From the plan's metres, y up, to pixels, y down."""

    low: Float[np.ndarray, "2"]  # metres
    height: float  # pixels

    def at(self, point: Iterable[float]) -> tuple[str, str]:
        """The pixel coordinates of a point; a third coordinate is left out."""
        x, y = (np.asarray(point, float)[:2] - self.low) * PIXELS_PER_METRE
        return f"{x:.1f}", f"{self.height - y:.1f}"

    def line(self, points: Iterable[Iterable[float]]) -> str:
        """An open path."""
        return "M" + " L".join(",".join(self.at(point)) for point in points)

    def outline(self, points: Iterable[Iterable[float]]) -> str:
        """A closed path."""
        return f"{self.line(points)} Z"


def draw_floorplan(plan: FloorPlan, objects: Sequence[SceneObject], views: Sequence[View]) -> Markup:
    """An `<svg>` element of the plan seen from above, north (y) up."""
    corners = np.concatenate([np.asarray(room.polygon) for room in plan.rooms])
    low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
    width, height = (high - low) * PIXELS_PER_METRE
    sheet = _Sheet(low=low, height=height)
    return fill(
        "floorplan.svg",
        width=f"{width:.0f}",
        height=f"{height:.0f}",
        rooms=[_room(sheet, plan, index) for index in range(len(plan.rooms))],
        openings=[{"kind": portal.kind, "line": sheet.line(portal.ends)} for portal in portals(plan)],
        things=[{"support": x.support, "label": x.label, "outline": sheet.outline(_footprint(x))} for x in objects],
        cameras=[_camera(sheet, view) for view in views],
    )


def _room(sheet: _Sheet, plan: FloorPlan, index: int) -> dict:
    room, interior = plan.rooms[index], interior_polygon(plan, index)
    return {
        "name": room.name,
        "area": f"{interior.area:.1f}",
        "outline": sheet.outline(room.polygon),
        "interior": sheet.outline(np.asarray(interior.exterior.coords)[:-1]),
        "middle": sheet.at(interior.representative_point().coords[0]),
    }


def _camera(sheet: _Sheet, view: View) -> dict:
    T_world_cam = np.linalg.inv(np.asarray(view.camera.T_cam_world, float))
    eye, forward = T_world_cam[:3, 3], T_world_cam[:3, 2]
    return {
        "name": view.name,
        "colour": CAMERA_COLOURS.get(view.kind, "#888"),
        "eye": sheet.at(eye),
        "line": sheet.line([eye, eye + CAMERA_LENGTH * forward]),
    }


def _footprint(thing: SceneObject) -> np.ndarray:
    """[4, 2] corners of the object's oriented box, seen from above, metres."""
    x, y = thing.size[0] / 2, thing.size[1] / 2
    corners = np.array([[-x, -y, 0, 1], [x, -y, 0, 1], [x, y, 0, 1], [-x, y, 0, 1]])
    return (corners @ thing.T_world_object.T)[:, :2]
