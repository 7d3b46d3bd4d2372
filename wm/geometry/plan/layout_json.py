"""Reading plan text into records: syntax, types and ranges, every fault named. How rooms fit together is checked in rules.py."""

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from wm.geometry.plan.object_json import object_json, read_objects
from wm.geometry.plan.outlines import counter_clockwise, keyhole
from wm.geometry.plan.records import (
    CEILING_HEIGHT,
    WALL_THICKNESS,
    FloorPlan,
    Opening,
    PlanError,
    PlanObject,
    Room,
    ThickWall,
    Violation,
)
from wm.geometry.plan.units import METRES, OPENINGS, metres_per, opening_kind, unread
from wm.schema import LONGEST_ROOM_NAME

MAX_BYTES = 8 * 2**20
MAX_ROOMS = 2048
MAX_POINTS = 512  # per polygon
MAX_OPENINGS = 64  # per room
MAX_COORDINATE = 1e4  # metres
CEILING = (1.2, 50.0)  # metres: from attics that people crawl into to halls
WALL = (0.05, 1.0)
WIDEST = 100.0  # metres, of an opening
SILLS = {"window": 0.9, "hatch": 0.9}  # metres, where an opening does not say
MAX_RINGS = 256  # holes, columns and walls of their own thickness, of a room
# Ids become folder names (views/<room>/), so they hold no character that means something in a path.
ROOM_ID = re.compile(r"[^\W_][\w\-]{0,63}", re.ASCII)
LEAST_OPENING = (0.1, 0.1)  # metres of width and height
_MOST_NOTES = 20


def decode(text: str, source: str) -> Any:
    """The JSON value of a text; duplicate keys, NaN and Infinity are refused.

    Raises:
      PlanError: one violation, rule "json".
    """
    if len(text) > MAX_BYTES:
        raise _syntax(f"{len(text)} characters long; at most {MAX_BYTES} are read", source)
    try:
        return json.loads(text, object_pairs_hook=_unique, parse_constant=_no_constant, parse_int=_integer)
    except RecursionError:
        raise _syntax("nested too deeply; a plan needs six levels", source) from None
    except json.JSONDecodeError as error:
        raise _syntax(f"not JSON: {error.msg} at line {error.lineno} column {error.colno}", source) from None
    except ValueError as error:
        raise _syntax(str(error), source) from None


def encode(plan: FloorPlan) -> str:
    """The plan as JSON text in the published layout; numbers are exact, and equal plans give equal texts."""
    document = {
        "metadata": {
            "units": "meters",
            "coordinate_system": "z_up",
            "wall_thickness": plan.wall_thickness,
            "default_ceiling_height": plan.default_ceiling_height,
        },
        "rooms": [_room_json(room) for room in plan.rooms],
        "objects": [object_json(thing) for thing in plan.objects],
    }
    if plan.solids:
        document["solids"] = [ring.tolist() for ring in plan.solids]
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _room_json(room: Room) -> dict[str, Any]:
    more: dict[str, Any] = {}
    for key, rings in (("holes", room.holes), ("columns", room.columns)):
        if rings:
            more[key] = [ring.tolist() for ring in rings]
    if room.walls:
        more["walls"] = [{"segment": wall.segment.tolist(), "thickness": wall.thickness} for wall in room.walls]
    return {
        "id": room.id,
        "name": room.name,
        "floor_polygon": room.polygon.tolist(),
        "ceiling_height": room.ceiling_height,
        "openings": [
            {
                "type": opening.kind,
                "wall_segment": opening.segment.tolist(),
                "position": opening.position,
                "width": opening.width,
                "height": opening.height,
                "sill_height": opening.sill_height,
            }
            for opening in room.openings
        ],
        **more,
    }


