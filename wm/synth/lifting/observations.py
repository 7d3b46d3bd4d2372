"""Which segments of several images show the same instance, and the world points that an observation shows.

The two cameras of a room stand at its ends and see two sides of most things. Segments of two images with the same label are taken
for observations of one instance if their points together are no larger than such a thing may be. Pairs that fit best come first.
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Bool, Float
from scipy import ndimage

from wm.geometry.placement.support import support_of
from wm.geometry.placement.upright_box import UprightBox, box_iou
from wm.geometry.rays.pinhole import camera_center, ray_basis
from wm.synth.backends import Observation, Segment
from wm.synth.lifting.vocabulary import largest_size, sort_of

_SLACK, _MARGIN = 1.1, 0.08
"""An instance may measure this many times the largest size of its sort, and this many metres more."""
_REACH = 0.8
"""The same for the distance of a point from the median point, as a share of the diagonal: the median may lie near an end."""
_SHARED, _SHARED_IN_ONE = 0.12, 0.4
"""Share of the smaller of two boxes in the other from which they are one instance: in different images, in the same one."""
_WALL = 0.06
"""Metres into a wall at which points of an instance that hangs there may seem to be."""
_RIM = 3.0
"""Pixels from the nearest one away from silhouettes within which a mask's pixels take its depth."""
_FIRM = 30
"""Pixels away from silhouettes that an observation must have for the others to be left out."""
_EDGE = 0.04
"""Relative jump of depth to a neighbour from which a pixel lies on a silhouette, where its depth may belong to either side."""


@dataclasses.dataclass(frozen=True, eq=False)
class Instance:
    """A thing in the room: its label and its observations, at least one."""

    label: str
    observations: tuple[Observation, ...]


def gather(views: Sequence[Sequence[tuple[Segment, Observation]]]) -> list[Instance]:
    """The instances in a room from the segments of each of its images, each with its observation; no segment is used twice."""
    instances = [Instance(segment.label, (observation,)) for segment, observation in views[0]] if views else []
    for found in views[1:]:
        fits = _fits(instances, found)
        taken: dict[int, int] = {}
        for _, i, j in sorted(fits):
            if i not in taken.values() and j not in taken:
                taken[j] = i
        for j, (segment, observation) in enumerate(found):
            if j in taken:
                known = instances[taken[j]]
                instances[taken[j]] = Instance(known.label, (*known.observations, observation))
            else:
                instances.append(Instance(segment.label, (observation,)))
    return instances


def joined(instances: Sequence[Instance], boxes: Sequence[UprightBox | None]) -> list[tuple[Instance, tuple[int, ...]]]:
    """Instances of one sort whose reconstructions share space, joined into one; each with the indices of those that it was.

    Args:
      boxes: of the reconstruction of each instance; None where there is none.
    """
    groups: list[list[int]] = []
    for k, (instance, box) in enumerate(zip(instances, boxes)):
        home = next((group for group in groups if any(_is_one(instance, box, instances[j], boxes[j]) for j in group)), None)
        if home is None:
            groups.append([k])
        else:
            home.append(k)
    return [(_together([instances[k] for k in group]), tuple(group)) for group in groups]


def _is_one(a: Instance, box: UprightBox | None, b: Instance, other: UprightBox | None) -> bool:
    """Whether two instances are the same one.

    Solid things do not share space, so two of one sort that do are one instance. Less shared space is enough if no image shows
    both, or if they hang from the ceiling: the thin arms of a chandelier come apart in an image.
    """
    if box is None or other is None or sort_of(a.label) != sort_of(b.label):
        return False
    iou = box_iou(box, other)
    shared = iou / (1 + iou) * (box.volume + other.volume) / min(box.volume, other.volume)
    apart = _cameras(a).isdisjoint(_cameras(b))
    hangs = support_of(a.label, largest_size(a.label).tolist()) == "ceiling"
    return shared > (_SHARED if apart or hangs else _SHARED_IN_ONE)


def _cameras(instance: Instance) -> set[int]:
    return {id(observation.camera) for observation in instance.observations}


def _together(instances: list[Instance]) -> Instance:
    """One instance with the observations of several; masks of the same camera are joined."""
    views: dict[int, Observation] = {}
    for observation in (observation for instance in instances for observation in instance.observations):
        known = views.get(id(observation.camera))
        mask = observation.mask if known is None else known.mask | observation.mask
        views[id(observation.camera)] = dataclasses.replace(observation, mask=mask)
    return Instance(instances[0].label, tuple(views.values()))


