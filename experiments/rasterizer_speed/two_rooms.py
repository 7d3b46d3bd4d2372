"""Wall-clock and CPU time of a step of the fit where two rooms are fitted side by side: threads of a process, and processes.

The rooms are bare boxes beside each other, shown from their planned cameras in colours that follow the place.
"""

import argparse
import json
import os
import pathlib
import time
from collections.abc import Iterator

import jax
import numpy as np

from wm.geometry import build_ray_scene, build_structure, cast, parse_plan, place_cameras
from wm.geometry.camera import camera_center, camera_rays
from wm.host import prepare_process
from wm.schema import CameraSettings, FitSettings
from wm.splat import TrainingView, fit_scene, initial_gaussians, room_workers
from wm.splat.padding import Capacity

VIEWS = 8
"""Of each room."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=24)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--spacing", type=float, default=0.022, help="of the gaussians, metres")
    arguments = parser.parse_args()
    prepare_process()
    settings = FitSettings(spacing=arguments.spacing, detail_spacing=arguments.spacing, steps=arguments.steps, curve_points=0)
    views = [list(views_of(room)) for room in range(2)]
    start = [initial_gaussians(some, settings=settings, rng=np.random.default_rng(0)) for some in views]
    print("gaussians:", *(len(some.means) for some in start))
    with room_workers(2) as workers:
        ways = {
            "one process, two threads": {"devices": jax.devices()[:1] * 2, "capacity": Capacity()},
            "two processes, a core each": {"workers": workers, "capacity": Capacity()},
        }
        for _ in range(arguments.repeats):
            for name, how in ways.items():
                marks: list[tuple[int, float, float]] = []

                def mark(done: int, total: int, info: dict, marks: list = marks) -> None:
                    marks.append((info["room"], time.perf_counter(), cpu_seconds()))

                fit_scene(start, views.__getitem__, settings=settings, key=jax.random.key(0), progress=mark, **how)
                wall, cpu = per_step(marks, settings.steps)
                print(f"{name}: {wall:.0f} ms a step of either room, {cpu:.0f} ms of CPU", flush=True)


def views_of(room: int) -> Iterator[TrainingView]:
    """What a room shows of itself."""
    mesh, cameras = build_structure(PLAN), CameraSettings()
    rays = build_ray_scene(mesh)
    for view in [view for view in place_cameras(PLAN, rays, cameras) if view.room == room][:VIEWS]:
        shown, size = cast(rays, view.camera), (view.camera.height, view.camera.width)
        points = camera_center(view.camera) + shown.depth.reshape(-1, 1) * camera_rays(view.camera)
        rgb = (255 * (0.5 + 0.4 * np.sin(3 * points + np.arange(3.0)))).astype(np.uint8).reshape(*size, 3)
        yield TrainingView(
            camera=view.camera,
            rgb=rgb,
            depth=shown.depth,
            mask=np.ones(size, bool),
            room=room,
            own=shown.hit & (mesh.face_room[shown.face] == room),
            normal=shown.normal,
            sees=(1 - room,),
        )


def per_step(marks: list[tuple[int, float, float]], steps: int) -> tuple[float, float]:
    """Milliseconds of the wall and of CPUs for a step while both rooms are at it: from the second of both to the last of one."""
    counts, first = [0, 0], None
    for k, (room, *_) in enumerate(marks):
        counts[room] += 1
        first = k if first is None and min(counts) == 2 else first
        if max(counts) == steps and first is not None:
            return tuple(1e3 * (marks[k][i] - marks[first][i]) / (k - first) for i in (1, 2))
    raise RuntimeError("one room had ended before the other began: more --steps")


def cpu_seconds() -> float:
    """Of this process and those that it started, so far. Linux."""
    listed = pathlib.Path("/proc/self/task").glob("*/children")
    pids = ["self", *(pid for file in listed for pid in file.read_text().split())]
    stats = [pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split() for pid in pids]
    return sum(int(stat[11]) + int(stat[12]) for stat in stats) / os.sysconf("SC_CLK_TCK")


def box(x: float, name: str) -> dict:
    corners = [[x, 0.0], [x + 5.0, 0.0], [x + 5.0, 4.0], [x, 4.0]]
    door = {"type": "passage", "wall_segment": [[5.0, 0.0], [5.0, 4.0]], "position": 1.0, "width": 1.6, "height": 2.2}
    return {"id": name, "name": name, "floor_polygon": corners, "ceiling_height": 2.8, "openings": [door | {"sill_height": 0.0}]}


PLAN = parse_plan(
    json.dumps(
        {
            "metadata": {"units": "meters", "coordinate_system": "z_up", "wall_thickness": 0.15, "default_ceiling_height": 2.8},
            "rooms": [box(0.0, "hall"), box(5.0, "study")],
            "objects": [],
        }
    ),
    "two rooms",
)


if __name__ == "__main__":
    main()
