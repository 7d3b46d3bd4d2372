"""SpatialGen's input of a room: sixteen views on a circle, 90 degrees wide, in the folders that its loader reads.

    spatialgen/ROOM/rgb/frame_KK.jpg               the painted scaffold
                    depth/frame_KK.png             its depth, 16 bits of millimetres
                    semantic/frame_KK.jpg          its things, by class
                    layout_semantic/frame_KK.jpg   shell and boxes, by class
                    layout_depth/frame_KK.png      their depth
                    cameras.json                   width, height, intrinsic [9], cameras {KK: camera to world [16], OpenCV's axes}
                    room_layout.json               the boxes
    spatialgen/test_split.txt                      the rooms, one a line
    spatialgen/captions.jsonl                      the prompt of each

The first view is the one that conditions the others. Axes are ours: z up, metres.
Source: manycore-research/SpatialGen, src/data/example_loader.py (`get_spatialgen_item`), commit 677c1168.
"""

import io
import json
import pathlib

import numpy as np
from jaxtyping import Float, Num, UInt8
from PIL import Image

from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import json_text
from wm.color import to_bytes
from wm.compare.axes import UP, moved_camera, rotation_matrix, upright
from wm.compare.inputs.classes import CEILING, FLOOR, WALL, WINDOW, Color, class_of
from wm.compare.inputs.layout import RoomLayout, room_layout
from wm.compare.inputs.standing import standing_place
from wm.compare.painted_mesh import PaintedMesh, read_painted_mesh, see
from wm.finished import FinishedRun
from wm.geometry import cast
from wm.geometry.cameras.air import free
from wm.geometry.rays.pinhole import camera_center, make_camera
from wm.types import OUTSIDE, Camera, SurfaceKind

VIEWS, SIDE, FOV = 16, 512, 90.0
RADII = (0.5, 0.35, 0.2, 0.1)  # metres of the circle that are tried, until all its places are free; else all stand at its middle
CLEARANCE = 0.2  # metres of free air round each
FARTHEST = 65.535  # metres, of 16 bits of millimetres
_KINDS: dict[int, Color] = {SurfaceKind.FLOOR: FLOOR, SurfaceKind.CEILING: CEILING, SurfaceKind.PANE: WINDOW}


def write_spatialgen(run: FinishedRun, folder: pathlib.Path) -> list[pathlib.Path]:
    """Writes the views of every room; returns the folders of the rooms. Raises: InputError where a room has no free place."""
    painted = read_painted_mesh(run.scaffold_file)
    rooms = [_room(run, painted, room, folder / name) for room, name in enumerate(run.rooms)]
    write_atomically(folder / "test_split.txt", "".join(f"{name}\n" for name in run.rooms))
    rows = [json.dumps({"room_uid": name, "style": "", "prompt": run.theme}, sort_keys=True) for name in run.rooms]
    write_atomically(folder / "captions.jsonl", "\n".join(rows) + "\n")
    return rooms


def circle(run: FinishedRun, room: int) -> list[Camera]:
    """The views of a room, counter-clockwise from above, looking outwards."""
    middle = standing_place(run, room)
    angles = np.arange(VIEWS) * 2 * np.pi / VIEWS
    outwards = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(VIEWS)])
    circles = (middle + radius * outwards for radius in RADII)
    eyes = next((places for places in circles if free(run.rays, places, CLEARANCE).all()), middle + 0 * outwards)
    return [make_camera(eye, eye + ahead, width=SIDE, height=SIDE, fov_deg=FOV) for eye, ahead in zip(eyes, outwards)]


def _room(run: FinishedRun, painted: PaintedMesh, room: int, folder: pathlib.Path) -> pathlib.Path:
    cameras = circle(run, room)
    eyes = np.array([camera_center(camera) for camera in cameras])
    layout = room_layout(run, room, around=eyes)
    for k, camera in enumerate(cameras):
        _view(run, painted, layout, camera, folder, f"frame_{k:02d}")
    write_atomically(folder / "cameras.json", json_text(_cameras(cameras)))
    write_atomically(folder / "room_layout.json", json_text(_boxes(layout)))
    return folder


def _view(run: FinishedRun, painted: PaintedMesh, layout: RoomLayout, camera: Camera, folder: pathlib.Path, name: str) -> None:
    seen = see(painted, moved_camera(camera, rotation_matrix(upright(UP["y"]))))  # glTF's y is up
    scene, shell = cast(run.rays, camera), cast(layout.rays, camera)
    pictures = {
        f"rgb/{name}.jpg": jpeg(to_bytes(np.asarray(seen.rgb))),
        f"depth/{name}.png": millimetres(scene.depth),
        f"semantic/{name}.jpg": jpeg(_semantic(run, scene.face)),
        f"layout_semantic/{name}.jpg": jpeg(_painted(layout.face_color, shell.face)),
        f"layout_depth/{name}.png": millimetres(shell.depth),
    }
    for file, content in pictures.items():
        write_atomically(folder / file, content, sync_first=False)


def _semantic(run: FinishedRun, face: np.ndarray) -> UInt8[np.ndarray, "h w 3"]:
    """Colours of the classes of what is hit."""
    mesh = run.scaffold
    of_kind = np.array([_KINDS.get(kind, WALL) for kind in range(len(SurfaceKind))], np.uint8)
    colors = of_kind[mesh.face_kind]
    things = mesh.face_object != OUTSIDE
    if things.any():
        of_thing = np.array([class_of(thing.label)[1] for thing in run.objects], np.uint8)
        colors[things] = of_thing[mesh.face_object[things]]
    return _painted(colors, face)


def _painted(face_color: UInt8[np.ndarray, "f 3"], face: np.ndarray) -> UInt8[np.ndarray, "h w 3"]:
    return np.where((face >= 0)[..., None], face_color[face], np.uint8(0))


def _cameras(cameras: list[Camera]) -> dict[str, object]:
    """Keys have two digits, since the loader takes them in the order of the file."""
    focal = float(cameras[0].focal[0])
    poses = {f"{k:02d}": np.linalg.inv(camera.T_cam_world).round(9).reshape(-1).tolist() for k, camera in enumerate(cameras)}
    intrinsic = [focal, 0.0, SIDE / 2, 0.0, focal, SIDE / 2, 0.0, 0.0, 1.0]
    return {"width": SIDE, "height": SIDE, "intrinsic": intrinsic, "cameras": poses}


def _boxes(layout: RoomLayout) -> dict[str, object]:
    rows = []
    for box in layout.boxes:
        pose = box.T_world_box.round(9).reshape(-1).tolist()
        rows.append({"id": box.id, "class": box.label, "transform": pose, "size": box.size.round(6).tolist()})
    return {"bboxes": rows}


def jpeg(image: UInt8[np.ndarray, "h w 3"]) -> bytes:
    """A JPEG without loss of colour resolution."""
    file = io.BytesIO()
    Image.fromarray(image).save(file, "JPEG", quality=95, subsampling=0)
    return file.getvalue()


def millimetres(depth: Num[np.ndarray, "h w"] | Float[np.ndarray, "h w"]) -> bytes:
    """A PNG of 16 bits: millimetres, 0 where nothing is."""
    file = io.BytesIO()
    Image.fromarray(np.round(np.minimum(depth, FARTHEST) * 1000).astype(np.uint16)).save(file, "PNG")
    return file.getvalue()
