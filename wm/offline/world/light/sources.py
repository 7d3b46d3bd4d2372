"""Where a room's light comes from: the sky in its panes, the sun through them, its lamps, and a ceiling light where it has none.

Every source is a set of sample points with area and radiance, made once per room from low-discrepancy sequences. Radiances are
relative: wm.offline.world.light.bake scales daylight and lamps so that every room is legible at the scene's one exposure.
"""

import dataclasses

import numpy as np

from wm.color import to_linear
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.offline.style.finish import Light
from wm.types import OUTSIDE, Mesh, SceneObject, SurfaceKind

FIRE = ("flame", "ember")
"""Slots that glow in the colour of fire."""


@dataclasses.dataclass(frozen=True, eq=False)
class Emitter:
    """Area light sampled at k strata of one surface."""

    points: np.ndarray  # [k, 3] float64 one point in each stratum
    spread: np.ndarray  # [k, 2, 3] float64: a point may be moved by these vectors times a number in [-1/2, 1/2]
    normals: np.ndarray  # [k, 3] float64 unit, into the room; 0 for a source that shines all ways
    areas: np.ndarray  # [k] float64 square metres that each point stands for
    radiance: np.ndarray  # [k, 3] float32 linear
    sky: bool  # seen through it is the sky: its radiance depends on the direction


def pane_emitters(mesh: Mesh, room: int, light: Light) -> list[Emitter]:
    """One emitter for each pane of a room: 4 x 5 strata of its rectangle."""
    faces = np.flatnonzero((mesh.face_room == room) & (mesh.face_kind == SurfaceKind.PANE))
    emitters = []
    corners = mesh.vertices[mesh.faces[faces]]
    cross = face_crosses(corners)
    normals = cross / np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-12)
    color = np.maximum(soften(light.sky_color), 0)
    for group in _rectangles(corners, normals):
        points = corners[group].reshape(-1, 3)
        normal = normals[group[0]]
        u = np.array([-normal[1], normal[0], 0.0])
        s, z = points @ u, points[:, 2]
        width, height = np.ptp(s), np.ptp(z)
        across, up = (np.arange(4) + 0.5) / 4, (np.arange(5) + 0.5) / 5
        a, b = (grid.ravel() for grid in np.meshgrid(s.min() + across * width, z.min() + up * height))
        base = points[0] - (points[0] @ u) * u  # any point of the plane
        base = np.array([base[0], base[1], 0.0])
        where = base + a[:, None] * u + b[:, None] * np.array([0.0, 0.0, 1.0]) + 0.02 * normal
        spread = np.broadcast_to(np.stack([u * width / 4, np.array([0.0, 0.0, height / 5])]), (20, 2, 3))
        emitters.append(
            Emitter(
                points=where, spread=spread, normals=np.broadcast_to(normal, (20, 3)), areas=np.full(20, width * height / 20),
                radiance=np.broadcast_to(color, (20, 3)).astype(np.float32), sky=True,
            )
        )  # fmt: skip
    return emitters


