"""Verification under the errors of real depth estimators: which violations are caught, which good images are rejected.

    python experiments/verification/estimators.py --preset draft --every 4

The true depth of an image, with or without a violation, is turned into what an estimator might make of it, each error alone and
together; then it is judged by recall alone (the paper) and by ours, with the settings of the offline models and with those of the
real ones. Good images are also held to scaffolds whose objects are boxes or left out. Also: estimates that are inverted.
"""

import argparse
import csv
import dataclasses
import pathlib
import sys
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.ndimage import gaussian_filter, grey_closing

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE))

import run as kinds  # noqa: E402 - the experiment beside this one

from wm.geometry import assemble_scene, cast, object_boxes  # noqa: E402
from wm.offline.image.violations import KINDS, PLAIN  # noqa: E402
from wm.offline.world.edit import edited_mesh  # noqa: E402
from wm.run import load_config, options  # noqa: E402
from wm.schema import VerifySettings  # noqa: E402
from wm.synth.attempt import attempt_seed, binding_edges, compared_depth, near_glass  # noqa: E402
from wm.synth.canny import depth_edges  # noqa: E402
from wm.synth.condition import glass  # noqa: E402
from wm.synth.verify import verify  # noqa: E402
from wm.types import GBuffer, Mesh, SceneObject, SurfaceKind  # noqa: E402

LIMITS = {
    "offline": load_config(["+scene=gothic"]).verify,
    "real": load_config(["+scene=gothic", "image=openai_images", "depth=depth_pro"]).verify,
}
"""The settings of the offline models, and those that a real depth model brings."""
OUTDOORS = 30.0
"""Metres at which an estimator that looks through a pane puts what it sees."""


def scale_field(depth, amplitude, rng):
    """Depth whose scale drifts over the image, as where an estimator joins parts that it has judged apart."""
    field = gaussian_filter(rng.normal(size=depth.shape), depth.shape[1] / 6, mode="nearest")
    return depth * np.exp(amplitude * (field - field.mean()) / max(float(field.std()), 1e-9))


def blurred(depth, sigma):
    """Depth whose edges are as wide as those of an estimator that works at a smaller size; in pixels at 688 wide."""
    return gaussian_filter(depth, sigma * depth.shape[1] / 688, mode="nearest")


def without_thin_things(depth, pixels):
    """Depth without what is thinner than this, in pixels at 688 wide: legs, arms of chandeliers."""
    side = max(1, round(pixels * depth.shape[1] / 688))
    return grey_closing(depth, (side, side), mode="nearest")


def through_glass(depth, panes):
    return np.where(panes, OUTDOORS, depth)


def mirrored(depth, mirrors):
    """A mirror is as deep as what it shows."""
    return np.where(mirrors, 2 * depth, depth)


def estimators(depth, panes, mirrors, rng) -> Iterator[tuple[str, np.ndarray]]:
    yield "exact", depth
    for amplitude in (0.02, 0.05, 0.1):
        yield f"scale field {amplitude:.0%}", scale_field(depth, amplitude, rng)
    for sigma in (2.0, 4.0):
        yield f"blurred {sigma:g} px", blurred(depth, sigma)
    yield "no thin things (6 px)", without_thin_things(depth, 6)
    yield "through glass", through_glass(depth, panes)
    yield "mirrors", mirrored(depth, mirrors)
    together = mirrored(through_glass(without_thin_things(depth, 4), panes), mirrors)
    yield "all, mild", scale_field(blurred(together, 1.0), 0.02, rng)
    yield "all, strong", scale_field(blurred(together, 2.0), 0.05, rng)
    yield "inverted", 1 / np.maximum(depth, 0.1)


def samples(scene: kinds.Scene, number: int) -> Iterator[dict]:
    """By each estimator: a good image of a view and one for each kind of violation; the good one also held to boxes and none."""
    stage, gbuffer = scene.stage, scene.gbuffer
    objects = stage.context.objects
    shown = [Held.of(gbuffer, scene.mesh, objects, "textured", stage.config.verify)]
    for mode, things in (("boxes", object_boxes(objects)), ("none", ())):
        mesh = assemble_scene(stage.context.structure, things)
        shown.append(Held.of(cast(mesh, scene.view.camera), mesh, things, mode, stage.config.verify))
    for k, kind in enumerate((kinds.GOOD, *KINDS)):
        seed = attempt_seed(2000, number, k)
        wrong = None if kind == kinds.GOOD else scene.violated(kind, seed)
        if kind != kinds.GOOD and wrong is None:
            continue
        mesh = scene.mesh if wrong is None else edited_mesh(scene.mesh, stage.context.plan, wrong.edit)[0]
        drawn = gbuffer if wrong is None else cast(mesh, scene.view.camera)
        changed = float(np.mean(np.abs(drawn.depth - gbuffer.depth) > stage.config.verify.tolerance * gbuffer.depth))
        panes = drawn.hit & (np.append(mesh.face_kind, 0)[drawn.face] == SurfaceKind.PANE)
        rng = np.random.default_rng(seed)
        for name, depth in estimators(drawn.depth, panes, glass(drawn, mesh, objects) & ~panes, rng):
            estimate = rng.uniform(0.3, 3) * depth * (1 + 0.003 * rng.normal(size=depth.shape)) + rng.uniform(0, 0.3)
            for held in shown if kind == kinds.GOOD else shown[:1]:
                yield {"kind": kind, "estimator": name, "changed": changed, **held.judged(estimate)}


