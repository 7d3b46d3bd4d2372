"""Files of other systems, written by our own code as the public code of each writes them (docs/comparison.md names it)."""

import dataclasses
import pathlib

import numpy as np

from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians


def some_gaussians(n: int = 40, degree: int = 0, seed: int = 0) -> Gaussians:
    """Gaussians with unit quaternions, colours and opacities within (0, 1)."""
    random = np.random.default_rng(seed)
    quats = random.normal(size=(n, 4))
    sh = np.zeros((n, (degree + 1) ** 2, 3))
    sh[:, 0] = (random.uniform(0.1, 0.9, (n, 3)) - 0.5) / SH_C0
    sh[:, 1:] = 0.1 * random.normal(size=sh[:, 1:].shape)
    fields = {
        "means": random.normal(size=(n, 3)),
        "quats": quats / np.linalg.norm(quats, axis=1, keepdims=True),
        "log_scales": random.uniform(-4, -2, (n, 3)),
        "opacity_logits": random.uniform(-2, 3, n),
        "sh": sh,
    }
    return Gaussians(**{name: value.astype(np.float32) for name, value in fields.items()})


def plyfile_ply(path: pathlib.Path, columns: dict[str, np.ndarray]) -> None:
    """What `PlyData([PlyElement.describe(elements, "vertex")]).write(path)` writes of float32 columns."""
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(next(iter(columns.values())))}"]
    header = "\n".join([*lines, *(f"property float {name}" for name in columns), "end_header\n"])
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode() + np.column_stack(list(columns.values())).astype("<f4").tobytes())


def inria_ply(path: pathlib.Path, g: Gaussians, *, normals: bool = True) -> None:
    """`GaussianModel.save_ply` of DreamScene360 and LayerPano3D: f_rest by channel, all values before activation."""
    rest = np.swapaxes(g.sh[:, 1:], 1, 2).reshape(len(g.means), -1)
    columns = {name: g.means[:, k] for k, name in enumerate("xyz")}
    columns |= {name: np.zeros(len(g.means)) for name in ("nx", "ny", "nz")} if normals else {}
    columns |= {f"f_dc_{k}": g.sh[:, 0, k] for k in range(3)} | {f"f_rest_{k}": rest[:, k] for k in range(rest.shape[1])}
    columns |= {"opacity": g.opacity_logits} | {f"scale_{k}": g.log_scales[:, k] for k in range(3)}
    plyfile_ply(path, columns | {f"rot_{k}": g.quats[:, k] for k in range(4)})


def flexworld_ply(path: pathlib.Path, g: Gaussians) -> None:
    """`GaussianMgr.save_ply(flip=True)`: x and y negated, rotations as they were, colours as logits, no normals."""
    color = 0.5 + SH_C0 * g.sh[:, :1].astype(np.float64)
    stored = dataclasses.replace(g, means=g.means * [-1, -1, 1], sh=np.log(color / (1 - color)))
    inria_ply(path, stored, normals=False)


def before_tanh(unit: np.ndarray) -> np.ndarray:
    """WonderWorld's inverse activation."""
    return np.arctanh((unit - 0.5) / 0.51)


def wonderworld_ply(path: pathlib.Path, g: Gaussians) -> None:
    """`save_ply_all_with_filter`: colours and opacities before tanh, and a column filter_3D."""
    color = before_tanh(0.5 + SH_C0 * g.sh[:, 0].astype(np.float64))
    opacity = before_tanh(1 / (1 + np.exp(-g.opacity_logits.astype(np.float64))))
    columns = {name: g.means[:, k] for k, name in enumerate("xyz")}
    columns |= {name: np.zeros(len(g.means)) for name in ("nx", "ny", "nz")}
    columns |= {f"f_dc_{k}": color[:, k] for k in range(3)} | {"opacity": opacity}
    columns |= {f"scale_{k}": g.log_scales[:, k] for k in range(3)} | {f"rot_{k}": g.quats[:, k] for k in range(4)}
    plyfile_ply(path, columns | {"filter_3D": np.full(len(g.means), 0.01)})


def wonderworld_splat(path: pathlib.Path, g: Gaussians) -> None:
    """`yield_splat_data`: sorted by volume times opacity, fractions cut off."""
    opacity = 1 / (1 + np.exp(-g.opacity_logits.astype(np.float64)))
    order = np.argsort(-np.exp(g.log_scales.sum(axis=1)) * opacity)
    color = np.column_stack([0.5 + SH_C0 * g.sh[:, 0], opacity])
    quats = g.quats / np.linalg.norm(g.quats, axis=1, keepdims=True)
    rows = []
    for k in order:
        rows += [g.means[k].astype("<f4").tobytes(), np.exp(g.log_scales[k]).astype("<f4").tobytes()]
        rows += [(color[k] * 255).clip(0, 255).astype(np.uint8).tobytes()]
        rows += [(quats[k] * 128 + 128).clip(0, 255).astype(np.uint8).tobytes()]
    path.write_bytes(b"".join(rows))


def spatialgen_npz(path: pathlib.Path, room: dict[str, object], uid: str = "scenes/a/perspective/room_1") -> None:
    """`np.savez(filepath, **infer_results)`: one pickled dictionary a room."""
    np.savez(path, **{uid: np.array(room, dtype=object)})


def spatialgen_room(points: np.ndarray, colors: np.ndarray, T_layout_first: np.ndarray, scale: float) -> dict[str, object]:
    """What `align_and_save_pointcloud` and `model_inference` keep of a room whose points [2, h, w, 3] are given in the layout.

    The first view is the input; its camera is the world, and the world is scaled. One pixel is masked, that is, 0.
    """
    h, w = points.shape[1:3]
    T_first_layout = np.linalg.inv(T_layout_first)
    stored = scale * (points.reshape(2, -1, 3) @ T_first_layout[:3, :3].T + T_first_layout[:3, 3])
    stored[1, 0] = 0
    pose = np.eye(4, dtype=np.float32)
    room: dict[str, object] = {}
    for k, kind in enumerate(("input", "target")):
        rgb = colors[k] * 255
        room |= {f"{kind}_rgbs": [rgb], f"{kind}_semantics": [rgb], f"{kind}_depths": [stored[k, :, 2].reshape(h, w)]}
        room |= {f"{kind}_poses": [pose], f"{kind}_points": [stored[k]], f"{kind}_colors": [colors[k].reshape(-1, 3)]}
    intrinsic = np.array([[w / 2, 0, w / 2], [0, w / 2, h / 2], [0, 0, 1]], np.float32)
    metric = [T_layout_first.astype(np.float32)]
    return room | {
        "intrinsic": intrinsic,
        "input_poses_metric": metric,
        "target_poses_metric": metric,
        "scene_scale": float(scale),
    }
