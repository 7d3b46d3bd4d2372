"""Run folders for tests of exporters, made by hand: a plan, objects of known masses, a painted scaffold, some gaussians."""

import dataclasses
import json
from pathlib import Path

import numpy as np

from tests.geometry.plans import two_rooms
from tests.geometry.things import box
from wm import codecs
from wm.finished import FinishedRun, open_finished
from wm.geometry import atlas_nodes, build_atlas, build_structure, plan_to_json, save_glb
from wm.geometry.texture.atlas import texel_positions
from wm.types import GAUSSIAN_FIELDS, Gaussians, SceneObject

TABLE = "hall-table-1"


def named(thing: SceneObject, name: str, *, support: str = "floor", slots: tuple[str, ...] = ("wood",)) -> SceneObject:
    return dataclasses.replace(thing, id=name, support=support, slots=slots)


def joined(*things: SceneObject) -> SceneObject:
    """One object of several: parts that share no vertex, each with a material of its own."""
    counts = np.cumsum([0, *(len(thing.vertices) for thing in things)])
    first = things[0]
    return dataclasses.replace(
        first,
        vertices=np.concatenate([thing.vertices for thing in things]),
        faces=np.concatenate([thing.faces + count for thing, count in zip(things, counts)]).astype(np.int32),
        face_slot=np.repeat(np.arange(len(things), dtype=np.int32), [len(thing.faces) for thing in things]),
        slots=tuple(f"part {k}" for k in range(len(things))),
        slot_colors=np.concatenate([thing.slot_colors for thing in things]),
        emission=np.concatenate([thing.emission for thing in things]),
    )


def table(name: str = TABLE) -> SceneObject:
    """A board of 1 x 0.6 x 0.04 m on four legs, from (1, 1) to (2, 1.6); its top is 0.74 m high."""
    feet = [(1.0, 1.0), (1.95, 1.0), (1.0, 1.55), (1.95, 1.55)]
    legs = [box((x, y, 0), (x + 0.05, y + 0.05, 0.7)) for x, y in feet]
    thing = joined(box((1, 1, 0.7), (2, 1.6, 0.74), color=(0.4, 0.25, 0.1), label="table"), *legs)
    foot = np.eye(4)
    foot[:3, 3] = [1.5, 1.3, 0.0]
    return dataclasses.replace(thing, id=name, slots=("wood",) * 5, T_world_object=foot, size=np.array([1.0, 0.6, 0.74]))


def objects() -> list[SceneObject]:
    """A table with a vase on it, a picture, a rug under the table, a lamp that glows, a chest in the other room."""
    lamp = named(box((0.1, 3.5, 2.5), (0.3, 3.7, 2.8), label="lamp"), "hall-lamp-1", support="ceiling", slots=("bulb",))
    return [
        table(),
        named(box((1.4, 1.2, 0.74), (1.5, 1.3, 0.94), label="vase"), "hall-vase-1", support="object", slots=("ceramic",)),
        named(box((0.2, 3.9, 1.2), (0.8, 3.95, 1.7), label="picture"), "hall-picture-1", support="wall"),
        named(box((0.8, 0.8, 0.002), (2.2, 1.8, 0.01), label="rug"), "hall-rug-1", support="flat", slots=("rug",)),
        dataclasses.replace(lamp, emission=np.array([1.5], np.float32)),
        named(box((7, 2, 0), (7.8, 2.5, 0.5), room=1, label="chest"), "study-chest-1"),
    ]


def write_run(folder: Path, things: list[SceneObject] | None = None) -> FinishedRun:
    """A run of two rooms that has been furnished, and not painted."""
    plan, things = two_rooms(), objects() if things is None else things
    (folder / "stages").mkdir(parents=True)
    (folder / "plan.json").write_text(plan_to_json(plan))
    (folder / "stages" / "objects.npz").write_bytes(codecs.encode_objects(things))
    summary = codecs.object_summary(things, [room.id for room in plan.rooms])
    (folder / "objects.json").write_text(json.dumps(summary))
    (folder / "manifest.json").write_text(json.dumps({"header": {"config": {}}, "entries": {}}))
    return open_finished(folder)


def paint(run: FinishedRun) -> None:
    """Adds a scaffold whose walls are red where x is small and green where y is small."""
    structure = build_structure(run.plan)
    atlas = build_atlas(structure, 0.1)
    painted = dataclasses.replace(
        atlas, color=shade(texel_positions(atlas)).astype(np.float32), weight=np.ones_like(atlas.weight)
    )
    save_glb(run.folder / "scaffold.glb", atlas_nodes(painted, structure))


def shade(points: np.ndarray) -> np.ndarray:
    """[n, 3] the colour of painted surfaces at places [n, 3] in the house."""
    return np.clip(points / np.array([10.0, 5.0, 4.0]), 0, 1)


def fit(run: FinishedRun) -> None:
    """Adds 30 gaussians to the first room and 20 to the second."""
    rng = np.random.default_rng(3)
    arrays = {}
    for room, count in enumerate((30, 20)):
        gaussians = Gaussians(
            means=rng.uniform(0, 4, (count, 3)).astype(np.float32),
            quats=rng.normal(size=(count, 4)).astype(np.float32),
            log_scales=rng.uniform(-5, -2, (count, 3)).astype(np.float32),
            opacity_logits=rng.uniform(-2, 4, count).astype(np.float32),
            sh=rng.normal(size=(count, 4, 3)).astype(np.float32),
        )
        arrays |= {f"{room:05d}.{leaf}": getattr(gaussians, leaf) for leaf in GAUSSIAN_FIELDS}
    (run.folder / "stages" / "splats.npz").write_bytes(codecs.encode_arrays(arrays))
