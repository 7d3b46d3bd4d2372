"""Stages `plan`, `structure`, `furnish` and `cameras`: everything that is fixed before the first view is painted."""

import dataclasses
import json
import pathlib

from wm import codecs, console
from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import file_digest, json_text
from wm.geometry import (
    FloorPlan,
    RayScene,
    assemble_scene,
    build_ray_scene,
    place_cameras,
    place_heldout,
    plan_to_json,
)
from wm.geometry.plan.loading import read_plan_file, stored_plan
from wm.schema import ObjectsSettings, RunConfig
from wm.stages import edits
from wm.stages.arranged import ArrangementError, arranged, is_json
from wm.stages.hearing import hear
from wm.stages.run_context import RunContext
from wm.stages.unfurnished import unfurnished
from wm.synth.backends import ImageDrivenBackend, SceneContext
from wm.synth.furnished import Furnisher, bare_context, make_furnisher
from wm.synth.lifting.drawings import drawing_files
from wm.synth.object_ids import with_ids
from wm.synth.proposing import propose_plan
from wm.synth.registry import backend_key, make_backend
from wm.synth.room_names import unknown_rooms
from wm.synth.seeds import seed_of
from wm.types import Mesh, SceneObject, View

PLAN, LAYOUT, OBJECTS, OBJECT_ARRAYS, CAMERAS = "plan.json", "layout.json", "objects.json", "stages/objects.npz", "cameras.json"
_FORMAT = "ids"
"""Part of the furniture's key: older run folders hold objects without ids."""
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
    heard: str = ""  # what was made of the theme's words, in one line

    @property
    def objects(self) -> tuple[SceneObject, ...]:
        return self.context.objects

    @property
    def rooms(self) -> list[str]:
        return [room.id for room in self.plan.rooms]


def build_scene(run: RunContext) -> Scene:
    """Builds the scene of a run. What the run folder already holds is read from there."""
    heard = hear(run)
    if heard:
        console.say(f"theme: {heard}")
    with run.stage("plan"):
        plan, plan_key = _plan(run)
    with run.stage("structure", stores=False):
        context = bare_context(run.config, plan)
    with run.stage("furnish"):
        objects, key = _furnish(run, context, plan_key)
        context = dataclasses.replace(context, objects=objects)
        mesh = assemble_scene(context.structure, objects)
        rays = build_ray_scene(mesh)
    with run.stage("cameras"):
        views, heldout = _cameras(run, plan, rays)
    return Scene(plan=plan, context=context, mesh=mesh, rays=rays, views=views, heldout=heldout, key=key, heard=heard)


def _plan(run: RunContext) -> tuple[FloorPlan, str]:
    config = run.config
    file = config.plan.file
    mends = {"repair": config.plan.repair, "unreachable": config.plan.unreachable, "storey": config.plan.storey}
    mended = ["repair"] * config.plan.repair + ([] if config.plan.storey is None else ["storey", config.plan.storey])
    source = (
        [file_digest(_user_file(file)), *mended]
        if file
        else [config.scene.theme, config.scene.rooms, *backend_key(config.language)]
    )
    seed = seed_of(config, "plan")
    key = run.key("plan", *source, config.plan.max_iterations, seed)
    edited = edits.edited_key(run, "plan", PLAN, key)
    if edited is not None and is_json((run.folder.path / PLAN).read_bytes()):
        plan, _ = _told(run.folder.path / PLAN, repair=False, unreachable=config.plan.unreachable)  # read again as it stands
        edits.accept(run, "plan", edited, [PLAN], "structure, furniture, cameras and all that follows are made again")
        return plan, edited
    if not run.folder.has("plan", key):
        if file:
            plan, notes = _told(pathlib.Path(file), **mends)
            layout = {"source": "file", "iterations": 0, "seconds": 0.0, "notes": list(notes)}
        else:
            backend = make_backend("language", config.language, services=run.services)
            proposal = propose_plan(
                backend, config.scene.theme, list(config.scene.rooms), seed=seed, max_iterations=config.plan.max_iterations
            )
            plan = proposal.plan
            layout = {"source": config.language.backend, "iterations": proposal.iterations, "seconds": round(proposal.seconds, 3)}
        text = plan_to_json(plan)
        edits.keep_copy(run, "plan", PLAN, text)
        # The time that the layout took is not part of the plan's entry, so that equal runs have equal manifests.
        run.folder.write(LAYOUT, json_text(layout))
        run.folder.save("plan", key, {PLAN: text})
    return stored_plan(run.folder.path / PLAN), key


def _told(file: pathlib.Path, *, repair: bool, unreachable: str, storey: str | None = None) -> tuple[FloorPlan, tuple[str, ...]]:
    """A user's plan, and what is not read of it, may not be meant or was changed in it, which is said too."""
    reading = read_plan_file(file, repair=repair, unreachable=unreachable, storey=storey)
    for note in reading.notes:
        console.say(f"{file}: {note}")
    return reading.plan, reading.notes


def _user_file(file: str) -> pathlib.Path:
    path = pathlib.Path(file)
    if not path.is_file():
        read_plan_file(path)  # raises the error that says what is wrong with the path
    return path


