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

    Attributes:
        T_cam_world: [4, 4] world to camera
        focal: [2] pixels
        principal: [2] pixels, (width / 2, height / 2) for a centred camera
        width, height: pixels of the image
    """

    T_cam_world: Any
    focal: Any
    principal: Any
    width: int = dataclasses.field(metadata={"static": True})
    height: int = dataclasses.field(metadata={"static": True})


@record
class Mesh:
    """A labelled triangle mesh on the host; normals (right-hand rule) point from the solid into free air.

    Attributes:
        vertices: [v, 3] float64, metres
        faces: [f, 3] int32
        face_room: [f] int32, index into FloorPlan.rooms, OUTSIDE for none
        face_kind: [f] int32, SurfaceKind
        face_object: [f] int32, index into the scene's objects, OUTSIDE for structure
    """

    vertices: np.ndarray
    faces: np.ndarray
    face_room: np.ndarray
    face_kind: np.ndarray
    face_object: np.ndarray

    @classmethod
    def from_triangles(
        cls, vertices: Any, faces: Any, *, face_room: Any = 0, face_kind: Any = SurfaceKind.WALL, face_object: Any = OUTSIDE
    ) -> "Mesh":
        """A mesh from vertices [v, 3] in metres and faces [f, 3]; each label is one for all faces or [f], by default those of
        walls of the first room.

        Raises:
            ValueError: a shape is wrong, a vertex is not finite, or a face names a vertex that is not there.
        """
        vertices, faces = np.asarray(vertices, np.float64), np.asarray(faces)
        for name, x in (("vertices", vertices), ("faces", faces)):
            if x.ndim != 2 or x.shape[1] != 3:
                raise ValueError(f"{name} has shape {x.shape}; (n, 3) would be right")
        if not np.isfinite(vertices).all():
            raise ValueError("vertices has numbers that are not finite; metres would be right")
        if faces.size and (not np.issubdtype(faces.dtype, np.integer) or faces.min() < 0 or faces.max() >= len(vertices)):
            raise ValueError(f"faces must be whole numbers from 0 to {len(vertices) - 1}, the indices of vertices")
        labels = {"face_room": face_room, "face_kind": face_kind, "face_object": face_object}
        full = {name: np.broadcast_to(np.asarray(x, np.int32), len(faces)).copy() for name, x in labels.items()}
        return cls(vertices=vertices, faces=faces.astype(np.int32), **full)

    def to_trimesh(self) -> Any:
        """A `trimesh.Trimesh` with the same vertices and faces and `face_attributes` room, kind and object."""
        import trimesh

        labels: dict[str, Any] = {"room": self.face_room, "kind": self.face_kind, "object": self.face_object}
        return trimesh.Trimesh(self.vertices, self.faces, face_attributes=labels, process=False)


@record
class GBuffer:
    """What a camera sees of a mesh, on the host. Where nothing is hit: depth 0, normal 0, face -1, hit False.

    Attributes:
        depth: [h, w] float32 z-depth, metres
        normal: [h, w, 3] float32 unit geometric normal in world axes, as the mesh winds it
        face: [h, w] int32
        barycentric: [h, w, 2] float32 (u, v): p = (1 - u - v) v0 + u v1 + v v2
        hit: [h, w] bool
    """

    depth: np.ndarray
    normal: np.ndarray
    face: np.ndarray
    barycentric: np.ndarray
    hit: np.ndarray


@record
class Gaussians:
    """Anisotropic 3D gaussians on the device. Opacity is sigmoid(opacity_logits); k = (degree + 1)^2 SH coefficients.

    Attributes:
        means: [n, 3] metres, world
        quats: [n, 4] wxyz, need not be unit
        log_scales: [n, 3] log metres (standard deviations along the local axes)
        opacity_logits: [n]
        sh: [n, k, 3]; colour = max(0, 0.5 + sum_k sh_k Y_k(direction)), sRGB-encoded
    """

    means: Any
    quats: Any
    log_scales: Any
    opacity_logits: Any
    sh: Any


GAUSSIAN_FIELDS: tuple[str, ...] = tuple(field.name for field in dataclasses.fields(Gaussians))
"""In the order in which files keep them."""

Background = Float[Array, "3"] | Float[Array, "h w 3"] | Float[np.ndarray, "3"] | Float[np.ndarray, "h w 3"]
"""The colour behind all gaussians: one colour, or one per pixel. On the device or the host."""


@record
class Render:
    """What a camera sees of gaussians, on the device.

    Attributes:
        rgb: [h, w, 3] background included
        depth: [h, w] expected z-depth normalised by alpha, metres; 0 where alpha is 0
        alpha: [h, w] 1 - transmittance
    """

    rgb: Any
    depth: Any
    alpha: Any


@dataclasses.dataclass(frozen=True, eq=False)
class View:
    """A planned camera and why it stands there.

    Attributes:
        camera: NumPy float64 leaves
        room: index into FloorPlan.rooms: the room it looks at
        kind: bootstrap | perimeter | overhead | doorway | heldout
        name: unique in the scene, "<room id>/<kind><k>"
    """

    camera: Camera
    room: int
    kind: str
    name: str


@dataclasses.dataclass(frozen=True, eq=False)
class Texture:
    """Base colours on the faces of an object, on the host.

    They are tied to faces and not to positions, so that they stay with the object when it is moved or scaled.

    Attributes:
        image: [h, w, 3] uint8 sRGB
        corner_uv: [f, 3, 2] float32 in [0, 1]: of each face's corners; (0, 0) is the first pixel's corner, v runs down
        slots: [s] bool: slots whose faces look it up; the others have their slot's colour
    """

    image: np.ndarray
    corner_uv: np.ndarray
    slots: np.ndarray


@dataclasses.dataclass(frozen=True, eq=False)
class SceneObject:
    """One separate object in a room, as a closed or open triangle mesh in world space, on the host.

    Attributes:
        label: its name in everyday words, such as "armchair" or "floor lamp"
        room: index into FloorPlan.rooms
        support: floor | flat | wall | ceiling | object (stacked on another)
        vertices: [v, 3] float64, world metres
        faces: [f, 3] int32, outward winding
        face_slot: [f] int32, index into slots
        slots: material names: "dark_wood", "velvet", "brass" ...
        slot_colors: [s, 3] float32 base colour of each slot, sRGB in [0, 1]
        T_world_object: [4, 4] float64: object frame (x right, y back, z up, origin at the foot's centre) to world
        size: [3] float64 extent along the object's own axes, metres
        emission: [s] float32: how strongly each slot glows (0 for none)
        texture: colours finer than the slots', where images have shown them
        id: unique in the scene: the name of its GLB node and its row in objects.json; empty until it is furnished
    """

    label: str
    room: int
    support: str
    vertices: np.ndarray
    faces: np.ndarray
    face_slot: np.ndarray
    slots: tuple[str, ...]
    slot_colors: np.ndarray
    T_world_object: np.ndarray
    size: np.ndarray
    emission: np.ndarray
    texture: Texture | None = None
    id: str = ""


@dataclasses.dataclass(frozen=True, eq=False)
class Atlas:
    """Texels over the planar surfaces of a scaffold, on the host: the accumulated wall texture (paper, "Mesh Texturing").

    A chart is a planar surface of one room and one kind; its texels lie on a regular grid, row-major from `chart_start`.

    Attributes:
        texel_size: metres
        chart_origin: [c, 3] float64: world corner of texel (0, 0)
        chart_u: [c, 3] float64 unit axis along columns
        chart_v: [c, 3] float64 unit axis along rows
        chart_normal: [c, 3] float64 into free air
        chart_shape: [c, 2] int32 rows, columns
        chart_start: [c] int64: index of its first texel
        chart_room: [c] int32
        chart_kind: [c] int32 SurfaceKind
        face_chart: [f] int32 chart of each face of the mesh it was built from, -1 for none
        inside: [t] bool: the texel's centre lies on the surface (not in a hole or off its edge)
        color: [t, 3] float32 weighted mean so far
        weight: [t] float32 total weight so far
    """

    texel_size: float
    chart_origin: np.ndarray
    chart_u: np.ndarray
    chart_v: np.ndarray
    chart_normal: np.ndarray
    chart_shape: np.ndarray
    chart_start: np.ndarray
    chart_room: np.ndarray
    chart_kind: np.ndarray
    face_chart: np.ndarray
    inside: np.ndarray
    color: np.ndarray
    weight: np.ndarray
