"""A piece of furniture before it is placed: closed parts, each with a slot, assembled into one mesh in the frame of the piece.

Object frame: x to the right of someone who looks at the front, y to the back, z up; the **front faces -y**; the origin is the
centre of the footprint at the piece's lowest point (also for wall and ceiling pieces, whose back is at +y and top at +z).
"""

import dataclasses
from collections.abc import Callable, Iterable

import numpy as np

from wm.offline.furniture.solids import Point3, Solid
from wm.offline.style.finish import Rgb, Style

Size = Point3
"""Width (x), depth (y), height (z), metres."""

EMISSION: dict[str, float] = {"bulb": 1.0, "flame": 1.0, "ember": 0.8, "lamp_shade": 0.45, "screen": 0.05}
"""How strongly each slot glows; slots that are not listed do not glow."""


@dataclasses.dataclass(frozen=True, eq=False)
class Part:
    """A closed solid and its material slot."""

    slot: str  # one of finish.SLOTS
    solid: Solid
    color: Rgb | None = None  # in place of the slot's own


@dataclasses.dataclass(frozen=True)
class Top:
    """A level surface that things may stand on, in the piece's frame."""

    z: float
    x0: float
    y0: float
    x1: float
    y1: float


@dataclasses.dataclass(frozen=True, eq=False)
class Model:
    """The result of a builder: parts in any position, and the surfaces that clutter may stand on."""

    parts: list[Part]
    tops: tuple[Top, ...] = ()


Builder = Callable[[Style, np.random.Generator, Size], Model]


@dataclasses.dataclass(frozen=True)
class FurnitureKind:
    """A kind of furniture: its builder, its support and its range of sizes."""

    build: Builder
    support: str  # floor | flat | wall | ceiling | object
    low: Size
    high: Size
    front: float = 0.0  # metres of free floor in front of it


@dataclasses.dataclass(frozen=True, eq=False)
class Piece:
    """A finished piece in its own frame."""

    label: str
    support: str
    vertices: np.ndarray  # [v, 3] float64; footprint centred on the origin, lowest point at z = 0
    faces: np.ndarray  # [f, 3] int32
    face_slot: np.ndarray  # [f] int32
    slots: tuple[str, ...]
    slot_colors: np.ndarray  # [s, 3] float32
    emission: np.ndarray  # [s] float32
    part_start: np.ndarray  # [p + 1] int32: faces of closed part k are part_start[k] : part_start[k + 1]
    size: np.ndarray  # [3] float64
    tops: tuple[Top, ...]


def of(slot: str, *solids: Solid, color: Rgb | None = None) -> list[Part]:
    """The solids as parts of one slot."""
    return [Part(slot, solid, color) for solid in solids]


def assemble(label: str, support: str, model: Model, style: Style) -> Piece:
    """The parts as one mesh, moved so that its footprint is centred on the origin and its lowest point is at z = 0."""
    keys = list(dict.fromkeys((part.slot, part.color) for part in model.parts))
    index = {key: k for k, key in enumerate(keys)}
    sizes = [len(part.solid.vertices) for part in model.parts]
    starts = np.concatenate([[0], np.cumsum(sizes)])
    vertices = np.concatenate([part.solid.vertices for part in model.parts])
    faces = np.concatenate([part.solid.faces + start for part, start in zip(model.parts, starts)])
    face_slot = np.concatenate([np.full(len(part.solid.faces), index[part.slot, part.color]) for part in model.parts])
    low, high = vertices.min(0), vertices.max(0)
    origin = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    x, y, z = origin.tolist()
    return Piece(
        label=label,
        support=support,
        vertices=vertices - origin,
        faces=faces.astype(np.int32),
        face_slot=face_slot.astype(np.int32),
        slots=tuple(slot for slot, _ in keys),
        slot_colors=np.array([color or style.slot(slot).colors[0] for slot, color in keys], np.float32),
        emission=np.array([EMISSION.get(slot, 0.0) for slot, _ in keys], np.float32),
        part_start=np.concatenate([[0], np.cumsum([len(part.solid.faces) for part in model.parts])]).astype(np.int32),
        size=high - low,
        tops=tuple(Top(t.z - z, t.x0 - x, t.y0 - y, t.x1 - x, t.y1 - y) for t in model.tops),
    )


def pick(rng: np.random.Generator, choices: Iterable[Rgb]) -> Rgb:
    """A randomly chosen colour."""
    table = list(choices)
    return table[int(rng.integers(len(table)))]
