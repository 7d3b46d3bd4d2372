"""A desk with its chair."""

import math

from wm.offline.arrangement.layout import Placed
from wm.offline.arrangement.room_arrangement import RoomArrangement, local
from wm.offline.style.finish import PERIOD


def writing(room: RoomArrangement, *, at_wall: bool) -> Placed | None:
    """A desk with its chair: facing a wall, or free in the room with the chair behind it."""
    seat = room.piece("office chair" if room.style.family not in PERIOD else "chair")
    table = room.piece("desk")
    mates = frozenset({"office chair", "chair"})
    deep, sit = float(table.size[1]), float(seat.size[1])
    placed = None
    if not at_wall:
        # the desk's front, where one sits, faces the wall: its back shows to the room
        site = room.layout.site
        for k in sorted(range(len(site.lengths)), key=lambda k: -float(site.lengths[k]) + float(room.rng.uniform(0, 2))):
            normal, middle = site.normals[k], site.starts[k] + 0.5 * site.lengths[k] * site.directions[k]
            x, y = (middle + (1.15 + deep / 2) * normal).tolist()
            placed = placed or room.layout.try_at(
                table, x, y, math.atan2(-float(normal[0]), float(normal[1])), front=0.75, mates=mates
            )
    if placed is None:
        placed = room.layout.against_wall(table, room.rng, front=0.75, where="centre", mates=mates)
    if placed is None:
        return None
    room.dressed(placed)
    x, y = local(placed, float(room.rng.uniform(-0.1, 0.05)), -(deep + sit) / 2 - 0.04)
    room.layout.try_at(seat, x, y, placed.yaw + math.pi + math.radians(float(room.rng.uniform(-3, 3))))
    return placed
