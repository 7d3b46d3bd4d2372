"""Stage `paint`: an image for every view. Each is an entry of the run folder, so a killed run resumes at the next view."""

import dataclasses
import functools
import json
from collections.abc import Callable

import numpy as np

from wm import codecs, console
from wm.artifacts.digests import json_text
from wm.geometry import assemble_scene, atlas_nodes, build_ray_scene, object_boxes
from wm.geometry.mesh.glb import save_glb
from wm.geometry.mesh.glb_lights import house_lights
from wm.geometry.mesh.glb_nodes import object_nodes
from wm.geometry.plan.site import room_site
from wm.geometry.texture.atlas_export import coarse_rooms
from wm.schema import RunConfig
from wm.stages.run_context import RunContext
from wm.stages.scene import Scene
from wm.synth.backends import DepthBackend, ImageBackend
from wm.synth.painting import PaintedView, PaintSettings, PaintSummary, Scaffold, paint_scene
from wm.synth.prompts import ViewPrompt, image_prompt
from wm.synth.registry import backend_key
from wm.synth.sights import sights
from wm.types import SceneObject, View

SCAFFOLD = "scaffold.glb"
SUMMARY = "stages/paint.json"
_ORDER = "anchors first, then each room by itself"
"""Part of the key: views of folders of older versions were painted in another order."""
_SHOWN = "bootstrap"
"""Kind of the views that are cameras of `scaffold.glb`: two a room, which show most of it."""
_NOTED = ("model", "model_version", "seed")
"""What the manifest says of how a view was made; `views/*.json` says all of it."""


@dataclasses.dataclass(frozen=True, eq=False)
class Painted:
    """The result of the painting: its yield and attempts, its key, and access to each stored view."""

    yield_share: float
    atm: float | None
    key: str
    run: RunContext

    def view(self, view: View) -> PaintedView:
        """A finished view, read from the run folder."""
        return read_view(self.run, view)

    def picture(self, view: View) -> tuple[np.ndarray, np.ndarray]:
        """Only the image [h, w, 3] uint8 of a finished view and its usable pixels [h, w] bool."""
        return _read_picture(self.run, view)


def paint(run: RunContext, scene: Scene, image: ImageBackend, depth: DepthBackend) -> Painted:
    """Paints and stores all views, and exports the textured scaffold."""
    with run.stage("paint"):
        return _paint(run, scene, image, depth)


def is_painted(run: RunContext, scene: Scene) -> bool:
    """Whether the run folder holds every painted view and the textured scaffold."""
    key = paint_key(run, scene)
    return all(run.folder.has(name, key) for name in ("paint", *map(_entry, scene.views)))


def paint_key(run: RunContext, scene: Scene) -> str:
    """The key of every entry of the painting."""
    config = run.config
    shown = (config.cameras, config.texture, config.condition, config.verify, config.finish, config.light)
    return run.key("paint", _ORDER, scene.key, config.scene.theme, *shown, *backend_key(config.image), *backend_key(config.depth))


def _entry(view: View) -> str:
    return f"paint/{view.name}"


def _paint(run: RunContext, scene: Scene, image: ImageBackend, depth: DepthBackend) -> Painted:
    config, key = run.config, paint_key(run, scene)
    settings = PaintSettings(texture=config.texture, condition=config.condition, verify=config.verify)
    names = {_entry(view) for view in scene.views}
    if is_painted(run, scene):
        summary = json.loads((run.folder.path / SUMMARY).read_text(encoding="utf-8"))
        return Painted(yield_share=summary["yield"], atm=summary["atm"], key=key, run=run)
    run.folder.drop_others("paint/", names)
    run.services.views = sum(not run.folder.has(_entry(view), key) for view in scene.views)
    scaffold = Scaffold(scene=scene.rays, objects=scene.objects)
    with run.bar("paint", len(scene.views)) as bar:

        def show(view: View, painted: PaintedView) -> None:
            bar.set_postfix_str(view.name, refresh=False)
            bar.update()

        result = paint_scene(
            scene.views,
            scaffold,
            _conditioning(scene, scaffold, config.condition.objects),
            image,
            depth,
            prompt=_prompts(scene, config),
            seed=config.seed,
            load=lambda view: read_view(run, view) if run.folder.has(_entry(view), key) else None,
            store=lambda view, painted, gbuffer: _store(run, scene, key, view, painted, gbuffer.depth),
            settings=settings,
            progress=show,
        )
    _export(run, scene, result, key)
    return Painted(yield_share=result.yield_share, atm=result.atm, key=key, run=run)


