"""Stage `report`: `metrics.json`, the fly-through and `report.html`."""

import dataclasses
import pathlib
from collections.abc import Iterator

import numpy as np

from wm.artifacts.digests import json_text
from wm.color import to_bytes
from wm.environment import shown
from wm.geometry import cast, walkthrough
from wm.geometry.rays.pinhole import scale_camera
from wm.metric_table import METRICS
from wm.report import ReportData, SheetRow, render_page, write_video
from wm.splat.optimization.curve import HELDOUT
from wm.stages.asking import paid
from wm.stages.evaluation import GLIMPSE, Seen, glimpse, look_all, stored_render
from wm.stages.ordered import in_order
from wm.stages.painting import Painted
from wm.stages.reconstruction import ReconstructedScene
from wm.stages.run_context import RunContext
from wm.stages.scene import Scene
from wm.types import OUTSIDE, View

VIDEO, REPORT, METRICS_FILE = "flythrough.mp4", "report.html", "metrics.json"
GENERATOR = b'<meta name="generator" content="wm">'
"""What tells a report page of ours."""
SHEET_KINDS = ("bootstrap", "perimeter", "overhead", "doorway")
"""Kinds of views in the contact sheet: for each room it shows one view of each kind."""
ENOUGH = 0.05
"""Largest share of a picture that one object counts for, since a close-up of a wardrobe does not show the bedroom."""
FARTHER = 1e-3
"""Score of a metre of median depth, beside those shares."""


def report(run: RunContext, scene: Scene, painted: Painted, result: ReconstructedScene, metrics: dict) -> dict:
    """Writes the report; returns the metrics with time and memory in them."""
    page = None
    # A page without a video keeps nothing in an entry.
    with run.stage("report", stores=run.config.report.video or not run.config.report.enabled):
        if run.config.report.enabled:
            page = _page(run, scene, painted, result)
    # The times of the stages are complete only now. A metric that was not measured becomes null.
    spent = run.services.ledger.spent()
    cost = {"seconds": run.meter.seconds, "peak_gib": run.meter.peak_gib, "usd": spent.usd if spent.requests else None}
    complete = dict.fromkeys(METRICS) | metrics | cost
    run.folder.write(METRICS_FILE, json_text(complete))
    if page is None:
        _remove_report(run.folder.path / REPORT)
    else:
        run.folder.write(REPORT, render_page(dataclasses.replace(page, metrics=complete, timings=run.meter.stages)))
    return complete


def _remove_report(file: pathlib.Path) -> None:
    """Removes a page that an earlier run has left here, and no other."""
    if file.is_file() and GENERATOR in file.read_bytes()[:1000]:
        file.unlink()


def _page(run: RunContext, scene: Scene, painted: Painted, result: ReconstructedScene) -> ReportData:
    return ReportData(
        scene=shown(run.config.scene.name),
        theme=shown(run.config.scene.theme),
        heard=scene.heard,
        paid=paid(run.services),
        variant=shown(run.config.variant),
        preset=shown(run.config.preset),
        seed=run.config.seed,
        plan=scene.plan,
        objects=scene.objects,
        views=scene.views,
        sheets=_sheets(scene, painted, result),
        heroes=_heroes(run, scene),
        metrics={},
        timings={},
        history=_scene_curve(result.history),
        video=_video(run, scene, result) if run.config.report.video else None,
    )


def _video(run: RunContext, scene: Scene, result: ReconstructedScene) -> bytes:
    config = run.config
    key = run.key("video", result.key, config.report)
    if not run.folder.has("video", key):
        cameras = walkthrough(scene.plan, scene.rays, config.cameras, fps=config.report.fps, speed=config.report.walking_speed)
        views = [View(camera=camera, room=-1, kind="walk", name=f"walk{k}") for k, camera in enumerate(cameras)]

        def frames() -> Iterator[np.ndarray]:
            with run.bar("video", len(views)) as bar:
                for render in in_order(lambda view: glimpse(scene, result.renderer, view), views):
                    yield to_bytes(render.rgb)
                    bar.update()

        run.folder.save("video", key, {VIDEO: lambda path: write_video(path, frames(), fps=config.report.fps)})
    return (run.folder.path / VIDEO).read_bytes()


def _sheets(scene: Scene, painted: Painted, result: ReconstructedScene) -> dict[str, list[SheetRow]]:
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


def _heroes(run: RunContext, scene: Scene) -> dict[str, np.ndarray]:
    """For each room the stored render of the held-out view that shows most of its objects."""
    heroes = {}
    for index, room in enumerate(scene.rooms):
        members = [view for view in scene.heldout if view.room == index]
        if members:
            heroes[room] = stored_render(run, max(members, key=lambda view: showing(scene, view)))
    return heroes


def showing(scene: Scene, view: View) -> float:
    """A score of how much a view shows of its room.

    It is the sum over the room's objects of the share of the picture that each fills, at most ENOUGH for each. The sum falls the
    more the view looks up or down, to 0 at 45 degrees. FARTHER times the median depth decides between views without objects.
    """
    gbuffer = cast(scene.rays, scale_camera(view.camera, GLIMPSE))
    face = gbuffer.face[gbuffer.hit]
    own = face[(scene.mesh.face_room[face] == view.room) & (scene.mesh.face_object[face] != OUTSIDE)]
    shares = np.bincount(scene.mesh.face_object[own]) / gbuffer.hit.size
    farther = FARTHER * float(np.median(gbuffer.depth))
    rise = float(np.asarray(view.camera.T_cam_world)[2, 2])  # sine of the angle above the horizon
    return float(np.minimum(shares, ENOUGH).sum()) * max(1 - 2 * rise**2, 0.0) + farther


def _scene_curve(history: tuple[dict, ...]) -> list[dict]:
    """One curve for all rooms: at each time at which a room was measured, the mean over the rooms of their latest errors.

    It starts when every room has been measured once.
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
