"""Tidying segments: small ones are discarded, overlapping ones of one label merged, and unconnected pieces split.

Two pieces of one segment stay one instance if what lies between them in the image is nearer, as with a sofa behind a table.
Source: WorldMesh, supplement, "Object Segmentation"; the rule about what lies between is ours.
"""

import numpy as np
from jaxtyping import Float
from scipy import ndimage
from skimage.measure import label

from wm.geometry.placement.support import is_plural, is_structure
from wm.synth.backends import Segment

_SAME = 0.5
"""Share of the smaller of two masks in the larger from which they are one instance."""
_NEARER = 0.03
"""Relative depth by which something must be nearer to hide what is behind it."""
_HIDDEN = 0.7
"""Share of the straight line between two pieces that must be hidden."""


def tidy_segments(segments: list[Segment], depth: Float[np.ndarray, "h w"], *, min_area: float) -> list[Segment]:
    """Segments fit for reconstruction, large before small. Neither their order nor tidying them twice changes the result.

    Args:
      depth: z-depth of the image, metres.
      min_area: share of the image below which a segment is discarded.
    """
    least = max(min_area * depth.size, 1.0)
    kept = [segment for segment in segments if segment.mask.sum() >= least and not is_structure(segment.label)]
    kept = _merged(sorted(kept, key=_rank))
    parts = [part for segment in kept for part in _split(segment, depth, least)]
    return sorted(parts, key=_rank)


def _rank(segment: Segment) -> tuple[int, str, bytes]:
    """Large before small. Segments of equal size are ordered too, so that the order in which they come decides nothing."""
    return -int(segment.mask.sum()), segment.label, np.packbits(segment.mask).tobytes()


def _merged(segments: list[Segment]) -> list[Segment]:
    """Masks of one label that mostly cover each other are joined. Each pixel then belongs to the smallest segment that has it."""
    joined: list[Segment] = []
    for segment in segments:
        for k, other in enumerate(joined):
            shared = int((segment.mask & other.mask).sum())
            if segment.label == other.label and shared > _SAME * int(segment.mask.sum()):
                joined[k] = Segment(other.label, other.mask | segment.mask)
                break
        else:
            joined.append(segment)
    taken = np.zeros(joined[0].mask.shape, bool) if joined else np.zeros((0, 0), bool)
    exclusive = []
    for segment in reversed(joined):
        exclusive.append(Segment(segment.label, segment.mask & ~taken))
        taken |= segment.mask
    return exclusive[::-1]


def _split(segment: Segment, depth: np.ndarray, least: float) -> list[Segment]:
    """Connected parts of a segment; those that something nearer may separate stay together, and all of a plural (curtains)."""
    if is_plural(segment.label):
        return [segment] if segment.mask.sum() >= least else []
    labels = np.asarray(label(segment.mask, connectivity=2), np.int32)
    sizes = np.bincount(labels.ravel())[1:]
    order = [int(k) + 1 for k in np.argsort(-sizes, kind="stable") if sizes[k] >= 0.1 * least]
    groups: list[np.ndarray] = []
    for k in order:
        component = labels == k
        home = next((g for g, group in enumerate(groups) if _one_thing(group, component, depth)), None)
        if home is None:
            groups.append(component)
        else:
            groups[home] = groups[home] | component
    return [Segment(segment.label, mask) for mask in groups if mask.sum() >= least]


def _one_thing(a: np.ndarray, b: np.ndarray, depth: np.ndarray) -> bool:
    """Whether the shortest line between two masks runs behind something nearer than both of its ends."""
    nearest = np.zeros((2, *a.shape), np.int32)
    distance = np.asarray(ndimage.distance_transform_edt(~a, return_indices=True, indices=nearest))
    ys, xs = np.nonzero(b)
    k = int(np.argmin(distance[ys, xs]))
    start, end = np.array([ys[k], xs[k]]), nearest[:, ys[k], xs[k]]
    count = int(np.abs(end - start).max()) - 1
    if count < 1:
        return True
    share = (np.arange(count) + 1) / (count + 1)
    line = np.round(start + share[:, None] * (end - start)).astype(int)
    between = depth[line[:, 0], line[:, 1]]
    ends = min(float(depth[tuple(start)]), float(depth[tuple(end)]))
    return bool((between < (1 - _NEARER) * ends).mean() >= _HIDDEN)
