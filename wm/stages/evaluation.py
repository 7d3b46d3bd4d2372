"""Stage `evaluate`: the metrics of `wm.metric_table`, measured on held-out views."""

import dataclasses
import itertools
from collections.abc import Iterator, Sequence

import jax
import numpy as np

from wm import codecs
from wm.artifacts.digests import json_text
from wm.color import to_bytes
from wm.geometry import cast, coverage, navigability, visible_rooms
from wm.geometry.rays.pinhole import scale_camera
from wm.metric_table import read_metrics
from wm.splat.metrics import depth_error, normal_error, one_surface, psnr
from wm.splat.reprojection import every, overlap, reprojection_error, shared_pixels
from wm.splat.scene.scene_render import SceneRenderer
from wm.splat.similarity import ssim
from wm.stages.heldout import HeldOut
from wm.stages.ordered import in_order
from wm.stages.painting import Painted
from wm.stages.reconstruction import ReconstructedScene
from wm.stages.run_context import RunContext
from wm.stages.scene import Scene
from wm.stages.scoring import scores_of
from wm.types import OUTSIDE, GBuffer, Render, SurfaceKind, View

_ssim = jax.jit(ssim)

EVALUATION = "stages/evaluation.json"
GLIMPSE = 1 / 4
"""Share of the resolution at which the scaffold is cast for a frame of the fly-through."""
HOLE = 0.5
"""Opacity below which a pixel that hits the scaffold counts as a hole."""
SPARSE = 2
"""Stride, in rows and columns, of the pixels that are moved from one view into another to compare depths."""


@dataclasses.dataclass(frozen=True, eq=False)
class Seen:
    """A view of the splats, and the scaffold from the same camera."""

    view: View
    render: Render
    gbuffer: GBuffer


def evaluate(run: RunContext, scene: Scene, painted: Painted, result: ReconstructedScene, heldout: HeldOut) -> dict:
    """The metrics of the run by key, without its time and memory. A metric that no view could measure may be missing."""
    with run.stage("evaluate"):
        key = run.key("evaluate", result.key, run.config.evaluate, run.config.navigation)
        metrics = _found(run, scene, key) or _measured(run, scene, painted, result, heldout, key)
        return metrics | scores_of(run, [_picture(view) for view in scene.heldout], key)


def _found(run: RunContext, scene: Scene, key: str) -> dict | None:
    """The metrics that the folder holds, with all pictures."""
    entries = ("evaluate", *(_entry(view) for view in scene.heldout))
    return read_metrics(run.folder.path / EVALUATION) if all(run.folder.has(name, key) for name in entries) else None


def _measured(run: RunContext, scene: Scene, painted: Painted, result: ReconstructedScene, heldout: HeldOut, key: str) -> dict:
    metrics = _scene_metrics(run, scene, painted, result) | _heldout_metrics(run, scene, result, heldout, key)
    clean = {name: value if value is None or np.isfinite(value) else None for name, value in metrics.items()}
    run.folder.save("evaluate", key, {EVALUATION: json_text(clean)})
    return clean


def look(scene: Scene, renderer: SceneRenderer, view: View) -> Seen:
    """Renders the splats and casts the scaffold from a view."""
    gbuffer = cast(scene.rays, view.camera)
    rooms = np.flatnonzero(visible_rooms(scene.plan, scene.mesh, [view])[0])
    render = renderer.render(view.camera, [int(room) for room in rooms], gbuffer.depth)
    return Seen(view=view, render=render, gbuffer=gbuffer)


def glimpse(scene: Scene, renderer: SceneRenderer, view: View) -> Render:
    """Renders the splats alone. Which rooms the view sees, and what hides them, comes from the scaffold cast at a quarter of the
    resolution, so a room that shows in only a few pixels may be missing."""
    gbuffer = cast(scene.rays, scale_camera(view.camera, GLIMPSE))
    rooms = np.unique(scene.mesh.face_room[gbuffer.face[gbuffer.hit]])
    return renderer.render(view.camera, [int(room) for room in rooms if room != OUTSIDE], gbuffer.depth)


def look_all(scene: Scene, renderer: SceneRenderer, views: Sequence[View]) -> Iterator[Seen]:
    """`look` at every view, in order, with one thread per core."""
    return in_order(lambda view: look(scene, renderer, view), views)


def stored_render(run: RunContext, view: View) -> np.ndarray:
    """[h, w, 3] uint8: the render of a held-out view that `evaluate` has stored."""
    return codecs.decode_png((run.folder.path / _picture(view)).read_bytes())


def _entry(view: View) -> str:
    return f"evaluate/{view.name}"


def _picture(view: View) -> str:
    return f"heldout/{view.name}.png"


