"""Stages `plan`, `structure`, `furnish` and `cameras`: everything that is fixed before the first view is painted."""

import dataclasses
import json
import pathlib

from wm import codecs
from wm.artifacts import file_digest, json_text
from wm.geometry import (
    FloorPlan,
    RayScene,
    assemble_scene,
    build_ray_scene,
    load_plan,
    parse_plan,
    place_cameras,
    place_heldout,
    plan_to_json,
)
from wm.stages.run_context import RunContext
from wm.synth.backends import SceneContext
from wm.synth.furnished import bare_context, make_furnisher
from wm.synth.proposing import propose_plan
from wm.synth.registry import backend_key, make_backend
from wm.types import Mesh, SceneObject, View

PLAN, LAYOUT, OBJECTS, OBJECT_ARRAYS, CAMERAS = "plan.json", "layout.json", "objects.json", "stages/objects.npz", "cameras.json"
HELDOUT_CAMERAS, POINTS = "cameras.heldout.json", "points.ply"


@dataclasses.dataclass(frozen=True, eq=False)
class Scene:
    """The scaffold and its cameras."""

    plan: FloorPlan
    context: SceneContext
    mesh: Mesh  # structure and objects
    rays: RayScene
    views: tuple[View, ...]
    heldout: tuple[View, ...]
    key: str

    @property
    def objects(self) -> tuple[SceneObject, ...]:
        return self.context.objects

    @property
    def rooms(self) -> list[str]:
        return [room.id for room in self.plan.rooms]


def build_scene(run: RunContext) -> Scene:
    """Builds the scene of a run. What the run folder already holds is read from there."""
    with run.stage("plan"):
        plan, plan_key = _plan(run)
    with run.stage("structure"):
        context = bare_context(run.config, plan)
    with run.stage("furnish"):
        objects, key = _furnish(run, context, plan_key)
        context = dataclasses.replace(context, objects=objects)
        mesh = assemble_scene(context.structure, objects)
        rays = build_ray_scene(mesh)
    with run.stage("cameras"):
        views, heldout = _cameras(run, plan, rays)
    return Scene(plan=plan, context=context, mesh=mesh, rays=rays, views=views, heldout=heldout, key=key)


def _plan(run: RunContext) -> tuple[FloorPlan, str]:
    config = run.config
    file = config.plan.file
    source = [file_digest(_user_file(file))] if file else [config.scene.theme, config.scene.rooms, *backend_key(config.language)]
    key = run.key("plan", *source, config.plan.max_iterations)
    if not run.folder.has("plan", key):
        if file:
            plan = load_plan(pathlib.Path(file))
            layout = {"source": "file", "iterations": 0, "seconds": 0.0}
        else:
            backend = make_backend("language", config.language)
            proposal = propose_plan(
                backend, config.scene.theme, list(config.scene.rooms), seed=config.seed, max_iterations=config.plan.max_iterations
            )
            plan = proposal.plan
            layout = {"source": config.language.backend, "iterations": proposal.iterations, "seconds": round(proposal.seconds, 3)}
        # The time that the layout took is not part of the plan's entry, so that equal runs have equal manifests.
        run.folder.write(LAYOUT, json_text(layout))
        run.folder.save("plan", key, {PLAN: plan_to_json(plan)})
    return parse_plan((run.folder.path / PLAN).read_text(), PLAN), key


def _user_file(file: str) -> pathlib.Path:
    path = pathlib.Path(file)
    if not path.is_file():
        load_plan(path)  # raises the error that says what is wrong with the path
    return path


def _furnish(run: RunContext, context: SceneContext, plan_key: str) -> tuple[tuple[SceneObject, ...], str]:
    config = run.config
    furnisher = make_furnisher(config, context)
    key = run.key("furnish", plan_key, config.furnish, config.scene.theme, *furnisher.keys)
    if not config.furnish.enabled:
        return (), key
    if not run.folder.has("furnish", key):
        with run.bar("furnish", len(context.plan.rooms)) as bar:
            objects = furnisher.furnish(context, done=bar.update)
        summary = codecs.object_summary(objects, [room.id for room in context.plan.rooms])
        run.folder.save("furnish", key, {OBJECT_ARRAYS: codecs.encode_objects(objects), OBJECTS: json_text(summary)})
    return codecs.decode_objects((run.folder.path / OBJECT_ARRAYS).read_bytes()), key


def _cameras(run: RunContext, plan: FloorPlan, rays: RayScene) -> tuple[tuple[View, ...], tuple[View, ...]]:
    settings = run.config.cameras
    views = tuple(place_cameras(plan, rays, settings))
    heldout = tuple(place_heldout(plan, rays, views, settings))
    rooms = [room.id for room in plan.rooms]
    frames = codecs.transforms_json(views, rooms, POINTS)
    apart = codecs.heldout_json(heldout, rooms, "heldout/{}.truth.png")
    key = run.key("cameras", settings, json.dumps([frames, apart]))
    run.folder.save("cameras", key, {CAMERAS: json_text(frames), HELDOUT_CAMERAS: json_text(apart)})
    return views, heldout
