"""The laws of a furnished room, checked on its meshes alone, so that they judge every way of placing things.

No thing reaches into another by more than LIMIT, floats by more than that, leaves its room or leans by more than TILT; and a
body of 0.25 m radius gets from every door to every other that it could reach in the bare room. Seen from above, a thing is the
convex outline of its vertices. Nothing here is shared with placement, which is judged by it.
"""

import dataclasses
import math

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry
from skimage.measure import label

from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.plan.site import Site
from wm.geometry.rays.raycast import build_ray_scene, cast_rays
from wm.types import Mesh, SceneObject

LIMIT = 0.01
"""Metres."""
TILT = math.radians(1.0)
_BODY, _HEADROOM = 0.25, 1.8  # as in clearances.py, stated again: a slip there must not pass here
_CELL = 0.05
_HELD = 1 / 3
"""Share of the points under a thing that must find something within LIMIT below them."""
_EMPTY = Mesh(
    vertices=np.zeros((0, 3)), faces=np.zeros((0, 3), np.int32), face_room=np.zeros(0, np.int32),
    face_kind=np.zeros(0, np.int32), face_object=np.zeros(0, np.int32),
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class BrokenLaw:
    """One law that a room breaks, and what breaks it."""

    law: str  # interpenetrates | floats | leaves | tilts | blocks
    what: str


@dataclasses.dataclass(frozen=True, eq=False)
class _Trunk:
    hull: BaseGeometry
    low: float
    high: float


def broken_laws(things: list[SceneObject], site: Site) -> list[BrokenLaw]:
    """Every law that the things of a room break."""
    trunks = [_trunk(thing) for thing in things]
    found = []
    for thing, trunk in zip(things, trunks):
        if not site.polygon.buffer(LIMIT).covers(trunk.hull) or trunk.low < -LIMIT or trunk.high > site.ceiling + LIMIT:
            found.append(BrokenLaw("leaves", thing.label))
        if math.acos(min(max(float(thing.T_world_object[2, 2]), -1.0), 1.0)) > TILT:
            found.append(BrokenLaw("tilts", thing.label))
    found += [BrokenLaw("floats", things[k].label) for k in range(len(things)) if _floats(k, things, trunks, site)]
    found += [
        BrokenLaw("interpenetrates", f"{things[i].label} and {things[j].label}")
        for i in range(len(things))
        for j in range(i)
        if _penetrate(trunks[i], trunks[j])
    ]
    return found + [BrokenLaw("blocks", f"door {k}") for k in blocked_doors(things, site)]


def blocked_doors(things: list[SceneObject], site: Site) -> list[int]:
    """Doors and passages from which a body no longer gets to all that it could reach from there in the bare room."""
    hulls = [t.hull for t in map(_trunk, things) if t.low < _HEADROOM and t.high > 0.1]
    bare = _reach_of(site, shapely.MultiPolygon())
    now = _reach_of(site, shapely.union_all(hulls).buffer(_BODY))
    return [k for k in range(len(site.probes)) if bare[k] and not bare[k] <= now[k]]


def _reach_of(site: Site, blocked: BaseGeometry) -> list[frozenset[int]]:
    """For each door, the doors that a body reaches from it; nothing where it cannot stand before it."""
    x0, y0, x1, y1 = site.polygon.bounds
    gx, gy = np.meshgrid(np.arange(x0, x1, _CELL), np.arange(y0, y1, _CELL))
    area = site.polygon.buffer(-_BODY + 0.02).difference(blocked.buffer(-0.02))
    shapely.prepare(area)
    labels = np.asarray(label(shapely.contains_xy(area, gx, gy), connectivity=2), np.int32)
    near = [set(np.unique(labels[np.hypot(gx - x, gy - y) < 0.35]).tolist()) - {0} for x, y in site.probes]
    return [frozenset(j for j, other in enumerate(near) if mine & other) for mine in near]


def _trunk(thing: SceneObject) -> _Trunk:
    z = thing.vertices[:, 2]
    return _Trunk(shapely.MultiPoint(thing.vertices[:, :2]).convex_hull, float(z.min()), float(z.max()))


def _penetrate(a: _Trunk, b: _Trunk) -> bool:
    if min(a.high, b.high) - max(a.low, b.low) <= LIMIT or not a.hull.intersects(b.hull):
        return False
    return bool(a.hull.buffer(-LIMIT / 2).intersects(b.hull.buffer(-LIMIT / 2)))


def _floats(k: int, things: list[SceneObject], trunks: list[_Trunk], site: Site) -> bool:
    """Whether nothing holds a thing: no floor, wall, ceiling or other thing within LIMIT."""
    trunk, support = trunks[k], things[k].support
    if trunk.low <= LIMIT:
        return False
    if support == "ceiling":
        return site.ceiling - trunk.high > LIMIT
    if support == "wall":
        return float(shapely.distance(site.polygon.exterior, trunk.hull)) > LIMIT
    return not _held(trunk, [thing for j, thing in enumerate(things) if j != k])


def _held(trunk: _Trunk, others: list[SceneObject]) -> bool:
    x0, y0, x1, y1 = trunk.hull.bounds
    gx, gy = np.meshgrid(np.linspace(x0, x1, 11)[1:-1], np.linspace(y0, y1, 11)[1:-1])
    inside = shapely.contains_xy(trunk.hull, gx, gy)
    origins = np.stack([gx[inside], gy[inside], np.full(int(inside.sum()), trunk.low + 0.001)], axis=1)
    if not others or not len(origins):
        return False
    hits = cast_rays(build_ray_scene(assemble_scene(_EMPTY, others)), origins, np.tile([[0.0, 0.0, -1.0]], (len(origins), 1)))
    return bool((hits.t < LIMIT + 0.001).mean() >= _HELD)
