"""Times of the rasterizer's parts on one core, beside one `jnp.exp` element, printed and written to result.csv.

The bench scene: gaussians on the walls of a 6 x 4 x 2.7 m room and on three balls in it, seen from one end.
"""

import argparse
import csv
import functools
import os
import pathlib
import sys
import time

CORE = min(os.sched_getaffinity(0))
os.sched_setaffinity(0, {CORE})  # before JAX counts the cores

import jax  # noqa: E402
import jax.numpy as jnp  # noqa: E402
import numpy as np  # noqa: E402

from wm.host import prepare_process  # noqa: E402
from wm.schema import RasterSettings  # noqa: E402
from wm.splat import WIDE, plan_tiles, project, rasterize  # noqa: E402
from wm.types import Camera, Gaussians  # noqa: E402

HERE = pathlib.Path(__file__).parent
ROOM = np.array([6.0, 4.0, 2.7])
SH_C0 = 0.28209479177387814
CASES = (
    (100_000, 688, 384, 0.46, True),
    (100_000, 688, 384, 0.6, True),
    (100_000, 688, 384, 1.0, True),
    (100_000, 688, 384, 1.0, False),
    (300_000, 688, 384, 1.0, True),
    (100_000, 1376, 768, 1.0, True),
    (300_000, 1376, 768, 1.0, True),
)
"""Gaussians, width, height, how many times the standard size they have (at 0.46 a view lists 12M pairs), and whether depth is
slanted, which is two features more."""

MARGIN = 0.15
"""By how much a step may exceed the baseline before the gate fails: the best of 15 wanders by 5 % on a shared machine."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--gate", action="store_true", help="compare with result.csv and leave it; fail if a step is slower")
    arguments = parser.parse_args()
    prepare_process()
    rows = [measure(*case, arguments.repeats) for case in CASES]
    if arguments.gate:
        sys.exit("\n".join(slower(rows)) or None)
    with open(HERE / "result.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def slower(rows: list[dict]) -> list[str]:
    """One line for each case whose step, in exponentials, is more than MARGIN above the committed one."""
    with open(HERE / "result.csv", newline="") as file:
        baseline = [int(row["step_ms_per_ns"]) for row in csv.DictReader(file)]
    return [
        f"{row['gaussians']} gaussians of {row['size']} the size at {row['width']} x {row['height']}, slanted {row['slanted']}: "
        f"{row['step_ms_per_ns']} ms a step for each ns of an exponential; the committed baseline is {before}, "
        f"and {MARGIN:.0%} above it is allowed"
        for row, before in zip(rows, baseline)
        if row["step_ms_per_ns"] > before * (1 + MARGIN)
    ]


def measure(n: int, width: int, height: int, size: float, slanted: bool, repeats: int) -> dict:
    """One case: the best of `repeats` for every part, milliseconds of wall-clock on one core."""
    gaussians, camera, settings = scene(n, size), camera_of(width, height), RasterSettings(slanted=slanted)
    jit = functools.partial(jax.jit, compiler_options=WIDE)
    shoot = jit(lambda p, plan: rasterize(p, plan, width, height, settings))
    both = jit(lambda p, plan, ct: jax.vjp(lambda p: rasterize(p, plan, width, height, settings), p)[1](ct)[0])
    projection = jit(lambda g: project(g, camera, settings))
    pull = jit(lambda g, ct: jax.vjp(lambda g: project(g, camera, settings), g)[1](ct)[0])
    projected = projection(gaussians)
    plan = plan_tiles(jax.tree.map(np.asarray, projected), width, height, settings)
    pairs = int(plan.count.sum()) * settings.tile**2
    cotangent = random_like(jax.eval_shape(shoot, projected, plan))
    parts = {
        "exp_ns": lambda: exponential(),
        "project_ms": functools.partial(projection, gaussians),
        "plan_ms": lambda: plan_tiles(jax.tree.map(np.asarray, projected), width, height, settings),
        "forward_ms": functools.partial(shoot, projected, plan),
        "both_ms": functools.partial(both, projected, plan, cotangent),
        "pull_ms": functools.partial(pull, gaussians, both(projected, plan, cotangent)),
    }
    ms = best(parts, repeats)
    exp_ns = ms.pop("exp_ns") * 1e6 / EXPONENTIALS
    backward = ms["both_ms"] - ms["forward_ms"]
    step = sum(ms[name] for name in ("project_ms", "plan_ms", "both_ms", "pull_ms"))
    row = {"gaussians": n, "width": width, "height": height, "size": size, "slanted": slanted}
    row |= {"pairs_1e6": round(pairs / 1e6, 1), "exp_ns": round(exp_ns, 3)}
    row |= {name: round(value, 1) for name, value in ms.items()} | {"step_ms": round(step, 1)}
    for name, value in (("forward", ms["forward_ms"]), ("backward", backward)):
        ns = value * 1e6 / pairs
        row |= {f"{name}_ns_pair": round(ns, 2), f"{name}_exps": round(ns / exp_ns, 2)}
    row |= {"step_ms_per_ns": round(step / exp_ns)}
    print("  ".join(f"{name} {value}" for name, value in row.items()), flush=True)
    return row


ELEMENTS, TURNS = 1 << 15, 200
EXPONENTIALS = ELEMENTS * TURNS
_argument = jnp.linspace(0.1, 1, ELEMENTS)
_turns = jax.jit(lambda x: jax.lax.fori_loop(0, TURNS, lambda _, y: jnp.exp(-y), x))


def exponential():
    """`EXPONENTIALS` exponentials on 128 KiB, which stay in the L2 cache."""
    return _turns(_argument)


def best(parts: dict, repeats: int) -> dict[str, float]:
    """The shortest time of each part, milliseconds; in turns, so that a slow moment of the machine hits none alone."""
    for part in parts.values():
        jax.block_until_ready(part())
    times = dict.fromkeys(parts, np.inf)
    for _ in range(repeats):
        for name, part in parts.items():
            start = time.perf_counter()
            jax.block_until_ready(part())
            times[name] = min(times[name], (time.perf_counter() - start) * 1e3)
    return times


def scene(n: int, size: float) -> Gaussians:
    """The bench scene: four fifths on the six walls, one fifth on three balls."""
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
    return Gaussians(**{name: jnp.asarray(leaf, jnp.float32) for name, leaf in leaves.items()})


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


def random_like(shapes):
    """Normal numbers in the shapes of a record."""
    rng = np.random.default_rng(1)
    return jax.tree.map(lambda x: jnp.asarray(rng.normal(size=x.shape), jnp.float32), shapes)


if __name__ == "__main__":
    main()