def observation_points(observation: Observation, *, limit: int, seed: int) -> Float[np.ndarray, "n 3"]:
    """World points of an observation's pixels in metres, a random subsample of `limit` where there are more.

    Pixels beside a silhouette take the depth of the nearest pixel farther in.
    """
    rows, columns = (np.flatnonzero(observation.mask.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return np.zeros((0, 3))
    y0, x0 = max(int(rows[0]) - 2, 0), max(int(columns[0]) - 2, 0)
    window = (slice(y0, int(rows[-1]) + 3), slice(x0, int(columns[-1]) + 3))
    mask, depth = observation.mask[window], observation.depth[window]
    some = mask & (depth > 0)
    solid = some & np.asarray(ndimage.binary_erosion(mask), bool) & ~silhouettes(depth)
    if solid.sum() >= _FIRM:
        depth, some = _filled(depth, solid, some)
    y, x = np.nonzero(some)
    if len(y) > limit:
        chosen = np.random.default_rng(np.random.SeedSequence([seed, 0x9017])).choice(len(y), limit, replace=False)
        y, x = y[chosen], x[chosen]
    across, down = ray_basis(observation.camera)
    return camera_center(observation.camera) + depth[y, x, None].astype(np.float64) * (across[x + x0] + down[y + y0])


def _filled(depth: np.ndarray, solid: np.ndarray, some: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(depth in which pixels of the rim have that of the nearest solid pixel, the mask of solid pixels and their rim).

    Towards its border a mask stays right for longer than the depth in it does.
    """
    nearest = np.zeros((2, *solid.shape), np.int32)
    away = np.asarray(ndimage.distance_transform_edt(~solid, return_indices=True, indices=nearest))
    return depth[nearest[0], nearest[1]], some & (away <= _RIM)


def in_room(observation: Observation, room: shapely.Polygon) -> bool:
    """Whether most of an observation's points lie in a room, and not beyond one of its doors."""
    points = observation_points(observation, limit=200, seed=0)
    return len(points) > 0 and bool(shapely.contains_xy(room.buffer(_WALL), points[:, :2]).mean() > 0.5)


def silhouettes(depth: Float[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """Pixels at a jump in depth."""
    low = np.asarray(ndimage.minimum_filter(depth, 3))
    high = np.asarray(ndimage.maximum_filter(depth, 3))
    return high - low > _EDGE * np.maximum(low, 1e-3) + 0.02


def _fits(instances: list[Instance], found: Sequence[tuple[Segment, Observation]]) -> list[tuple[float, int, int]]:
    """(size over the largest that is allowed, index of the instance, index of the segment) of the pairs that may be one."""
    clouds = [_cloud(instance.observations) for instance in instances]
    fits = []
    for j, (segment, observation) in enumerate(found):
        cloud = _cloud((observation,))
        limit = largest_size(segment.label)
        for i, instance in enumerate(instances):
            if instance.label != segment.label or not len(cloud) or not len(clouds[i]):
                continue
            share = _extent_share(np.concatenate([clouds[i], cloud]), limit)
            if share <= 1.0:
                fits.append((share, i, j))
    return fits


def _cloud(observations: Sequence[Observation]) -> np.ndarray:
    return np.concatenate([trimmed(observation_points(one, limit=400, seed=0)) for one in observations])


def trimmed(points: Float[np.ndarray, "n 3"], share: float = 0.02) -> Float[np.ndarray, "m 3"]:
    """Points without those that lie more than 0.1 m beyond the quantiles `share` and 1 - `share` along any axis."""
    if len(points) < 20:
        return points
    low, high = np.quantile(points, [share, 1 - share], axis=0)
    return points[((points > low - 0.1) & (points < high + 0.1)).all(axis=1)]


def near_together(points: Float[np.ndarray, "n 3"], largest: Float[np.ndarray, "3"]) -> Float[np.ndarray, "m 3"]:
    """Points no farther from the median point, seen from above, than a thing of the size `largest` (metres) reaches.

    Pixels of a mask that miss a thin thing show the room behind it.
    """
    if not len(points):
        return points
    reach = _REACH * math.hypot(largest[0], largest[1]) + _MARGIN
    return points[np.linalg.norm(points[:, :2] - np.median(points[:, :2], axis=0), axis=1) <= reach]


def _extent_share(points: np.ndarray, limit: Float[np.ndarray, "3"]) -> float:
    """A cloud's size as a share of the largest that is allowed: of its footprint's diameter or its height, the larger one."""
    angle = np.pi * np.arange(12) / 12
    across = points[:, :2] @ np.stack([np.cos(angle), np.sin(angle)])
    low, high = np.quantile(across, [0.01, 0.99], axis=0)
    diameter = float((high - low).max())
    bottom, top = np.quantile(points[:, 2], [0.01, 0.99]).tolist()
    return max(
        diameter / (_SLACK * math.hypot(limit[0], limit[1]) + _MARGIN), (top - bottom) / (_SLACK * float(limit[2]) + _MARGIN)
    )