def lamp_emitters(objects: tuple[SceneObject, ...], room: int, light: Light, *, budget: int = 40) -> list[Emitter]:
    """One emitter for each glowing object of a room, its samples spread over its glowing triangles by area and strength."""
    glowing = [thing for thing in objects if thing.room == room and np.any(thing.emission > 0)]
    each = max(2, min(8, budget // max(1, len(glowing))))
    return [_object_emitter(thing, light, each) for thing in glowing]


def ceiling_emitters(polygon: np.ndarray, height: float, light: Light) -> list[Emitter]:
    """A soft ceiling light, or a row of them along a long room, for rooms that have no lamp."""
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    span = high - low
    axis = int(span[1] > span[0])
    count = max(1, round(span[axis] / 3.0))
    emitters = []
    for k in range(count):
        middle = (low + high) / 2
        middle[axis] = low[axis] + (k + 0.5) / count * span[axis]
        turn = 2 * np.pi * (np.arange(6) + 0.5) / 6
        points = np.column_stack([middle[0] + 0.25 * np.cos(turn), middle[1] + 0.25 * np.sin(turn), np.full(6, height - 0.06)])
        emitters.append(
            Emitter(
                points=points, spread=np.zeros((6, 2, 3)), normals=np.tile([0.0, 0.0, -1.0], (6, 1)), areas=np.full(6, 0.05),
                radiance=np.tile(soften(light.lamp_color), (6, 1)), sky=False,
            )
        )  # fmt: skip
    return emitters


def glow_color(thing: SceneObject, slot: int, light: Light) -> np.ndarray:
    """[3] linear colour that a glowing slot sends out."""
    name = thing.slots[slot]
    if name in FIRE:
        return soften(light.fire_color)
    own = to_linear(np.asarray(thing.slot_colors[slot], np.float32))
    if name == "screen":
        return own
    warm = soften(light.lamp_color)
    return (warm * (0.5 + 0.5 * own / max(float(own.max()), 1e-3))).astype(np.float32)


def soften(color: tuple[float, float, float], share: float = 0.55) -> np.ndarray:
    """[3] linear colour of light, its largest channel 1, with part of its tint taken out: as an adapted eye sees it."""
    linear = to_linear(np.asarray(color, np.float32))
    linear = linear / max(float(linear.max()), 1e-3)
    return (linear**share).astype(np.float32)


def sun_direction(mesh: Mesh, light: Light) -> np.ndarray:
    """[3] unit vector towards the sun: at the style's height, and turned to where it shines slantwise into most glass.

    The style's azimuth decides among directions that are nearly as good.
    """
    panes = (mesh.face_kind == SurfaceKind.PANE) & (mesh.face_object == OUTSIDE)
    corners = mesh.vertices[mesh.faces[panes]]
    cross = face_crosses(corners) / 2
    azimuths = light.sun_azimuth + np.radians(np.arange(0, 360, 15.0))
    toward = np.column_stack([np.cos(azimuths), np.sin(azimuths), np.zeros(len(azimuths))])
    area = np.linalg.norm(cross, axis=1)
    facing = -(toward @ (cross / np.maximum(area[:, None], 1e-12)).T)
    slant = np.where(facing > 0.15, np.exp(-(((np.arccos(np.clip(facing, -1, 1)) - 0.7) / 0.35) ** 2)), 0.0)
    score = slant @ area + 1e-3 * np.cos(azimuths - light.sun_azimuth)
    best = azimuths[int(np.argmax(score))]
    height = max(light.sun_elevation, 0.05)
    return np.array([np.cos(best) * np.cos(height), np.sin(best) * np.cos(height), np.sin(height)])


def _rectangles(corners: np.ndarray, normals: np.ndarray) -> list[np.ndarray]:
    """Triangles grouped into panes: one plane and overlapping in plan and height."""
    groups: list[list[int]] = []
    boxes: list[list[np.ndarray]] = []
    for k in range(len(corners)):
        low, high = corners[k].min(axis=0) - 1e-3, corners[k].max(axis=0) + 1e-3
        for group, box in zip(groups, boxes):
            if normals[group[0]] @ normals[k] > 0.999 and np.all(low <= box[1]) and np.all(box[0] <= high):
                group.append(k)
                box[0], box[1] = np.minimum(box[0], low), np.maximum(box[1], high)
                break
        else:
            groups.append([k])
            boxes.append([low, high])
    return [np.array(group) for group in groups]


def _object_emitter(thing: SceneObject, light: Light, count: int) -> Emitter:
    strength = thing.emission[thing.face_slot]
    faces = np.flatnonzero(strength > 0)
    corners = thing.vertices[thing.faces[faces]]
    cross = face_crosses(corners)
    area = np.linalg.norm(cross, axis=1) / 2
    flux = area * strength[faces]
    cumulative = np.cumsum(flux) / max(float(flux.sum()), 1e-12)
    at = (np.arange(count) + 0.5) / count
    pick = np.minimum(np.searchsorted(cumulative, at), len(faces) - 1)
    r1 = np.sqrt(np.mod(np.arange(count) * 0.7548777 + 0.5, 1.0))
    r2 = np.mod(np.arange(count) * 0.5698403 + 0.5, 1.0)
    weights = np.column_stack([1 - r1, r1 * (1 - r2), r1 * r2])
    normals = cross[pick] / np.maximum(np.linalg.norm(cross[pick], axis=1, keepdims=True), 1e-12)
    points = np.einsum("kp,kpi->ki", weights, corners[pick]) + 0.02 * normals
    colors = np.stack([glow_color(thing, int(slot), light) for slot in thing.face_slot[faces[pick]]])
    # Lamps shine all ways: shades and flames are small, and a sample stands for the whole body's share.
    return Emitter(
        points=points, spread=np.zeros((count, 2, 3)), normals=np.zeros((count, 3)),
        areas=np.full(count, float(flux.sum()) / count / 4), radiance=colors.astype(np.float32), sky=False,
    )  # fmt: skip
