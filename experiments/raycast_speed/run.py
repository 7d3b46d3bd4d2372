"""How long does a G-buffer of 1376 x 768 pixels of a 500k-triangle scene take, and where does the time go?

    python experiments/raycast_speed/run.py            writes result.csv beside itself and prints it

The scene is a furnished hall made of arithmetic: an 8 x 6 x 3 m box with 64 bumpy balls of 7,800 triangles each. Times are
the best of REPEATS runs (other work on the machine only ever adds). "single" is one thread; "all" every core the process may use.
"""

import argparse
import csv
import pathlib
import time
from collections.abc import Callable

import numpy as np

from wm.geometry.rays import _embree, raycast
from wm.geometry.rays._reference import cast_reference
from wm.geometry.rays.pinhole import camera_center, camera_rays, make_camera, scale_camera
from wm.geometry.rays.raycast import build_ray_scene, cast, cast_rays, occluded
from wm.types import Mesh

REPEATS = 15
WIDTH, HEIGHT = 1376, 768


def scene(balls: int = 64, rings: int = 60, segments: int = 66) -> Mesh:
    """A box seen from inside with bumpy balls on a grid in it."""
    corners = np.array([[x, y, z] for x in (0.0, 8.0) for y in (0.0, 6.0) for z in (0.0, 3.0)])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    vertices = [corners]
    faces = [np.array([triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])]
    latitude, longitude = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.arange(segments) * 2 * np.pi / segments, indexing="ij")
    radius = 0.28 + 0.02 * np.sin(7 * latitude) * np.cos(9 * longitude)
    ball = (
        radius[..., None]
        * np.stack([np.sin(latitude) * np.cos(longitude), np.sin(latitude) * np.sin(longitude), np.cos(latitude)], axis=-1)
    ).reshape(-1, 3)
    i, j = (index.reshape(-1) for index in np.meshgrid(np.arange(rings), np.arange(segments), indexing="ij"))
    a, b = i * segments + j, i * segments + (j + 1) % segments
    skin = np.concatenate([np.stack([a, a + segments, b], 1), np.stack([b, a + segments, b + segments], 1)])
    for k in range(balls):
        centre = np.array([0.9 + 0.88 * (k % 8), 0.9 + 1.4 * (k // 8 % 4), 0.5 + 1.3 * (k // 32)])
        faces.append(skin + sum(map(len, vertices)))
        vertices.append(ball + centre)
    joined = np.concatenate(faces).astype(np.int32)
    label = np.zeros(len(joined), np.int32)
    return Mesh(vertices=np.concatenate(vertices), faces=joined, face_room=label, face_kind=label, face_object=label - 1)


def best(work: Callable[[], object]) -> float:
    """Milliseconds of the fastest of REPEATS runs, after one that warms up."""
    work()
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def single(work: Callable[[], object]) -> float:
    cores = raycast.cores
    raycast.cores = lambda: 1
    try:
        return best(work)
    finally:
        raycast.cores = cores


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).with_name("result.csv"))
    out = arguments.parse_args().out
    mesh = scene()
    camera = make_camera(np.array([0.4, 0.4, 1.6]), np.array([5.0, 4.0, 1.2]), width=WIDTH, height=HEIGHT, fov_deg=60.0)
    built = build_ray_scene(mesh)
    directions = camera_rays(camera)
    origins = np.tile(camera_center(camera), (len(directions), 1))
    bounce = np.random.default_rng(0).normal(size=directions.shape)
    start = origins + (0.999 * cast(built, camera).depth.reshape(-1, 1)) * directions
    local = (origins - built.origin).astype(np.float32), directions.astype(np.float32)
    rows = [
        ("build_ray_scene", "single", best(lambda: build_ray_scene(mesh))),
        ("embree alone", "single", best(lambda: _embree.intersect(built.embree, *local))),
        ("cast", "single", single(lambda: cast(built, camera))),
        ("cast", "all", best(lambda: cast(built, camera))),
        ("cast_rays primary", "all", best(lambda: cast_rays(built, origins, directions))),
        ("cast_rays scattered", "all", best(lambda: cast_rays(built, start, bounce))),
        ("occluded scattered", "all", best(lambda: occluded(built, start, bounce))),
    ]
    small = scale_camera(camera, 1 / 86)
    near, far = cast(built, small), cast_reference(mesh, small)
    same = near.face == far.face
    error = np.abs(near.depth - far.depth)[same].max()
    with out.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["what", "cores", "ms", "mrays_per_s"])
        for what, cores, ms in rows:
            table.writerow([what, cores, f"{ms:.1f}", "" if what.startswith("build") else f"{len(directions) / ms / 1e3:.1f}"])
    print(out.read_text(), end="")
    print(f"{len(mesh.faces)} triangles, {WIDTH} x {HEIGHT}, {raycast.cores()} cores")
    print(f"against float64: {np.mean(same):.4f} of faces equal, largest depth error on those {error:.1e} m")


if __name__ == "__main__":
    main()
