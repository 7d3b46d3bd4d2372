"""How many violations of the structure does verification catch, and how many good images does it reject?

    python experiments/verification/run.py --preset draft --every 2

Images are judged by their depth alone, so none is shaded: a violation is drawn as the offline image model draws it
(wm/offline/image/violations.py), cast, estimated by the offline depth model and verified. Two parts:
  kinds     every kind of violation once a view, and two good images a view
  profiles  the painting loop of every offline image model: attempts until one passes, violations at its shares
"""

import argparse
import csv
import dataclasses
import pathlib
from collections.abc import Iterator, Sequence

import numpy as np

from wm.geometry import assemble_scene, build_ray_scene, cast, place_cameras
from wm.geometry.plan.openings import portals
from wm.offline.image.violations import KINDS, PLAIN, ScaffoldViolation, draw_violation, violation
from wm.offline.world.edit import edited_mesh
from wm.run import load_config, options
from wm.schema import RunConfig
from wm.synth.attempt import attempt_seed, binding_edges, compared_depth, near_glass
from wm.synth.backends import Condition, ImageResult, SceneContext
from wm.synth.canny import depth_edges
from wm.synth.condition import glass
from wm.synth.furnished import furnished_context
from wm.synth.registry import make_backend
from wm.synth.verify import verify
from wm.types import OUTSIDE, GBuffer, Mesh, SceneObject, View

HERE = pathlib.Path(__file__).parent
GOOD = "good"
PROFILES = ("procedural", "like_closed", "like_distilled")
"""The image models that are offline; all others are paid or need weights."""
RECALL = 0.6
"""Threshold for the test by edge recall alone; the paper does not tell its own."""


@dataclasses.dataclass(frozen=True, eq=False)
class Stage:
    """A scene that images can be judged in."""

    config: RunConfig
    context: SceneContext
    mesh: Mesh
    views: tuple[View, ...]

    @classmethod
    def of(cls, scene: str, preset: str, every: int) -> "Stage":
        config = load_config([f"+scene={scene}", f"preset={preset}"])
        context = furnished_context(config)
        mesh = assemble_scene(context.structure, context.objects)
        views = place_cameras(context.plan, build_ray_scene(mesh), config.cameras)
        return cls(config, context, mesh, tuple(views[::every]))


class Scene:
    """What a view sees, with and without a violation: only its room and those behind a doorway are cast."""

    def __init__(self, stage: Stage, view: View):
        self.stage, self.view = stage, view
        near = {view.room, *(room for p in portals(stage.context.plan) if view.room in p.rooms for room in p.rooms)}
        kept = np.isin(stage.mesh.face_room, [*near, OUTSIDE])
        mesh = stage.mesh
        labels = {name: getattr(mesh, name)[kept] for name in ("faces", "face_room", "face_kind", "face_object")}
        self.mesh = Mesh(vertices=mesh.vertices, **labels)
        self.gbuffer: GBuffer = cast(self.mesh, view.camera)
        self.thing = np.append(self.mesh.face_object, np.int32(OUTSIDE))[self.gbuffer.face]
        settings = stage.config.verify
        self.edges = depth_edges(self.gbuffer.depth, self.gbuffer.hit, low=settings.low, high=settings.high)
        condition = blank_condition(self.gbuffer, self.mesh, stage.context.objects)
        self.binding = binding_edges(self.gbuffer, condition, settings)
        self.held = compared_depth(self.gbuffer, condition, settings)
        self.glass = near_glass(condition, settings)

    def violated(self, kind: str, seed: int) -> ScaffoldViolation | None:
        return violation(kind, self.stage.context, self.view, self.gbuffer, self.thing, np.random.default_rng(seed))

    def drawn(self, config, seed: int) -> ScaffoldViolation | None:
        rng = np.random.default_rng(np.random.SeedSequence([seed, 0xBAD]))
        shares = {kind: getattr(config, kind) for kind in KINDS}
        return draw_violation(shares, self.stage.context, self.view, self.gbuffer, self.thing, rng)

    def judged(self, wrong: ScaffoldViolation | None, seed: int) -> dict:
        """One sample: what it is, whether it is a violation by definition, and what the two tests say of it."""
        depth = self.gbuffer.depth
        if wrong is not None:
            depth = cast(edited_mesh(self.mesh, self.stage.context.plan, wrong.edit)[0], self.view.camera).depth
        settings = self.stage.config.verify
        changed = np.abs(depth - self.gbuffer.depth) > settings.tolerance * self.gbuffer.depth
        image = ImageResult(rgb=np.zeros((*depth.shape, 3), np.float32), drawn_depth=depth)
        estimate = make_backend("depth", self.stage.config.depth).estimate(image, camera=self.view.camera, seed=seed)
        paper = verify(self.edges, estimate, dataclasses.replace(settings, min_recall=RECALL))
        ours = verify(self.binding, estimate, settings, depth=self.held, glass=self.glass)
        return {
            "kind": GOOD if wrong is None else wrong.kind, "what": "" if wrong is None else wrong.what,
            "changed": float(changed.mean()), "recall": ours.recall, "disagreement": ours.disagreement,
            "paper_rejects": not paper.passed, "rejects": not ours.passed,
        }  # fmt: skip


