"""What a simulated house looks like: triangles with the materials of objects, and rooms with their painted textures."""

import dataclasses
from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import Int
from scipy.spatial import KDTree

from wm.export.simulation.bodies import Body
from wm.finished import FinishedRun
from wm.geometry.exchange.parts import read_parts
from wm.geometry.mesh.axes import Y_UP
from wm.stages.painting import SCAFFOLD
from wm.types import OUTSIDE, Mesh, SurfaceKind, Texture

_NEAR = 1e-3  # metres between the corners of a triangle in the scaffold's file and of the same one in the structure
_COLORS = {
    SurfaceKind.WALL: (0.85, 0.83, 0.79),
    SurfaceKind.FLOOR: (0.55, 0.43, 0.32),
    SurfaceKind.CEILING: (0.93, 0.93, 0.92),
    SurfaceKind.REVEAL: (0.80, 0.78, 0.75),
    SurfaceKind.PANE: (0.70, 0.80, 0.88),
    SurfaceKind.EXTERIOR: (0.60, 0.60, 0.60),
}
"""sRGB of surfaces of a house that is not painted (yet)."""


@dataclasses.dataclass(frozen=True, eq=False)
class Appearance:
    """A coloured surface: the fields of `SceneObject` that say how it looks, in the frame of its body."""

    vertices: np.ndarray  # [v, 3] metres
    faces: np.ndarray  # [f, 3]
    face_slot: np.ndarray  # [f]
    slots: tuple[str, ...]
    slot_colors: np.ndarray  # [s, 3] sRGB
    emission: np.ndarray  # [s]
    texture: Texture | None = None
    unlit: bool = False  # its colours carry their light


@dataclasses.dataclass(frozen=True, eq=False)
class HousePart:
    """The surfaces of one kind of one room (or the outer skin): how they look, and which faces of the structure they are."""

    room: int  # index into FloorPlan.rooms, OUTSIDE of the skin
    kind: SurfaceKind
    faces: np.ndarray  # [f] indices of faces of the structure
    looks: tuple[Appearance, ...]  # painted faces by their image, and those without one


def body_appearance(body: Body) -> Appearance:
    """How an object looks, in its body's frame."""
    thing = body.thing
    return Appearance(body.vertices, thing.faces, thing.face_slot, thing.slots, thing.slot_colors, thing.emission, thing.texture)


def house_parts(run: FinishedRun) -> list[HousePart]:
    """The structure by room and kind, painted where the run has come so far."""
    structure = run.structure
    painted = _painted(run)
    order = [*range(len(run.rooms)), OUTSIDE]
    found = [(room, kind) for room in order for kind in SurfaceKind]
    chosen = [(room, kind, np.flatnonzero((structure.face_room == room) & (structure.face_kind == kind))) for room, kind in found]
    return [
        HousePart(room, kind, faces, tuple(_looks(structure, kind, faces, painted))) for room, kind, faces in chosen if len(faces)
    ]


def _looks(structure: Mesh, kind: SurfaceKind, faces: Int[np.ndarray, "f"], painted: "_Painted | None") -> Iterator[Appearance]:
    """The faces of one image after another, then those that no image shows."""
    source = np.full(len(faces), -1) if painted is None else painted.source[faces]
    for image in np.unique(source).tolist():
        mine = faces[source == image]
        corners = structure.vertices[structure.faces[mine]].reshape(-1, 3)
        texture = None if painted is None or image < 0 else painted.texture(image, mine)
        yield Appearance(
            vertices=corners,
            faces=np.arange(len(corners), dtype=np.int32).reshape(-1, 3),
            face_slot=np.zeros(len(mine), np.int32),
            slots=(kind.name.lower(),),
            slot_colors=np.array([_COLORS[kind]], np.float32),
            emission=np.zeros(1, np.float32),
            texture=texture,
            unlit=texture is not None,
        )


@dataclasses.dataclass(frozen=True, eq=False)
class _Painted:
    """The painted texture of each face of the structure."""

    images: Sequence[np.ndarray]
    source: np.ndarray  # [f] index into images, -1 of a face without one
    corner_uv: np.ndarray  # [f, 3, 2] float32

    def texture(self, image: int, faces: Int[np.ndarray, "f"]) -> Texture:
        """An image on some faces of the structure."""
        return Texture(self.images[image], self.corner_uv[faces], np.ones(1, bool))


def _painted(run: FinishedRun) -> _Painted | None:
    """The rooms' textures in the scaffold's file, brought to the faces of the structure by place; None before `paint`."""
    if not (run.folder / SCAFFOLD).is_file():
        return None
    corners = run.structure.vertices[run.structure.faces]
    source = np.full(len(corners), -1)
    corner_uv = np.zeros((len(corners), 3, 2), np.float32)
    near = KDTree(corners.mean(axis=1))
    images: list[np.ndarray] = []
    for part in read_parts(run.scaffold_file):
        if part.paint.image is None or part.corner_uv is None:
            continue
        theirs = part.corners @ Y_UP
        face = np.asarray(near.query(theirs.mean(axis=1))[1])
        gap = np.linalg.norm(corners[face][:, :, None] - theirs[:, None, :], axis=-1)
        same = gap.min(axis=2).max(axis=1) < _NEAR
        order = gap.argmin(axis=2)[same]
        corner_uv[face[same]] = np.take_along_axis(part.corner_uv[same], order[:, :, None], axis=1)
        source[face[same]] = len(images)
        images.append(part.paint.image)
    return _Painted(images, source, corner_uv)