def read_view(run: RunContext, view: View) -> PaintedView:
    """Reads a stored view."""
    base = run.folder.path / "views"
    record = json.loads((base / f"{view.name}.json").read_text(encoding="utf-8"))["painted"]
    rgb, mask = _read_picture(run, view)
    condition = codecs.decode_png((base / f"{view.name}.condition.png").read_bytes())
    return PaintedView(rgb=rgb, mask=mask, condition=condition, **record)


def _read_picture(run: RunContext, view: View) -> tuple[np.ndarray, np.ndarray]:
    base = run.folder.path / "views"
    rgb = codecs.decode_png((base / f"{view.name}.png").read_bytes())
    return rgb, codecs.decode_mask((base / f"{view.name}.mask.png").read_bytes())


def _store(run: RunContext, scene: Scene, key: str, view: View, painted: PaintedView, depth: np.ndarray) -> None:
    record = {name: getattr(painted, name) for name in ("recall", "attempts", "accepted", "reference", "made_by")}
    frame = codecs.camera_frame(view, scene.rooms[view.room])
    base = f"views/{view.name}"
    files = {
        f"{base}.png": codecs.encode_png(painted.rgb),
        f"{base}.mask.png": codecs.encode_mask(painted.mask),
        f"{base}.condition.png": codecs.encode_png(painted.condition),
        f"{base}.depth.png": codecs.encode_depth(depth),
        f"{base}.json": json_text({"camera": frame, "painted": record}),
    }
    told = {name: value for name, value in painted.made_by.items() if name in _NOTED}
    run.folder.save(_entry(view), key, files, {"backend": run.config.image.backend, **told})


def _conditioning(scene: Scene, scaffold: Scaffold, objects: str) -> Scaffold:
    """The scaffold that the image model is shown: the true one, one with boxes for objects, or one without objects.

    Source: WorldMesh, the ablation of the conditioning modalities.
    """
    if objects == "textured" or not scene.objects:
        return scaffold
    shown: tuple[SceneObject, ...] = object_boxes(scene.objects) if objects == "boxes" else ()
    return Scaffold(scene=build_ray_scene(assemble_scene(scene.context.structure, shown)), objects=shown)


def _prompts(scene: Scene, config: RunConfig) -> Callable[[View, bool], ViewPrompt]:
    """A function that returns the prompt of a view, given the view and whether it has a style reference."""
    sites = functools.cache(functools.partial(room_site, scene.plan))

    def prompt(view: View, has_reference: bool) -> ViewPrompt:
        seen = sights(view.camera, sites(view.room))
        name, shown = scene.plan.rooms[view.room].name, config.condition.objects
        text = image_prompt(config.scene.theme, name, seen, objects=shown, has_reference=has_reference)
        return ViewPrompt(text=text, theme=config.scene.theme, room=name, sights=tuple(seen))

    return prompt


def _export(run: RunContext, scene: Scene, result: PaintSummary, key: str) -> None:
    """Writes `scaffold.glb`: rooms with their painted texture, every object as a node of its own, lights, and some cameras."""
    nodes = [*atlas_nodes(result.atlas, scene.context.structure, scene.rooms), *object_nodes(scene.objects, scene.rooms)]
    lights, views = house_lights(scene.plan, scene.objects), [view for view in scene.views if view.kind == _SHOWN]
    for room in coarse_rooms(result.atlas):
        console.say(f"{SCAFFOLD}: surfaces of {scene.rooms[room]} that no image holds at {result.atlas.texel_size} m are coarser")
    run.folder.save(
        "paint",
        key,
        {
            SCAFFOLD: lambda path: save_glb(path, nodes, lights=lights, views=views),
            SUMMARY: json_text({"yield": result.yield_share, "atm": result.atm, "order": list(result.order)}),
        },
    )