def blank_condition(gbuffer: GBuffer, mesh: Mesh, objects: Sequence[SceneObject], mode: str = "textured") -> Condition:
    """What verification reads of a condition, without its colours."""
    blank, owner = np.zeros((*gbuffer.depth.shape, 3), np.float32), np.append(mesh.face_object, np.int32(OUTSIDE))
    return Condition(
        rgb=blank, known=blank[..., 0], depth=gbuffer.depth, objects=mode, object=owner[gbuffer.face] != OUTSIDE,
        glass=glass(gbuffer, mesh, objects),
    )  # fmt: skip


def kinds(stage: Stage, scene: Scene, number: int) -> Iterator[dict]:
    """Two good images of a view, and one for each kind of violation that it has something for."""
    for k, kind in enumerate((GOOD, GOOD, *KINDS)):
        seed = attempt_seed(1000, number, k)
        wrong = None if kind == GOOD else scene.violated(kind, seed)
        if kind == GOOD or wrong is not None:
            yield scene.judged(wrong, seed)


def loop(scene: Scene, profile: RunConfig, number: int) -> Iterator[dict]:
    """The attempts at a view until one passes."""
    for attempt in range(profile.verify.max_attempts):
        seed = attempt_seed(profile.seed, number, attempt)
        row = scene.judged(scene.drawn(profile.image, seed), seed)
        yield row
        if not row["rejects"]:
            return


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--preset", default="draft", choices=options("preset"))
    parser.add_argument("--every", type=int, default=1, help="of the planned views, every so many")
    parser.add_argument("--scenes", nargs="+", default=list(options("scene")))
    parser.add_argument("--again", action="store_true", help="judge the stored samples by the limits of today")
    arguments = parser.parse_args()
    profiles = {name: load_config(["+scene=gothic", f"image={name}"]) for name in PROFILES}
    path = HERE / f"samples_{arguments.preset}.csv"
    rows: list[dict] = list(judged_again(path, load_config(["+scene=gothic"]))) if arguments.again else []
    for name in () if arguments.again else arguments.scenes:
        stage = Stage.of(name, arguments.preset, arguments.every)
        for view in stage.views:
            scene = Scene(stage, view)
            number = len(rows)  # of no other view, so that no two draw alike
            place = {"scene": name, "view": view.name}
            rows += [place | {"part": "kinds", "attempt": 0} | row for row in kinds(stage, scene, number)]
            for profile, config in profiles.items():
                for k, row in enumerate(loop(scene, config, number)):
                    rows.append(place | {"part": profile, "attempt": k} | row)
        print(f"{name}: {len(stage.views)} views, {len(rows)} samples so far", flush=True)
    with path.open("w", newline="") as file:
        columns = ["part", "scene", "view", "attempt", "kind", "what", "changed", "recall", "disagreement", "paper_rejects",
                   "rejects"]  # fmt: skip
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: f"{v:.4g}" if isinstance(v, float) else v for key, v in row.items()} for row in rows)
    table = list(summary(rows, list(profiles)))
    with (HERE / f"result_{arguments.preset}.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, table[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(table)
    for row in table:
        print("  ".join(f"{key} {value}" for key, value in row.items()))


def judged_again(path: pathlib.Path, config: RunConfig) -> Iterator[dict]:
    """Stored samples under the limits of a configuration: a view's attempts end at the first that now passes."""
    done: set[tuple[str, str, str]] = set()
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            loop_of = (row["part"], row["scene"], row["view"])
            recall = float(row["recall"]) if row["recall"] else None
            numbers = {name: float(row[name]) for name in ("changed", "disagreement")}
            low = recall is not None and recall < config.verify.min_recall
            rejects = low or numbers["disagreement"] > config.verify.max_disagreement
            if loop_of in done:
                continue
            if row["part"] != "kinds" and not rejects:
                done.add(loop_of)
            paper = recall is not None and recall < RECALL
            yield row | numbers | {"recall": recall, "attempt": int(row["attempt"]), "paper_rejects": paper, "rejects": rejects}


def summary(rows: list[dict], profiles: list[str]) -> Iterator[dict]:
    """For each part and kind: images, those of them that are violations by definition, and shares rejected by either test."""
    for part in ("kinds", *profiles):
        mine = [row for row in rows if row["part"] == part]
        views = {(row["scene"], row["view"]) for row in mine}
        accepted = [row for row in mine if not row["rejects"]]
        for kind in (GOOD, "any", *KINDS):
            some = [row for row in mine if row["kind"] == kind or (kind == "any" and row["kind"] != GOOD)]
            judged = [row for row in some if kind == GOOD or row["changed"] >= PLAIN]
            yield {
                "part": part, "kind": kind, "images": len(some), "counted": len(judged),
                "rejected_by_recall": _share(judged, "paper_rejects"), "rejected": _share(judged, "rejects"),
                "yield": f"{len(accepted) / len(views):.3f}" if part != "kinds" and kind == GOOD else "",
                "atm": f"{np.mean([row['attempt'] + 1 for row in accepted]):.3f}" if part != "kinds" and kind == GOOD else "",
                "wrong_accepted": f"{np.mean([row['kind'] != GOOD and row['changed'] >= PLAIN for row in accepted]):.4f}"
                if part != "kinds" and kind == GOOD else "",
            }  # fmt: skip


def _share(rows: list[dict], flag: str) -> str:
    return f"{np.mean([row[flag] for row in rows]):.3f}" if rows else ""


if __name__ == "__main__":
    main()
