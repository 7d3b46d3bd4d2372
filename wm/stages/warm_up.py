"""Warm-up: the functions that the fit is going to run are compiled while the views are painted.

Compiling a step of the fit takes as long as fifty steps, and painting, which is NumPy for the most part, leaves half a core idle.
So one step is taken in advance, in a thread: for the room with the most gaussians, since all rooms are padded to its size, from
its true initial cloud (which depends on the scaffold alone, but for the colours) toward a black image. Only the compiled
functions and the capacity of plans that they are compiled for are kept, so a wrong guess of the room costs time and changes no
result.
"""

import dataclasses
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager

import jax
import numpy as np

from wm import console
from wm.geometry import cast
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.host import cores
from wm.schema import FitSettings, RunConfig
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.training import TrainingView
from wm.splat.scene.scene_fit import fit_scene
from wm.stages.reconstruction import training_view
from wm.stages.run_context import RunContext
from wm.stages.scene import Scene
from wm.stages.starting import starting_gaussians
from wm.types import OUTSIDE, Gaussians, View

CONTENDERS = 0.8
"""Share of the largest estimate from which a room's cloud is made: the estimate is that good."""


@contextmanager
def warming_up(run: RunContext, scene: Scene, capacity: Capacity, *, needed: bool) -> Iterator[None]:
    """The warm-up runs in a thread beside the block if it is needed and there is a second core."""
    if not needed or cores() == 1 or not scene.views:
        yield
        return
    pool = ThreadPoolExecutor(1, thread_name_prefix="wm-warm-up")
    try:
        pool.submit(warm_up, run, scene, capacity).add_done_callback(_tell)
        yield
    finally:
        pool.shutdown(wait=False)  # a fit of the same shapes waits for the compilation, nobody else needs to


def warm_up(run: RunContext, scene: Scene, capacity: Capacity) -> None:
    """One step of the room with the most gaussians, and one held-out render; raises the capacity to what they need."""
    settings = run.config.fit
    clouds = {room: _cloud(scene, room, run.config) for room in contenders(scene, settings)}
    room = max(clouds, key=lambda room: len(clouds[room].opacity_logits))
    nothing = jax.tree.map(lambda x: x[:0], clouds[room])
    first = next(_blank_views(scene, room))
    fit_scene(
        [clouds[room] if k == room else nothing for k in range(len(scene.rooms))],
        lambda k: [first] if k == room else [],
        settings=dataclasses.replace(settings, steps=1, rounds=1, curve_points=1, batch=1, refine_every=0),
        raster=run.config.raster,
        key=jax.random.key(0),
        heldout=lambda k: [first],
        capacity=capacity,
        devices=jax.devices()[:1],
        workers=1,
    )


def _tell(warmed: Future) -> None:
    error = warmed.exception()
    if error is not None:
        console.warn(f"warm-up of the fit: {type(error).__name__}: {error}; the fit compiles for itself")


def contenders(scene: Scene, settings: FitSettings) -> list[int]:
    """Rooms that may have the most gaussians, by the area of their surfaces over that of a gaussian's cell.

    Half of an object's surface counts: the other half faces the wall, the floor, or its inside.
    """
    mesh = scene.mesh
    corners = mesh.vertices[mesh.faces]
    area = 0.5 * np.linalg.norm(face_crosses(corners), axis=1)
    cells = np.where(mesh.face_object != OUTSIDE, 0.5 * area / settings.detail_spacing**2, area / settings.spacing**2)
    inside = mesh.face_room != OUTSIDE
    painted = sorted({view.room for view in scene.views})
    estimate = np.bincount(mesh.face_room[inside], cells[inside], minlength=len(scene.rooms))[painted]
    return [room for room, cells in zip(painted, estimate) if cells >= CONTENDERS * estimate.max()]


def _cloud(scene: Scene, room: int, config: RunConfig) -> Gaussians:
    rng = np.random.default_rng(0)
    return starting_gaussians(scene, room, _blank_views(scene, room), None, cameras=config.cameras, settings=config.fit, rng=rng)


def _blank_views(scene: Scene, room: int) -> Iterator[TrainingView]:
    """The training views of a room before they are painted: black, and all of them usable."""
    for view in scene.views:
        if view.room == room:
            yield _blank(scene, view)


def _blank(scene: Scene, view: View) -> TrainingView:
    size = (view.camera.height, view.camera.width)
    return training_view(scene, view, np.zeros((*size, 3), np.uint8), np.ones(size, bool), cast(scene.rays, view.camera))
