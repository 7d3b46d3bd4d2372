"""Furnishes one room: functional groups by room type, pieces at the walls, pictures, lamps, curtains and clutter.

The dice are np.random.SeedSequence([seed, room index, 4]); two seeds never give the same room, one seed always does.
"""

import math
from collections.abc import Callable

import numpy as np
import shapely

from wm.synth.procedural import groups
from wm.synth.procedural.clutter import PERIOD
from wm.synth.procedural.finish import Style
from wm.synth.procedural.groups import Desk
from wm.synth.procedural.layout import Layout, Placed
from wm.synth.procedural.site import Site
from wm.types import SceneObject

NARROW = 2.1
"""Metres of width below which a room is furnished as a corridor, whatever it is called."""

AT_WALL: dict[str, tuple[str, ...]] = {
    "bedroom": ("wardrobe", "dresser", "armchair", "plant", "chest", "bookshelf", "floor lamp"),
    "living": ("bookshelf", "sideboard", "plant", "floor lamp", "console table", "bookshelf", "plant"),
    "dining": ("sideboard", "console table", "plant", "candelabra", "grandfather clock", "plant"),
    "kitchen": ("sideboard", "basket", "plant", "bookshelf"),
    "bathroom": ("stool", "basket", "plant"),
    "library": ("bookshelf", "bookshelf", "bookshelf", "globe", "bookshelf", "floor lamp", "lectern", "bookshelf", "plant"),
    "study": ("bookshelf", "armchair", "bookshelf", "floor lamp", "plant", "globe", "chest"),
    "hall": ("console table", "bench", "statue", "column", "plant", "grandfather clock", "armchair", "chest", "statue"),
    "gallery": ("statue", "column", "bench", "statue", "column", "plant", "bench", "console table"),
    "corridor": ("console table", "plant", "bench", "column", "chest", "floor lamp"),
    "utility": ("bookshelf", "chest", "desk", "stool", "basket", "bookshelf", "basket", "wardrobe"),
    "other": ("bookshelf", "armchair", "plant", "console table", "chest", "floor lamp", "bench"),
}
"""What stands along the walls of a room, in the order in which it is tried, until the room holds enough."""

FLAVOUR: dict[str, tuple[tuple[str, frozenset[str]], ...]] = {
    "gothic": (("suit of armour", frozenset({"hall", "gallery", "corridor", "library"})), ("candelabra", frozenset({"dining", "hall", "living", "bedroom"})),
               ("altar table", frozenset({"hall", "gallery"}))),
    "roman": (("column", frozenset({"hall", "living", "dining", "gallery", "bathroom", "study"})), ("statue", frozenset({"hall", "dining", "bathroom", "gallery"}))),
    "baroque": (("candelabra", frozenset({"hall", "dining", "bedroom", "living"})), ("statue", frozenset({"hall", "gallery"}))),
    "surreal": (("giant mushroom", frozenset({"hall", "living", "bedroom", "corridor", "other", "utility"})),
                ("chess piece", frozenset({"hall", "living", "dining", "library", "corridor", "gallery", "other", "utility"})),
                ("giant mushroom", frozenset({"hall", "living"}))),
    "japanese": (("folding screen", frozenset({"living", "bedroom", "dining", "hall"})),),
    "moroccan": (("folding screen", frozenset({"living", "bedroom"})), ("candelabra", frozenset({"hall", "living"}))),
    "victorian": (("grandfather clock", frozenset({"hall", "living", "library", "study"})), ("globe", frozenset({"living", "study"}))),
}  # fmt: skip
"""Pieces that only some families have, and the rooms they belong in."""

ABSENT: dict[str, frozenset[str]] = {
    "scandinavian": frozenset({"statue", "column", "candelabra", "grandfather clock", "chest", "lectern"}),
    "coastal": frozenset({"statue", "column", "candelabra", "grandfather clock", "lectern"}),
    "minimalist": frozenset({"candelabra", "grandfather clock", "chest", "lectern", "statue"}),
    "modern": frozenset({"statue", "candelabra", "grandfather clock", "lectern", "chest"}),
    "neutral": frozenset({"statue", "candelabra", "grandfather clock", "lectern"}),
    "industrial": frozenset({"statue", "candelabra", "grandfather clock", "lectern"}),
    "cyberpunk": frozenset({"candelabra", "grandfather clock", "lectern", "chest", "basket"}),
    "midcentury": frozenset({"statue", "candelabra", "lectern"}),
    "japanese": frozenset({"statue", "column", "candelabra", "grandfather clock", "globe", "lectern"}),
}
"""What families would not own."""


ONCE = frozenset({"wardrobe", "dresser", "desk", "grandfather clock", "globe", "lectern", "suit of armour"})
"""Pieces of which a room holds one."""


