"""Furnishes one room: functional groups by room type, pieces at the walls, pictures, lamps, curtains and clutter.

All choices are drawn from np.random.SeedSequence([seed, number of the room, 4]): equal seeds give equal rooms, different seeds
give different ones.
"""

import math
import zlib

import numpy as np
import shapely

from wm.geometry.plan.site import Site
from wm.offline.arrangement.equipped import Equipped
from wm.offline.arrangement.groups import middle_piece
from wm.offline.arrangement.hangings import curtain_pairs, hang, on_wall, wall_piece
from wm.offline.arrangement.inventory import (
    ABSENT,
    AT_WALL,
    CORNERS,
    FLAVOUR,
    ONCE,
    OVER_FURNITURE,
    WALL_FEATURES,
    lamp_sorts,
    with_lamp,
)
from wm.offline.arrangement.layout import Layout, Placed
from wm.offline.arrangement.programmes import PROGRAMME
from wm.offline.arrangement.room_arrangement import RoomArrangement
from wm.offline.arrangement.room_type import finish_type
from wm.offline.arrangement.rooms_equipped import EQUIPPED
from wm.offline.arrangement.wishes import granted
from wm.offline.style.finish import Style
from wm.types import SceneObject

NARROW = 2.1
"""Metres of width below which a room is furnished as a corridor, whatever it is called."""


LAMPED = (*PROGRAMME, "utility", "other")
"""Types of rooms that a house has lamps of one sort for."""


def furnish_site(site: Site, kind: str, style: Style, *, seed: int, room: int, density: float = 1.0) -> list[Placed]:
    """Everything in one room.

    Args:
      kind: room type, a value of room_type.ROOM_TYPES.
      room: a number that tells the room from others (wm.synth.seeds.room_number).
      density: 0..1, the share of the optional pieces that are tried.
    """
    rng = np.random.default_rng(np.random.SeedSequence([seed, room, 4]))
    layout = Layout(site)
    if not layout.floor.standing.any():
        return []
    narrow = 2 * float(shapely.maximum_inscribed_circle(site.polygon, tolerance=0.02).length) < NARROW
    kind = "corridor" if narrow and kind in ("hall", "gallery", "living", "other") else kind
    style = lamped(style, kind, seed)
    arrangement = RoomArrangement(layout, style, rng, density)
    if kind in EQUIPPED:
        equip(arrangement, kind, EQUIPPED[kind])
        return granted(layout.placed, style)
    if kind != "bathroom" and rng.random() < 0.55 + 0.4 * style.form.softness:
        curtain_pairs(arrangement)
    PROGRAMME[kind](arrangement)
    feature_walls(arrangement, kind)
    fill(arrangement, kind, AT_WALL[kind], wanted(site, kind, density))
    for _ in range(2 if kind not in ("bathroom", "corridor", "kitchen", "dining") else 0):
        if arrangement.chance(0.9) and middle_piece(arrangement, kind) is None:
            break
    hang_lamps(arrangement)
    hang_pictures(arrangement, kind)
    return granted(layout.placed, style)


def equip(room: RoomArrangement, kind: str, equipped: Equipped) -> None:
    """What makes a room of a type what it is, then what it may have besides."""
    if equipped.soft and room.chance(0.8):
        curtain_pairs(room)
    for group in equipped.groups:
        group(room)
    feature_walls(room, kind)
    fill(room, kind, equipped.walls, round(equipped.sparse * wanted(room.layout.site, kind, room.density)))
    hang_lamps(room)
    if equipped.soft:
        hang_pictures(room, kind)


def feature_walls(room: RoomArrangement, kind: str) -> None:
    """The large things on the walls that the style's family has in rooms of a type."""
    for name, middle, rooms in WALL_FEATURES.get(room.style.family, ()):
        if kind in rooms.split():
            wall_piece(room, name, middle)


def lamped(style: Style, kind: str, seed: int) -> Style:
    """The style with the sort of lamp that rooms of a kind have in this house."""
    sorts = lamp_sorts(style, finish_type(kind))
    pick = np.random.default_rng(np.random.SeedSequence([seed, zlib.crc32(kind.encode()), 5])).integers(len(sorts))
    return with_lamp(style, sorts[int(pick)])


