"""What a visitor looks at: how much there is to see in every direction from a place, and where the eyes go from it.

panorama   rays all about an eye, level and a little down; for each of HEADINGS headings, the share of the picture that each
           thing fills: objects, the windows of a room, another room through a door
worth      the sum of these shares, each at most ENOUGH and times the thing's weight, less the share of the picture that is
           near: a wall or a jamb at arm's length
looks      at a stop, the headings with most that has not been seen yet, until too little is left
turns      from look to look, past as little as may be of what is near
gaze       while walking, the headings of largest worth, near the course and without haste (dynamic programming)
"""

import dataclasses
import itertools

import numpy as np
from jaxtyping import Float

from wm.geometry.rays.raycast import RayScene, cast_rays
from wm.types import OUTSIDE, SurfaceKind

HEADINGS = 72
"""Headings that are told apart: every 5 degrees."""
ENOUGH = 0.06
"""Largest share of a picture that one thing counts for, so that a wardrobe from near is not worth a furnished room."""
NEAR, FAR = 0.8, 1.8
"""Metres up to which what is seen counts as near in full, and from which it does not."""
LEAST = 0.055
"""Worth of what is new below which a visitor does not turn to it."""
LOOKS = 3
"""Looks at one stop at most."""

_ELEVATIONS = np.radians(np.arange(-20.0, 11.0, 5.0))
_THROUGH_A_DOOR = 0.35  # weight of what stands in another room, and of that room
_SEEN = 0.1  # share of its weight that a thing keeps when it has been seen
_CRAMPED = 6.0  # times its angle that a turn counts for in addition where all of the picture is near
_COURSE = 0.4  # worth that a heading at a right angle to the course loses
_HASTE, _STEP = 0.01, 2  # worth that a turn by one heading between two places costs (by n: n^2 times), and the largest turn


@dataclasses.dataclass(frozen=True, eq=False)
class Panorama:
    """What an eye sees in each of HEADINGS headings, heading k towards azimuth 2 pi k / HEADINGS."""

    shares: np.ndarray  # [HEADINGS, k] share of the picture that each of k things fills
    own: np.ndarray  # [k] bool: it stands in the room that the eye is in
    near: np.ndarray  # [HEADINGS] share of the picture that is near

    def worth(self, weights: Float[np.ndarray, "k"]) -> Float[np.ndarray, "HEADINGS"]:
        """How much there is to see in each heading, given the weight of each thing."""
        return np.minimum(self.shares, ENOUGH) @ weights - self.near


def panorama(scene: RayScene, eye: Float[np.ndarray, "3"], room: int, *, fov: float) -> Panorama:
    """The panorama of an eye that stands in a room; `fov` is the width of its picture in radians."""
    azimuth, elevation = np.meshgrid(2 * np.pi / HEADINGS * np.arange(HEADINGS), _ELEVATIONS, indexing="ij")
    level = np.cos(elevation)
    directions = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], axis=-1).reshape(-1, 3)
    hits = cast_rays(scene, np.broadcast_to(eye, directions.shape), directions)
    number, own = _things(scene, hits.face, room)
    _, first, fills = np.unique(number, return_index=True, return_inverse=True)
    fills = (fills.reshape(*azimuth.shape, 1) == np.arange(len(first))).mean(axis=1)
    things = np.flatnonzero(number[first] >= 0)
    away = np.where(hits.hit, hits.t, FAR).reshape(azimuth.shape) * level
    near = np.clip((FAR - away) / (FAR - NEAR), 0, 1).mean(axis=1)
    apart = np.abs(np.mod(azimuth[:, :1] - azimuth[:, 0] + np.pi, 2 * np.pi) - np.pi)
    window = np.cos(np.minimum(apart / fov, 0.5) * np.pi)  # the middle of a picture counts most
    window /= window.sum(axis=1, keepdims=True)
    return Panorama(shares=window @ fills[:, things], own=own[first[things]], near=window @ near)


