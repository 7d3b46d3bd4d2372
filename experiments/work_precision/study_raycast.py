"""Rays against the float64 reference: Embree's robust and fast modes, primary rays and rays at edges.

Embree's wheel offers neither its compact mode nor packets; what its library reaches with packets is in facts.md and not measured
here. The second kind of rays aims at points a billionth of a metre to a millimetre from edges: the scene is closed, so that a
miss is a leak. Errors of face, and of depth where the face is the same, are those of a sample of rays.
"""

import dataclasses
import functools
import pathlib
from collections.abc import Iterator

import bench
import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from wm.geometry.rays._reference import cast_rays_reference
from wm.geometry.rays.pinhole import camera_center, camera_rays, make_camera
from wm.geometry.rays.raycast import RayHits
from wm.types import Mesh

PANELS = [("mrays_per_s", "depth_error_m", "log"), ("mrays_per_s", "other_face", "linear")]


def rows(tiny: bool, world: pathlib.Path) -> Iterator[dict]:
    speed = bench.sibling("raycast_speed", "run")
    mesh = speed.scene(balls=2, rings=8, segments=9) if tiny else speed.scene()
    width, height, repeats = (40, 24, 2) if tiny else (1376, 768, 15)
    camera = make_camera(np.array([0.4, 0.4, 1.6]), np.array([5.0, 4.0, 1.2]), width=width, height=height, fov_deg=60.0)
    directions = camera_rays(camera)
    origins = np.tile(camera_center(camera), (len(directions), 1))
    aims = {"pixels": (origins, directions), "edges": at_edges(mesh, origins[0], len(origins))}
    exact = {aim: Exact.of(mesh, *rays) for aim, rays in aims.items()}
    for robust in (True, False):
        scene = build(mesh, robust)
        parts = {aim: functools.partial(shoot, scene, *rays) for aim, rays in aims.items()}
        for aim, ms in bench.median_ms(parts, repeats).items():
            labels = {"vary": aim, "value": "robust" if robust else "fast", "default": robust}
            yield labels | {"mrays_per_s": len(origins) / ms / 1e3} | exact[aim].errors(shoot(scene, *aims[aim]))


def build(mesh: Mesh, robust: bool):
    """Embree's scene and the geometry that must outlive it."""
    scene = EmbreeScene(robust=robust)
    geometry = TriangleMesh(scene, mesh.vertices.astype(np.float32), mesh.faces.astype(np.int32))
    return scene, geometry


def shoot(scene, origins: np.ndarray, directions: np.ndarray) -> dict[str, np.ndarray]:
    return scene[0].run(origins.astype(np.float32), directions.astype(np.float32), output=True)


def at_edges(mesh: Mesh, eye: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Rays from the eye to points near edges of the mesh, all of which hit something since the scene is closed."""
    rng = np.random.default_rng(0)
    face = rng.integers(0, len(mesh.faces), count)
    a, b = (mesh.vertices[mesh.faces[face, k]] for k in (0, 1))
    share = rng.uniform(0.05, 0.95, (count, 1))
    aside = rng.normal(size=(count, 3)) * 10.0 ** rng.uniform(-9, -3, (count, 1))
    return np.tile(eye, (count, 1)), a + share * (b - a) + aside - eye


@dataclasses.dataclass(frozen=True, eq=False)
class Exact:
    """What a sample of rays meets, in float64."""

    some: np.ndarray  # which rays
    hits: RayHits

    @classmethod
    def of(cls, mesh: Mesh, origins: np.ndarray, directions: np.ndarray, sample: int = 400) -> "Exact":
        some = np.random.default_rng(1).choice(len(origins), min(sample, len(origins)), replace=False)
        return cls(some=some, hits=cast_rays_reference(mesh, origins[some], directions[some]))

    def errors(self, found: dict[str, np.ndarray]) -> dict[str, float]:
        """Leaks over all rays; face and depth over the sample."""
        face, depth = found["primID"][self.some], found["tfar"][self.some]
        same = (face == self.hits.face) & (self.hits.face >= 0)
        return {
            "leaks": float(np.mean(found["primID"] < 0)),
            "other_face": float(np.mean(face != self.hits.face)),
            "depth_error_m": float(np.abs(depth - self.hits.t)[same].max()),
        }
