"""The floor plan as an inline SVG: walls, doors, windows, furniture with its names, cameras.

What stands on the floor is labelled, large things first, where the label overlaps no other; every thing has its name as a title.
"""

import dataclasses
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import shapely
from jaxtyping import Float
from markupsafe import Markup

from wm.geometry import FloorPlan, interior_polygon, portals
from wm.geometry.plan.walls import room_polygon
from wm.report.labels import LETTER, LINE, Box, Label, place_label
from wm.report.templating import fill
from wm.types import SceneObject, View

PIXELS_PER_METRE = 44
MARGIN = 0.8
"""Metres around the plan."""
CAMERA_LENGTH = 0.35
"""Metres of the line that shows where a camera looks."""

ROOM_TEXT, THING_TEXT = 13.0, 9.0
"""Sizes of the names of rooms and of things, pixels."""
SPOTS = 0.25
"""Metres between places tried for the name of a room."""

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
    rooms = [_room(sheet, plan, objects, index) for index in range(len(plan.rooms))]
    return fill(
        "floorplan.svg",
        width=f"{width:.0f}",
        height=f"{height:.0f}",
        rooms=rooms,
        openings=[{"kind": portal.kind, "line": sheet.line(portal.ends)} for portal in portals(plan)],
        things=[{"support": x.support, "label": x.label, "outline": sheet.outline(_footprint(x))} for x in objects],
        labels=[_text(label, THING_TEXT) for label in _labels(sheet, objects, rooms)],
        cameras=[_camera(sheet, view) for view in views],
    )


def _room(sheet: _Sheet, plan: FloorPlan, objects: Sequence[SceneObject], index: int) -> dict:
    room, interior = plan.rooms[index], interior_polygon(plan, index)
    area = f"{interior.area:.1f} m²"
    (west, south), (east, north) = (map(float, sheet.at(corner)) for corner in np.array(interior.bounds).reshape(2, 2))
    width = LETTER * ROOM_TEXT * max(len(room.name), len(area))
    x, y = (float(v) for v in sheet.at(_clear_spot(interior, objects, index, width, 2.4 * ROOM_TEXT)))
    return {
        "name": room.name,
        "area": area,
        "outline": _rings(sheet, room_polygon(room)),
        "interior": _rings(sheet, interior),
        "middle": (f"{x:.1f}", f"{y:.1f}"),
        "bounds": Box(west, north, east, south),
        "box": Box(x - width / 2, y - 1.2 * ROOM_TEXT, x + width / 2, y + 1.2 * ROOM_TEXT),
    }


def _rings(sheet: _Sheet, polygon: shapely.Polygon) -> str:
    """A path around a polygon and its holes, to be filled by the even-odd rule."""
    return " ".join(sheet.outline(np.asarray(ring.coords)[:-1]) for ring in (polygon.exterior, *polygon.interiors))


def _clear_spot(
    interior: shapely.Polygon, objects: Sequence[SceneObject], room: int, width: float, height: float
) -> Float[np.ndarray, "2"]:
    """Where a text of this size, pixels, hides least furniture of a room; near its middle where several places are as good."""
    standing = [shapely.Polygon(_footprint(x)) for x in objects if x.room == room and x.support == "floor"]
    furniture, middle = shapely.union_all(standing), np.asarray(interior.representative_point().coords[0])
    low, high = np.array(interior.bounds).reshape(2, 2)
    x, y = (grid.ravel() for grid in np.meshgrid(*(np.arange(low[k], high[k], SPOTS) for k in (0, 1))))
    places = np.concatenate([middle[None], np.column_stack([x, y])])
    w, h = width / 2 / PIXELS_PER_METRE, height / 2 / PIXELS_PER_METRE
    boxes = shapely.box(places[:, 0] - w, places[:, 1] - h, places[:, 0] + w, places[:, 1] + h)
    hidden = shapely.area(shapely.intersection(boxes, furniture)) + 2 * shapely.area(shapely.difference(boxes, interior))
    away = np.linalg.norm(places - middle, axis=1)
    return places[np.argmin(hidden + 1e-3 * away)]


def _labels(sheet: _Sheet, objects: Sequence[SceneObject], rooms: Sequence[dict]) -> Iterator[Label]:
    """The names of what stands on the floor, within the outlines of their rooms, the largest first."""
    taken = [room["box"] for room in rooms]
    standing = [(_footprint(thing), thing) for thing in objects if thing.support == "floor"]
    for corners, thing in sorted(standing, key=lambda pair: -shapely.Polygon(pair[0]).area):
        x, y = (float(v) for v in sheet.at(corners.mean(axis=0)))
        wide, tall = (np.ptp(corners, axis=0) * PIXELS_PER_METRE / 2).tolist()
        places = [(x, y), (x, y - tall / 2), (x, y + tall / 2), (x - wide / 2, y), (x + wide / 2, y)]
        frame, turned = rooms[thing.room]["bounds"], bool(tall > 1.5 * wide)
        label = place_label(thing.label, places, size=THING_TEXT, taken=taken, sheet=frame, turned=turned)
        if label is not None:
            taken.append(label.box)
            yield label


def _text(label: Label, size: float) -> dict:
    first = -LINE * size * (len(label.lines) - 1) / 2 + 0.35 * size  # from the middle down to the first base line
    lines = [{"text": line, "y": f"{first + k * LINE * size:.1f}"} for k, line in enumerate(label.lines)]
    return {"place": f"translate({label.x:.1f} {label.y:.1f}){' rotate(-90)' if label.turned else ''}", "lines": lines}


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
