"""Placement: reconstructed things become furniture that stands, hangs and lies as furniture does.

Every thing is classified by its label, set upright and put down: on the floor, flat on it, with its back to a wall, under the
ceiling, or on what is below it. What then shares space with another thing, leaves the room or shuts a door is shifted by the
least that helps, towards walls rather than away from them and never past what it ran into; what fits nowhere near is left out,
with the reason. Large things come first, so the result does not depend on the order in which they are given; and a room that is
placed already stays as it is, to the bit.
Source: WorldMesh, supplement, "Object Placement"; the doors, the headroom and the limits of the search are ours.
"""

import dataclasses
import math

import numpy as np

from wm.geometry.placement.clearances import FLAT, LIFT, WALL_GAP
from wm.geometry.placement.occupancy import Occupancy, circle_points, distance_to_wall
from wm.geometry.placement.stacking import stacked
from wm.geometry.placement.support import covers_windows, is_structure, support_of
from wm.geometry.placement.upright import EXACT, flattened, levelled, moved_to, turn_between
from wm.geometry.placement.upright_box import UprightBox, box_of
from wm.geometry.plan.site import Site, wall_yaw
from wm.types import SceneObject

REACH = 1.2
"""Metres by which a thing is shifted at most before it is left out."""
_STEP = 0.04
"""Metres between places that are tried."""
_TO_WALL = 0.35
"""How much cheaper a shift straight towards the nearest wall counts than one away from it."""
_ORDER = {"floor": 0, "flat": 1, "ceiling": 2, "wall": 3, "object": 4}
"""Things are put down in this order of classes."""


@dataclasses.dataclass(frozen=True, eq=False)
class Placement:
    """What became of a room's things."""

    objects: tuple[SceneObject, ...]  # in the order in which they were given
    source: tuple[int, ...]  # index of each among the things given
    dropped: tuple[tuple[int, str], ...]  # (index among the things given, why it is not in the room)


def place_objects(things: list[SceneObject], site: Site) -> Placement:
    """The things of one room, placed.

    Args:
      things: in world space, nearly upright; their labels say what they are. Their `support` is found anew, unless they
        are where placement put them.
      site: the room.

    Returns:
      The things with what they rest on now: what found no top to stand on stands on the floor.
    """
    upright = [_classified(thing) for thing in things]
    order = sorted(range(len(things)), key=lambda k: _priority(upright[k]))
    taken, flats = Occupancy(site), Occupancy(site)
    done: dict[int, SceneObject] = {}
    dropped: list[tuple[int, str]] = []
    for k in order:
        thing = upright[k]
        placed = None if is_structure(thing.label) else _placed(thing, site, flats if thing.support == "flat" else taken, done)
        if placed is None:
            dropped.append((k, "part of the building" if is_structure(thing.label) else "no free place within reach"))
            continue
        done[k] = placed
        (flats if placed.support == "flat" else taken).add(box_of(placed))
    source = tuple(sorted(done))
    return Placement(objects=tuple(done[k] for k in source), source=source, dropped=tuple(sorted(dropped)))


def _classified(thing: SceneObject) -> SceneObject:
    upright = levelled(thing)
    low = float(upright.vertices[:, 2].min())
    told = support_of(thing.label, upright.size.tolist(), low)
    held = support_of(thing.label, upright.size.tolist(), math.inf)  # where words do not tell, what would hold it off the floor
    if told == "object" and thing.support == "floor" and abs(low - LIFT) < EXACT:
        told = "floor"  # it found no top before
    elif thing.support == held and held in ("object", "wall") and low > LIFT + EXACT:
        told = held  # it hangs or stands on something, however low that is
    return dataclasses.replace(upright, support=told)


def _priority(thing: SceneObject) -> tuple:
    """Larger things first within a class, lower ones first among what stands on others; then anything that tells two apart."""
    box = box_of(thing)
    size = -round(box.width * box.depth, 6) if thing.support != "wall" else -round(box.width * box.height, 6)
    low = round(box.z, 2) if thing.support == "object" else 0.0
    return _ORDER[thing.support], low, size, thing.label, box.x, box.y, box.z, box.yaw