@dataclasses.dataclass(frozen=True, eq=False)
class Held:
    """What an image of a view is held to, in one mode of the condition."""

    mode: str
    edges: np.ndarray  # of the whole scaffold, as in the paper
    binding: np.ndarray
    depth: np.ndarray
    glass: np.ndarray | None

    @classmethod
    def of(cls, gbuffer: GBuffer, mesh: Mesh, objects: Sequence[SceneObject], mode: str, settings: VerifySettings) -> "Held":
        condition = kinds.blank_condition(gbuffer, mesh, objects, mode)
        edges = depth_edges(gbuffer.depth, gbuffer.hit, low=settings.low, high=settings.high)
        binding = binding_edges(gbuffer, condition, settings)
        return cls(mode, edges, binding, compared_depth(gbuffer, condition, settings), near_glass(condition, settings))

    def judged(self, estimate: np.ndarray) -> dict:
        """Recall as in the paper, and ours by the two kinds of settings."""
        row: dict = {"mode": self.mode, "paper": verify(self.edges, estimate, LIMITS["offline"]).recall}
        for name, settings in LIMITS.items():
            adds = self.mode != "textured"
            verdict = verify(self.binding, estimate, settings, depth=self.depth, adds=adds, glass=self.glass)
            row |= {f"{name} recall": verdict.recall, f"{name} apart": verdict.disagreement}
        return row


def table(rows: list[dict]) -> Iterator[dict]:
    """By mode and estimator: shares of violations caught and of good images rejected, by recall alone and by ours."""
    for mode, name in dict.fromkeys((row["mode"], row["estimator"]) for row in rows):
        mine = [row for row in rows if (row["mode"], row["estimator"]) == (mode, name)]
        good = [row for row in mine if row["kind"] == kinds.GOOD]
        bad = [row for row in mine if row["kind"] != kinds.GOOD and row["changed"] >= PLAIN]
        line = {"mode": mode, "estimator": name, "good": len(good), "violations": len(bad)}
        for test, rejects in tests():
            line[test] = f"{share(bad, rejects):.2f} / {share(good, rejects):.2f}" if bad else f"{share(good, rejects):.2f}"
        yield line


def tests():
    yield "paper, recall < 0.6", lambda row: low(row["paper"], 0.6)
    for name, settings in LIMITS.items():
        for least in (0.35, 0.15):
            yield f"{name}, recall < {least}", lambda row, n=name, r=least: low(row[f"{n} recall"], r)
        for limit in (0.0012, 0.0015, 0.003):
            yield f"{name}, apart > {limit:.2%}", lambda row, n=name, m=limit: row[f"{n} apart"] > m
        yield (
            f"{name}, as set",
            lambda row, n=name, s=settings: low(row[f"{n} recall"], s.min_recall) or row[f"{n} apart"] > s.max_disagreement,
        )


def low(recall: float | None, least: float) -> bool:
    return recall is not None and recall < least


def share(rows, rejects) -> float:
    return float(np.mean([rejects(row) for row in rows])) if rows else float("nan")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--preset", default="draft", choices=options("preset"))
    parser.add_argument("--every", type=int, default=4, help="of the planned views, every so many")
    parser.add_argument("--scenes", nargs="+", default=list(options("scene")))
    arguments = parser.parse_args()
    rows: list[dict] = []
    for name in arguments.scenes:
        stage = kinds.Stage.of(name, arguments.preset, arguments.every)
        for number, view in enumerate(stage.views):
            rows += [{"scene": name, "view": view.name, **row} for row in samples(kinds.Scene(stage, view), number)]
        print(f"{name}: {len(stage.views)} views, {len(rows)} estimates so far", flush=True)
    lines = list(table(rows))
    with (HERE / f"estimators_{arguments.preset}.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, lines[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)
    for line in lines:
        print("  ".join(f"{key} {value}" for key, value in line.items()))


if __name__ == "__main__":
    main()