def _furnish(run: RunContext, context: SceneContext, plan_key: str) -> tuple[tuple[SceneObject, ...], str]:
    config = run.config
    file = _arrangement_file(config)
    furnisher = make_furnisher(config, context, run.services, run.folder.path)
    rearranged = [file_digest(_existing(file))] if file is not None else []
    made_of = (_FORMAT, plan_key, *_meshes(context.plan), config.furnish, config.scene.theme, *furnisher.keys)
    key = run.key("furnish", *made_of, *rearranged)
    if not config.furnish.enabled and not context.objects:
        return (), key
    arrangement = run.folder.path / OBJECTS
    edited = edits.edited_key(run, "furnish", OBJECTS, key)
    if edited is not None and is_json(arrangement.read_bytes()):
        objects = arranged(_furnished(run, context, furnisher), arrangement.read_bytes(), context.plan, str(arrangement))
        consequence = "cameras, paintings and all that follows are made again"
        edits.accept(run, "furnish", edited, [OBJECT_ARRAYS, *_drawings(run, furnisher), OBJECTS], consequence)
        return objects, edited
    if not run.folder.has("furnish", key):
        objects = made = _made(run, context, furnisher)
        if file is not None:
            objects = arranged(made, _existing(file).read_bytes(), context.plan, file)
        text = json_text(codecs.object_summary(objects, [room.id for room in context.plan.rooms]))
        edits.keep_copy(run, "furnish", OBJECTS, text)
        files = {OBJECT_ARRAYS: codecs.encode_objects(made), OBJECTS: text}
        for name, content in files.items():
            run.folder.write(name, content)
        run.folder.record("furnish", key, [*files, *_drawings(run, furnisher)])
    made = codecs.decode_objects((run.folder.path / OBJECT_ARRAYS).read_bytes())
    return arranged(made, arrangement.read_bytes(), context.plan, str(arrangement)), key


def _made(run: RunContext, context: SceneContext, furnisher: Furnisher) -> tuple[SceneObject, ...]:
    """All objects of the scene, with ids: those that the plan lists, and, where it is furnished, those of the backend."""
    rooms = [room.id for room in context.plan.rooms]
    if not run.config.furnish.enabled:
        return with_ids(context.objects, rooms)
    unknown = ", ".join(map(repr, unknown_rooms(room.name for room in context.plan.rooms)))
    if unknown:
        console.say(f"furnish: no use is known of rooms named {unknown}; the offline backends furnish them sparsely")
    with run.bar("furnish", len(context.plan.rooms)) as bar:
        objects = furnisher.furnish(context, done=bar.update)
    if isinstance(furnisher.backend, ImageDrivenBackend):
        for line in unfurnished(run.folder.path, context.plan, objects):
            console.say(f"furnish: {line}")
    return with_ids(objects, rooms)


def _furnished(run: RunContext, context: SceneContext, furnisher: Furnisher) -> tuple[SceneObject, ...]:
    """The objects that an edited arrangement refers to; made again where their file is not whole."""
    entry, arrays = run.folder.entry("furnish"), run.folder.path / OBJECT_ARRAYS
    if entry is None or not arrays.is_file() or entry["files"].get(OBJECT_ARRAYS) != file_digest(arrays):
        write_atomically(arrays, codecs.encode_objects(_made(run, context, furnisher)))
    return codecs.decode_objects(arrays.read_bytes())


def _drawings(run: RunContext, furnisher: Furnisher) -> list[str]:
    """The files of the images that the furniture was lifted from."""
    return drawing_files(run.folder.path) if isinstance(furnisher.backend, ImageDrivenBackend) else []


def _meshes(plan: FloorPlan) -> list[str]:
    """Digests of the mesh files that the plan names."""
    return [file_digest(pathlib.Path(thing.mesh)) for thing in plan.objects if thing.mesh is not None]


def _arrangement_file(config: RunConfig) -> str | None:
    return config.objects.file if isinstance(config.objects, ObjectsSettings) else None


def _existing(file: str) -> pathlib.Path:
    path = pathlib.Path(file)
    if not path.is_file():
        raise ArrangementError(f"objects.file={file}: there is no such file; give an objects.json as a run writes it")
    return path


def _cameras(run: RunContext, plan: FloorPlan, rays: RayScene) -> tuple[tuple[View, ...], tuple[View, ...]]:
    settings = run.config.cameras
    views = tuple(place_cameras(plan, rays, settings))
    heldout = tuple(place_heldout(plan, rays, views, settings))
    rooms = [room.id for room in plan.rooms]
    frames = codecs.transforms_json(views, rooms)
    apart = codecs.heldout_json(heldout, rooms, "heldout/{}.truth.png")
    key = run.key("cameras", settings, json.dumps([frames, apart]))
    if not run.folder.has("cameras", key):
        run.folder.save("cameras", key, {CAMERAS: json_text(frames), HELDOUT_CAMERAS: json_text(apart)})
    name_points(run)
    return views, heldout


def name_points(run: RunContext) -> None:
    """Makes `cameras.json` name the point cloud where the folder has one, and only there: a stopped run has none yet."""
    entry, path = run.folder.entry("cameras"), run.folder.path / CAMERAS
    if entry is None:
        return
    told = json.loads(path.read_text(encoding="utf-8"))
    reconstructed = run.folder.entry("reconstruct")
    has_points = reconstructed is not None and POINTS in reconstructed["files"] and (run.folder.path / POINTS).is_file()
    if (told.get("ply_file_path") == POINTS) != has_points:
        told.pop("ply_file_path", None)
        named = told | ({"ply_file_path": POINTS} if has_points else {})
        run.folder.write(CAMERAS, json_text(named))
        run.folder.record("cameras", entry["key"], list(entry["files"]))
