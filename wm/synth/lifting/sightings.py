"""Which segments of several images show one thing, and the points of the room that they show.

A camera at each end of a room sees two sides of most things. Two segments of one label are one thing if the points of both
together are no larger than such a thing may be; the pairs that fit best are taken first.
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Bool, Float
from scipy import ndimage

from wm.geometry.placement.upright_box import UprightBox, box_iou
from wm.geometry.rays.pinhole import camera_center, ray_basis
from wm.offline.furniture import KINDS
from wm.offline.reconstruction.kinds import kind_of, largest_size
from wm.synth.backends import Segment, Sighting

_SLACK, _MARGIN = 1.1, 0.08
"""A thing may measure this many times its kind's largest, and this many metres more."""
_REACH = 0.8
"""The same for the distance of a point from the middle one, as a share of the diagonal: the middle one may be near an end."""
_SHARED, _SHARED_IN_ONE = 0.12, 0.4
"""Share of the smaller of two boxes in the other from which they are one thing: in different images, in the same one."""
_WALL = 0.06
"""Metres into a wall at which a point of a thing that hangs there may seem to be."""
_RIM = 3.0
"""Pixels from the nearest one away from silhouettes within which a mask's pixels take its depth."""
_FIRM = 30
"""Pixels away from silhouettes that a sighting must have for the others to be left out."""
_EDGE = 0.04
"""Relative jump of depth to a neighbour from which a pixel lies on a silhouette, where its depth may be anybody's."""


@dataclasses.dataclass(frozen=True, eq=False)
class Thing:
    """A label and all that the images show of it."""

    label: str
    sightings: tuple[Sighting, ...]


def gather(views: Sequence[Sequence[tuple[Segment, Sighting]]]) -> list[Thing]:
    """The things of a room from the segments of each of its images, each segment with its sighting; no mask is used twice."""
    things = [Thing(segment.label, (sighting,)) for segment, sighting in views[0]] if views else []
    for found in views[1:]:
        fits = _fits(things, found)
        taken: dict[int, int] = {}
        for _, i, j in sorted(fits):
            if i not in taken.values() and j not in taken:
                taken[j] = i
        for j, (segment, sighting) in enumerate(found):
            if j in taken:
                i = taken[j]
                things[i] = Thing(things[i].label, (*things[i].sightings, sighting))
            else:
                things.append(Thing(segment.label, (sighting,)))
    return things


def joined(things: Sequence[Thing], boxes: Sequence[UprightBox | None]) -> list[tuple[Thing, tuple[int, ...]]]:
    """Things of one kind whose reconstructions share space, as one; each with the numbers of those that it was."""
    groups: list[list[int]] = []
    for k, (thing, box) in enumerate(zip(things, boxes)):
        home = next((group for group in groups if any(_is_one(thing, box, things[j], boxes[j]) for j in group)), None)
        if home is None:
            groups.append([k])
        else:
            home.append(k)
    return [(_together([things[k] for k in group]), tuple(group)) for group in groups]


def _is_one(a: Thing, box: UprightBox | None, b: Thing, other: UprightBox | None) -> bool:
    """Solids of one kind do not share space: two that do are one seen twice, the more surely if no image shows both, or if they
    hang, for the thin arms of what hangs come apart in an image."""
    if box is None or other is None or kind_of(a.label) != kind_of(b.label):
        return False
    iou = box_iou(box, other)
    shared = iou / (1 + iou) * (box.volume + other.volume) / min(box.volume, other.volume)
    apart = {id(sighting.camera) for sighting in a.sightings}.isdisjoint(id(sighting.camera) for sighting in b.sightings)
    hang = KINDS[kind_of(a.label)].support == "ceiling"
    return shared > (_SHARED if apart or hang else _SHARED_IN_ONE)


def _together(things: list[Thing]) -> Thing:
    """All sightings of several things; of one camera the masks are joined."""
    views: dict[int, Sighting] = {}
    for sighting in (sighting for thing in things for sighting in thing.sightings):
        known = views.get(id(sighting.camera))
        mask = sighting.mask if known is None else known.mask | sighting.mask
        views[id(sighting.camera)] = dataclasses.replace(sighting, mask=mask)
    return Thing(things[0].label, tuple(views.values()))


