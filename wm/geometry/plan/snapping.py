"""Walls of two rooms that nearly touch are made to touch: what drawing by hand and export from CAD leave of a shared wall.

Corners of different rooms within SNAP of each other become one, the one of the room listed first. A corner within SNAP of the
middle of another room's wall is moved onto that wall. Openings follow the wall that they lie on. So gaps and overlaps of up to
SNAP vanish, and walls a fraction of a degree askew become one wall. Corners of one room are never joined with each other, and
what coincides within EXACT is left as it is, bit for bit.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Float

from wm.geometry.plan.records import Room
from wm.geometry.plan.walls import distinct

SNAP = 0.025  # metres: 0.3 degrees over a wall of 4.8 m
EXACT = 1e-6  # metres within which points are one, as `Reader` takes them to be
_AT_A_CORNER = 16  # rooms that may meet at one place
_PASSES = 3  # a corner that moves may come near another wall


def snapped(rooms: Sequence[Room]) -> tuple[tuple[Room, ...], tuple[str, ...]]:
    """The rooms with walls that nearly touch made to touch, and a sentence for each room that was changed.

    Rooms whose polygons are not simple, or would not be afterwards, are left alone: the rules name what is wrong with them.
    """
    sound = [k for k, room in enumerate(rooms) if len(room.polygon) >= 3 and shapely.Polygon(room.polygon).is_valid]
    counts = [len(rooms[k].polygon) for k in sound]
    owner = np.repeat(sound, counts).astype(int)
    if len(set(sound)) < 2:
        return tuple(rooms), ()
    before = np.concatenate([rooms[k].polygon for k in sound])
    if np.unique(before.round(6), axis=0, return_counts=True)[1].max() > _AT_A_CORNER:
        return tuple(rooms), ()  # a heap of rooms: the rules refuse it before all pairs are looked at
    after = before[_joined(before, owner)]
    parts = np.split(np.arange(len(owner)), np.cumsum(counts)[:-1])
    following = np.concatenate([np.roll(part, -1) for part in parts])
    for _ in range(_PASSES):
        moved = _onto_walls(after, owner, following)
        if (moved == after).all():
            break
        after = moved
    result, notes = list(rooms), []
    for k, mine in zip(sound, parts):
        shift = float(np.abs(after[mine] - before[mine]).max())
        if shift > 0 and shapely.Polygon(after[mine]).is_valid:
            result[k] = _moved(rooms[k], after[mine])
            how = f"corners moved by up to {1e3 * shift:.1f} mm, so that its walls meet those of its neighbours"
            notes.append(f"room {rooms[k].id}: {how}")
    return tuple(result), tuple(notes)


def _joined(points: Float[np.ndarray, "n 2"], owner: np.ndarray) -> np.ndarray:
    """For each corner the index of the one that it becomes: the nearest earlier corner of another room that stays in place."""
    places = np.asarray(shapely.points(points))
    i, j = shapely.STRtree(places).query(places, predicate="dwithin", distance=SNAP)
    foreign = owner[i] != owner[j]
    i, j = i[foreign], j[foreign]
    distance = np.linalg.norm(points[i] - points[j], axis=1)
    # A corner takes one corner of each room at most, so that no edge of a room collapses.
    taken = set(zip(owner[i[distance <= EXACT]].tolist(), j[distance <= EXACT].tolist()))
    earlier = (j < i) & (distance > EXACT)
    i, j, distance = i[earlier], j[earlier], distance[earlier]
    target = np.arange(len(points))
    for k in np.lexsort((distance, i)).tolist():
        corner, other = int(i[k]), int(j[k])
        room = int(owner[corner])
        if target[corner] == corner and target[other] == other and (room, other) not in taken:
            target[corner] = other
            taken.add((room, other))
    return target


def _onto_walls(points: Float[np.ndarray, "n 2"], owner: np.ndarray, following: np.ndarray) -> Float[np.ndarray, "n 2"]:
    """Corners beside the middle of another room's wall moved onto it; corners at one place stay at one place."""
    walls = np.asarray(shapely.linestrings(np.stack([points, points[following]], axis=1)))
    place, inverse = np.unique(points, axis=0, return_inverse=True)
    corner, wall = shapely.STRtree(walls).query(shapely.points(place), predicate="dwithin", distance=SNAP)
    start, span = points[wall], points[following[wall]] - points[wall]
    share = np.sum((place[corner] - start) * span, axis=1) / np.maximum(np.sum(span**2, axis=1), EXACT**2)
    foot = start + share[:, None] * span
    to_ends = [np.linalg.norm(place[corner] - end, axis=1) for end in (start, start + span)]
    off = np.linalg.norm(foot - place[corner], axis=1)
    beside = (share > 0) & (share < 1) & (np.minimum(*to_ends) > SNAP) & (off > EXACT)
    here = set(zip(inverse.tolist(), owner.tolist()))
    result, done = place.copy(), set()
    for k in np.flatnonzero(beside).tolist():
        i = int(corner[k])
        if i not in done and (i, int(owner[wall[k]])) not in here:
            result[i] = foot[k]
            done.add(i)
    return result[inverse]


def _moved(room: Room, polygon: Float[np.ndarray, "k 2"]) -> Room:
    """A room with its corners moved; each end of an opening's segment moves as the nearest point of its old outline does.

    Two corners of a room that have come to one place, each that of another neighbour, are one.
    """
    ends = np.stack([room.polygon, np.roll(room.polygon, -1, axis=0)], axis=1)  # [k, end, xy]
    shift = np.stack([polygon - room.polygon, np.roll(polygon - room.polygon, -1, axis=0)], axis=1)
    openings = tuple(
        dataclasses.replace(opening, segment=np.stack([_carried(point, ends, shift) for point in opening.segment]))
        for opening in room.openings
    )
    return dataclasses.replace(room, polygon=distinct(polygon), openings=openings)


def _carried(
    point: Float[np.ndarray, "2"], ends: Float[np.ndarray, "k 2 2"], shift: Float[np.ndarray, "k 2 2"]
) -> Float[np.ndarray, "2"]:
    span = ends[:, 1] - ends[:, 0]
    share = np.clip(np.sum((point - ends[:, 0]) * span, axis=1) / np.maximum(np.sum(span**2, axis=1), EXACT**2), 0, 1)
    nearest = int(np.argmin(np.linalg.norm(ends[:, 0] + share[:, None] * span - point, axis=1)))
    return point + (1 - share[nearest]) * shift[nearest, 0] + share[nearest] * shift[nearest, 1]
