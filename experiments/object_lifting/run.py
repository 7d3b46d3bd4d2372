"""How far reconstructed furniture is from the truth, over the scenes of conf/scene; and whether placed rooms obey the laws.

python experiments/object_lifting/run.py --lifted 200 --rooms 200
"""

import argparse
import csv
import dataclasses
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matching import SEEN, Match, matches, summary
from shaking import shaken
from sketch import sketch_of

from wm.geometry import build_structure, navigability
from wm.geometry.placement.laws import broken_laws
from wm.geometry.placement.placing import place_objects
from wm.geometry.plan.site import room_site
from wm.offline.arrangement.furnishing import furnish_scene
from wm.offline.objects.generator import ProceduralObjects
from wm.run import load_config, options
from wm.synth.backends import SceneContext
from wm.synth.lifting.lifted import LiftedObjects, LiftedRoom, lift_room, room_cameras
from wm.synth.lifting.lifted import Settings as LiftingSettings
from wm.synth.proposing import propose_plan
from wm.synth.registry import make_backend, model_settings
from wm.types import SceneObject

HERE = Path(__file__).parent
LAWS = ("interpenetrates", "floats", "leaves", "tilts", "blocks")


@dataclasses.dataclass
class Tally:
    """Rooms of one sort, and what was wrong with them."""

    furniture: str
    objects: list[int] = dataclasses.field(default_factory=list)  # in each room
    walk: list[float] = dataclasses.field(default_factory=list)  # navigability of each plan whose rooms are all here
    broken: Counter = dataclasses.field(default_factory=Counter)
    broken_before: int = 0  # placing
    dropped: int = 0
    unmatched: int = 0

    def judge(self, context: SceneContext, room: int, things: list[SceneObject]) -> None:
        """Counts a placed room, and says which laws it breaks."""
        self.objects.append(len(things))
        for law in broken_laws(things, room_site(context.plan, room)):
            self.broken[law.law] += 1
            print("BROKEN", context.theme, context.seed, context.plan.rooms[room].name, law.law, law.what, flush=True)

    def row(self) -> dict:
        return {
            "furniture": self.furniture, "rooms": len(self.objects), "objects_a_room": round(float(np.mean(self.objects)), 1),
            "fewest": min(self.objects), "broken_before": self.broken_before, **{law: self.broken[law] for law in LAWS},
            "left_out": self.dropped, "unmatched": self.unmatched, "plans": len(self.walk),
            "navigability_mean": round(float(np.mean(self.walk)), 4) if self.walk else None,
            "navigability_least": round(min(self.walk), 4) if self.walk else None,
        }  # fmt: skip


def context_of(scene: str, seed: int) -> SceneContext:
    """A scene of conf/scene, unfurnished."""
    config = load_config([f"+scene={scene}"])
    backend = make_backend("language", config.language)
    proposal = propose_plan(backend, config.scene.theme, list(config.scene.rooms), seed=seed, max_iterations=8)
    structure = build_structure(proposal.plan)
    return SceneContext(theme=config.scene.theme, seed=seed, plan=proposal.plan, structure=structure, objects=())


def contexts(scenes: list[str], rooms: int, seed: int) -> Iterator[tuple[str, SceneContext]]:
    """Whole scenes with at least so many rooms in all: every scene at the first seed, then at the next, and so on."""
    given = 0
    while given < rooms:
        for scene in scenes:
            if given < rooms:
                context = context_of(scene, seed)
                given += len(context.plan.rooms)
                yield scene, context
        seed += 1


def lifted(backend: LiftedObjects, context: SceneContext, every: int) -> Iterator[tuple[int, LiftedRoom]]:
    """Every nth room of a scene, lifted from sketches of it."""
    models = backend.models(context, image=sketch_of(context))
    for room in range(0, len(context.plan.rooms), every):
        cameras = room_cameras(context, room, models.image, backend.config)
        yield room, lift_room(context, room, cameras, models, backend.config)


