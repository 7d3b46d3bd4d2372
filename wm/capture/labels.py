"""Instances and classes of what a camera sees: pieces of furniture, and walls, floors, ceilings by room.

Numbers start at 1; 0 is nothing (no surface). They belong to the run, not to the trajectory.
"""

import dataclasses
from typing import Any

import numpy as np

from wm.finished import FinishedRun
from wm.types import OUTSIDE, SurfaceKind

_KINDS = {
    SurfaceKind.WALL: "wall",
    SurfaceKind.FLOOR: "floor",
    SurfaceKind.CEILING: "ceiling",
    SurfaceKind.REVEAL: "door or window frame",
    SurfaceKind.PANE: "window",
    SurfaceKind.EXTERIOR: "exterior",
}


@dataclasses.dataclass(frozen=True)
class LabelledInstance:
    """A row of the table."""

    id: int
    class_id: int
    label: str
    object: str | None  # SceneObject.id
    room: str | None


@dataclasses.dataclass(frozen=True, eq=False)
class LabelTable:
    """The instances and classes of a run."""

    instances: tuple[LabelledInstance, ...]
    classes: dict[str, int]
    face_instance: np.ndarray  # [f] uint16 of each face of the scaffold
    instance_class: np.ndarray  # [instances + 1] uint16, 0 for nothing

    def json(self) -> dict[str, Any]:
        """What labels.json holds."""
        rows = [
            {"id": row.id, "class": row.class_id, "label": row.label, "object": row.object, "room": row.room}
            for row in self.instances
        ]
        classes = [{"id": number, "label": label} for label, number in self.classes.items()]
        return {"version": 1, "nothing": 0, "instances": rows, "classes": classes}


def label_table(run: FinishedRun) -> LabelTable:
    """The table of a run: structure first, then furniture in its order."""
    mesh = run.scaffold
    structure = sorted({(int(r), int(k)) for r, k in zip(mesh.face_room, mesh.face_kind) if k != SurfaceKind.OBJECT})
    named = [(_KINDS[SurfaceKind(kind)], None, None if room == OUTSIDE else run.rooms[room]) for room, kind in structure]
    named += [(thing.label, thing.id, run.rooms[thing.room]) for thing in run.objects]
    classes = {label: number for number, label in enumerate(sorted({label for label, _, _ in named}), 1)}
    instances = tuple(LabelledInstance(number, classes[row[0]], *row) for number, row in enumerate(named, 1))
    of_structure = {key: number for number, key in enumerate(structure, 1)}
    face_instance = np.array(
        [
            1 + len(structure) + thing if thing != OUTSIDE else of_structure[(room, kind)]
            for room, kind, thing in zip(mesh.face_room.tolist(), mesh.face_kind.tolist(), mesh.face_object.tolist())
        ],
        np.uint16,
    )
    instance_class = np.array([0, *(row.class_id for row in instances)], np.uint16)
    return LabelTable(instances, classes, face_instance, instance_class)
