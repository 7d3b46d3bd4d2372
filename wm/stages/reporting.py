"""Report: metrics.json, the fly-through and report.html."""

import dataclasses
from collections.abc import Iterator

import numpy as np

from wm.artifacts import json_text
from wm.geometry import walkthrough
from wm.report import ReportData, SheetRow, render_page, to_bytes, write_video
from wm.splat.scene_render import SceneRenderer
from wm.stages.evaluation import METRICS, look
from wm.stages.job import Job
from wm.stages.painting import Painted
from wm.stages.reconstruction import Reconstruction
from wm.stages.scene import Scene
from wm.types import View

VIDEO, REPORT = "flythrough.mp4", "report.html"
SHEET_KINDS = ("bootstrap", "perimeter", "overhead", "doorway")
"""The contact sheet shows one view of each kind a room."""


def report(job: Job, scene: Scene, painted: Painted, result: Reconstruction, metrics: dict) -> dict:
    """Writes the report; returns the metrics with time and memory in them."""
    page = None
    with job.stage("report"):
        if job.config.report.enabled:
            page = _page(job, scene, painted, result)
    # Only now are the stages' times complete.
    complete = metrics | {"seconds": job.meter.seconds, "peak_gib": job.meter.peak_gib}
    job.folder.write(METRICS, json_text(complete))
    if page is not None:
        job.folder.write(REPORT, render_page(dataclasses.replace(page, metrics=complete, timings=job.meter.stages)))
    return complete


def _page(job: Job, scene: Scene, painted: Painted, result: Reconstruction) -> ReportData:
    renderer = SceneRenderer(result.rooms, job.config.raster)
    return ReportData(
        scene=job.config.scene.name,
        theme=job.config.scene.theme,
        variant=job.config.variant,
        preset=job.config.preset,
        seed=job.config.seed,
        plan=scene.plan,
        objects=scene.objects,
        views=scene.views,
        sheets=_sheets(scene, renderer, painted),
        heroes=_heroes(scene, renderer),
        metrics={},
        timings={},
        history=_scene_curve(result.history),
        video=_video(job, scene, renderer, result.key) if job.config.report.video else None,
    )


def _video(job: Job, scene: Scene, renderer: SceneRenderer, key: str) -> bytes:
    config = job.config
    key = job.key("video", key, config.report)
    if not job.folder.has("video", key):
        cameras = walkthrough(scene.plan, scene.mesh, config.cameras, fps=config.report.fps, speed=config.report.walking_speed)
        views = [View(camera=camera, room=-1, kind="walk", name=f"walk{k}") for k, camera in enumerate(cameras)]

        def frames() -> Iterator[np.ndarray]:
            with job.bar("video", len(views)) as bar:
                for view in views:
                    yield to_bytes(look(scene, renderer, view).render.rgb)
                    bar.update()

        job.folder.save("video", key, {VIDEO: lambda path: write_video(path, frames(), fps=config.report.fps)})
    return (job.folder.path / VIDEO).read_bytes()


def _sheets(scene: Scene, renderer: SceneRenderer, painted: Painted) -> dict[str, list[SheetRow]]:
    sheets: dict[str, list[SheetRow]] = {}
    for index, room in enumerate(scene.plan.rooms):
        members = [view for view in scene.views if view.room == index]
        shown = [next((v for v in members if v.kind == kind), None) for kind in SHEET_KINDS]
        sheets[room.name] = [_sheet_row(scene, renderer, painted, view) for view in shown if view is not None]
    return sheets


def _sheet_row(scene: Scene, renderer: SceneRenderer, painted: Painted, view: View) -> SheetRow:
    stored, seen = painted.view(view), look(scene, renderer, view)
    recall = "edge recall not measured" if stored.recall is None else f"edge recall {stored.recall:.2f}"
    tries = "1 attempt" if stored.attempts == 1 else f"{stored.attempts} attempts"
    style = f"style from {stored.reference}" if stored.reference else "no style reference"
    return SheetRow(
        name=view.name,
        note=f"{recall}, {tries}{'' if stored.accepted else ', used only where it agrees'}, {style}",
        condition=stored.condition,
        generated=stored.rgb,
        splats=to_bytes(seen.render.rgb),
        splat_depth=seen.render.depth,
        scaffold_depth=seen.gbuffer.depth,
    )


def _heroes(scene: Scene, renderer: SceneRenderer) -> dict[str, np.ndarray]:
    """One held-out view a room: the one that sees farthest, so that most of the room is in it."""
    heroes = {}
    for index, room in enumerate(scene.plan.rooms):
        members = [view for view in scene.heldout if view.room == index]
        seen = [look(scene, renderer, view) for view in members]
        if seen:
            best = max(seen, key=lambda one: float(np.median(one.gbuffer.depth)))
            heroes[room.name] = to_bytes(best.render.rgb)
    return heroes


def _scene_curve(history: tuple[dict, ...]) -> list[dict]:
    """The rooms' curves as one: at each time a room was measured, the mean over rooms of their latest error.

    It starts once every room has been measured.
    """
    latest: dict[int, dict] = {}
    curve = []
    expected = len({point["room"] for point in history})
    for point in sorted(history, key=lambda p: p["seconds"]):
        latest[point["room"]] = point
        if len(latest) == expected:
            row: dict = {"seconds": point["seconds"]}
            for name in ("psnr", "m_mae"):
                values = [p[name] for p in latest.values() if p[name] is not None]
                row[name] = float(np.mean(values)) if values else None
            curve.append(row)
    return curve
