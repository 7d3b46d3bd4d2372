"""The floor plan as an inline SVG: walls, doors, windows, furniture, cameras."""

import html
from collections.abc import Sequence

import numpy as np

from wm.geometry import FloorPlan, interior_polygon, portals
from wm.types import SceneObject, View

PIXELS_PER_METRE = 44
MARGIN = 0.8
CAMERA_LENGTH = 0.35

_COLOURS = {"bootstrap": "#d1495b", "perimeter": "#30638e", "overhead": "#7a9e7e", "doorway": "#edae49", "heldout": "#8d6a9f"}


def draw_floorplan(plan: FloorPlan, objects: Sequence[SceneObject], views: Sequence[View]) -> str:
    """An `<svg>` element of the plan seen from above, north (y) up."""
    corners = np.concatenate([np.asarray(room.polygon) for room in plan.rooms])
    low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
    width, height = (high - low) * PIXELS_PER_METRE

    def at(point) -> str:
        x, y = (np.asarray(point, float)[:2] - low) * PIXELS_PER_METRE
        return f"{x:.1f},{height - y:.1f}"

    def path(points) -> str:
        return "M" + " L".join(at(p) for p in points) + " Z"

    parts = [f'<svg class="plan" viewBox="0 0 {width:.0f} {height:.0f}" role="img" aria-label="floor plan">']
    for room in plan.rooms:
        parts.append(f'<path class="wall" d="{path(room.polygon)}"/>')
    interiors = [interior_polygon(plan, index) for index in range(len(plan.rooms))]
    for interior in interiors:
        parts.append(f'<path class="room" d="{path(np.asarray(interior.exterior.coords)[:-1])}"/>')
    for portal in portals(plan):
        (ax, ay), (bx, by) = at(portal.ends[0]).split(","), at(portal.ends[1]).split(",")
        parts.append(f'<line class="{portal.kind}" x1="{ax}" y1="{ay}" x2="{bx}" y2="{by}"/>')
    for thing in objects:
        outline = f'class="thing {thing.support}" d="{path(_footprint(thing))}"'
        parts.append(f"<path {outline}><title>{html.escape(thing.label)}</title></path>")
    for view in views:
        T_world_cam = np.linalg.inv(np.asarray(view.camera.T_cam_world, float))
        eye, forward = T_world_cam[:3, 3], T_world_cam[:3, 2]
        (ax, ay), (bx, by) = at(eye).split(","), at(eye + CAMERA_LENGTH * forward).split(",")
        colour = _COLOURS.get(view.kind, "#888")
        parts.append(f'<g stroke="{colour}" fill="{colour}"><circle cx="{ax}" cy="{ay}" r="2.4"/>')
        parts.append(f'<line x1="{ax}" y1="{ay}" x2="{bx}" y2="{by}"/><title>{html.escape(view.name)}</title></g>')
    for room, interior in zip(plan.rooms, interiors):
        x, y = at(interior.representative_point().coords[0]).split(",")
        parts.append(f'<text x="{x}" y="{y}">{html.escape(room.name)}</text>')
        parts.append(f'<text class="area" x="{x}" y="{float(y) + 15:.1f}">{interior.area:.1f} m²</text>')
    parts.append("</svg>")
    return "".join(parts)


def camera_legend() -> str:
    """The colours of the cameras in the drawing, as HTML."""
    return " ".join(f'<span class="key"><i style="background:{colour}"></i>{kind}</span>' for kind, colour in _COLOURS.items())


def _footprint(thing: SceneObject) -> np.ndarray:
    """[4, 2] corners of the oriented box on the floor."""
    x, y = thing.size[0] / 2, thing.size[1] / 2
    corners = np.array([[-x, -y, 0, 1], [x, -y, 0, 1], [x, y, 0, 1], [-x, y, 0, 1]])
    return (corners @ thing.T_world_object.T)[:, :2]