def looks(view: Panorama) -> list[tuple[float, float]]:
    """Headings, radians, and the worth that each adds, best first: at what is in the eye's own room.

    At least one, whatever there is to see.
    """
    weights, chosen = view.own.astype(float), []
    while len(chosen) < LOOKS:
        worth = view.worth(weights)
        best = int(np.argmax(worth))
        if chosen and worth[best] < LEAST:
            break
        chosen.append((2 * np.pi * best / HEADINGS, max(float(worth[best]), 0.0)))
        weights *= 1 - (1 - _SEEN) * np.minimum(view.shares[best] / ENOUGH, 1)
    return chosen


def turns(view: Panorama, start: float, found: list[tuple[float, float]], end: float | None) -> list[tuple[float, float | None]]:
    """The looks in the order, and each turned to from the side, that pass least of what is near on the way from `start` to `end`.

    Returns: pairs of the angle to turn by, radians, and the worth of the look; None for the turn to `end`, if there is one.
    """
    last = [] if end is None else [(end, None)]
    ways = [[(start, None), *order, *last] for order in itertools.permutations(found)]
    plans = [[(*_turn(view, a, b), worth) for (a, _), (b, worth) in itertools.pairwise(way)] for way in ways]
    best = min(plans, key=lambda plan: sum(cost for _, cost, _ in plan))
    return [(angle, worth) for angle, _, worth in best]


def _turn(view: Panorama, start: float, end: float) -> tuple[float, float]:
    """The angle by which to turn from one heading to another, and its cost; the long way round costs less where it is open."""
    angle = turn(start, end)
    around = [angle, angle - np.copysign(2 * np.pi, angle)]
    passed = [start + np.linspace(0.0, a, max(2, round(abs(a) * HEADINGS / (2 * np.pi)))) for a in around]
    numbers = [np.mod(np.round(p * HEADINGS / (2 * np.pi)).astype(np.int64), HEADINGS) for p in passed]
    costs = [abs(a) * (1 + _CRAMPED * float(view.near[k].mean())) for a, k in zip(around, numbers)]
    best = int(np.argmin(costs))
    return around[best], costs[best]


def turn(start: float, end: float) -> float:
    """The angle in [-pi, pi) by which to turn from one heading to another."""
    return float(np.mod(end - start + np.pi, 2 * np.pi) - np.pi)


def gaze(views: list[Panorama], courses: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    """Continuous headings, radians, one for each place of a walk along `courses`."""
    azimuth = 2 * np.pi / HEADINGS * np.arange(HEADINGS)
    seen = np.stack([view.worth(np.where(view.own, 1.0, _THROUGH_A_DOOR)) for view in views])
    reward = seen - _COURSE * (1 - np.cos(azimuth - courses[:, None]))
    moves = np.arange(-_STEP, _STEP + 1)
    best, came = reward[0], np.zeros((len(reward), HEADINGS), np.int64)
    for k in range(1, len(reward)):
        options = np.stack([np.roll(best, move) - _HASTE * move**2 for move in moves])
        came[k] = np.argmax(options, axis=0)
        best = options.max(axis=0) + reward[k]
    at = [int(np.argmax(best))]
    for k in range(len(reward) - 1, 0, -1):
        at.append(int(np.mod(at[-1] - moves[came[k, at[-1]]], HEADINGS)))
    return np.unwrap(azimuth[at[::-1]])


def _things(scene: RayScene, face: np.ndarray, room: int) -> tuple[np.ndarray, np.ndarray]:
    """The number of the thing at each hit, [r], and whether it is in the room, [r] bool.

    Objects have their index, then come the windows of each room, then the other rooms. -1: no thing, but the walls, floor and
    ceiling of the room itself, a door's jambs, or a miss.
    """
    mesh = scene.mesh
    objects, rooms = int(mesh.face_object.max(initial=-1)) + 1, int(mesh.face_room.max(initial=-1)) + 1
    thing, place, kind = mesh.face_object[face], mesh.face_room[face], mesh.face_kind[face]
    number = np.where((place != room) & (kind != SurfaceKind.REVEAL), objects + rooms + place, -1)
    number = np.where(kind == SurfaceKind.PANE, objects + place, number)
    number = np.where(thing != OUTSIDE, thing, number)
    return np.where((face >= 0) & (place != OUTSIDE), number, -1), place == room
