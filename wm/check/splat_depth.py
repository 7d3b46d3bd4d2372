"""Whether the gaussians lie on the scaffold: their rendered depth against the mesh, by room, in held-out views."""

import numpy as np

from wm.export.records import Check
from wm.finished import FinishedRun
from wm.geometry import cast, visible_rooms
from wm.splat.scene.scene_render import SceneRenderer
from wm.stages.reconstruction import BY_ROOM
from wm.types import View

VIEWS = 2
"""Held-out views of a room that are rendered."""
WITHIN = 0.05
"""Metres by which the depth of a pixel may differ from the mesh's."""
LEAST = 0.8
"""Share of a room's pixels that must be within; draft runs reach 0.9 and more."""
_COVERED = 0.5
"""Alpha above which a pixel shows gaussians."""


def splat_depth(run: FinishedRun) -> list[Check]:
    """One check for each room; none of a run that is not fitted."""
    if not (run.folder / BY_ROOM).is_file():
        return []
    renderer = SceneRenderer(run.gaussians_by_room, run.raster)
    checks = []
    for room, name in enumerate(run.rooms):
        views = [view for view in run.heldout if view.room == room][:VIEWS]
        if views:
            share = float(np.mean([_share(run, renderer, view) for view in views]))
            what = f"depth of gaussians within {WITHIN * 100:g} cm of the mesh, {name}"
            checks.append(Check("depth", what, f"{share:.1%}", f"{LEAST:.0%}", share >= LEAST))
    return checks


def _share(run: FinishedRun, renderer: SceneRenderer, view: View) -> float:
    """The share of a view's pixels that show gaussians where the mesh is."""
    rooms = np.flatnonzero(visible_rooms(run.plan, run.scaffold, [view])[0]).tolist()
    truth, drawn = cast(run.rays, view.camera), renderer.render(view.camera, rooms)
    depth, alpha = np.asarray(drawn.depth), np.asarray(drawn.alpha)
    near = (np.abs(depth - truth.depth) <= WITHIN) & (alpha > _COVERED)
    return float(near[truth.hit].mean()) if truth.hit.any() else 1.0
