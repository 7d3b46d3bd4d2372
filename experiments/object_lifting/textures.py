"""How far the colours of lifted furniture are from those of the furniture that was drawn, with textures and without.

python experiments/object_lifting/textures.py --rooms 3 --width 320

Compared are colours of surfaces (albedo, sRGB), without light: of the true furniture the material's at the point, of the lifted
one the texture's ("after") or the slot's ("before"). Points are those of pixels of the room's planned views, none of which the
room was lifted from, at which truth and reconstruction show a thing of one label at one depth. A point is seen if one of the two
images that the room was lifted from shows it.
"""

import argparse
import csv
import dataclasses
import time
from pathlib import Path

import numpy as np
from run import context_of

from wm.color import to_srgb
from wm.geometry.cameras.views import place_cameras
from wm.geometry.mesh.object_colors import object_colors
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.pinhole import camera_center, camera_rays, project_points
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.offline.arrangement.furnishing import furnish_scene
from wm.offline.style.theme import style_of
from wm.offline.world.pieces import build_pieces, look
from wm.run import load_config, options
from wm.schema import CameraSettings
from wm.synth.backends import SceneContext
from wm.synth.lifting.lifted import LiftedObjects, LiftedRoom
from wm.synth.lifting.lifted import Settings as LiftingSettings
from wm.synth.registry import model_settings
from wm.types import Camera, GBuffer, SceneObject

HERE = Path(__file__).parent
PRINTED = ("rug", "picture", "mat")
"""Words of what has a pattern that is not its template's."""
VIEWS = CameraSettings(width=320, height=180, perimeter=5, overhead=2)


@dataclasses.dataclass(frozen=True)
class Points:
    """Points of a room's furniture and how far off their colours are."""

    seen: np.ndarray  # [n] bool
    printed: np.ndarray  # [n] bool
    before: np.ndarray  # [n] mean of the channels' differences
    after: np.ndarray  # [n]


def compared(context: SceneContext, room: int, lifted: LiftedRoom) -> Points:
    """All planned views of a room, point by point."""
    furniture = furnish_scene(context)
    truth = [thing for thing in furniture if thing.room == room]
    everything = build_ray_scene(assemble_scene(context.structure, furniture))
    views = [
        view.camera for view in place_cameras(context.plan, everything, VIEWS) if view.room == room and view.kind != "doorway"
    ]
    parts = [_of_view(context, truth, list(lifted.things), lifted, camera) for camera in views]
    fields = [field.name for field in dataclasses.fields(Points)]
    return Points(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in fields})


def _of_view(
    context: SceneContext, truth: list[SceneObject], made: list[SceneObject], lifted: LiftedRoom, camera: Camera
) -> Points:
    buffers = [cast(build_ray_scene(assemble_scene(context.structure, things)), camera) for things in (truth, made)]
    pixel = np.flatnonzero((np.abs(buffers[0].depth - buffers[1].depth) < 0.05 + 0.02 * buffers[0].depth).ravel())
    (thing, face, place), (other, other_face, other_place) = (
        _hits(context, things, gbuffer, pixel) for things, gbuffer in zip((truth, made), buffers)
    )
    labels, other_labels = (np.array([*(thing.label for thing in things), ""]) for things in (truth, made))
    glows = np.concatenate([thing.emission[thing.face_slot] > 0 for thing in truth])
    first = np.cumsum([0] + [len(thing.faces) for thing in truth])
    kept = np.flatnonzero((thing >= 0) & (other >= 0) & (labels[thing] == other_labels[other]))
    kept = kept[~glows[first[thing[kept]] + face[kept]]]
    depth = buffers[0].depth.ravel()[pixel[kept]]
    seen = look(
        build_pieces(truth, style_of(context.theme), seed=0),
        first[thing[kept]] + face[kept],
        place[kept],
        depth / camera.focal[0],
    )
    metal = seen.albedo.max(axis=1, keepdims=True) == 0  # it scatters nothing: its colour is that of its mirror
    color = to_srgb(np.where(metal, seen.mirror, seen.albedo))
    plain = [dataclasses.replace(one, texture=None) for one in made]
    off = [
        np.abs(object_colors(things, other[kept], other_face[kept], other_place[kept]) - color).mean(axis=1)
        for things in (plain, made)
    ]
    points = camera_center(camera) + depth[:, None] * camera_rays(camera)[pixel[kept]]
    printed = np.array([any(word in label.split() for word in PRINTED) for label in labels])[thing[kept]]
    return Points(seen=_seen(points, lifted), printed=printed, before=off[0], after=off[1])


