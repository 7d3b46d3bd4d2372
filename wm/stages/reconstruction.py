"""Reconstruct: gaussians from the painted views, room by room, with a checkpoint after each room and round."""

import dataclasses
from collections.abc import Iterator, Mapping, Sequence

import jax
import numpy as np

from wm import codecs, console
from wm.color import to_bytes
from wm.geometry import cast, visible_rooms
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.training import TrainingView
from wm.splat.ply import save_ply, save_point_cloud
from wm.splat.rasterizer.harmonics import SH_C0
from wm.splat.scene.scene_fit import fit_scene
from wm.splat.scene.scene_render import SceneRenderer
from wm.stages.executors import room_executor, worker_count
from wm.stages.heldout import HeldOut
from wm.stages.history import HISTORY, history_text, read_history
from wm.stages.ordered import in_order
from wm.stages.painting import Painted
from wm.stages.run_context import RunContext
from wm.stages.scene import POINTS, Scene, name_points
from wm.stages.starting import starting_gaussians
from wm.types import GAUSSIAN_FIELDS, OUTSIDE, Gaussians, GBuffer, View

SPLATS, BY_ROOM = "splats.ply", "stages/splats.npz"
CURVE_VIEWS = 2
"""Held-out views of a room that the error curve is measured on while fitting; the evaluation uses all of them."""

VISIBLE_LOGIT = float(np.log(1 / 254))
"""Of opacity 1 / 255, at or below which every rasterizer of gaussians leaves one out."""


@dataclasses.dataclass(frozen=True, eq=False)
class ReconstructedScene:
    """The fitted scene."""

    rooms: tuple[Gaussians, ...]  # by room, NumPy
    history: tuple[dict, ...]  # error against wall-clock; empty where the folder has none, or a damaged one
    key: str
    renderer: SceneRenderer  # of the rooms


def reconstruct(run: RunContext, scene: Scene, painted: Painted, heldout: HeldOut, capacity: Capacity) -> ReconstructedScene:
    """The gaussians of the scene, in `splats.ply`. The capacity is that of the warm-up: the fit runs what was compiled for it."""
    with run.stage("reconstruct"):
        config = run.config
        key = run.key("reconstruct", painted.key, config.fit, config.raster)
        if not run.folder.has("reconstruct", key):
            _fit(run, scene, painted, heldout, capacity, key)
        name_points(run)
        rooms = split_rooms(codecs.decode_arrays((run.folder.path / BY_ROOM).read_bytes()))
        return ReconstructedScene(
            rooms=rooms,
            renderer=SceneRenderer(rooms, config.raster, capacity=capacity),
            history=read_history(run.folder.path / HISTORY),
            key=key,
        )


def training_view(scene: Scene, view: View, rgb: np.ndarray, mask: np.ndarray, gbuffer: GBuffer) -> TrainingView:
    """A painted or true image with the scaffold behind it.

    A window's depth is that of its pane: the outdoors is painted on it. Left without depth, gaussians would stray out of the
    scene to show it, and the metrics, which count depth wherever the scaffold is hit, would say so.
    """
    mesh = scene.mesh
    sees = np.flatnonzero(visible_rooms(scene.plan, scene.mesh, [view])[0])
    return TrainingView(
        camera=view.camera,
        rgb=rgb,
        depth=gbuffer.depth,
        mask=mask,
        room=view.room,
        own=gbuffer.hit & (mesh.face_room[gbuffer.face] == view.room),
        normal=gbuffer.normal,
        detailed=gbuffer.hit & (mesh.face_object[gbuffer.face] != OUTSIDE),
        sees=tuple(int(room) for room in sees),
    )


