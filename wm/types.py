"""The records that several packages share.

Units are metres and radians; z is up; right-handed. Camera axes are OpenCV's (x right, y down, z forward); pixel (i, j) has its
centre at (i + 0.5, j + 0.5); depth is z-depth, not ray length; quaternions are wxyz; images are float32 in [0, 1], sRGB-encoded,
`[h, w, 3]`. Records on the host hold NumPy arrays and records on the device hold JAX arrays; each docstring says which.
"""

import dataclasses
import enum
import typing
from typing import Any

import chex
import jax
import numpy as np
from jaxtyping import Array, Float

T = typing.TypeVar("T")


@typing.dataclass_transform(frozen_default=True, eq_default=False)
def record(cls: type[T]) -> type[T]:
    """A frozen pytree of arrays without static fields: chex's dataclass, declared so that type checkers understand it."""
    return chex.dataclass(frozen=True, mappable_dataclass=False, eq=False)(cls)


OUTSIDE = -1
"""`Mesh.face_room` of a face that belongs to no room (the building's outer skin), and `Mesh.face_object` of structure."""


class SurfaceKind(enum.IntEnum):
    """What a triangle of the scaffold is part of (`Mesh.face_kind`)."""

    WALL = 0
    FLOOR = 1
    CEILING = 2
    REVEAL = 3  # the jambs, head and sill inside an opening
    PANE = 4  # the glass that closes a window
    OBJECT = 5
    EXTERIOR = 6  # the outer skin: never seen from inside


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera; `width` and `height` are static under jit, the rest are arrays (host or device).

    A point projects to pixels by p_cam = T_cam_world @ p_world, (u, v) = focal * p_cam[:2] / p_cam[2] + principal.
    """

    T_cam_world: Any  # [4, 4] world to camera
    focal: Any  # [2] pixels
    principal: Any  # [2] pixels, (width / 2, height / 2) for a centred camera
    width: int = dataclasses.field(metadata={"static": True})
    height: int = dataclasses.field(metadata={"static": True})


@record
class Mesh:
    """A labelled triangle mesh on the host; normals (right-hand rule) point from the solid into free air."""

    vertices: np.ndarray  # [v, 3] float64, metres
    faces: np.ndarray  # [f, 3] int32
    face_room: np.ndarray  # [f] int32, index into FloorPlan.rooms, OUTSIDE for none
    face_kind: np.ndarray  # [f] int32, SurfaceKind
    face_object: np.ndarray  # [f] int32, index into the scene's objects, OUTSIDE for structure

    def to_trimesh(self) -> Any:
        """A `trimesh.Trimesh` with the same vertices and faces and `face_attributes` room, kind and object."""
        import trimesh

        labels: dict[str, Any] = {"room": self.face_room, "kind": self.face_kind, "object": self.face_object}
        return trimesh.Trimesh(self.vertices, self.faces, face_attributes=labels, process=False)


@record
class GBuffer:
    """What a camera sees of a mesh, on the host. Where nothing is hit: depth 0, normal 0, face -1, hit False."""

    depth: np.ndarray  # [h, w] float32 z-depth, metres
    normal: np.ndarray  # [h, w, 3] float32 unit geometric normal in world axes, as the mesh winds it
    face: np.ndarray  # [h, w] int32
    barycentric: np.ndarray  # [h, w, 2] float32 (u, v): p = (1 - u - v) v0 + u v1 + v v2
    hit: np.ndarray  # [h, w] bool


@record
class Gaussians:
    """Anisotropic 3D gaussians on the device. Opacity is sigmoid(opacity_logits); k = (degree + 1)^2 SH coefficients."""

    means: Any  # [n, 3] metres, world
    quats: Any  # [n, 4] wxyz, need not be unit
    log_scales: Any  # [n, 3] log metres (standard deviations along the local axes)
    opacity_logits: Any  # [n]
    sh: Any  # [n, k, 3]; colour = 0.5 + sum_k sh_k Y_k(direction), sRGB-encoded


Background = Float[Array, "3"] | Float[Array, "h w 3"] | Float[np.ndarray, "3"] | Float[np.ndarray, "h w 3"]
"""The colour behind all gaussians: one colour, or one per pixel. On the device or the host."""


@record
class Render:
    """What a camera sees of gaussians, on the device."""

    rgb: Any  # [h, w, 3] background included
    depth: Any  # [h, w] expected z-depth normalised by alpha, metres; 0 where alpha is 0
    alpha: Any  # [h, w] 1 - transmittance


@dataclasses.dataclass(frozen=True, eq=False)
class View:
    """A planned camera and why it stands there."""

    camera: Camera  # NumPy float64 leaves
    room: int  # index into FloorPlan.rooms: the room it looks at
    kind: str  # bootstrap | perimeter | overhead | doorway | heldout
    name: str  # unique in the scene, "<room id>/<kind><k>"


@dataclasses.dataclass(frozen=True, eq=False)
class Texture:
    """Base colours on the faces of an object, on the host.

    They are tied to faces and not to positions, so that they stay with the object when it is moved or scaled.
    """

    image: np.ndarray  # [h, w, 3] uint8 sRGB
    corner_uv: np.ndarray  # [f, 3, 2] float32 in [0, 1]; (0, 0) is the top left corner, v runs down
    slots: np.ndarray  # [s] bool: slots whose faces are textured; faces of the others have the colour of their slot


@dataclasses.dataclass(frozen=True, eq=False)
class SceneObject:
    """One separate object in a room, as a closed or open triangle mesh in world space, on the host."""

    label: str  # its name in everyday words, such as "armchair" or "floor lamp"
    room: int  # index into FloorPlan.rooms
    support: str  # floor | flat | wall | ceiling | object (stacked on another)
    vertices: np.ndarray  # [v, 3] float64, world metres
    faces: np.ndarray  # [f, 3] int32, outward winding
    face_slot: np.ndarray  # [f] int32, index into slots
    slots: tuple[str, ...]  # material names: "dark_wood", "velvet", "brass" ...
    slot_colors: np.ndarray  # [s, 3] float32 base colour of each slot, sRGB in [0, 1]
    T_world_object: np.ndarray  # [4, 4] float64: object frame (x right, y back, z up, origin at the foot's centre) to world
    size: np.ndarray  # [3] float64 extent along the object's own axes, metres
    emission: np.ndarray  # [s] float32: how strongly each slot glows (0 for none)
    texture: Texture | None = None  # colours finer than the slots', where images have shown them
    id: str = ""  # unique in the scene: the name of its GLB node and its row in objects.json; empty until it is furnished


@dataclasses.dataclass(frozen=True, eq=False)
class Atlas:
    """Texels over the planar surfaces of a scaffold, on the host: the accumulated wall texture (paper, "Mesh Texturing").

    A chart is a planar surface of one room and one kind; its texels lie on a regular grid, row-major from `chart_start`.
    """

    texel_size: float  # metres
    chart_origin: np.ndarray  # [c, 3] float64: world corner of texel (0, 0)
    chart_u: np.ndarray  # [c, 3] float64 unit axis along columns
    chart_v: np.ndarray  # [c, 3] float64 unit axis along rows
    chart_normal: np.ndarray  # [c, 3] float64 into free air
    chart_shape: np.ndarray  # [c, 2] int32 rows, columns
    chart_start: np.ndarray  # [c] int64: index of its first texel
    chart_room: np.ndarray  # [c] int32
    chart_kind: np.ndarray  # [c] int32 SurfaceKind
    face_chart: np.ndarray  # [f] int32 chart of each face of the mesh it was built from, -1 for none
    inside: np.ndarray  # [t] bool: the texel's centre lies on the surface (not in a hole or off its edge)
    color: np.ndarray  # [t, 3] float32 weighted mean so far
    weight: np.ndarray  # [t] float32 total weight so far