def furnish_site(site: Site, kind: str, style: Style, *, seed: int, room: int, density: float = 1.0) -> list[Placed]:
    """Everything in one room.

    Args:
      kind: room type, a key of room_type.ROOM_WORDS or "other".
      density: 0..1, the share of the optional pieces that are tried.
    """
    rng = np.random.default_rng(np.random.SeedSequence([seed, room, 4]))
    layout = Layout(site)
    if not layout.standing.any():
        return []
    desk = Desk(layout, style, rng, density)
    narrow = 2 * float(shapely.maximum_inscribed_circle(site.polygon, tolerance=0.02).length) < NARROW
    kind = "corridor" if narrow and kind in ("hall", "gallery", "living", "other") else kind
    if kind != "bathroom" and rng.random() < 0.55 + 0.4 * style.form.softness:
        groups.curtain_pairs(desk)
    PROGRAMME[kind](desk)
    fill(desk, kind)
    light(desk)
    hang_pictures(desk, kind)
    return layout.placed


def bedroom(desk: Desk) -> None:
    groups.sleeping(desk)
    desk.at_wall("wardrobe", where="corner")
    if desk.layout.site.polygon.area > 15 and desk.chance(0.6):
        writing(desk, at_wall=True)


def living(desk: Desk) -> None:
    groups.sitting(desk, groups.hearth(desk))


def dining(desk: Desk) -> None:
    groups.dining(desk)
    if desk.style.form.ornament > 0.5 and desk.chance(0.7):
        groups.hearth(desk) if desk.style.family in PERIOD else None


def kitchen(desk: Desk) -> None:
    groups.cooking(desk)
    if desk.layout.site.polygon.area > 9:
        island = desk.chance(0.45) and desk.dressed(
            desk.layout.on_floor(desk.piece("kitchen island"), desk.rng, desk.layout.site.centre, yaw=0.0, radius=1.0)
        )
        if not island:
            groups.dining(desk, kitchen=True)


def bathroom(desk: Desk) -> None:
    groups.bathing(desk)


def library(desk: Desk) -> None:
    for _ in range(2):
        desk.at_wall("bookshelf", where="any")
    if desk.style.form.ornament > 0.5:
        focus = groups.hearth(desk) if desk.style.family in PERIOD and desk.chance(0.6) else None
        if focus is not None:
            groups.sitting(desk, focus)
        else:
            groups.around_table(desk)
    else:
        groups.around_table(desk)
    if desk.chance(0.7):
        writing(desk, at_wall=False)


def study(desk: Desk) -> None:
    writing(desk, at_wall=desk.layout.site.polygon.area < 9 or desk.rng.random() < 0.4)
    centre = desk.layout.site.centre
    groups.rug_under(desk, *centre, 0.0, 2.2, 1.6)


def writing(desk: Desk, *, at_wall: bool) -> Placed | None:
    """A desk with its chair: facing a wall, or free in the room with the chair behind it."""
    seat = desk.piece("office chair" if desk.style.family not in PERIOD else "chair")
    table = desk.piece("desk")
    mates = frozenset({"office chair", "chair"})
    deep, sit = float(table.size[1]), float(seat.size[1])
    placed = None
    if not at_wall:
        # the desk's front, where one sits, faces the wall: its back shows to the room
        site = desk.layout.site
        for k in sorted(range(len(site.lengths)), key=lambda k: -float(site.lengths[k]) + float(desk.rng.uniform(0, 2))):
            normal, middle = site.normals[k], site.starts[k] + 0.5 * site.lengths[k] * site.directions[k]
            x, y = (middle + (1.15 + deep / 2) * normal).tolist()
            placed = placed or desk.layout.try_at(table, x, y, math.atan2(-float(normal[0]), float(normal[1])), front=0.75, mates=mates)
    if placed is None:
        placed = desk.layout.against_wall(table, desk.rng, front=0.75, where="centre", mates=mates)
    if placed is None:
        return None
    desk.dressed(placed)
    x, y = groups.local(placed, float(desk.rng.uniform(-0.1, 0.05)), -(deep + sit) / 2 - 0.04)
    desk.layout.try_at(seat, x, y, placed.yaw + math.pi + math.radians(float(desk.rng.uniform(-3, 3))))
    return placed


def hall(desk: Desk) -> None:
    site = desk.layout.site
    if site.polygon.area > 22 and desk.style.form.ornament > 0.3:
        focus = groups.hearth(desk) if desk.style.family in PERIOD else None
        if desk.chance(0.8):
            groups.sitting(desk, focus)
    elif site.polygon.area > 10 and desk.chance(0.7):
        desk.dressed(desk.layout.on_floor(desk.piece("round table"), desk.rng, site.centre, yaw=0.0, radius=1.2))
    if site.polygon.area > 7:
        groups.rug_under(desk, *site.centre, long_way(site), 2.4, 1.7)


def gallery(desk: Desk) -> None:
    site = desk.layout.site
    if site.polygon.area > 12 and desk.chance(0.8):
        desk.layout.on_floor(desk.piece("bench"), desk.rng, site.centre, yaw=long_way(site), radius=1.5)
    groups.rug_under(desk, *site.centre, long_way(site), 2.6, 1.4)