def sighting_points(sighting: Sighting, *, limit: int, seed: int) -> Float[np.ndarray, "n 3"]:
    """World points of a sighting's pixels, metres, `limit` at most; beside silhouettes, with the depth farther in."""
    rows, columns = (np.flatnonzero(sighting.mask.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return np.zeros((0, 3))
    y0, x0 = max(int(rows[0]) - 2, 0), max(int(columns[0]) - 2, 0)
    window = (slice(y0, int(rows[-1]) + 3), slice(x0, int(columns[-1]) + 3))
    mask, depth = sighting.mask[window], sighting.depth[window]
    some = mask & (depth > 0)
    solid = some & np.asarray(ndimage.binary_erosion(mask), bool) & ~silhouettes(depth)
    if solid.sum() >= _FIRM:
        depth, some = _filled(depth, solid, some)
    y, x = np.nonzero(some)
    if len(y) > limit:
        chosen = np.random.default_rng(np.random.SeedSequence([seed, 0x9017])).choice(len(y), limit, replace=False)
        y, x = y[chosen], x[chosen]
    across, down = ray_basis(sighting.camera)
    return camera_center(sighting.camera) + depth[y, x, None].astype(np.float64) * (across[x + x0] + down[y + y0])


def _filled(depth: np.ndarray, solid: np.ndarray, some: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(depth with that of the nearest solid pixel on the rim, the solid pixels and their rim): a mask is right farther out
    than the depth inside it."""
    nearest = np.zeros((2, *solid.shape), np.int32)
    away = np.asarray(ndimage.distance_transform_edt(~solid, return_indices=True, indices=nearest))
    return depth[nearest[0], nearest[1]], some & (away <= _RIM)


def in_room(sighting: Sighting, room: shapely.Polygon) -> bool:
    """Whether most of what a sighting shows lies in a room, and not beyond one of its doors."""
    points = sighting_points(sighting, limit=200, seed=0)
    return len(points) > 0 and bool(shapely.contains_xy(room.buffer(_WALL), points[:, :2]).mean() > 0.5)


def silhouettes(depth: Float[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """Pixels at a jump in depth."""
    low = np.asarray(ndimage.minimum_filter(depth, 3))
    high = np.asarray(ndimage.maximum_filter(depth, 3))
    return high - low > _EDGE * np.maximum(low, 1e-3) + 0.02


def _fits(things: list[Thing], found: Sequence[tuple[Segment, Sighting]]) -> list[tuple[float, int, int]]:
    """(size over the largest allowed, thing, segment) of the pairs that may be one."""
    clouds = [_cloud(thing.sightings) for thing in things]
    fits = []
    for j, (segment, sighting) in enumerate(found):
        cloud = _cloud((sighting,))
        limit = largest_size(kind_of(segment.label))
        for i, thing in enumerate(things):
            if thing.label != segment.label or not len(cloud) or not len(clouds[i]):
                continue
            share = _extent_share(np.concatenate([clouds[i], cloud]), limit)
            if share <= 1.0:
                fits.append((share, i, j))
    return fits


def _cloud(sightings: Sequence[Sighting]) -> np.ndarray:
    return np.concatenate([trimmed(sighting_points(s, limit=400, seed=0)) for s in sightings])


def trimmed(points: Float[np.ndarray, "n 3"], share: float = 0.02) -> Float[np.ndarray, "m 3"]:
    """Points without those beyond the outer quantiles of any axis, by more than a hand."""
    if len(points) < 20:
        return points
    low, high = np.quantile(points, [share, 1 - share], axis=0)
    return points[((points > low - 0.1) & (points < high + 0.1)).all(axis=1)]


def near_together(points: Float[np.ndarray, "n 3"], largest: Float[np.ndarray, "3"]) -> Float[np.ndarray, "m 3"]:
    """Points without those farther from the middle one, seen from above, than a thing reaches that is no larger than `largest`:
    behind thin things a mask's strays show the room."""
    if not len(points):
        return points
    reach = _REACH * math.hypot(largest[0], largest[1]) + _MARGIN
    return points[np.linalg.norm(points[:, :2] - np.median(points[:, :2], axis=0), axis=1) <= reach]


def _extent_share(points: np.ndarray, limit: Float[np.ndarray, "3"]) -> float:
    """How large a cloud is against a kind's largest size: the worse of its footprint's diameter and its height."""
    angle = np.pi * np.arange(12) / 12
    across = points[:, :2] @ np.stack([np.cos(angle), np.sin(angle)])
    low, high = np.quantile(across, [0.01, 0.99], axis=0)
    diameter = float((high - low).max())
    bottom, top = np.quantile(points[:, 2], [0.01, 0.99]).tolist()
    return max(
        diameter / (_SLACK * math.hypot(limit[0], limit[1]) + _MARGIN), (top - bottom) / (_SLACK * float(limit[2]) + _MARGIN)
    )