def _placed(thing: SceneObject, site: Site, taken: Occupancy, done: dict[int, SceneObject]) -> SceneObject | None:
    if thing.support == "object":
        box = stacked(box_of(thing), [done[k] for k in sorted(done)], taken, lift=LIFT)
        if box is not None:
            return moved_to(thing, box)
        thing = dataclasses.replace(thing, support="floor")
    if thing.support == "wall":
        box = _on_wall(box_of(thing), site, taken, covers=covers_windows(thing.label))
    elif thing.support == "ceiling":
        box = box_of(thing)
        box = _shifted(dataclasses.replace(box, z=site.ceiling - LIFT - box.height), site, taken)
    else:
        thing = flattened(thing, FLAT) if thing.support == "flat" else thing
        box = _shifted(dataclasses.replace(box_of(thing), z=LIFT), site, taken)
    return moved_to(thing, box) if box is not None else None


def _shifted(box: UprightBox, site: Site, taken: Occupancy) -> UprightBox | None:
    """The box where it is, or at the nearest place that takes it, or nowhere."""
    if taken.allows(box, exactly=True):
        return box
    _, toward = distance_to_wall(site, box.center)
    blockers = taken.blockers(box)
    for shift in _shifts(toward):
        moved = dataclasses.replace(box, x=box.x + float(shift[0]), y=box.y + float(shift[1]))
        if _same_side(box, moved, blockers) and taken.allows(moved):
            return moved
    return None


def _shifts(toward: np.ndarray) -> np.ndarray:
    """[n, 2] shifts in the order in which they are tried: short before long, towards the wall before away from it."""
    shifts = np.concatenate([circle_points(radius) for radius in np.arange(0.005, REACH, _STEP)])
    length = np.linalg.norm(shifts, axis=1)
    cost = length - _TO_WALL * (shifts @ toward)
    return shifts[np.argsort(cost, kind="stable")]


def _same_side(before: UprightBox, after: UprightBox, blockers: list[UprightBox]) -> bool:
    """Whether a shift keeps a thing on its side of what it ran into."""
    return all(float((before.center - other.center) @ (after.center - other.center)) >= 0 for other in blockers)


def _on_wall(box: UprightBox, site: Site, taken: Occupancy, *, covers: bool) -> UprightBox | None:
    """A box with its back to the nearest wall it can face, slid along it past openings and other things."""
    for k in _walls_by_nearness(box, site):
        length = float(site.lengths[k])
        if box.width > length - 0.01:
            continue
        along = float((box.center - site.starts[k]) @ site.directions[k])
        low, high = box.width / 2 + 0.004, length - box.width / 2 - 0.004
        z = min(max(box.z, LIFT), max(site.ceiling - box.height - LIFT, LIFT))
        first = _at_wall(box, site, k, min(max(along, low), high), z)
        blockers = taken.blockers(first)
        for slide in _slides():
            start = min(max(along + slide, low), high)
            if slide != 0.0 and start != along + slide:
                continue
            hung = _at_wall(box, site, k, start, z)
            if _before_opening(hung, site, k, start, covers=covers) or not _same_side(first, hung, blockers):
                continue
            if taken.allows(hung, exactly=True):
                return hung
    return None


def _slides() -> list[float]:
    steps = np.arange(1, int(REACH / _STEP)) * _STEP
    return [0.0, *np.stack([steps, -steps], axis=1).ravel().tolist()]


def _walls_by_nearness(box: UprightBox, site: Site) -> list[int]:
    """Walls that a box is near to and that it can turn its back to, the nearest first."""
    offset = ((box.center - site.starts) * site.normals).sum(axis=1)
    along = ((box.center - site.starts) * site.directions).sum(axis=1)
    beyond = np.maximum(np.maximum(-along, along - site.lengths), 0.0)
    turn = np.array([abs(turn_between(box.yaw, wall_yaw(normal))) for normal in site.normals])
    askew = np.minimum(turn, math.pi - np.minimum(turn, math.pi))  # a flat thing may have been taken for its back
    distance = np.abs(offset) + beyond + 0.3 * askew
    return [int(k) for k in np.argsort(distance, kind="stable") if distance[k] < REACH]


def _at_wall(box: UprightBox, site: Site, k: int, along: float, z: float) -> UprightBox:
    center = site.starts[k] + along * site.directions[k] + (WALL_GAP + box.depth / 2) * site.normals[k]
    return dataclasses.replace(box, x=float(center[0]), y=float(center[1]), z=z, yaw=wall_yaw(site.normals[k]))


def _before_opening(box: UprightBox, site: Site, wall: int, along: float, *, covers: bool) -> bool:
    """Whether a box on a wall hangs before a doorway, or before a window that it should not cover."""
    low, high = along - box.width / 2, along + box.width / 2
    return any(
        k == wall and opening.low < high and opening.high > low and opening.sill < box.top and opening.head > box.z
        for k, opening in site.openings
        if not (covers and opening.kind == "window")
    )
