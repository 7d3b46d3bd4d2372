"""The building as one watertight solid, carved from a block.

    block    the outline of all rooms, from below the floor slab to above the highest ceiling slab
    rooms    each interior from floor to its ceiling                                   -> FLOOR, CEILING, WALL
    doors    from beyond one wall face to beyond the other, floor to head              -> FLOOR under the door, REVEAL
    windows  from beyond the inner face to the pane, and from beyond the outer face    -> REVEAL and PANE; EXTERIOR
             to the pane: what is left between is the glass

All is subtraction of prisms that overshoot (a cutter that stops short by 1e-12 m leaves a film), so every triangle lies on
one labelled face of one prism and normals point into free air. Source: WorldMesh, "Floor Plan Generation"; the reveals,
panes and labels are ours.
"""

import numpy as np
import shapely
from shapely.geometry import Polygon

from wm.geometry.footprint import DECIMALS, Portal, interior_polygon, portals
from wm.geometry.plan_records import FloorPlan
from wm.geometry.prism import Prism, carve, polygon_rings
from wm.geometry.walls import SHARED, room_polygons
from wm.types import OUTSIDE, Mesh, SurfaceKind

SLAB = 0.15  # metres of floor and ceiling slab
PANE = 0.02  # metres of glass
OVERSHOOT = 0.02  # metres by which a cutter passes the face of a wall


def build_structure(plan: FloorPlan) -> Mesh:
    """The watertight, labelled mesh of a plan's walls, floors and ceilings.

    The building has one flat roof above its highest ceiling. A door's reveal and threshold belong to the lower-numbered of
    its two rooms. Same plan, same bytes.

    Args:
      plan: a plan that keeps the rules (`parse_plan` returns no other).

    Returns:
      A closed mesh; `face_room` is OUTSIDE exactly where `face_kind` is EXTERIOR.

    Raises:
      ValueError: a room has no floor, or an opening no place (PlanError).
      RuntimeError: the geometry kernel failed, or removed another volume than the plan says.
    """
    origin = np.append(np.round(np.min([room.polygon.min(axis=0) for room in plan.rooms], axis=0)), 0.0)
    blocks, rooms, holes = _block(plan, origin), _rooms(plan, origin), _openings(plan, origin)
    vertices, faces, labels = carve(blocks, [*rooms, *holes])
    _check_volume(plan, vertices, faces, blocks, rooms)
    vertices, faces, labels = _canonical(vertices + origin, faces, labels)
    room, kind = np.divmod(labels, len(SurfaceKind))
    return Mesh(
        vertices=vertices,
        faces=faces,
        face_room=(room + OUTSIDE).astype(np.int32),
        face_kind=kind.astype(np.int32),
        face_object=np.full(len(faces), OUTSIDE, np.int32),
    )


def _label(room: int, kind: SurfaceKind) -> int:
    return (room - OUTSIDE) * len(SurfaceKind) + int(kind)


_SKIN = _label(OUTSIDE, SurfaceKind.EXTERIOR)


def outline(plan: FloorPlan) -> Polygon | shapely.MultiPolygon:
    """The building from above: the union of the room polygons, gaps narrower than SHARED closed."""
    rooms = shapely.union_all(room_polygons(plan))
    mitred = {"join_style": "mitre", "mitre_limit": 1e3}
    closed = rooms.buffer(SHARED / 2 + 1e-6, **mitred).buffer(-SHARED / 2 - 1e-6, **mitred)
    return shapely.simplify(closed, 1e-7)


def _block(plan: FloorPlan, origin: np.ndarray) -> list[Prism]:
    top = max(room.ceiling_height for room in plan.rooms) + SLAB
    blocks = []
    for part in shapely.get_parts(outline(plan)):
        rings = tuple(np.round(ring - origin[:2], DECIMALS) for ring in polygon_rings(part))
        blocks.append(Prism(rings, -SLAB, top, _SKIN, _SKIN, [_SKIN] * sum(map(len, rings))))
    return blocks


