"""The stages in order: plan, structure, furnish, cameras, paint, heldout, reconstruct, evaluate, report.

Each stage is a function of `wm.stages`. Its key is a digest of its configuration, the seed and the keys of its inputs, so that a
resumed run makes only what is missing and ends with the same bytes as an uninterrupted one.
"""

import contextlib
import functools
import json
import pathlib
from collections.abc import Sequence

from tabulate import tabulate

from wm.artifacts import identity, json_text, open_run_folder, write_atomically
from wm.geometry.plan.loading import read_plan_file
from wm.host import prepare_process
from wm.meter import StageMeter
from wm.metric_table import METRICS
from wm.neighbours import Neighbours
from wm.schema import RunConfig
from wm.splat.optimization.padding import Capacity
from wm.stages.evaluation import evaluate
from wm.stages.heldout import HeldOut, render_heldout
from wm.stages.painting import Painted, is_painted, paint
from wm.stages.reconstruction import HISTORY, reconstruct
from wm.stages.reporting import METRICS_FILE, REPORT, report
from wm.stages.run_context import TIMINGS, RunContext, versions
from wm.stages.scene import LAYOUT, Scene, build_scene
from wm.stages.warm_up import warming_up
from wm.synth.registry import close_backend, make_backend

_CLOCKED = {"plan": LAYOUT, "reconstruct": HISTORY}
"""The file of a stage whose content depends on the clock, and which therefore is not part of the stage's entry."""


def run(config: RunConfig, folder: pathlib.Path, *, neighbours: Sequence[pathlib.Path] = ()) -> dict:
    """One run, from the theme to the report.

    Args:
      config: the whole configuration, already checked (wm.validate).
      folder: the run folder. If it holds a part of the same run, that run is continued.
      neighbours: other run folders. A finished stage of theirs that has the same key is copied instead of made again; its time
        and memory are added to this run's, so that the times of runs stay comparable.

    Returns:
      The content of `metrics.json`.

    Raises:
      ArtifactError: the folder is in use, or holds a run of another configuration.
      PlanError, ProposalError, ValueError: the plan or the views cannot be made as configured; the message says why.
      OSError: the folder cannot be written.
    """
    prepare_process()
    if config.plan.file is not None:
        read_plan_file(config.plan.file)  # raises before a folder is made
    header, meter = _header(config), StageMeter(_timings(folder), keep=functools.partial(_keep_timings, folder))
    account = functools.partial(_account, meter, folder)
    lend = Neighbours(neighbours, say=print, account=account).lend
    with open_run_folder(folder, header, overwrite=config.overwrite, lend=lend) as store:
        if store.overwrites:
            meter.outdate()
        context = RunContext(config=config, folder=store, meter=meter)
        scene = build_scene(context)
        capacity = Capacity()
        with warming_up(context, scene, capacity, needed=not is_painted(context, scene)):
            painted, heldout = _painted(context, scene)
        result = reconstruct(context, scene, painted, heldout, capacity)
        metrics = evaluate(context, scene, painted, result, heldout)
        metrics = report(context, scene, painted, result, metrics)
        print(_summary(folder, context, metrics))
        return metrics


def _painted(context: RunContext, scene: Scene) -> tuple[Painted, HeldOut]:
    """The stages that need the image and depth backends, which are closed afterwards to free their memory."""
    with contextlib.ExitStack() as done:
        image = make_backend("image", context.config.image, scene.context)
        done.callback(close_backend, image)
        depth = make_backend("depth", context.config.depth, scene.context)
        done.callback(close_backend, depth)
        return paint(context, scene, image, depth), render_heldout(context, scene, image)


def _account(meter: StageMeter, folder: pathlib.Path, stage: str, elsewhere: pathlib.Path) -> None:
    """Adds the time and memory of a copied stage to ours, and copies its file that depends on the clock."""
    if stage in (timings := _timings(elsewhere)):
        meter.credit(stage, timings[stage])
    if (elsewhere / (clocked := _CLOCKED.get(stage, ""))).is_file():
        write_atomically(folder / clocked, (elsewhere / clocked).read_bytes())


def _header(config: RunConfig) -> dict:
    return {"config": identity(config), "seed": config.seed, "versions": versions()}


def _keep_timings(folder: pathlib.Path, rows: dict) -> None:
    write_atomically(folder / TIMINGS, json_text(rows))


def _timings(folder: pathlib.Path) -> dict:
    """The rows that a finished or interrupted run has left; none if the file is missing or damaged."""
    try:
        rows = json.loads((folder / TIMINGS).read_text())
        return {name: {"seconds": float(row["seconds"]), "peak_gib": float(row["peak_gib"])} for name, row in rows.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _summary(folder: pathlib.Path, context: RunContext, metrics: dict) -> str:
    stages = {**context.meter.stages, "in all": metrics}
    rows = [(name, *(METRICS[key].text(row[key]) for key in ("seconds", "peak_gib"))) for name, row in stages.items()]
    measured = (METRICS[key] for key in ("psnr", "m_mae", "n_ang_deg") if metrics[key] is not None)
    held_out = ", ".join(f"{metric.label} {metric.text(metrics[metric.key])}" for metric in measured)
    where = folder / REPORT if context.config.report.enabled else folder / METRICS_FILE
    return "\n".join(
        [
            f"\n{metrics['rooms']} rooms, {metrics['views']} views, {metrics['gaussians']:,} gaussians",
            tabulate(rows, tablefmt="plain", colalign=("left", "right", "right"), disable_numparse=True),
            f"held-out: {held_out}" if held_out else "held-out: not measured",
            f"results: {where}",
        ]
    )
