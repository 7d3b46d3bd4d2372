"""Objects as rigid bodies: a frame, a mass with its centre and inertia, and the hulls of their parts.

    mass     of a part: density x min(volume, surface x wall) (`substances`); a part that is not closed has its hull's volume
    inertia  each part's as if its mass filled it evenly, about the centre of all
    moving   what stands on the floor or on another object; what hangs on a wall or under the ceiling is fixed
    rugs     lie fixed and collide with nothing: they are thinner than 1 cm, and the feet of furniture reach through them
"""

import dataclasses

import numpy as np
from jaxtyping import Float

from wm.export.simulation.hulls import Hull, convex_hull
from wm.export.simulation.parts import BodyPart, parts_of, volume
from wm.export.simulation.substances import LIGHTEST, substance
from wm.types import SceneObject

STANDING = ("floor", "object")
"""Values of `SceneObject.support` of what may move."""
SMALLEST_INERTIA = 1e-9
"""kg m^2 along each axis at least: engines refuse a body that nothing resists turning."""


@dataclasses.dataclass(frozen=True, eq=False)
class Body:
    """A rigid body; its frame is the object's (`SceneObject.T_world_object`), without scale."""

    thing: SceneObject
    T_world_body: np.ndarray  # [4, 4]
    mass: float  # kg
    center: np.ndarray  # [3] metres: centre of mass
    inertia: np.ndarray  # [3, 3] kg m^2 about the centre, along the body's axes
    hulls: tuple[Hull, ...]  # empty where it collides with nothing
    open_parts: int  # parts that bound no volume, whose hulls stand for them

    @property
    def id(self) -> str:
        return self.thing.id

    @property
    def moves(self) -> bool:
        return self.thing.support in STANDING

    @property
    def vertices(self) -> np.ndarray:
        """[v, 3] of the object, in the body's frame."""
        return to_frame(self.T_world_body, self.thing.vertices)


def rigid_body(thing: SceneObject) -> Body:
    """The body of an object."""
    T_world_body = _rigid(thing.T_world_object)
    parts = parts_of(thing)
    hulls = [convex_hull(to_frame(T_world_body, part.corners.reshape(-1, 3))) for part in parts]
    masses, centers, inertias = zip(*(_massive(thing, part, hull, T_world_body) for part, hull in zip(parts, hulls)))
    mass, center, inertia = _joined(np.array(masses), np.array(centers), np.array(inertias))
    return Body(
        thing=thing,
        T_world_body=T_world_body,
        mass=mass,
        center=center,
        inertia=inertia,
        hulls=() if thing.support == "flat" else tuple(hulls),
        open_parts=sum(not part.closed for part in parts),
    )


def to_frame(T_world_body: Float[np.ndarray, "4 4"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """World points in a body's frame."""
    return (points - T_world_body[:3, 3]) @ T_world_body[:3, :3]


def _rigid(T: Float[np.ndarray, "4 4"]) -> Float[np.ndarray, "4 4"]:
    """The pose without scale and mirroring: the rotation closest to it (Kabsch)."""
    U, _, Vt = np.linalg.svd(T[:3, :3])
    rigid = np.eye(4)
    rigid[:3, :3] = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
    rigid[:3, 3] = T[:3, 3]
    exact = np.abs(rigid - T).max() < 1e-12
    return np.array(T, np.float64) if exact else rigid


def _massive(thing: SceneObject, part: BodyPart, hull: Hull, T_world_body: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, centre and inertia about the centre of a part, in the body's frame."""
    import trimesh

    corners = hull.vertices[hull.faces]
    if part.closed:
        corners = to_frame(T_world_body, part.corners.reshape(-1, 3)).reshape(-1, 3, 3)
    material = substance(thing.slots[part.slot], thing.label)
    mass = material.density * min(volume(corners), part.area * material.wall)
    middle = corners.mean(axis=(0, 1))
    solid = trimesh.triangles.mass_properties(corners - middle, density=1.0)
    share = mass / solid["volume"]
    return mass, solid["center_mass"] + middle, np.asarray(solid["inertia"]) * share


def _joined(mass: np.ndarray, center: np.ndarray, inertia: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, centre and inertia of all parts together (parallel axes, Steiner)."""
    total = mass.sum()
    middle = (mass[:, None] * center).sum(axis=0) / total
    arm = center - middle
    steiner = (arm**2).sum(axis=1)[:, None, None] * np.eye(3) - arm[:, :, None] * arm[:, None, :]
    joined = (inertia + mass[:, None, None] * steiner).sum(axis=0) * (max(total, LIGHTEST) / total)
    return float(max(total, LIGHTEST)), middle, (joined + joined.T) / 2 + np.eye(3) * SMALLEST_INERTIA
