"""The stages in order: plan, structure, furnish, cameras, paint, heldout, reconstruct, evaluate, report.

A stage's key is a digest of its configuration, the seed and the keys of its inputs, so a resumed run does again only what is
missing, and ends with the same bytes as an undisturbed one. Each stage is a function of `wm.stages`.
"""

import contextlib
import functools
import json
import pathlib
from collections.abc import Sequence

from tabulate import tabulate

from wm.artifacts import identity, json_text, open_run_folder, write_atomically
from wm.geometry import load_plan
from wm.host import prepare_process
from wm.meter import StageMeter
from wm.metric_table import METRICS
from wm.neighbours import Neighbours
from wm.schema import RunConfig
from wm.stages.evaluation import evaluate
from wm.stages.fitters import fitters
from wm.stages.heldout import HeldOut, render_heldout
from wm.stages.job import TIMINGS, Job, versions
from wm.stages.painting import Painted, is_painted, paint
from wm.stages.reconstruction import HISTORY, reconstruct
from wm.stages.rehearsal import rehearsed
from wm.stages.reporting import METRICS_FILE, REPORT, report
from wm.stages.scene import LAYOUT, Scene, build_scene
from wm.synth.backends import close_backend, make_backend

_CLOCKED = {"plan": LAYOUT, "reconstruct": HISTORY}
"""Files that a stage leaves and that depend on the clock."""


def run(config: RunConfig, folder: pathlib.Path, *, neighbours: Sequence[pathlib.Path] = ()) -> dict:
    """One run, from the theme to the report.

    Args:
      config: all of it, checked (wm.validate).
      folder: the run folder; one that holds part of the same run is continued.
      neighbours: other run folders, from which finished stages are copied where they would come out the same. Their time and
        memory count as this run's, so that runs stay comparable whatever was there before them.

    Returns:
      What `metrics.json` holds.

    Raises:
      ArtifactError: the folder is in use, or holds another run.
      PlanError, ProposalError, ValueError: the plan or the views cannot be made as asked; the message says why.
      OSError: the folder cannot be written.
    """
    prepare_process()
    if config.plan.file is not None:
        load_plan(pathlib.Path(config.plan.file))  # a plan that cannot be used leaves no folder behind
    header, meter = _header(config), StageMeter(_timings(folder), keep=functools.partial(_keep_timings, folder))
    account = functools.partial(_account, meter, folder)
    lend = Neighbours(neighbours, say=print, account=account).lend
    with open_run_folder(folder, header, overwrite=config.overwrite, lend=lend) as store:
        if store.overwrites:
            meter.outdate()
        job = Job(config=config, folder=store, meter=meter)
        scene = build_scene(job)
        with fitters(config, scene) as fitting:
            with rehearsed(job, scene, fitting, needed=not is_painted(job, scene)):
                painted, heldout = _painted(job, scene)
            result = reconstruct(job, scene, painted, heldout, fitting)
        metrics = evaluate(job, scene, painted, result, heldout)
        metrics = report(job, scene, painted, result, metrics)
        print(_summary(folder, job, metrics))
        return metrics


def _painted(job: Job, scene: Scene) -> tuple[Painted, HeldOut]:
    """All that the image and depth backends are asked for; they are closed afterwards, and gone with their memory."""
    with contextlib.ExitStack() as done:
        image = make_backend("image", job.config.image, scene.context)
        done.callback(close_backend, image)
        depth = make_backend("depth", job.config.depth, scene.context)
        done.callback(close_backend, depth)
        return paint(job, scene, image, depth), render_heldout(job, scene, image)


def _account(meter: StageMeter, folder: pathlib.Path, stage: str, elsewhere: pathlib.Path) -> None:
    """What a stage that was taken from elsewhere has cost there, as if it had been done here."""
    if stage in (timings := _timings(elsewhere)):
        meter.credit(stage, timings[stage])
    if (elsewhere / (clocked := _CLOCKED.get(stage, ""))).is_file():
        write_atomically(folder / clocked, (elsewhere / clocked).read_bytes())


def _header(config: RunConfig) -> dict:
    return {"config": identity(config), "seed": config.seed, "versions": versions()}


def _keep_timings(folder: pathlib.Path, rows: dict) -> None:
    write_atomically(folder / TIMINGS, json_text(rows))


def _timings(folder: pathlib.Path) -> dict:
    """What a finished or interrupted run has measured; nothing if the file is not there or not whole."""
    try:
        rows = json.loads((folder / TIMINGS).read_text())
        return {name: {"seconds": float(row["seconds"]), "peak_gib": float(row["peak_gib"])} for name, row in rows.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _summary(folder: pathlib.Path, job: Job, metrics: dict) -> str:
    stages = {**job.meter.stages, "in all": metrics}
    rows = [(name, *(METRICS[key].text(row[key]) for key in ("seconds", "peak_gib"))) for name, row in stages.items()]
    measured = (METRICS[key] for key in ("psnr", "m_mae", "n_ang_deg") if metrics[key] is not None)
    held_out = ", ".join(f"{metric.label} {metric.text(metrics[metric.key])}" for metric in measured)
    where = folder / REPORT if job.config.report.enabled else folder / METRICS_FILE
    return "\n".join(
        [
            f"\n{metrics['rooms']} rooms, {metrics['views']} views, {metrics['gaussians']:,} gaussians",
            tabulate(rows, tablefmt="plain", colalign=("left", "right", "right"), disable_numparse=True),
            f"held-out: {held_out}" if held_out else "held-out: nothing to compare with",
            f"results: {where}",
        ]
    )