def lifted_rooms(scenes: list[str], count: int, every: int, seed: int, config: LiftingSettings) -> tuple[list[Match], Tally]:
    """(every true thing, the tally) of seeded rooms that went through the whole chain: every nth of each scene."""
    rows: list[Match] = []
    tally = Tally("lifted")
    for scene, context in contexts(scenes, count, seed):
        models = model_settings(load_config([f"+scene={scene}"]))
        backend, truth, everything = LiftedObjects(config, models), furnish_scene(context), []
        for room, result in lifted(backend, context, every):
            found = matches(scene, context, room, truth, result)
            rows += found
            tally.unmatched += len(result.things) - int(sum(np.isfinite(row.center_m) for row in found))
            tally.dropped += len(result.placement.dropped)
            tally.broken_before += len(broken_laws(list(result.things), room_site(context.plan, room)))
            tally.judge(context, room, result.objects)
            everything += result.objects
        if every == 1:
            tally.walk.append(navigability(context.plan, everything).share)
        print(scene, context.seed, len(tally.objects), "rooms so far; navigability", tally.walk[-1:], flush=True)
    return rows, tally


def shaken_rooms(scenes: list[str], count: int, seed: int, config: LiftingSettings) -> Tally:
    """Seeded rooms whose furniture was shaken and placed."""
    tally, generator = Tally("shaken"), ProceduralObjects(config)
    for _, context in contexts(scenes, count, seed):
        everything = []
        for room in range(len(context.plan.rooms)):
            site = room_site(context.plan, room)
            things = shaken(generator.furnish(context, room), np.random.default_rng([context.seed, room, 7]))
            placement = place_objects(things, site)
            tally.broken_before += len(broken_laws(things, site))
            tally.dropped += len(placement.dropped)
            tally.judge(context, room, list(placement.objects))
            everything += placement.objects
        tally.walk.append(navigability(context.plan, everything).share)
    return tally


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lifted", type=int, default=200, help="rooms through the whole chain, at least; 30: the five at seed 0")
    parser.add_argument("--every", type=int, default=1, help="lift only every nth room of a scene")
    parser.add_argument("--rooms", type=int, default=200, help="rooms whose furniture is shaken and placed, at least")
    parser.add_argument("--seed", type=int, default=0, help="the first")
    parser.add_argument("--width", type=int, default=LiftingSettings().image_width, help="of the images to lift from")
    parser.add_argument("--scenes", nargs="*", default=options("scene"))
    parser.add_argument("--out", type=Path, default=HERE)
    arguments = parser.parse_args()
    scenes, width = list(arguments.scenes), arguments.width
    config = LiftingSettings(image_width=width, image_height=width * 3 // 4)
    laws = []
    if arguments.lifted:
        rows, tally = lifted_rooms(scenes, arguments.lifted, arguments.every, arguments.seed, config)
        laws.append(tally.row())
        _write(arguments.out / "result.csv", _table(rows))
        _write(arguments.out / "kinds.csv", _by_kind(rows))
    if arguments.rooms:
        laws.append(shaken_rooms(scenes, arguments.rooms, arguments.seed, config).row())
    _write(arguments.out / "laws.csv", laws)


def _table(rows: list[Match]) -> list[dict]:
    groups = {scene: [row for row in rows if row.scene == scene] for scene in dict.fromkeys(row.scene for row in rows)}
    groups |= {f"on {kind}": [row for row in rows if row.support == kind] for kind in sorted({row.support for row in rows})}
    return [{"group": name} | summary(group) for name, group in (groups | {"all": rows}).items()]


def _by_kind(rows: list[Match]) -> list[dict]:
    """Kinds of which at least three were seen, the worst first."""
    kinds = {kind: [row for row in rows if row.label == kind and row.pixels >= SEEN] for kind in {row.label for row in rows}}
    table = [{"kind": kind} | summary(group) for kind, group in sorted(kinds.items()) if len(group) >= 3]
    return sorted(table, key=lambda row: row["iou_mean"])


def _write(path: Path, table: list[dict]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, table[0].keys())
        writer.writeheader()
        writer.writerows(table)
    for row in table:
        print(row)


if __name__ == "__main__":
    main()
