"""Which rooms of a plan people can walk between, and where they come in.

connected_parts   rooms joined by doors and passages, part by part: one part unless the plan has separate buildings, garages
                  or rooms without a door
entrances         the doors to the outside
"""

from collections.abc import Iterable

from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan


def connected_parts(plan: FloorPlan) -> tuple[tuple[int, ...], ...]:
    """The rooms of each part, by index; parts with more rooms first, and those of equal size in the order of the plan."""
    return joined_rooms(len(plan.rooms), [portal.rooms for portal in portals(plan) if portal.is_way])


def entrances(plan: FloorPlan) -> tuple[Portal, ...]:
    """The doors to the outside that people get through, in the order of the plan; each stands in `portal.wall.room`."""
    return tuple(portal for portal in portals(plan) if portal.is_entrance)


def joined_rooms(count: int, ways: Iterable[tuple[int, int]]) -> tuple[tuple[int, ...], ...]:
    """The rooms 0 to `count` - 1 in parts that ways (pairs of rooms) join, as `connected_parts` orders them."""
    beside: list[list[int]] = [[] for _ in range(count)]
    for a, b in ways:
        beside[a].append(b)
        beside[b].append(a)
    parts, seen = [], set()
    for seed in range(count):
        part, queue = set(), [seed]
        while queue:
            room = queue.pop()
            if room not in part and room not in seen:
                part.add(room)
                queue.extend(beside[room])
        seen |= part
        if part:
            parts.append(tuple(sorted(part)))
    return tuple(sorted(parts, key=lambda part: (-len(part), part[0])))
