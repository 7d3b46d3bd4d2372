"""A furnished room seen by two cameras, with the depth and the masks that models would give of it."""

import functools
import json

import numpy as np

from wm.geometry import build_structure, parse_plan
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.placement.upright_box import UprightBox
from wm.geometry.plan.site import Site, room_site
from wm.geometry.rays.pinhole import make_camera
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.offline.reconstruction.kinds import template_of
from wm.offline.reconstruction.templates import built
from wm.offline.style.theme import style_of
from wm.synth.backends import Observation, SceneContext
from wm.types import OUTSIDE, SceneObject

THEME = "scandinavian flat"
STYLE = style_of(THEME)
PLAN = {
    "metadata": {"units": "meters", "coordinate_system": "z_up", "wall_thickness": 0.15, "default_ceiling_height": 2.6},
    "rooms": [
        {
            "id": "living", "name": "living room", "floor_polygon": [[0, 0], [5, 0], [5, 4], [0, 4]], "ceiling_height": 2.6,
            "openings": [
                {"type": "door", "wall_segment": [[5, 0], [5, 4]], "position": 2.6, "width": 0.9, "height": 2.1,
                 "sill_height": 0},
            ],
        },
        {"id": "bath", "name": "bathroom", "floor_polygon": [[5, 0], [7.2, 0], [7.2, 4], [5, 4]], "ceiling_height": 2.6,
         "openings": []},
    ],
    "objects": [],
}  # fmt: skip


@functools.cache
def bare() -> SceneContext:
    plan = parse_plan(json.dumps(PLAN))
    return SceneContext(theme=THEME, seed=3, plan=plan, structure=build_structure(plan), objects=())


@functools.cache
def site() -> Site:
    return room_site(bare().plan, 0)


def piece(kind: str, x: float, y: float, yaw: float, size: tuple[float, float, float], z: float = 0.002) -> SceneObject:
    """A piece of furniture that fills a box; its colours and cushions are of other dice than the reconstruction's."""
    return built(kind, template_of(kind, STYLE), UprightBox(x, y, z, yaw, *size), 0, seed=11)


def cameras(width: int = 160, height: int = 120):
    """One at each end of the room."""
    ends = (((0.5, 2.0, 1.6), (3.0, 2.0, 1.1)), ((4.5, 1.9, 1.6), (2.0, 2.0, 1.1)))
    return [make_camera(np.array(eye), np.array(at), width=width, height=height, fov_deg=90.0) for eye, at in ends]


def observations(things: list[SceneObject], index: int, count: int = 2, noise: float = 0.003) -> tuple[Observation, ...]:
    """What `count` cameras show of one thing among others, with a little noise of depth."""
    scene = build_ray_scene(assemble_scene(bare().structure, things))
    rng = np.random.default_rng(5)
    found = []
    for camera in cameras()[:count]:
        gbuffer = cast(scene, camera)
        owner = np.append(scene.mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]
        depth = gbuffer.depth * (1 + noise * rng.normal(size=gbuffer.depth.shape)).astype(np.float32)
        grey = np.full((*depth.shape, 3), 0.5, np.float32)
        grey[owner == index] = (0.6, 0.3, 0.2)
        found.append(Observation(camera=camera, rgb=grey, depth=depth, mask=owner == index))
    return tuple(observation for observation in found if observation.mask.any())
