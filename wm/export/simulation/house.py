"""A finished run as a simulation takes it: rigid bodies, the building's prisms, and what both look like."""

import dataclasses

import numpy as np

from wm.export.records import ExportError
from wm.export.simulation.bodies import Body, rigid_body
from wm.export.simulation.identifiers import identifiers
from wm.export.simulation.looks import HousePart, house_parts
from wm.finished import FinishedRun

RESERVED = ("house", "world")
"""Names that the formats need for themselves."""


@dataclasses.dataclass(frozen=True, eq=False)
class House:
    """All of a run that the targets of this package write."""

    bodies: tuple[Body, ...]
    names: tuple[str, ...]  # of the bodies: identifiers
    rooms: tuple[str, ...]  # identifiers of the plan's rooms
    parts: tuple[HousePart, ...]

    def part_name(self, part: HousePart) -> str:
        """An identifier of a part: "hall_floor", or "exterior"."""
        kind = part.kind.name.lower()
        return kind if part.room < 0 else f"{self.rooms[part.room]}_{kind}"


def simulated(run: FinishedRun) -> House:
    """The bodies and surfaces of a run.

    Raises:
      ExportError: an object has no surface, or an id that the formats need for themselves.
      UnfinishedRunError: the run has no plan yet.
    """
    empty = [thing.id for thing in run.objects if not _has_surface(thing.vertices, thing.faces)]
    if empty:
        raise ExportError(f"{run.folder}: {', '.join(empty)}: an object without a surface can have no mass")
    reserved = [thing.id for thing in run.objects if thing.id in RESERVED or thing.id.startswith("house/")]
    if reserved:
        raise ExportError(f"{run.folder}: the id {reserved[0]!r} is taken by the building; give the object another one")
    rooms, names = house_names(run)
    return House(
        bodies=tuple(rigid_body(thing) for thing in run.objects), names=names, rooms=rooms, parts=tuple(house_parts(run))
    )


def house_names(run: FinishedRun) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The identifiers of the rooms, and those of the objects."""
    taken = identifiers(["House", "Looks", "exterior", *run.rooms, *(thing.id for thing in run.objects)])
    return tuple(taken[3 : 3 + len(run.rooms)]), tuple(taken[3 + len(run.rooms) :])


def _has_surface(vertices: np.ndarray, faces: np.ndarray) -> bool:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return bool(len(faces) and np.abs(np.cross(b - a, c - a)).max() > 0)