def corridor(desk: Desk) -> None:
    site = desk.layout.site
    box = site.polygon.minimum_rotated_rectangle
    sides = sorted(np.linalg.norm(np.diff(np.asarray(box.exterior.coords), axis=0), axis=1).tolist()) if isinstance(box, shapely.Polygon) else [1.0]
    width = 2 * float(shapely.maximum_inscribed_circle(site.polygon, tolerance=0.02).length)
    groups.rug_under(desk, *site.centre, long_way(site), min(0.7 * sides[-1], 4.0), max(min(width - 0.5, 1.1), 0.45))
    for _ in range(2):
        groups.wall_piece(desk, "wall sconce", 1.75)


def utility(desk: Desk) -> None:
    writing(desk, at_wall=True)
    desk.at_wall("bookshelf", where="any")
    groups.wall_piece(desk, "wall shelf", 1.55)


def other(desk: Desk) -> None:
    groups.sitting(desk, groups.hearth(desk) if desk.style.family in PERIOD else None)


PROGRAMME: dict[str, Callable[[Desk], None]] = {
    "bedroom": bedroom, "living": living, "dining": dining, "kitchen": kitchen, "bathroom": bathroom, "library": library,
    "study": study, "hall": hall, "gallery": gallery, "corridor": corridor, "utility": utility, "other": other,
}  # fmt: skip


def long_way(site: Site) -> float:
    """Direction (radians) of the longest wall."""
    k = int(np.argmax(site.lengths))
    return math.atan2(float(site.directions[k, 1]), float(site.directions[k, 0]))


def wanted(site: Site, kind: str, density: float) -> int:
    """How many pieces of furniture (without pictures, curtains, lamps and clutter) a room should hold."""
    base = {"bathroom": 4, "corridor": 2, "kitchen": 6, "dining": 8}.get(kind, 5)
    return round((base + 0.22 * min(site.polygon.area, 45.0)) * (0.3 + 0.7 * density))


def fill(desk: Desk, kind: str) -> None:
    """Pieces along the walls until the room holds enough."""
    absent = ABSENT.get(desk.style.family, frozenset())
    special = [piece for piece, rooms in FLAVOUR.get(desk.style.family, ()) if kind in rooms]
    usual = [piece for piece in AT_WALL[kind] if piece not in absent]
    if kind not in ("library", "bathroom", "bedroom"):
        head = usual[:1]
        usual = head + [usual[1:][k] for k in desk.rng.permutation(len(usual) - 1)] if usual else []
    target = wanted(desk.layout.site, kind, desk.density)
    for name in [*special, *usual]:
        if sum(p.piece.support in ("floor", "flat") for p in desk.layout.placed) >= target and name not in special:
            break
        if desk.rng.random() > 0.45 + 0.55 * desk.density or (name in ONCE and any(p.piece.label == name for p in desk.layout.placed)):
            continue
        where = "corner" if name in ("plant", "floor lamp", "candelabra", "statue", "column", "globe", "basket", "stool", "armchair", "suit of armour", "giant mushroom", "folding screen") else "any"
        desk.at_wall(name, where=where)


def light(desk: Desk) -> None:
    """A lamp over the middle of the floor, two in a long or large room, where none hangs yet."""
    site = desk.layout.site
    hanging = [p for p in desk.layout.placed if p.piece.support == "ceiling"]
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
            groups.hang(desk, float(point[0]), float(point[1]))


def hang_pictures(desk: Desk, kind: str) -> None:
    """Pictures over what stands at the walls and between it, a mirror or tapestry or clock among them; sconces in grand rooms."""
    if kind == "bathroom":
        return
    style, rng = desk.style, desk.rng
    for placed in list(desk.layout.placed):
        name = placed.piece.label
        if name in ("bed", "single bed", "sofa", "console table", "sideboard", "fireplace", "dresser", "bench", "altar table", "desk") and desk.chance(0.85):
            mirror = name in ("console table", "dresser", "fireplace") and rng.random() < 0.55
            groups.on_wall(desk, "mirror" if mirror else "picture", placed, z=1.25)
    area = desk.layout.site.polygon.area
    extra = round(min(1 + area / 14, 4) * desk.density)
    choices = ["picture", "picture", "wall clock" if style.form.ornament < 0.6 else "picture", "wall shelf" if style.form.ornament < 0.5 else "picture"]
    if style.family in ("gothic", "rustic", "moroccan", "baroque"):
        choices[1] = "tapestry"
    for k in range(extra):
        name = choices[k % len(choices)]
        if kind == "kitchen" and name == "tapestry":
            name = "picture"
        groups.wall_piece(desk, name, 1.95 if name == "wall clock" else 1.6)
    if kind in ("hall", "corridor", "dining", "library", "gallery") and style.form.ornament > 0.4:
        for _ in range(2):
            groups.wall_piece(desk, "wall sconce", 1.75)


def scene_object(placed: Placed, room: int) -> SceneObject:
    """A placed piece as the scene's record, in world space."""
    c, s = math.cos(placed.yaw), math.sin(placed.yaw)
    transform = np.array([[c, -s, 0.0, placed.x], [s, c, 0.0, placed.y], [0.0, 0.0, 1.0, placed.z], [0.0, 0.0, 0.0, 1.0]])
    piece = placed.piece
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