def _hits(context: SceneContext, things: list[SceneObject], gbuffer: GBuffer, pixel: np.ndarray) -> tuple:
    """(object, its face, place in it) at pixels; object -1 for structure."""
    ends = len(context.structure.faces) + np.cumsum([0] + [len(thing.faces) for thing in things])
    face = gbuffer.face.ravel()[pixel]
    thing = np.searchsorted(ends, face, side="right") - 1
    return thing, face - ends[np.maximum(thing, 0)], gbuffer.barycentric.reshape(-1, 2)[pixel]


def _seen(points: np.ndarray, lifted: LiftedRoom) -> np.ndarray:
    """[n] bool: whether one of the images shows a point."""
    seen = np.zeros(len(points), bool)
    for drawing in lifted.drawings:
        camera = drawing.camera
        pixels, depth = project_points(camera, points)
        inside = np.flatnonzero((depth > 0.1) & (pixels >= 0).all(axis=1) & (pixels < [camera.width, camera.height]).all(axis=1))
        x, y = pixels[inside].astype(int).T
        seen[inside] |= np.abs(drawing.result.drawn_depth[y, x] - depth[inside]) < 0.03 + 0.01 * depth[inside]
    return seen


def _row(name: str, points: Points) -> dict:
    """One row of the table: mean errors before and after."""
    row: dict = {"room": name}
    for group, chosen in (("", np.ones_like(points.seen)), ("printed_", points.printed)):
        for side, shown in (("seen", points.seen), ("unseen", ~points.seen)):
            here = chosen & shown
            row |= {f"{group}{side}": int(here.sum())}
            for when in ("before", "after"):
                error = getattr(points, when)[here]
                row[f"{group}{side}_{when}"] = round(float(error.mean()), 4) if here.any() else None
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rooms", type=int, default=3, help="one of each scene, then the next of each")
    parser.add_argument("--width", type=int, default=320, help="of the images that rooms are lifted from")
    parser.add_argument("--scenes", nargs="*", default=options("scene"))
    parser.add_argument("--out", type=Path, default=HERE)
    arguments = parser.parse_args()
    config = LiftingSettings(image_width=arguments.width, image_height=arguments.width * 3 // 4)
    rows = []
    for number in range(arguments.rooms):
        scene, room = arguments.scenes[number % len(arguments.scenes)], number // len(arguments.scenes)
        context = context_of(scene, 0)
        backend = LiftedObjects(config, model_settings(load_config([f"+scene={scene}", "image.texel_size=0.04"])))
        start = time.process_time()
        lifted = backend.lift(context, room)
        seconds = time.process_time() - start
        points = compared(context, room, lifted)
        backend.close()
        rows.append(_row(f"{scene} {context.plan.rooms[room].name}", points))
        print(rows[-1], f"{seconds:.1f} s of this process's time", flush=True)
    columns = [name for name in rows[0] if name.endswith(("before", "after"))]
    means = {name: round(float(np.mean([row[name] for row in rows if row[name] is not None])), 4) for name in columns}
    rows.append(dict.fromkeys(rows[0]) | {"room": "mean of the rooms"} | means)
    print(rows[-1])
    with (arguments.out / "textures.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
