"""Scenes in the formats of six other systems, made of one run of ours: stand-ins for their outputs, and not their outputs.

Each is the same house, thinned to a number of gaussians, turned into the system's axes and unit, degraded in a way that the paper
reports of the system, and written as its public code writes it (tests/compare/writers.py). They serve to time the comparison and
to see whether its figures tell the degradations apart. Nothing here says how good a system is.

    wonderworld    depths stretched with the distance from the middle: accumulated error of monocular depth
    flexworld      a tenth of the gaussians moved by a few centimetres: loose geometry
    layerpano3d    what lies behind what the middle sees is left out: holes beyond the central perspective
    worldexplorer  colours that turn with the view, degree 3
    dreamscene360  the same holes, and the rest drawn towards one sphere
    splats         the thinned house as it is
    spatialgen     depths of sixteen views with an error of scale each
"""

import dataclasses
import pathlib

import jax
import numpy as np

from tests.compare import writers
from wm.compare.axes import UP, moved_camera, rotation_matrix, upright
from wm.compare.inputs.spatialgen import circle
from wm.compare.inputs.standing import standing_place
from wm.compare.painted_mesh import read_painted_mesh, see
from wm.finished import FinishedRun
from wm.geometry import cast_rays
from wm.geometry.rays.pinhole import unproject_depth
from wm.splat import save_ply
from wm.splat.formats.turning import turned
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians


def thinned(gaussians: Gaussians, count: int, seed: int = 0) -> Gaussians:
    """A number of gaussians drawn at random, larger by what that thins out."""
    n = len(gaussians.means)
    if n <= count:
        return gaussians
    fewer = chosen(gaussians, np.sort(np.random.default_rng(seed).choice(n, count, replace=False)))
    return dataclasses.replace(fewer, log_scales=fewer.log_scales + np.float32(0.5 * np.log(n / count)))


def placed(g: Gaussians, rotation: np.ndarray, middle: np.ndarray, scale: float) -> Gaussians:
    """Gaussians of degree 0 about a middle, turned and scaled."""
    return turned(dataclasses.replace(g, sh=g.sh[:, :1]), rotation, scale, -scale * rotation @ middle)


def with_harmonics(g: Gaussians, size: float, seed: int = 0) -> Gaussians:
    """Gaussians of degree 3 whose higher coefficients are random, of a standard deviation."""
    sh = size * np.random.default_rng(seed).normal(size=(len(g.means), 16, 3)).astype(np.float32)
    sh[:, 0] = g.sh[:, 0]
    return dataclasses.replace(g, sh=sh)


def in_sight(run: FinishedRun, g: Gaussians, eye: np.ndarray) -> np.ndarray:
    """Whether each gaussian is seen from a place, 5 cm and more before what hides it."""
    away = g.means.astype(np.float64) - eye
    return cast_rays(run.rays, np.broadcast_to(eye, away.shape).copy(), away).t > 1 - 0.05 / np.linalg.norm(away, axis=1)


def chosen(g: Gaussians, which: np.ndarray) -> Gaussians:
    """Those of a mask, or of indices."""
    return jax.tree.map(lambda x: np.asarray(x)[which], g)


def wonderworld(path: pathlib.Path, g: Gaussians, eye: np.ndarray) -> None:
    away = g.means - eye
    stretched = eye + away * (1 + 0.03 * np.linalg.norm(away, axis=1, keepdims=True))
    writers.wonderworld_splat(path, placed(_moved(g, stretched), upright(UP["y"]).T, eye, 400.0))


def flexworld(path: pathlib.Path, g: Gaussians, eye: np.ndarray) -> None:
    random = np.random.default_rng(0)
    loose = random.uniform(size=(len(g.means), 1)) < 0.1
    turned = placed(_moved(g, g.means + 0.04 * loose * random.normal(size=g.means.shape)), upright(UP["y"]).T, eye, 0.3)
    colors = np.clip(0.5 + SH_C0 * turned.sh, 0.002, 0.998)  # those that have logits
    writers.flexworld_ply(path, dataclasses.replace(turned, sh=((colors - 0.5) / SH_C0).astype(np.float32)))


