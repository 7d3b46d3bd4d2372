"""What an image model is shown and what it makes of it, in every variant of the modality ablation, and what it gets wrong.

    python experiments/conditioning/run.py --scene scandinavian --room 0

Writes variants.png (a room painted in each of the four variants: condition above, result below; the same views, side by side) and
flaws.png (one view by each profile of conf/image, and each kind of violation).
"""

import argparse
import dataclasses
import pathlib

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from wm.geometry import assemble_scene, build_ray_scene, cast, object_boxes, place_cameras
from wm.offline.image.painter import ProceduralImages
from wm.offline.image.painter import Settings as ImageSettings
from wm.offline.image.violations import KINDS
from wm.run import load_config, options
from wm.schema import ConditionConfig, RunConfig
from wm.synth.attempt import PaintedView
from wm.synth.backends import Condition, ImageRequest, SceneContext
from wm.synth.furnished import furnished_context
from wm.synth.painting import PaintSettings, Scaffold, paint_scene
from wm.synth.registry import make_backend
from wm.types import OUTSIDE, View

HERE = pathlib.Path(__file__).parent
VARIANTS = ("full", "depth_objects", "depth_walls_bboxes", "depth_only")
COLUMNS = 5
CAPTION = 22  # pixels


def painted(context: SceneContext, views: list[View], image: ProceduralImages, config: RunConfig) -> dict[str, PaintedView]:
    """A room by the loop of wm.synth.painting in the variant of a configuration."""
    objects = config.condition.objects
    whole = Scaffold(build_ray_scene(assemble_scene(context.structure, context.objects)), context.objects)
    shown = context.objects if objects == "textured" else object_boxes(context.objects) if objects == "boxes" else ()
    conditioning = whole if objects == "textured" else Scaffold(
        build_ray_scene(assemble_scene(context.structure, shown)), tuple(shown)
    )
    kept: dict[str, PaintedView] = {}
    summary = paint_scene(
        views, whole, conditioning, image, make_backend("depth", config.depth), prompt=lambda *_: "", seed=config.seed,
        load=lambda view: kept.get(view.name), store=lambda view, result, gbuffer: kept.update({view.name: result}),
        settings=PaintSettings(texture=config.texture, condition=config.condition, verify=config.verify),
    )  # fmt: skip
    recalls = [one.recall for one in kept.values() if one.recall is not None]
    went = f"yield {summary.yield_share:.0%}, Atm {summary.atm:.2f}, recall {min(recalls):.2f} to {max(recalls):.2f}"
    print(f"{config.variant}: {went}", flush=True)
    return kept


def variants_sheet(context: SceneContext, views: list[View], image: ProceduralImages, scene: str, preset: str) -> Image.Image:
    bands = []
    for variant in VARIANTS:
        config = load_config([f"+scene={scene}", f"preset={preset}", f"variant={variant}"])
        kept = painted(context, views, image, config)
        bootstraps = [view.name for view in views if view.kind == "bootstrap"]
        others = [view.name for view in views if view.name not in bootstraps]
        names = bootstraps + others[:: max(len(others) // (COLUMNS - len(bootstraps)), 1)]
        cells = [[kept[name].condition, kept[name].rgb] for name in names[:COLUMNS]]
        band = np.hstack([np.vstack(cell) for cell in cells])
        bands.append(captioned(band, f"{variant}: {told(config.condition)}"))
    return Image.fromarray(np.vstack(bands))


def told(condition: ConditionConfig) -> str:
    walls = "walls with the texture so far" if condition.wall_texture else "walls as depth"
    objects = {"textured": "objects textured", "boxes": "objects as grey boxes", "none": "no objects"}[condition.objects]
    return f"X shows {walls}, {objects}; above X, below what the model makes of it"


def flaws_sheet(context: SceneContext, view: View, config: RunConfig, image: ProceduralImages) -> Image.Image:
    cells = []
    mesh = assemble_scene(context.structure, context.objects)
    gbuffer = cast(mesh, view.camera)
    truth = image.truth(view)
    things = gbuffer.hit & (mesh.face_object[gbuffer.face] != OUTSIDE)
    condition = Condition(truth, np.ones_like(gbuffer.depth), gbuffer.depth, object=things)

    def by(flaws: ImageSettings, seed: int) -> np.ndarray:
        model = dataclasses.replace(image, config=flaws)
        result = model.generate(ImageRequest(condition, None, "", view, seed))
        return np.round(result.rgb * 255).astype(np.uint8)

    plain = dataclasses.replace(config.image, drift=0.0)
    for profile in sorted(options("image"), reverse=True):
        flaws = load_config(["+scene=gothic", f"image={profile}"]).image
        calm = dataclasses.replace(flaws, **dict.fromkeys(KINDS, 0.0))
        cells.append(captioned(by(calm, 1), profile))
    cells += [captioned(by(dataclasses.replace(plain, **{kind: 1.0}), 5), kind) for kind in KINDS]
    cells.append(captioned(np.round(truth * 255).astype(np.uint8), "truth"))
    return Image.fromarray(np.vstack([np.hstack(cells[k : k + 4]) for k in range(0, len(cells), 4)]))


def captioned(picture: np.ndarray, text: str) -> np.ndarray:
    strip = Image.new("RGB", (picture.shape[1], CAPTION), "white")
    ImageDraw.Draw(strip).text((6, 3), text, fill="black", font=ImageFont.load_default(15))
    return np.vstack([np.asarray(strip), picture])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", default="scandinavian", choices=options("scene"))
    parser.add_argument("--room", type=int, default=0)
    parser.add_argument("--preset", default="draft", choices=options("preset"))
    parser.add_argument("--only", choices=("variants", "flaws"))
    arguments = parser.parse_args()
    config = load_config([f"+scene={arguments.scene}", f"preset={arguments.preset}"])
    context = furnished_context(config)
    rays = build_ray_scene(assemble_scene(context.structure, context.objects))
    views = [view for view in place_cameras(context.plan, rays, config.cameras) if view.room == arguments.room]
    image: ProceduralImages = make_backend("image", config.image, context)
    if arguments.only != "flaws":
        variants_sheet(context, views, image, arguments.scene, arguments.preset).save(HERE / "variants.png")
    if arguments.only != "variants":
        flaws_sheet(context, views[0], config, image).save(HERE / "flaws.png")


if __name__ == "__main__":
    main()