def wanted(site: Site, kind: str, density: float) -> int:
    """How many pieces of furniture (without pictures, curtains, lamps and clutter) a room should hold."""
    base = {"bathroom": 4, "corridor": 2, "kitchen": 6, "dining": 8}.get(kind, 5)
    return round((base + 0.22 * min(site.polygon.area, 45.0)) * (0.3 + 0.7 * density))


def fill(room: RoomArrangement, kind: str, choices: tuple[str, ...], target: int) -> None:
    """Pieces along the walls, of `choices` and of what only the style's family has, until the room holds `target`."""
    absent = ABSENT.get(room.style.family, frozenset())
    special = [piece for piece, rooms in FLAVOUR.get(room.style.family, ()) if kind in rooms.split()]
    special = special if room.layout.site.polygon.area > 9 else special[:1]
    usual = [piece for piece in choices if piece not in absent]
    if kind not in ("library", "bathroom", "bedroom"):
        head = usual[:1]
        usual = head + [usual[1:][k] for k in room.rng.permutation(len(usual) - 1)] if usual else []
    for name in [*special, *usual]:
        if sum(p.piece.support in ("floor", "flat") for p in room.layout.placed) >= target and name not in special:
            break
        if room.rng.random() > 0.45 + 0.55 * room.density or (
            name in ONCE and any(p.piece.label == name for p in room.layout.placed)
        ):
            continue
        where = "corner" if name in CORNERS else "any"
        room.at_wall(name, where=where)


def hang_lamps(room: RoomArrangement) -> None:
    """A lamp over the middle of the floor, two in a long or large room, where none hangs yet."""
    site = room.layout.site
    hanging = [p for p in room.layout.placed if p.piece.support == "ceiling"]
    if hanging and site.polygon.area < 30:
        return
    k = int(np.argmax(site.lengths))
    along = site.directions[k]
    points = [np.array(site.centre)]
    if float(site.lengths[k]) > 6.5 or site.polygon.area > 32:
        reach = 0.25 * float(site.lengths[k])
        points = [points[0] - reach * along, points[0] + reach * along]
    for point in points:
        if all(math.hypot(p.x - point[0], p.y - point[1]) > 1.8 for p in hanging):
            hang(room, float(point[0]), float(point[1]))


def hang_pictures(room: RoomArrangement, kind: str) -> None:
    """Pictures over what stands at the walls and between it, a mirror or tapestry or clock among them; sconces in grand rooms."""
    if kind == "bathroom":
        return
    style, rng = room.style, room.rng
    own, hung = OVER_FURNITURE.get(style.family, ()), 0
    for placed in list(room.layout.placed):
        name = placed.piece.label
        if name in (
            "bed",
            "single bed",
            "sofa",
            "console table",
            "sideboard",
            "fireplace",
            "dresser",
            "bench",
            "altar table",
            "desk",
        ) and room.chance(0.85):
            mirror = name in ("console table", "dresser", "fireplace") and rng.random() < 0.55
            usual = "mirror" if mirror else "picture"
            for piece in (*own[hung % max(len(own), 1) :], usual):
                if on_wall(room, piece, placed, z=1.25):
                    hung += 1
                    break
    area = room.layout.site.polygon.area
    extra = round(min(1 + area / 14, 4) * room.density)
    choices = [
        "picture",
        "picture",
        "wall clock" if style.form.ornament < 0.6 else "picture",
        "wall shelf" if style.form.ornament < 0.5 else "picture",
    ]
    if style.family in ("gothic", "rustic", "moroccan", "baroque"):
        choices[1] = "tapestry"
    for k in range(extra):
        name = choices[k % len(choices)]
        if kind == "kitchen" and name == "tapestry":
            name = "picture"
        wall_piece(room, name, 1.95 if name == "wall clock" else 1.6)
    if kind in ("hall", "corridor", "dining", "library", "gallery") and style.form.ornament > 0.4:
        for _ in range(2):
            wall_piece(room, "wall sconce", 1.75)


def scene_object(placed: Placed, room: int) -> SceneObject:
    """A placed piece as the scene's record, in world space."""
    piece, transform = placed.piece, placed.box.transform
    return SceneObject(
        label=piece.label,
        room=room,
        support=piece.support,
        vertices=piece.vertices @ transform[:3, :3].T + transform[:3, 3],
        faces=piece.faces,
        face_slot=piece.face_slot,
        slots=piece.slots,
        slot_colors=piece.slot_colors,
        T_world_object=transform,
        size=piece.size,
        emission=piece.emission,
    )