class Reader:
    """Collects violations while it turns decoded JSON into records; what cannot be read is None."""

    def __init__(self, *, metres: bool = False) -> None:
        """Args: metres: every length is taken for metres, whatever the document says of units."""
        self._metres = metres
        self.violations: list[Violation] = []
        self.notes: list[str] = []  # a sentence for each thing that is not read
        self.scale = 1.0  # metres per unit of the document
        self.rooms_missing = False  # rooms are in the document that could not be read
        self.openings_missing = False  # openings likewise

    def plan(self, document: Any) -> FloorPlan | None:
        """The plan of all rooms and openings that could be read; None where there is no room."""
        if not isinstance(document, dict):
            self._fault(None, "type", f"a plan is a JSON object, not {_kind(document)}")
            return None
        self._note_unread(document, "plan", "the plan")
        wall, ceiling = self._metadata(_given(document, "metadata", {}))
        rooms = document.get("rooms")
        if not isinstance(rooms, list):
            found = "missing" if rooms is None else f"{_kind(rooms)}"
            self._fault(None, "type", f"'rooms' must be a list of rooms; it is {found}")
            return None
        if not rooms:
            self._fault(None, "no_rooms", "'rooms' is empty; a plan has at least one room")
            return None
        if len(rooms) > MAX_ROOMS:
            self._fault(None, "too_many", f"{len(rooms)} rooms; at most {MAX_ROOMS}")
            return None
        read = [self._room(room, index, ceiling) for index, room in enumerate(rooms)]
        good = tuple(room for room in read if room is not None)
        self.rooms_missing = len(good) < len(read)
        solids = tuple(counter_clockwise(ring) for ring in self._rings(None, document, "solids"))
        return FloorPlan(good, wall, ceiling, solids=solids) if good else None

    def blame_units(self, document: Any) -> None:
        """Makes one violation of all numbers out of range where each would be in range in metres: the unit is what is wrong."""
        out_of_range = [fault for fault in self.violations if fault.rule == "number"]
        if self.scale == 1 or len(out_of_range) < 2:
            return
        in_metres = Reader(metres=True)
        in_metres.plan(document)
        if not any(fault.rule == "number" for fault in in_metres.violations):
            self.violations = [fault for fault in self.violations if fault.rule != "number"]
            units = _show(document["metadata"]["units"])
            example = out_of_range[0].message.split(";")[0]
            message = f"metadata.units is {units}, and so {example}; every length fits a building of metres: say 'meters'"
            self._fault(None, "units", message)

    def objects(self, document: dict[str, Any], rooms: Sequence[Room], folder: Path | None) -> tuple[PlanObject, ...]:
        """The furniture that the document lists, in these rooms; relative mesh files lie in `folder`."""
        things, faults, notes = read_objects(_given(document, "objects", []), rooms, scale=self.scale, folder=folder)
        self.violations += faults
        self.notes += notes[:_MOST_NOTES]
        return things

    def _fault(self, room: str | None, rule: str, message: str) -> None:
        self.violations.append(Violation(room, rule, message))

    def _note_unread(self, holder: dict[str, Any], of: str, where: str) -> None:
        keys = unread(holder, of)
        if keys and len(self.notes) < _MOST_NOTES:
            self.notes.append(f"{where} says {', '.join(keys[:8])}, which is not read")

    def _metadata(self, metadata: Any) -> tuple[float, float]:
        if not isinstance(metadata, dict):
            self._fault(None, "type", f"'metadata' must be an object, not {_kind(metadata)}")
            return WALL_THICKNESS, CEILING_HEIGHT
        self._note_unread(metadata, "metadata", "metadata")
        units, system = _given(metadata, "units", "meters"), _given(metadata, "coordinate_system", "z_up")
        if metres_per(units) is None:
            self._fault(None, "units", f"metadata.units is {_show(units)}; choices: {', '.join(METRES)}")
        self.scale = 1.0 if self._metres else metres_per(units) or 1.0
        if system != "z_up":
            self._fault(None, "units", f"metadata.coordinate_system is {_show(system)}; only 'z_up' is understood")
        wall = self._number(None, metadata, "metadata.wall_thickness", WALL_THICKNESS, *WALL)
        ceiling = self._number(None, metadata, "metadata.default_ceiling_height", CEILING_HEIGHT, *CEILING)
        return (WALL_THICKNESS if wall is None else wall), (CEILING_HEIGHT if ceiling is None else ceiling)

    def _room(self, value: Any, index: int, ceiling: float) -> Room | None:
        name = f"rooms[{index}]"
        if not isinstance(value, dict):
            self._fault(name, "type", f"a room is an object, not {_kind(value)}")
            return None
        room_id = value.get("id")
        if isinstance(room_id, str) and ROOM_ID.fullmatch(room_id):
            name = room_id
        else:
            self._fault(
                name,
                "room_id",
                f"'id' is {_show(room_id)}; it must be 1 to 64 of a-z, A-Z, 0-9, _ and -, a letter or digit first",
            )
        self._note_unread(value, "room", f"room {name}")
        title = _given(value, "name", room_id)
        if not isinstance(title, str) or len(title) > LONGEST_ROOM_NAME or not title.isprintable():
            wanted = f"one line of at most {LONGEST_ROOM_NAME} printable characters"
            self._fault(name, "type", f"'name' is {_show(title)}; it must be {wanted}")
            title = name
        height = self._ceiling(name, value, ceiling)
        polygon, holes = self._outline(name, value)
        openings = _given(value, "openings", [])
        if not isinstance(openings, list) or len(openings) > MAX_OPENINGS:
            found = f"{len(openings)} long" if isinstance(openings, list) else _kind(openings)
            self._fault(name, "type", f"'openings' is {found}; it must be a list of at most {MAX_OPENINGS}")
            openings = []
            self.openings_missing = True
        read = [self._opening(name, opening, k) for k, opening in enumerate(openings)]
        good = tuple(opening for opening in read if opening is not None)
        self.openings_missing |= len(good) < len(read)
        if polygon is None:
            return None
        return Room(
            id=name,
            name=title,
            polygon=polygon,
            ceiling_height=CEILING[1] if height is None else height,  # one that cannot be read makes no opening reach above it
            openings=good,
            holes=holes,
            columns=tuple(counter_clockwise(ring) for ring in self._rings(name, value, "columns")),
            walls=self._walls(name, value),
        )

    def _ceiling(self, room: str, value: dict[str, Any], default: float) -> float | None:
        if isinstance(value.get("ceiling_height"), list | dict):
            what = "ceiling_height has several heights; ceilings are level: give one number of metres, or split the room"
            self._fault(room, "type", what)
            return None
        return self._number(room, value, "ceiling_height", default, *CEILING)

    def _outline(self, room: str, value: dict[str, Any]) -> tuple[np.ndarray | None, tuple[np.ndarray, ...]]:
        """The outline and the holes of a room: `holes`, further rings in `floor_polygon`, or slits of its one ring."""
        given = value.get("floor_polygon")
        inner: list[Any] = []
        if isinstance(given, list) and given and all(isinstance(ring, list) and len(ring) > 2 for ring in given):
            given, *inner = given
        outline = self._points(room, given, "floor_polygon", 3, MAX_POINTS)
        rings = [*self._rings(room, {"floor_polygon": inner}, "floor_polygon"), *self._rings(room, value, "holes")]
        if outline is None:
            return None, ()
        outline, slits = keyhole(counter_clockwise(outline))
        return outline, (*slits, *(counter_clockwise(ring)[::-1].copy() for ring in rings))

    def _rings(self, room: str | None, holder: dict[str, Any], key: str) -> list[np.ndarray]:
        """The polygons [k, 2] of a list of polygons; those that cannot be read are faults."""
        value = _given(holder, key, [])
        if not isinstance(value, list) or len(value) > MAX_RINGS:
            self._fault(room, "type", f"{key} is {_kind(value)}; it must be a list of at most {MAX_RINGS} polygons")
            return []
        read = [self._points(room, ring, f"{key}[{k}]", 3, MAX_POINTS) for k, ring in enumerate(value)]
        return [ring for ring in read if ring is not None]

    def _walls(self, room: str, value: dict[str, Any]) -> tuple[ThickWall, ...]:
        """The walls of a room that say how thick they are: `wall_thickness`, one number or one for each edge, and `walls`."""
        walls: list[ThickWall] = []
        outline, given = value.get("floor_polygon"), _given(value, "wall_thickness", [])
        if given != [] and isinstance(outline, list) and outline:
            ring = outline[0] if isinstance(outline[0], list) and outline[0] and isinstance(outline[0][0], list) else outline
            edges = list(zip(ring, [*ring[1:], ring[0]]))
            if not isinstance(given, list):
                given = [given] * len(edges)
            if len(given) not in (len(edges), len(edges) - 1):  # the last is missing where the first point is repeated
                message = (
                    f"wall_thickness is a list of {len(given)}; it must be one number, or one for each of {len(edges)} edges"
                )
                self._fault(room, "type", message)
                given = []
            rows = [
                {"segment": list(edge), "thickness": one}
                for edge, one in zip(edges, given)
                if one is not None and edge[0] != edge[1]
            ]
            walls += [wall for k, row in enumerate(rows) if (wall := self._wall(room, row, f"wall_thickness[{k}]")) is not None]
        listed = _given(value, "walls", [])
        if not isinstance(listed, list) or len(listed) > MAX_RINGS or not all(isinstance(row, dict) for row in listed):
            self._fault(room, "type", f"'walls' must be a list of at most {MAX_RINGS} objects with segment and thickness")
            listed = []
        walls += [wall for k, row in enumerate(listed) if (wall := self._wall(room, row, f"walls[{k}]")) is not None]
        return tuple(walls)

    def _wall(self, room: str, row: dict[str, Any], name: str) -> ThickWall | None:
        self._note_unread(row, "wall", f"room {room}, {name},")
        segment = self._points(room, row.get("segment"), f"{name}.segment", 2, 2)
        thickness = self._number(room, row, f"{name}.thickness", None, *WALL)
        return None if segment is None or thickness is None else ThickWall(segment, thickness)

    def _opening(self, room: str, value: Any, k: int) -> Opening | None:
        name = f"openings[{k}]"
        if not isinstance(value, dict):
            self._fault(room, "type", f"{name} is {_kind(value)}; an opening is an object")
            return None
        self._note_unread(value, "opening", f"room {room}, {name},")
        kind = opening_kind(value.get("type"))
        if kind is None:
            self._fault(room, "opening_type", f"{name}.type is {_show(value.get('type'))}; choices: {', '.join(OPENINGS)}")
            return None
        segment = self._points(room, value.get("wall_segment"), f"{name}.wall_segment", 2, 2)
        position = self._number(room, value, f"{name}.position", None, 0.0, MAX_COORDINATE)
        width = self._number(room, value, f"{name}.width", None, LEAST_OPENING[0], WIDEST)
        height = self._number(room, value, f"{name}.height", None, LEAST_OPENING[1], CEILING[1])
        sill = self._number(room, value, f"{name}.sill_height", SILLS.get(kind, 0.0), 0.0, CEILING[1])
        if segment is None or position is None or width is None or height is None or sill is None:
            return None
        if not np.linalg.norm(segment[1] - segment[0]) > 1e-3:
            self._fault(room, "opening_off_wall", f"{name}.wall_segment has no length")
            return None
        return Opening(kind, segment, position, width, height, sill)

    def _number(self, room: str | None, holder: dict, path: str, default: float | None, low: float, high: float) -> float | None:
        value = _given(holder, path.rsplit(".", 1)[-1], None)
        if value is None and default is not None:
            return default
        if value is None or not _is_number(value):
            self._fault(room, "type", f"{path} is {'missing' if value is None else _show(value)}; it must be a number of metres")
            return None
        if not low <= value * self.scale <= high:  # also false for infinities
            wanted = f"{low:g}" if low == high else f"between {low:g} and {high:g}"
            found = _show(value) if self.scale == 1 else f"{_show(value)} ({value * self.scale:.4g} m)"
            self._fault(room, "number", f"{path} is {found}; it must be {wanted} (metres)")
            return None
        return float(value) * self.scale

    def _points(self, room: str | None, value: Any, path: str, least: int, most: int) -> np.ndarray | None:
        """[k, 2] of a list of [x, y]; one violation for the first fault."""
        if not isinstance(value, list) or not least <= len(value) <= most:
            found = "missing" if value is None else f"{len(value)} points long" if isinstance(value, list) else _kind(value)
            wanted = f"{least}" if least == most else f"{least} to {most}"
            self._fault(room, "type", f"{path} is {found}; it must be a list of {wanted} points [x, y]")
            return None
        for k, point in enumerate(value):
            if not isinstance(point, list) or len(point) != 2 or not all(_is_number(x) for x in point):
                self._fault(room, "type", f"{path}[{k}] is {_show(point)}; a point is two numbers [x, y]")
                return None
            if not all(abs(x * self.scale) <= MAX_COORDINATE for x in point):
                self._fault(
                    room, "number", f"{path}[{k}] is {_show(point)}; coordinates are finite and within {MAX_COORDINATE:g} m"
                )
                return None
        return np.array(value, dtype=np.float64) * self.scale


def _given(holder: dict[str, Any], key: str, default: Any) -> Any:
    """The value of a key; the default where it is left out or null, as language models write what they leave out."""
    value = holder.get(key)
    return default if value is None else value


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result = dict(pairs)
    if len(result) < len(pairs):
        seen: set[str] = set()
        twice = next(key for key, _ in pairs if key in seen or seen.add(key))
        raise ValueError(f"key {_show(twice)} appears twice in one object")
    return result


def _integer(digits: str) -> int:
    if len(digits) > 18:
        raise ValueError(f"a number of {len(digits)} digits is not one a plan can hold")
    return int(digits)


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is not a number a plan can hold")


def _syntax(message: str, source: str) -> PlanError:
    return PlanError((Violation(None, "json", message),), source)


def _kind(value: Any) -> str:
    names = {dict: "an object", list: "a list", str: "text", bool: "true or false", type(None): "null"}
    return names.get(type(value), "a number")


def _show(value: Any) -> str:
    """A value as a message quotes it, cut short where it is long."""
    if isinstance(value, dict) or (isinstance(value, list) and any(isinstance(part, (dict, list)) for part in value)):
        return _kind(value)
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."
