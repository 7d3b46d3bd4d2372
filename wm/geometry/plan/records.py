"""What a floor plan is, and what can be wrong with one. Metres, z up; polygons counter-clockwise seen from above."""

import dataclasses

import numpy as np

from wm.errors import InputError

WALL_THICKNESS = 0.15
"""Metres, of the walls of a plan that does not say."""
CEILING_HEIGHT = 2.8
"""Metres from floor to ceiling, in a plan that does not say."""


@dataclasses.dataclass(frozen=True, eq=False)
class Opening:
    """A hole in a wall. Its near edge lies `position` metres along `segment` from the segment's start."""

    kind: str  # door | window | passage | hatch (an open hole between two rooms that nobody walks through)
    segment: np.ndarray  # [2, 2] float64: start and end of a stretch of wall, in either direction
    position: float
    width: float
    height: float
    sill_height: float  # 0 for doors and passages


@dataclasses.dataclass(frozen=True, eq=False)
class ThickWall:
    """A stretch of a room's outline whose wall is not as thick as the plan's others."""

    segment: np.ndarray  # [2, 2] float64: start and end on the outline, in either direction
    thickness: float  # metres, of the whole wall where it is shared


@dataclasses.dataclass(frozen=True, eq=False)
class Room:
    """One room; the polygon's edge is the outer face of an exterior wall and the middle of a shared one.

    The rings of `holes` are walls too, with another room or a courtyard behind; `columns` are solid from floor to ceiling.
    """

    id: str
    name: str
    polygon: np.ndarray  # [k, 2] float64, counter-clockwise, simple, first point not repeated
    ceiling_height: float
    openings: tuple[Opening, ...]
    holes: tuple[np.ndarray, ...] = ()  # [k, 2] each, clockwise, simple, within the polygon
    columns: tuple[np.ndarray, ...] = ()  # [k, 2] each, counter-clockwise, simple
    walls: tuple[ThickWall, ...] = ()


@dataclasses.dataclass(frozen=True)
class PlanObject:
    """One piece of furniture that the plan itself lists; it stands where the plan says."""

    label: str
    room: int  # index into FloorPlan.rooms
    position: tuple[float, ...]  # x, y, z of the middle of its foot, metres
    yaw: float  # degrees, counter-clockwise from above; at 0 the front looks along -y
    size: tuple[float, ...] | None  # width, depth, height, metres; None: that of the mesh
    mesh: str | None  # a mesh file; None: a box
    support: str | None = None  # as SceneObject.support; None: told by label and size
    color: tuple[float, ...] | None = None  # sRGB in [0, 1], of a box


@dataclasses.dataclass(frozen=True, eq=False)
class FloorPlan:
    """Rooms that touch along their walls. Two plans are equal when their JSON is (`plan_to_json`)."""

    rooms: tuple[Room, ...]
    wall_thickness: float = WALL_THICKNESS  # of an exterior wall, and of a shared one (half of it in either room)
    default_ceiling_height: float = CEILING_HEIGHT
    objects: tuple[PlanObject, ...] = ()  # furniture of the user's own
    solids: tuple[np.ndarray, ...] = ()  # [k, 2] counter-clockwise each: parts of the building that hold no room, such as shafts


@dataclasses.dataclass(frozen=True)
class Violation:
    """One rule that a plan breaks."""

    room: str | None  # id of the room, or "rooms[3]" where it has none; None for the plan as a whole
    rule: str  # one of RULES of wm.geometry.plan.rules
    message: str  # what is wrong, where, and what would be right

    def __str__(self) -> str:
        where = "plan" if self.room is None else f"room {self.room}"
        return f"{where}: {self.rule}: {self.message}"


class PlanWarning(UserWarning):
    """What a plan says and is not read, or what was changed in it."""


class PlanError(InputError):
    """A floor plan that cannot be used, with everything that is wrong with it."""

    def __init__(self, violations: tuple[Violation, ...], source: str = "plan"):
        self.violations = tuple(violations)
        self.source = source
        count = "1 violation" if len(violations) == 1 else f"{len(violations)} violations"
        super().__init__(f"{source}: {count}\n" + "\n".join(f"  {violation}" for violation in violations))
