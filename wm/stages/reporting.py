"""Report: metrics.json, the fly-through and report.html."""

import dataclasses
from collections.abc import Iterator

import numpy as np

from wm.artifacts import json_text
from wm.codecs import to_bytes
from wm.geometry import cast, walkthrough
from wm.geometry.rays.pinhole import scale_camera
from wm.metric_table import METRICS
from wm.report import ReportData, SheetRow, render_page, write_video
from wm.splat.optimization.curve import HELDOUT
from wm.stages.evaluation import GLIMPSE, Seen, glimpse, look_all, stored_render
from wm.stages.job import Job
from wm.stages.ordered import in_order
from wm.stages.painting import Painted
from wm.stages.reconstruction import Reconstruction
from wm.stages.scene import Scene
from wm.types import OUTSIDE, View

VIDEO, REPORT, METRICS_FILE = "flythrough.mp4", "report.html", "metrics.json"
SHEET_KINDS = ("bootstrap", "perimeter", "overhead", "doorway")
"""The contact sheet shows one view of each kind a room."""
ENOUGH = 0.05
"""Share of a picture beyond which one thing counts no more: a close-up of a wardrobe is no picture of a bedroom."""
FARTHER = 1e-3
"""What a metre of median depth counts beside that."""


def report(job: Job, scene: Scene, painted: Painted, result: Reconstruction, metrics: dict) -> dict:
    """Writes the report; returns the metrics with time and memory in them."""
    page = None
    with job.stage("report"):
        if job.config.report.enabled:
            page = _page(job, scene, painted, result)
    # Only now are the stages' times complete. A metric that was not measured is there as null.
    complete = dict.fromkeys(METRICS) | metrics | {"seconds": job.meter.seconds, "peak_gib": job.meter.peak_gib}
    job.folder.write(METRICS_FILE, json_text(complete))
    if page is not None:
        job.folder.write(REPORT, render_page(dataclasses.replace(page, metrics=complete, timings=job.meter.stages)))
    return complete


def _page(job: Job, scene: Scene, painted: Painted, result: Reconstruction) -> ReportData:
    return ReportData(
        scene=job.config.scene.name,
        theme=job.config.scene.theme,
        variant=job.config.variant,
        preset=job.config.preset,
        seed=job.config.seed,
        plan=scene.plan,
        objects=scene.objects,
        views=scene.views,
        sheets=_sheets(scene, painted, result),
        heroes=_heroes(job, scene),
        metrics={},
        timings={},
        history=_scene_curve(result.history),
        video=_video(job, scene, result) if job.config.report.video else None,
    )


def _video(job: Job, scene: Scene, result: Reconstruction) -> bytes:
    config = job.config
    key = job.key("video", result.key, config.report)
    if not job.folder.has("video", key):
        cameras = walkthrough(scene.plan, scene.mesh, config.cameras, fps=config.report.fps, speed=config.report.walking_speed)
        views = [View(camera=camera, room=-1, kind="walk", name=f"walk{k}") for k, camera in enumerate(cameras)]

        def frames() -> Iterator[np.ndarray]:
            with job.bar("video", len(views)) as bar:
                for render in in_order(lambda view: glimpse(scene, result.renderer, view), views):
                    yield to_bytes(render.rgb)
                    bar.update()

        job.folder.save("video", key, {VIDEO: lambda path: write_video(path, frames(), fps=config.report.fps)})
    return (job.folder.path / VIDEO).read_bytes()


def _sheets(scene: Scene, painted: Painted, result: Reconstruction) -> dict[str, list[SheetRow]]:
    shown = []
    for index in range(len(scene.plan.rooms)):
        members = [view for view in scene.views if view.room == index]
        firsts = (next((view for view in members if view.kind == kind), None) for kind in SHEET_KINDS)
        shown += [view for view in firsts if view is not None]
    sheets: dict[str, list[SheetRow]] = {room: [] for room in scene.rooms}
    for seen in look_all(scene, result.renderer, shown):
        sheets[scene.rooms[seen.view.room]].append(_sheet_row(painted, seen))
    return sheets


def _sheet_row(painted: Painted, seen: Seen) -> SheetRow:
    stored = painted.view(seen.view)
    recall = "edge recall not measured" if stored.recall is None else f"edge recall {stored.recall:.2f}"
    tries = "1 attempt" if stored.attempts == 1 else f"{stored.attempts} attempts"
    style = f"style from {stored.reference}" if stored.reference else "no style reference"
    return SheetRow(
        name=seen.view.name,
        note=f"{recall}, {tries}{'' if stored.accepted else ', used only where it agrees'}, {style}",
        condition=stored.condition,
        generated=stored.rgb,
        splats=to_bytes(seen.render.rgb),
        splat_depth=seen.render.depth,
        scaffold_depth=seen.gbuffer.depth,
    )


def _heroes(job: Job, scene: Scene) -> dict[str, np.ndarray]:
    """One held-out render a room, as the evaluation stored it: the view that shows most of what is in the room."""
    heroes = {}
    for index, room in enumerate(scene.rooms):
        members = [view for view in scene.heldout if view.room == index]
        if members:
            heroes[room] = stored_render(job, max(members, key=lambda view: showing(scene, view)))
    return heroes


def showing(scene: Scene, view: View) -> float:
    """How much of its room a view shows, 0 to 1: the share of the picture that its things fill, each up to ENOUGH of it, less
    the more it looks up or down (nothing at 45 degrees). Between views without things, the one that sees farther."""
    gbuffer = cast(scene.rays, scale_camera(view.camera, GLIMPSE))
    face = gbuffer.face[gbuffer.hit]
    own = face[(scene.mesh.face_room[face] == view.room) & (scene.mesh.face_object[face] != OUTSIDE)]
    shares = np.bincount(scene.mesh.face_object[own]) / gbuffer.hit.size
    farther = FARTHER * float(np.median(gbuffer.depth))
    rise = float(np.asarray(view.camera.T_cam_world)[2, 2])  # sine of the angle above the horizon
    return float(np.minimum(shares, ENOUGH).sum()) * max(1 - 2 * rise**2, 0.0) + farther


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
            for name in HELDOUT:
                values = [p[name] for p in latest.values() if p.get(name) is not None]
                row[name] = float(np.mean(values)) if values else None
            curve.append(row)
    return curve
