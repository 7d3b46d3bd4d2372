"""The building as one watertight solid, carved from a block.

    block    the outline of all rooms and shafts, from below the floor slab to above the highest ceiling slab
    rooms    each interior from floor to its ceiling                         -> FLOOR, CEILING, WALL
    doors    from one wall face to the other, sill to head                   -> FLOOR under the door, REVEAL
    hatches  the same                                                        -> REVEAL
    windows  from the inner face to the pane and from the outer face to it   -> REVEAL and PANE; EXTERIOR
             (what is left between is the glass)
    entrances  the same, and what is left between is the closed leaf         -> REVEAL; EXTERIOR

Everything is subtracted from the block, so every triangle lies on one labelled plane of one solid and normals point into free
air. A cutter that stops short of a wall's face by 1e-12 m leaves a film, and one that runs on into the room has its floor in the
room's floor, where either label may win; so openings run on by OVERSHOOT and narrow by INSET on the way. Source: WorldMesh,
"Floor Plan Generation"; the reveals, panes and labels are ours.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import Polygon

from wm.geometry.mesh.labelled_solids import LabelledSolid, carve, polygon_rings, prism, tunnel
from wm.geometry.mesh.slivers import flip_slivers
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan
from wm.geometry.plan.walls import SHARED, room_polygons
from wm.types import OUTSIDE, Mesh, SurfaceKind

SLAB = 0.15  # metres of floor and ceiling slab
PANE = 0.02  # metres of glass
LEAF = 0.04  # metres of a closed entrance door
OVERSHOOT = 0.02  # metres by which an opening runs on beyond the face of a wall
INSET = 0.005  # metres by which it narrows on the way


def build_structure(plan: FloorPlan) -> Mesh:
    """The watertight, labelled mesh of a plan's walls, floors and ceilings.

    The building has one flat roof above its highest ceiling. A door's reveal and threshold belong to the lower-numbered of
    its two rooms. Equal plans give equal bytes.

    Args:
      plan: a plan that keeps the rules (`parse_plan` returns no other).

    Returns:
      A closed mesh; `face_room` is OUTSIDE exactly where `face_kind` is EXTERIOR.

    Raises:
      ValueError: a room has no floor, or an opening is not on a wall (PlanError).
      RuntimeError: the geometry kernel failed, or removed another volume than the plan says.
    """
    # Carved about its own corner: far from zero, coordinates are too coarse for faces that should coincide.
    origin = np.min([room.polygon.min(axis=0) for room in plan.rooms], axis=0)
    local = _moved(plan, -origin)
    blocks, rooms = _blocks(local), _rooms(local)
    vertices, faces, labels = carve(blocks, [*rooms, *_openings(local)])
    _check_volume(local, vertices, faces, blocks, rooms)
    faces, labels = flip_slivers(vertices, faces, labels)
    vertices, faces, labels = _canonical(vertices + np.append(origin, 0.0), faces, labels)
    room, kind = np.divmod(labels, len(SurfaceKind))
    return Mesh(
        vertices=vertices,
        faces=faces,
        face_room=(room + OUTSIDE).astype(np.int32),
        face_kind=kind.astype(np.int32),
        face_object=np.full(len(faces), OUTSIDE, np.int32),
    )


def _moved(plan: FloorPlan, shift: np.ndarray) -> FloorPlan:
    rooms = []
    for room in plan.rooms:
        openings = tuple(dataclasses.replace(opening, segment=opening.segment + shift) for opening in room.openings)
        walls = tuple(dataclasses.replace(wall, segment=wall.segment + shift) for wall in room.walls)
        holes, columns = (tuple(ring + shift for ring in rings) for rings in (room.holes, room.columns))
        rooms.append(
            dataclasses.replace(room, polygon=room.polygon + shift, openings=openings, holes=holes, columns=columns, walls=walls)
        )
    return dataclasses.replace(plan, rooms=tuple(rooms), solids=tuple(ring + shift for ring in plan.solids))


def _label(room: int, kind: SurfaceKind) -> int:
    return (room - OUTSIDE) * len(SurfaceKind) + int(kind)


_SKIN = _label(OUTSIDE, SurfaceKind.EXTERIOR)


def outline(plan: FloorPlan) -> Polygon | shapely.MultiPolygon:
    """The building from above: the union of the rooms and of its solid parts, gaps narrower than SHARED closed."""
    rooms = shapely.union_all([*room_polygons(plan), *map(Polygon, plan.solids)])
    mitred = {"join_style": "mitre", "mitre_limit": 1e3}
    closed = rooms.buffer(SHARED / 2 + 1e-6, **mitred).buffer(-SHARED / 2 - 1e-6, **mitred)
    return shapely.simplify(closed, 1e-7)


def _blocks(plan: FloorPlan) -> list[LabelledSolid]:
    top = max(room.ceiling_height for room in plan.rooms) + SLAB
    return [
        prism(polygon_rings(part), -SLAB, top, bottom=_SKIN, top=_SKIN, side=_SKIN) for part in shapely.get_parts(outline(plan))
    ]


def _rooms(plan: FloorPlan) -> list[LabelledSolid]:
    solids = []
    for index, room in enumerate(plan.rooms):
        rings = polygon_rings(interior_polygon(plan, index))
        floor, ceiling, wall = (_label(index, kind) for kind in (SurfaceKind.FLOOR, SurfaceKind.CEILING, SurfaceKind.WALL))
        solids.append(prism(rings, 0.0, room.ceiling_height, bottom=floor, top=ceiling, side=wall))
    return solids


def _openings(plan: FloorPlan) -> list[LabelledSolid]:
    solids = []
    for portal in portals(plan):
        solids.extend([_hole(portal)] if portal.is_open else _closed(portal))
    return solids


def _hole(portal: Portal) -> LabelledSolid:
    """From face to face, and on into the free air of both rooms. Faces may be askew: only where it narrows may it leave them."""
    reveal = _label(portal.rooms[0], SurfaceKind.REVEAL)
    floor = reveal if portal.sill > 0 else _label(portal.rooms[0], SurfaceKind.FLOOR)
    first, last = -portal.depths[0], portal.depths[1]
    steps = [(first - OVERSHOOT, INSET), (first, 0.0), (last, 0.0), (last + OVERSHOOT, INSET)]
    return tunnel(_sections(portal, steps), bottom=floor, side=reveal, first=reveal, last=reveal)


def _closed(portal: Portal) -> list[LabelledSolid]:
    """The recess in the room and the recess outside, with the pane of a window or the leaf of an entrance between them."""
    first, last = -portal.half_depths[0], portal.half_depths[1]
    half = _barrier(portal) / 2
    window = portal.kind == "window"
    reveal, pane = _label(portal.rooms[0], SurfaceKind.REVEAL), _label(portal.rooms[0], SurfaceKind.PANE)
    inside = _sections(portal, [(first - OVERSHOOT, INSET), (first, 0.0), (-half, 0.0)])
    outside = _sections(portal, [(half, 0.0), (last, 0.0), (last + OVERSHOOT, INSET)])
    return [
        tunnel(inside, bottom=reveal, side=reveal, first=reveal, last=pane if window else reveal),
        tunnel(outside, bottom=_SKIN, side=_SKIN, first=_SKIN, last=_SKIN),
    ]


def _barrier(portal: Portal) -> float:
    """Metres of what closes an opening: glass or a door's leaf, 0 of a hole from room to room."""
    if portal.is_open:
        return 0.0
    return min(PANE if portal.kind == "window" else LEAF, sum(portal.half_depths) / 4)