def _rooms(plan: FloorPlan, origin: np.ndarray) -> list[Prism]:
    prisms = []
    for index, room in enumerate(plan.rooms):
        (ring,) = polygon_rings(interior_polygon(plan, index))
        floor, ceiling, wall = (_label(index, kind) for kind in (SurfaceKind.FLOOR, SurfaceKind.CEILING, SurfaceKind.WALL))
        ring = np.round(ring - origin[:2], DECIMALS)
        prisms.append(Prism((ring,), 0.0, room.ceiling_height, floor, ceiling, [wall] * len(ring)))
    return prisms


def _openings(plan: FloorPlan, origin: np.ndarray) -> list[Prism]:
    prisms = []
    for portal in portals(plan):
        prisms.extend(_window(portal, origin) if portal.kind == "window" else [_door(portal, origin)])
    return prisms


def _door(portal: Portal, origin: np.ndarray) -> Prism:
    """From beyond the face in room a to beyond the face in room b; its two ends are in free air."""
    floor, reveal = _label(portal.rooms[0], SurfaceKind.FLOOR), _label(portal.rooms[0], SurfaceKind.REVEAL)
    ring = _ring(portal, origin, -portal.half_depths[0] - OVERSHOOT, portal.half_depths[1] + OVERSHOOT)
    return Prism((ring,), portal.sill, portal.head, floor, reveal, [reveal] * 4)


def _window(portal: Portal, origin: np.ndarray) -> list[Prism]:
    """The recess in the room and the recess outside, with the pane between them."""
    inner, outer = portal.half_depths
    glass = min(PANE, (inner + outer) / 4) / 2
    reveal, pane = _label(portal.rooms[0], SurfaceKind.REVEAL), _label(portal.rooms[0], SurfaceKind.PANE)
    inside = _ring(portal, origin, -inner - OVERSHOOT, -glass)
    outside = _ring(portal, origin, glass, outer + OVERSHOOT)
    return [
        Prism((inside,), portal.sill, portal.head, reveal, reveal, [pane, reveal, reveal, reveal]),
        Prism((outside,), portal.sill, portal.head, _SKIN, _SKIN, [_SKIN] * 4),
    ]


def _ring(portal: Portal, origin: np.ndarray, low: float, high: float) -> np.ndarray:
    """[4, 2]: the rectangle over the opening from `low` to `high` along the normal, counter-clockwise.

    Its edges: at `high`, beside the end, at `low`, beside the start (the normal is on the right of start -> end).
    """
    start, end = portal.ends - origin[:2]
    near, far = low * portal.normal, high * portal.normal
    return np.round(np.stack([start + far, end + far, end + near, start + near]), DECIMALS)


def _check_volume(plan: FloorPlan, vertices, faces, blocks: list[Prism], rooms: list[Prism]) -> None:
    """The kernel fails in silence (facts.md), so its volume is compared with the plan's."""
    expected = sum(_volume(prism) for prism in blocks) - sum(_volume(prism) for prism in rooms)
    for portal in portals(plan):
        depth = sum(portal.half_depths)
        glass = min(PANE, depth / 4) if portal.kind == "window" else 0.0
        expected -= portal.width * (portal.head - portal.sill) * (depth - glass)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    volume = float(np.sum(a * np.cross(b, c))) / 6
    # Where shared walls are not quite parallel, a door's depth is a mean: 1e-5 m^3 each at most.
    if not abs(volume - expected) <= 1e-4 + 1e-5 * len(portals(plan)) + 1e-9 * expected:
        raise RuntimeError(f"the structure has a volume of {volume:.6f} m^3 where the plan says {expected:.6f} m^3")


def _volume(prism: Prism) -> float:
    area = 0.0
    for ring in prism.rings:
        x, y = ring.T
        area += float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2
    return area * (prism.high - prism.low)


def _canonical(vertices: np.ndarray, faces: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices sorted by coordinate, triangles by label, so that the bytes do not depend on the kernel's threads."""
    order = np.lexsort(vertices.T)
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order), dtype=np.int32)
    faces = rank[faces]
    turn = (np.argmin(faces, axis=1)[:, None] + np.arange(3)) % 3
    faces = np.take_along_axis(faces, turn, axis=1)
    by_label = np.lexsort((faces[:, 2], faces[:, 1], faces[:, 0], labels))
    return vertices[order], faces[by_label], labels[by_label]
