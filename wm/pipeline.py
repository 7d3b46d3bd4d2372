"""The stages in order: plan, structure, furnish, cameras, paint, heldout, reconstruct, evaluate, report.

Each stage is a function of `wm.stages`. Its key is a digest of its configuration, the seed and the keys of its inputs, so that a
resumed run makes only what is missing and ends with the same bytes as an uninterrupted one.
"""

import contextlib
import functools
import pathlib
from collections.abc import Iterable, Sequence

from tabulate import tabulate

from wm import console
from wm.artifacts.atomic import write_atomically
from wm.artifacts.confined import confined
from wm.artifacts.digests import file_digest, identity, json_text
from wm.artifacts.neighbours import Neighbours
from wm.artifacts.run_folder import open_run_folder
from wm.artifacts.timings import TIMINGS, UNKNOWN, Rows, read_rows
from wm.environment import shown_identity
from wm.errors import ArtifactError
from wm.export.exporting import FOLDER as EXPORT_FOLDER
from wm.export.exporting import export, exported_table
from wm.export.targets import check_targets
from wm.finished import open_finished
from wm.geometry.plan.loading import read_plan_file
from wm.host import prepare_process
from wm.meter import StageMeter
from wm.metric_table import METRICS
from wm.quality import check_quality
from wm.schema import STAGES, RunConfig
from wm.services.ledger import Ledger
from wm.splat.optimization.padding import Capacity
from wm.stages.asking import open_services, paid
from wm.stages.evaluation import evaluate
from wm.stages.heldout import HeldOut, render_heldout
from wm.stages.history import HISTORY
from wm.stages.painting import Painted, is_painted, paint
from wm.stages.reconstruction import reconstruct
from wm.stages.reporting import METRICS_FILE, REPORT, report
from wm.stages.run_context import RunContext, StoppedError, versions
from wm.stages.scene import LAYOUT, Scene, build_scene
from wm.stages.warm_up import warming_up
from wm.synth.registry import close_backend, make_backend, unasked

_CLOCKED = {"plan": LAYOUT, "reconstruct": HISTORY}
"""The file of a stage whose content depends on the clock, and which therefore is not part of the stage's entry."""
_STAGE_OF = {"fit": "reconstruct", "video": "report"}
"""The stage of an entry, where its name does not begin with that of its stage."""


def run(config: RunConfig, folder: pathlib.Path, *, neighbours: Sequence[pathlib.Path] = ()) -> dict:
    """One run, from the theme to the report, or to the end of the stage `until`.

    Args:
      config: the whole configuration, already checked (wm.validate).
      folder: the run folder. If it holds a part of the same run, that run is continued.
      neighbours: other run folders. A finished stage of theirs that has the same key is copied instead of made again; its time
        and memory are added to this run's, so that the times of runs stay comparable.

    Returns:
      The content of `metrics.json`; nothing if the run stops before its last stage.

    Raises:
      ArtifactError: the folder is in use, or holds a run of another configuration.
      ExportError: a target of `export` is unknown or lacks its extra.
      PlanError, ProposalError, ValueError: the plan or the views cannot be made as configured; the message says why.
      OSError: the folder cannot be written.
    """
    prepare_process()
    check_targets(config.export)
    if config.plan.file is not None:
        # raises before a folder is made
        read_plan_file(
            config.plan.file, repair=config.plan.repair, unreachable=config.plan.unreachable, storey=config.plan.storey
        )
    if config.evaluate.quality is not None:
        check_quality(config.evaluate.quality)
    meter = StageMeter(keep=functools.partial(_keep_timings, folder))
    account = functools.partial(_account, meter, folder)
    lend = Neighbours(neighbours, say=console.say, account=account).lend
    with open_run_folder(folder, _header(config), overwrite=config.overwrite, lend=lend) as store:
        meter.stages = _earlier_times(folder, store.stages)
        if store.overwrites:
            meter.outdate()
        _keep_timings(folder, meter.stages)  # from now on a folder without times has lost them
        services = open_services(config, folder)
        context = RunContext(config=config, folder=store, meter=meter, services=services)
        meter.keep = functools.partial(_keep_timings, folder, ledger=services.ledger)
        for line in unasked(config):
            console.say(line)
        try:
            metrics = _run_stages(context)
        except StoppedError:
            console.say(_stopped(context))
            return {}
        store.drop_unasked()
        console.say(_summary(context, metrics))
    if config.export:
        _export(config, folder)
    return metrics


def _export(config: RunConfig, folder: pathlib.Path) -> None:
    """Writes the targets that the configuration asks for into the folder of the finished run."""
    target = folder / EXPORT_FOLDER
    console.say(exported_table(export(open_finished(folder), config.export, target), target))
    console.say(f"exported: {target}")


def _run_stages(context: RunContext) -> dict:
    scene = build_scene(context)
    capacity = Capacity()
    fits = STAGES.index(context.config.until) >= STAGES.index("reconstruct")
    with warming_up(context, scene, capacity, needed=fits and not is_painted(context, scene)):
        painted, heldout = _painted(context, scene)
    result = reconstruct(context, scene, painted, heldout, capacity)
    metrics = evaluate(context, scene, painted, result, heldout)
    return report(context, scene, painted, result, metrics)


