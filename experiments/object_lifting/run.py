"""How far reconstructed furniture is from the truth, over the scenes of conf/scene; and whether placed rooms obey the laws.

python experiments/object_lifting/run.py --rooms 200
"""

import argparse
import csv
import dataclasses
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment

from wm.geometry import build_structure
from wm.geometry.placement_laws import violations
from wm.geometry.site import room_site
from wm.geometry.upright import levelled, turn_between
from wm.geometry.upright_box import UprightBox, box_iou, box_of
from wm.run import load_config, options
from wm.synth.backends import SceneContext, make_backend
from wm.synth.language.propose import propose_plan
from wm.synth.objects.lifted import LiftedObjects, LiftedRoom
from wm.types import SceneObject

HERE = Path(__file__).parent
FOUND = 0.25
"""Intersection over union from which a thing counts as found."""
SEEN = 300
"""Pixels from which a thing counts as seen in an image."""
_ROUND = ("lamp", "candelabra", "candle", "vase", "bowl", "plant", "flowers", "chandelier", "globe", "column", "stool", "statue",
          "round", "basket", "mushroom", "chess", "side table", "pendant")  # fmt: skip
"""Words of what looks alike from several sides: its yaw says nothing."""


@dataclasses.dataclass(frozen=True)
class Match:
    """One true thing and what became of it."""

    scene: str
    seed: int
    room: str
    label: str
    support: str
    pixels: int  # in the image that shows most of it
    iou: float  # of the reconstruction; 0 where there is none
    iou_placed: float
    center_m: float  # NaN where there is no reconstruction
    yaw_deg: float  # NaN too where the thing is round


def context_of(scene: str, seed: int) -> SceneContext:
    """A scene of conf/scene, unfurnished."""
    config = load_config([f"+scene={scene}"])
    backend = make_backend("language", config.language)
    proposal = propose_plan(backend, config.scene.theme, list(config.scene.rooms), seed=seed, max_iterations=8)
    structure = build_structure(proposal.plan)
    return SceneContext(theme=config.scene.theme, seed=seed, plan=proposal.plan, structure=structure, objects=())


def matches(name: str, context: SceneContext, room: int, backend: LiftedObjects, lifted: LiftedRoom) -> list[Match]:
    """Every true thing of a room against its reconstruction: one to one, of one label, for the largest sum of overlaps."""
    imagined = backend.imagined(context, 1.0).objects
    mine = [k for k, thing in enumerate(imagined) if thing.room == room]
    made = [levelled(thing) for thing in lifted.things]
    gain = np.array([[_gain(imagined[k], thing) for thing in made] for k in mine]).reshape(len(mine), len(made))
    partner = {i: j for i, j in zip(*linear_sum_assignment(-gain)) if gain[i, j] > 0}
    placed = dict(zip(lifted.placement.source, lifted.placement.objects))
    rows = []
    for i, k in enumerate(mine):
        thing, j = imagined[k], partner.get(i)
        pixels = max((int((drawing.result.drawn_object == k).sum()) for drawing in lifted.drawings), default=0)
        row = Match(name, context.seed, context.plan.rooms[room].name, thing.label, thing.support, pixels, 0, 0, np.nan, np.nan)
        if j is not None:
            row = dataclasses.replace(row, **_errors(box_of(thing), box_of(made[j]), thing.label))
            row = dataclasses.replace(row, iou_placed=box_iou(box_of(thing), box_of(placed[j])) if j in placed else 0.0)
        rows.append(row)
    return rows


def _gain(truth: SceneObject, made: SceneObject) -> float:
    if truth.label != made.label:
        return 0.0
    a, b = box_of(truth), box_of(made)
    distance = float(np.linalg.norm(a.center - b.center))
    return box_iou(a, b) + (1e-3 / (1 + distance) if distance < 1.0 else 0.0)


def _errors(truth: UprightBox, made: UprightBox, label: str) -> dict[str, float]:
    center = np.array([truth.x - made.x, truth.y - made.y, truth.z + truth.height / 2 - made.z - made.height / 2])
    turn = np.nan if any(word in label for word in _ROUND) else abs(np.degrees(turn_between(truth.yaw, made.yaw)))
    return {"iou": box_iou(truth, made), "center_m": float(np.linalg.norm(center)), "yaw_deg": float(turn)}