def _fit(run: RunContext, scene: Scene, painted: Painted, truths: HeldOut, capacity: Capacity, key: str) -> None:
    config, folder = run.config, run.folder
    rooms = range(len(scene.plan.rooms))

    def views(room: int) -> Iterator[TrainingView]:
        for view in (view for view in scene.views if view.room == room):
            yield training_view(scene, view, *painted.picture(view), cast(scene.rays, view.camera))

    def heldout(room: int) -> list[TrainingView]:
        if not truths.known or config.fit.curve_points == 0:
            return []
        members = [view for view in scene.heldout if view.room == room][:CURVE_VIEWS]
        everywhere = np.ones((config.cameras.height, config.cameras.width), bool)
        return [training_view(scene, v, truths.truth(v), everywhere, cast(scene.rays, v.camera)) for v in members]

    def name(round_: int, room: int) -> str:
        return f"fit/{round_}-{scene.rooms[room]}"

    def file(round_: int, room: int) -> str:
        return f"stages/fit/{round_}-{scene.rooms[room]}.npz"

    def load(round_: int, room: int) -> Mapping[str, np.ndarray] | None:
        if not folder.has(name(round_, room), key):
            return None
        return codecs.decode_arrays((folder.path / file(round_, room)).read_bytes())

    def store(round_: int, room: int, arrays: Mapping[str, np.ndarray]) -> None:
        folder.save(name(round_, room), key, {file(round_, room): codecs.encode_arrays(arrays)})

    folder.drop_others("fit/", {name(r, room) for r in range(config.fit.rounds) for room in rooms})
    seeds = np.random.SeedSequence([config.seed, 1])

    def initial(room: int) -> Gaussians:
        rng = np.random.default_rng(children[room])
        return starting_gaussians(scene, room, views(room), painted.picture, cameras=config.cameras, settings=config.fit, rng=rng)

    children = seeds.spawn(len(rooms))
    start = list(in_order(initial, rooms))
    workers = worker_count(config.workers)
    with run.bar("reconstruct", len(rooms) * config.fit.steps) as bar, room_executor(config.executor, workers) as executor:

        def progress(done: int, total: int, info: dict) -> None:
            if "loss" in info:
                bar.set_postfix_str(f"{scene.rooms[info['room']]} loss {info['loss']:.4f}", refresh=False)
            bar.update(done - bar.n)

        result = fit_scene(
            start,
            lambda room: list(views(room)),
            settings=config.fit,
            raster=config.raster,
            key=jax.random.key(config.seed),
            heldout=heldout,
            load=load,
            store=store,
            progress=progress,
            capacity=capacity,
            devices=jax.devices()[:1],  # for all rooms: a step is compiled once, and XLA runs calls of threads side by side
            executor=executor,
            workers=workers,
        )
    for line in result.stopped:
        console.say(f"reconstruct: {line}")
    folder.write(HISTORY, history_text(dataclasses.asdict(point) for point in result.history))
    folder.save(
        "reconstruct",
        key,
        {
            BY_ROOM: codecs.encode_arrays(_join(result.gaussians)),
            POINTS: lambda path: save_point_cloud(path, *points_of(start)),
            SPLATS: lambda path: save_ply(path, visible_gaussians(result.gaussians), antialias=config.raster.antialias),
        },
    )
    folder.drop_others("fit/", set())


def points_of(rooms: Sequence[Gaussians]) -> tuple[np.ndarray, np.ndarray]:
    """The centres [p, 3] of the initial gaussians of all rooms, in order, and their colours [p, 3] uint8."""
    colors = np.concatenate([0.5 + SH_C0 * np.asarray(room.sh[:, 0]) for room in rooms])
    return np.concatenate([np.asarray(room.means) for room in rooms]), to_bytes(colors[:, None])[:, 0]


def visible_gaussians(rooms: Sequence[Gaussians]) -> Gaussians:
    """All rooms in order, without the gaussians that refinement has left with an opacity that no program draws."""
    merged = jax.tree.map(lambda *leaves: np.concatenate(leaves), *rooms)
    return jax.tree.map(lambda leaf: leaf[is_visible(merged)], merged)


def is_visible(gaussians: Gaussians) -> np.ndarray:
    """[n] bool: which gaussians some program draws."""
    return np.asarray(gaussians.opacity_logits) > VISIBLE_LOGIT


def _join(rooms: Sequence[Gaussians]) -> dict[str, np.ndarray]:
    return {f"{k:05d}.{leaf}": getattr(room, leaf) for k, room in enumerate(rooms) for leaf in GAUSSIAN_FIELDS}


def split_rooms(arrays: Mapping[str, np.ndarray]) -> tuple[Gaussians, ...]:
    """The gaussians of each room, from the arrays of BY_ROOM."""
    rooms = sorted({name.split(".")[0] for name in arrays})
    return tuple(Gaussians(**{leaf: arrays[f"{room}.{leaf}"] for leaf in GAUSSIAN_FIELDS}) for room in rooms)