def _sections(portal: Portal, steps: Sequence[tuple[float | np.ndarray, float]]) -> np.ndarray:
    """[k, 4, 3]: the opening's rectangle at distances along its normal, drawn in by an inset at each.

    A distance is one number, or two for the two ends. Each rectangle is counter-clockwise seen from farther along the normal,
    because that is on the right of start -> end.
    """
    start, end = portal.ends
    along = (end - start) / portal.width
    sections = []
    for distance, inset in steps:
        at_start, at_end = np.broadcast_to(distance, 2)
        left, right = start + at_start * portal.normal + inset * along, end + at_end * portal.normal - inset * along
        low, high = portal.sill + inset, portal.head - inset
        sections.append([[*left, low], [*right, low], [*right, high], [*left, high]])
    return np.array(sections)


def _check_volume(plan: FloorPlan, vertices, faces, blocks: list[LabelledSolid], rooms: list[LabelledSolid]) -> None:
    """The kernel can fail without an error, so the volume of its result is compared with the plan's."""
    expected = sum(solid.volume for solid in blocks) - sum(solid.volume for solid in rooms)
    for portal in portals(plan):
        expected -= portal.width * (portal.head - portal.sill) * (sum(portal.half_depths) - _barrier(portal))
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    volume = float(np.sum(a * np.cross(b, c))) / 6
    # Where shared walls are not quite parallel (within SHARED), a door's depth is a mean, and less than 1e-4 m^3 wrong.
    if not abs(volume - expected) <= 1e-4 * (1 + len(portals(plan))) + 1e-9 * expected:
        raise RuntimeError(f"the structure has a volume of {volume:.6f} m^3 where the plan says {expected:.6f} m^3")


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
