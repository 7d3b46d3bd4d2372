"""The bench scene, one whole step on it, and times.

Gaussians on the walls of a 6 x 4 x 2.7 m room and on three balls in it, seen from one end. A step is all that one view costs:
projection, plan, forward, backward, and the derivative with respect to the 3D parameters.
"""

import dataclasses
import functools
import time
from collections.abc import Callable, Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from wm.schema import RasterSettings
from wm.splat import WIDE, Projected, TilePlan, project, rasterize
from wm.splat.rasterizer.planner import plan_outside_jit
from wm.types import Camera, Gaussians, Render

ROOM = np.array([6.0, 4.0, 2.7])
SH_C0 = 0.28209479177387814


def scene(n: int, size: float = 1.0) -> Gaussians:
    """The bench scene: four fifths on the six walls, one fifth on three balls, `size` times as large as is usual."""
    rng = np.random.default_rng(0)
    area = np.repeat([ROOM[1] * ROOM[2], ROOM[0] * ROOM[2], ROOM[0] * ROOM[1]], 2)
    wall = rng.choice(6, n, p=area / area.sum())
    means = rng.random((n, 3)) * ROOM
    means[np.arange(n), wall // 2] = np.where(wall % 2 == 0, 0, ROOM[wall // 2])
    balls = np.array([[3, 2, 0.6], [4.5, 1, 0.5], [5, 3, 0.8]])[rng.integers(0, 3, n // 5)]
    direction = rng.normal(size=(n // 5, 3))
    means[: n // 5] = balls + 0.45 * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    quats = rng.normal(size=(n, 4))
    scales = size * np.sqrt(area.sum() / n) * 0.7 * np.exp(rng.normal(0, 0.35, (n, 3)))
    opacity = rng.uniform(0.3, 0.95, n)
    leaves = {
        "means": means,
        "quats": quats / np.linalg.norm(quats, axis=1, keepdims=True),
        "log_scales": np.log(scales),
        "opacity_logits": np.log(opacity / (1 - opacity)),
        "sh": (rng.random((n, 1, 3)) - 0.5) / SH_C0,
    }
    return Gaussians(**{name: np.asarray(leaf, np.float32) for name, leaf in leaves.items()})


def camera_of(width: int, height: int) -> Camera:
    """At one end of the room, looking along it, 60 degrees across."""
    R_cam_world = np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]], float)
    T_cam_world = np.eye(4)
    T_cam_world[:3, :3], T_cam_world[:3, 3] = R_cam_world, -R_cam_world @ [0.2, 2, 1.5]
    focal = width / 2 / np.tan(np.deg2rad(30))
    return Camera(
        T_cam_world=np.float32(T_cam_world),
        focal=np.full(2, focal, np.float32),
        principal=np.float32([width / 2, height / 2]),
        width=width,
        height=height,
    )


@dataclasses.dataclass(frozen=True, eq=False)
class Step:
    """A whole step and its parts; the derivative of the image is a fixed random one."""

    gaussians: Gaussians  # on the device that computes
    camera: Camera
    settings: RasterSettings
    cotangent: Render  # on the device

    def __call__(self) -> Gaussians:
        projected = self.project()
        return self.vjp(self.both(projected, self.plan(projected)))

    def project(self) -> Projected:
        return _project(self.gaussians, self.camera, settings=self.settings)

    def plan(self, projected: Projected) -> TilePlan:
        return plan_outside_jit(projected, self.camera.width, self.camera.height, self.settings)

    def forward(self, projected: Projected, plan: TilePlan) -> Render:
        return _forward(projected, plan, width=self.camera.width, height=self.camera.height, settings=self.settings)

    def both(self, projected: Projected, plan: TilePlan) -> Projected:
        """Forward and backward: the derivative with respect to the ellipses."""
        size = {"width": self.camera.width, "height": self.camera.height}
        return _both(projected, plan, self.cotangent, **size, settings=self.settings)

    def vjp(self, derivative: Projected) -> Gaussians:
        return _vjp(self.gaussians, self.camera, derivative, settings=self.settings)


def bench_step(n: int, width: int, height: int, *, size: float = 1.0, settings: RasterSettings, device: Any = None) -> Step:
    """A step on the bench scene."""
    rng = np.random.default_rng(1)
    shapes = {"rgb": (height, width, 3), "depth": (height, width), "alpha": (height, width)}
    cotangent = Render(**{name: rng.normal(size=shape).astype(np.float32) for name, shape in shapes.items()})
    gaussians, cotangent = jax.device_put((scene(n, size), cotangent), device)
    return Step(gaussians=gaussians, camera=camera_of(width, height), settings=settings, cotangent=cotangent)


_jit_sized = functools.partial(jax.jit, static_argnames=("width", "height", "settings"), compiler_options=WIDE)
_forward = _jit_sized(rasterize)
_project = jax.jit(project, static_argnames="settings", compiler_options=WIDE)


@_jit_sized
def _both(projected: Projected, plan: TilePlan, cotangent: Render, *, width: int, height: int, settings: RasterSettings):
    return jax.vjp(lambda p: rasterize(p, plan, width, height, settings), projected)[1](cotangent)[0]


@functools.partial(jax.jit, static_argnames="settings", compiler_options=WIDE)
def _vjp(gaussians: Gaussians, camera: Camera, derivative: Projected, *, settings: RasterSettings):
    return jax.vjp(lambda g: project(g, camera, settings), gaussians)[1](derivative)[0]


ELEMENTS, TURNS = 1 << 15, 200
EXPONENTIALS = ELEMENTS * TURNS
_turns = jax.jit(lambda x: jax.lax.fori_loop(0, TURNS, lambda _, y: jnp.exp(-y), x))


def exponential() -> jax.Array:
    """`EXPONENTIALS` exponentials on 128 KiB, which stay in the L2 cache."""
    return _turns(np.linspace(0.1, 1, ELEMENTS, dtype=np.float32))


def exponential_ns(repeats: int) -> float:
    """Nanoseconds of one exponential of a long array, the unit in which processors are compared."""
    return best({"exp": exponential}, repeats)["exp"] * 1e6 / EXPONENTIALS


def best(parts: Mapping[str, Callable[[], Any]], repeats: int) -> dict[str, float]:
    """The shortest time of each part, milliseconds; in turns, so that a slow moment of the machine hits none alone."""
    for part in parts.values():
        jax.block_until_ready(part())
    times = dict.fromkeys(parts, np.inf)
    for _ in range(repeats):
        for name, part in parts.items():
            times[name] = min(times[name], 1e3 * seconds(part))
    return times


def seconds(part: Callable[[], Any]) -> float:
    """How long one call takes, its result waited for."""
    start = time.perf_counter()
    jax.block_until_ready(part())
    return time.perf_counter() - start
