"""What each type of room is for: which functional groups it gets, in which order."""

from collections.abc import Callable

import numpy as np
import shapely

from wm.offline.arrangement.equipment import long_way
from wm.offline.arrangement.groups import around_table, dining_group, hearth, rug_under, sitting, sleeping
from wm.offline.arrangement.hangings import wall_piece
from wm.offline.arrangement.room_arrangement import RoomArrangement
from wm.offline.arrangement.wet_groups import bathing, cooking, island
from wm.offline.arrangement.writing import writing
from wm.offline.style.finish import PERIOD


def bedroom(room: RoomArrangement) -> None:
    sleeping(room)
    room.at_wall("wardrobe", where="corner")
    if room.layout.site.polygon.area > 15 and room.chance(0.6):
        writing(room, at_wall=True)


def living(room: RoomArrangement) -> None:
    sitting(room, hearth(room))


def dining(room: RoomArrangement) -> None:
    dining_group(room)
    if room.style.form.ornament > 0.5 and room.chance(0.7):
        hearth(room) if room.style.family in PERIOD else None


def kitchen(room: RoomArrangement) -> None:
    cooking(room)
    if room.layout.site.polygon.area > 9:
        placed = island(room) if room.chance(0.45) else None
        if placed is None:
            dining_group(room, kitchen=True)


def bathroom(room: RoomArrangement) -> None:
    bathing(room)


def library(room: RoomArrangement) -> None:
    for _ in range(2):
        room.at_wall("bookshelf", where="any")
    if room.style.form.ornament > 0.5:
        focus = hearth(room) if room.style.family in PERIOD and room.chance(0.6) else None
        if focus is not None:
            sitting(room, focus)
        else:
            around_table(room)
    else:
        around_table(room)
    if room.chance(0.7):
        writing(room, at_wall=False)


def study(room: RoomArrangement) -> None:
    writing(room, at_wall=room.layout.site.polygon.area < 9 or room.rng.random() < 0.4)
    centre = room.layout.site.centre
    rug_under(room, *centre, 0.0, 2.2, 1.6)


def hall(room: RoomArrangement) -> None:
    site = room.layout.site
    if site.polygon.area > 22 and room.style.form.ornament > 0.3:
        focus = hearth(room) if room.style.family in PERIOD else None
        if room.chance(0.8):
            sitting(room, focus)
    elif site.polygon.area > 10 and room.chance(0.7):
        room.dressed(room.layout.on_floor(room.piece("round table"), room.rng, site.centre, yaw=0.0, radius=1.2))
    if site.polygon.area > 7:
        rug_under(room, *site.centre, long_way(site), 2.4, 1.7)


def gallery(room: RoomArrangement) -> None:
    site = room.layout.site
    if site.polygon.area > 12 and room.chance(0.8):
        room.layout.on_floor(room.piece("bench"), room.rng, site.centre, yaw=long_way(site), radius=1.5)
    rug_under(room, *site.centre, long_way(site), 2.6, 1.4)


def corridor(room: RoomArrangement) -> None:
    site = room.layout.site
    box = site.polygon.minimum_rotated_rectangle
    sides = (
        sorted(np.linalg.norm(np.diff(np.asarray(box.exterior.coords), axis=0), axis=1).tolist())
        if isinstance(box, shapely.Polygon)
        else [1.0]
    )
    width = 2 * float(shapely.maximum_inscribed_circle(site.polygon, tolerance=0.02).length)
    rug_under(room, *site.centre, long_way(site), min(0.7 * sides[-1], 4.0), max(min(width - 0.5, 1.1), 0.45))
    for _ in range(2):
        wall_piece(room, "wall sconce", 1.75)


PROGRAMME: dict[str, Callable[[RoomArrangement], None]] = {
    "bedroom": bedroom, "living": living, "dining": dining, "kitchen": kitchen, "bathroom": bathroom, "library": library,
    "study": study, "hall": hall, "gallery": gallery, "corridor": corridor,
}  # fmt: skip
"""The rooms that most houses have; what stands in all others says a table (equipped.py)."""