def _painted(context: RunContext, scene: Scene) -> tuple[Painted, HeldOut]:
    """The stages that need the image and depth backends, which are closed afterwards to free their memory."""
    with contextlib.ExitStack() as done:
        image = make_backend("image", context.config.image, scene.context, context.services)
        done.callback(close_backend, image)
        depth = make_backend("depth", context.config.depth, scene.context, context.services)
        done.callback(close_backend, depth)
        return paint(context, scene, image, depth), render_heldout(context, scene, image)


def _account(meter: StageMeter, folder: pathlib.Path, stage: str, elsewhere: pathlib.Path) -> None:
    """Adds the time and memory of a copied stage to ours, and copies its file that depends on the clock."""
    if stage in STAGES:  # the entries of a part of a stage ("video") have no time of their own
        meter.credit(stage, _timings(elsewhere).get(stage, UNKNOWN))
    if stage in _CLOCKED:
        with contextlib.suppress(ArtifactError, FileNotFoundError, IsADirectoryError):  # it has none
            content = confined(elsewhere, _CLOCKED[stage]).read_bytes()
            write_atomically(confined(folder, _CLOCKED[stage], replaced=True), content)


def _header(config: RunConfig) -> dict:
    """What identifies the run. A floor plan of the user's own is part of it by its content and not only by its name."""
    plan = {} if config.plan.file is None else {"plan": file_digest(pathlib.Path(config.plan.file))}
    return {"config": shown_identity(identity(config)), "seed": config.seed, "versions": versions(), **plan}


def _keep_timings(folder: pathlib.Path, rows: Rows, ledger: Ledger | None = None) -> None:
    """Writes `timings.json`: of each stage its time and memory, and what it has paid to models, if anything."""
    spent = {name: ledger.spent(name) for name in rows} if ledger is not None else {}
    cost = {name: {"paid_requests": part.requests, "usd": part.usd} for name, part in spent.items() if part.requests}
    told = {name: row | cost.get(name, {}) for name, row in rows.items()}
    write_atomically(confined(folder, TIMINGS, replaced=True), json_text(told))


def _timings(folder: pathlib.Path) -> Rows:
    """The rows that a finished or interrupted run has left; none if the file is missing or damaged."""
    return _read_timings(folder) or {}


def _read_timings(folder: pathlib.Path) -> Rows | None:
    try:
        return read_rows(confined(folder, TIMINGS))
    except ArtifactError:  # a link to elsewhere
        return None


def _earlier_times(folder: pathlib.Path, entries: Iterable[str]) -> Rows:
    """The rows of what is in the folder; UNKNOWN for finished stages if their times are lost, which is said."""
    rows, finished = _read_timings(folder), {_STAGE_OF.get(name, name) for name in entries} & set(STAGES)
    lost = finished if rows is None else {name for name, row in rows.items() if row == UNKNOWN}
    rows = rows or {}
    if lost:
        console.say(f"{folder / TIMINGS}: missing or damaged; how long {', '.join(sorted(lost))} took is not known any more")
    return {name: row for name, row in rows.items() if name in STAGES} | dict.fromkeys(lost, UNKNOWN)


def _stopped(context: RunContext) -> str:
    until = context.config.until
    goes_on = f"stopped after {until}; the same command without until={until} goes on"
    former = context.folder.overwrites and context.folder.unasked
    stays = ["what the former run has left of later stages stays in the folder until this run is completed"] if former else []
    spent = paid(context.services)
    more = [spent] * bool(spent)
    return "\n".join(["", _times(context), *more, goes_on, *stays, f"results: {context.folder.path}"])


def _summary(context: RunContext, metrics: dict) -> str:
    measured = (METRICS[key] for key in ("psnr", "m_mae", "n_ang_deg") if metrics[key] is not None)
    held_out = ", ".join(f"{metric.label} {metric.text(metrics[metric.key])}" for metric in measured)
    where = context.folder.path / (REPORT if context.config.report.enabled else METRICS_FILE)
    took = METRICS["seconds"].text(metrics["seconds"]) if metrics["seconds"] is not None else "an unknown time"
    again = [] if context.folder.recorded else [f"nothing to do: all of it is there; making it took {took}"]
    return "\n".join(
        [
            "",
            *again,
            f"{metrics['rooms']} rooms, {metrics['views']} views, {metrics['gaussians']:,} gaussians",
            _times(context),
            *filter(None, [paid(context.services), _rejected(metrics["yield"])]),
            f"held-out: {held_out}" if held_out else "held-out: not measured",
            f"results: {where}",
        ]
    )


def _rejected(accepted: float | None) -> str:
    """What verification made of the images, where it did not accept all."""
    if accepted is None or accepted == 1:
        return ""
    share = METRICS["yield"].text(accepted)
    return f"verification accepted {share} of the views; of the others only what agrees with the scaffold is used"


def _times(context: RunContext) -> str:
    """Time and memory of every stage, in the order of the stages, and in all."""
    meter = context.meter
    in_order: Rows = {name: meter.stages[name] for name in STAGES if name in meter.stages}
    stages: Rows = {**in_order, "in all": {"seconds": meter.seconds, "peak_gib": meter.peak_gib}}
    rows = [(name, *(METRICS[key].text(row[key]) for key in ("seconds", "peak_gib"))) for name, row in stages.items()]
    return tabulate(rows, tablefmt="plain", colalign=("left", "right", "right"), disable_numparse=True)