def _scene_metrics(run: RunContext, scene: Scene, painted: Painted, result: ReconstructedScene) -> dict:
    walk = navigability(scene.plan, scene.objects, run.config.navigation)
    seen = coverage(scene.plan, scene.rays, scene.views)
    return {
        "navigability": walk.share,
        "navigability_body": walk.share_body,
        "coverage_1": seen.once,
        "coverage_3": seen.three,
        "yield": painted.yield_share,
        "atm": painted.atm,
        "rooms": len(scene.plan.rooms),
        "views": len(scene.views),
        "gaussians": int(sum(len(room.opacity_logits) for room in result.rooms)),
    }


def _heldout_metrics(run: RunContext, scene: Scene, result: ReconstructedScene, heldout: HeldOut, key: str) -> dict:
    rows: list[dict[str, float]] = []
    with run.bar("evaluate", len(scene.heldout)) as bar:
        for _, members in itertools.groupby(scene.heldout, key=lambda view: view.room):
            seen = []
            for one in look_all(scene, result.renderer, list(members)):
                row = _alignment(scene, one, depth=run.config.raster.depth)
                if heldout.known:
                    row |= _photometry(one.render.rgb, heldout.truth(one.view))
                picture = codecs.encode_png(to_bytes(one.render.rgb))
                run.folder.save(_entry(one.view), key, {_picture(one.view): picture})
                rows.append(row)
                seen.append(one)
                bar.update()
            if run.config.raster.depth:
                rows += _reprojection(seen, run.config.evaluate.min_overlap)
    measured = {name for row in rows for name in row}
    return {name: _mean([row[name] for row in rows if name in row]) for name in measured}


def _photometry(rgb: np.ndarray, truth: np.ndarray) -> dict[str, float]:
    clipped, world = np.clip(rgb, 0, 1), truth.astype(np.float32) / np.float32(255)
    return {"psnr": psnr(clipped, world), "ssim": float(_ssim(clipped, world))}


def _alignment(scene: Scene, seen: Seen, *, depth: bool) -> dict[str, float]:
    """How the splats agree with the scaffold; without the errors of a depth that was not rendered."""
    holes = {"holes": _share(seen.render.alpha < HOLE, seen.gbuffer.hit)}
    return holes | _depth_errors(scene, seen) if depth else holes


def _depth_errors(scene: Scene, seen: Seen) -> dict[str, float]:
    depth = depth_error(seen.render.depth, seen.gbuffer.depth)
    surfaces = one_surface(_surface_of(scene, seen.gbuffer), seen.gbuffer.normal) & (seen.gbuffer.depth > 0)
    normal = normal_error(seen.render.depth, seen.view.camera, seen.gbuffer.normal, surfaces)
    return {"m_mae": depth.mae, "m_rmse": depth.rmse, "n_cos": normal.cosine, "n_ang_deg": normal.angle}


def _share(what: np.ndarray, where: np.ndarray) -> float:
    """Share of the pixels in `where` that are in `what`; NaN if `where` is empty."""
    return float(what[where].mean()) if where.any() else float("nan")


def _surface_of(scene: Scene, gbuffer: GBuffer) -> np.ndarray:
    """[h, w] a number for each object and for each surface kind of each room; -1 where nothing is hit."""
    mesh = scene.mesh
    structure = (mesh.face_room + 1) * len(SurfaceKind) + mesh.face_kind
    group = np.where(mesh.face_object >= 0, mesh.face_object + int(structure.max(initial=0)) + 1, structure)
    return np.where(gbuffer.hit, group[gbuffer.face], -1).astype(np.int64)


def _reprojection(seen: Sequence[Seen], min_overlap: float) -> Iterator[dict[str, float]]:
    """Reprojection errors, in both directions, of every pair of a room's views that share enough surface."""
    pairs = itertools.combinations(seen, 2)
    for rows in in_order(lambda pair: _pair(*pair, min_overlap), pairs):
        yield from rows


def _pair(a: Seen, b: Seen, min_overlap: float) -> list[dict[str, float]]:
    """Both directions of one pair. A quarter of the pixels is moved: it changes the means by less than one part in a thousand."""
    ways = ((a, b), (b, a))
    sparse = [every(SPARSE, i.gbuffer.depth, i.view.camera) for i, _ in ways]
    shared = [shared_pixels(*some, j.gbuffer.depth, j.view.camera) for some, (_, j) in zip(sparse, ways)]
    if overlap(shared[0], sparse[0][0], shared[1], sparse[1][0]) < min_overlap:
        return []
    rows = []
    for (i, j), mask in zip(ways, shared):
        error = reprojection_error(*every(SPARSE, i.render.depth, i.view.camera), j.render.depth, j.view.camera, mask)
        rows.append({"reproj_mae_norm": error.mae_norm, "reproj_absrel": error.absrel})
    return rows


def _mean(values: Sequence[float]) -> float | None:
    finite = [value for value in values if np.isfinite(value)]
    return float(np.mean(finite)) if finite else None