def summary(rows: list[Match]) -> dict[str, float]:
    """One row of the table."""
    seen = [row for row in rows if row.pixels >= SEEN]
    found = [row for row in seen if row.iou >= FOUND]
    yaws = np.array([row.yaw_deg for row in found if np.isfinite(row.yaw_deg)])
    return {
        "things": len(rows),
        "seen": round(len(seen) / max(len(rows), 1), 3),
        "recall_seen": round(len(found) / max(len(seen), 1), 3),
        "recall_all": round(sum(row.iou >= FOUND for row in rows) / max(len(rows), 1), 3),
        "iou_mean": round(float(np.mean([row.iou for row in seen])), 3),
        "iou_median": round(float(np.median([row.iou for row in seen])), 3),
        "iou_placed_mean": round(float(np.mean([row.iou_placed for row in seen])), 3),
        "center_cm_median": round(100 * float(np.nanmedian([row.center_m for row in seen])), 1),
        "yaw_within_10": round(float((yaws < 10).mean()), 3),
        "yaw_within_10_or_flipped": round(float((np.minimum(yaws, 180 - yaws) < 10).mean()), 3),
    }


def rooms_of(scenes: list[str], count: int):
    """(scene, context, room) of seeded rooms: every room of every scene at seed 0, then at seed 1, and so on."""
    seed, given = 0, 0
    while given < count:
        for scene in scenes:
            context = context_of(scene, seed)
            for room in range(len(context.plan.rooms)):
                if given < count:
                    given += 1
                    yield scene, context, room
        seed += 1


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rooms", type=int, default=200, help="seeded rooms; the first 30 are the five scenes at seed 0")
    parser.add_argument("--scenes", nargs="*", default=options("scene"))
    parser.add_argument("--out", type=Path, default=HERE)
    arguments = parser.parse_args()
    rows: list[Match] = []
    broken, dropped, extra, objects = [], 0, 0, []
    backend, current = None, None
    for scene, context, room in rooms_of(list(arguments.scenes), arguments.rooms):
        if context is not current:
            backend, current = make_backend("objects", load_config([f"+scene={scene}", "objects=lifted"]).objects, context), context
        assert backend is not None
        lifted = backend.lift(context, room)
        found = matches(scene, context, room, backend, lifted)
        rows += found
        extra += len(lifted.things) - sum(np.isfinite(row.center_m) for row in found)
        dropped += len(lifted.placement.dropped)
        objects.append(len(lifted.objects))
        laws = violations(lifted.objects, room_site(context.plan, room))
        broken += [(scene, context.seed, context.plan.rooms[room].name, law.law, law.what) for law in laws]
        print(scene, context.seed, context.plan.rooms[room].name, len(lifted.objects), summary(found) if found else "", laws, flush=True)
    _write(arguments.out, rows, {"rooms": len(objects), "violations": len(broken), "dropped": dropped, "unmatched": extra,
                                 "objects_a_room": round(float(np.mean(objects)), 2)}, broken)  # fmt: skip


def _write(folder: Path, rows: list[Match], laws: dict[str, float], broken: list[tuple]) -> None:
    with (folder / "things.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in dataclasses.fields(Match)])
        writer.writeheader()
        writer.writerows({k: round(v, 4) if isinstance(v, float) else v for k, v in dataclasses.asdict(row).items()} for row in rows)
    groups = {scene: [row for row in rows if row.scene == scene] for scene in dict.fromkeys(row.scene for row in rows)}
    groups |= {f"on {kind}": [row for row in rows if row.support == kind] for kind in sorted({row.support for row in rows})}
    groups |= {"all": rows}
    table = [{"group": name} | summary(group) for name, group in groups.items()]
    with (folder / "result.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, table[0].keys())
        writer.writeheader()
        writer.writerows(table)
    for row in table:
        print(row)
    print(laws)
    for line in broken:
        print(*line)


if __name__ == "__main__":
    main()