def layerpano3d(path: pathlib.Path, seen: Gaussians, eye: np.ndarray) -> None:
    writers.inria_ply(path, with_harmonics(placed(seen, upright(UP["-y"]).T, eye, 20.0), 0.0))


def worldexplorer(path: pathlib.Path, g: Gaussians, eye: np.ndarray) -> None:
    writers.inria_ply(path, with_harmonics(placed(g, np.eye(3), eye, 0.2), 0.1))


def dreamscene360(path: pathlib.Path, seen: Gaussians, eye: np.ndarray) -> None:
    away = seen.means - eye
    drawn = eye + away * np.linalg.norm(away, axis=1, keepdims=True) ** -0.3
    writers.inria_ply(path, with_harmonics(placed(_moved(seen, drawn), np.eye(3), eye, 0.4), 0.02))


def stand_ins(run: FinishedRun, folder: pathlib.Path, *, count: int, room: int = 0) -> dict[str, pathlib.Path]:
    """Writes all stand-ins; returns their paths by method. They are centred where `room` has most air."""
    g, eye = thinned(run.gaussians, count), standing_place(run, room)
    seen = thinned(chosen(run.gaussians, in_sight(run, run.gaussians, eye)), count)
    paths = {
        "wonderworld": folder / "wonderworld" / "x_finished_3dgs.splat",
        "flexworld": folder / "flexworld" / "x_gs_final_2.ply",
        "layerpano3d": folder / "layerpano3d" / "gsplat_layer0.ply",
        "worldexplorer": folder / "worldexplorer" / "splat.ply",
        "dreamscene360": folder / "dreamscene360" / "point_cloud.ply",
        "spatialgen": folder / "spatialgen" / "inference_results.npz",
        "splats": folder / "splats" / "plain.ply",
    }
    for path in paths.values():
        path.parent.mkdir(parents=True, exist_ok=True)
    wonderworld(paths["wonderworld"], g, eye)
    flexworld(paths["flexworld"], g, eye)
    layerpano3d(paths["layerpano3d"], seen, eye)
    worldexplorer(paths["worldexplorer"], g, eye)
    dreamscene360(paths["dreamscene360"], seen, eye)
    spatialgen(paths["spatialgen"], run, room, count)
    save_ply(paths["splats"], placed(g, np.eye(3), eye, 1.0))
    return paths


def _moved(g: Gaussians, means: np.ndarray) -> Gaussians:
    return dataclasses.replace(g, means=means.astype(np.float32))


def spatialgen(path: pathlib.Path, run: FinishedRun, room: int, count: int) -> None:
    """The views of a room with an error of scale each."""
    painted, random, scale = read_painted_mesh(run.scaffold_file), np.random.default_rng(1), 0.2
    cameras = circle(run, room)
    first = np.linalg.inv(cameras[0].T_cam_world)
    stride = max(1, int(np.sqrt(len(cameras) * cameras[0].width ** 2 / count)))
    told: dict[str, list[np.ndarray]] = {}
    for k, camera in enumerate(cameras):
        render = see(painted, moved_camera(camera, rotation_matrix(upright(UP["y"]))))
        points = unproject_depth(camera, render.depth * np.float32(1 + 0.02 * random.normal()))[::stride, ::stride]
        local = scale * (points.reshape(-1, 3) @ cameras[0].T_cam_world[:3, :3].T + cameras[0].T_cam_world[:3, 3])
        kind = "input" if k == 0 else "target"
        pose = cameras[0].T_cam_world @ np.linalg.inv(camera.T_cam_world)
        pose[:3, 3] *= scale
        rgb = render.rgb[::stride, ::stride]
        for name, value in (("points", local), ("colors", rgb.reshape(-1, 3)), ("rgbs", 255 * rgb), ("poses", pose)):
            told.setdefault(f"{kind}_{name}", []).append(value)
    half = cameras[0].width / 2
    room_told = told | {"intrinsic": np.array([[half, 0, half], [0, half, half], [0, 0, 1]]), "input_poses_metric": [first]}
    writers.spatialgen_npz(path, room_told | {"scene_scale": scale}, run.rooms[room])
