"""Where light is computed on objects: a few probes among the many corners that store it.

Furniture has far more corners than its light has detail. Corners that lie in one cell of a grid and face one way (of six) share
a probe, which stands on the corner nearest to their middle; afterwards every corner mixes the four probes nearest to it in place
and normal, so that light is smooth over a surface and still breaks at its creases.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool
from scipy.sparse import csr_array
from scipy.spatial import KDTree

from wm.offline.world.light.facets import Facets

NEIGHBOURS = 4
TURN = 1.3
"""What a difference of 1 between unit normals weighs, in cells of distance."""


@dataclasses.dataclass(frozen=True, eq=False)
class Probes:
    """Light samples on objects and how corners of facets mix them."""

    position: np.ndarray  # [p, 3] float64 metres
    normal: np.ndarray  # [p, 3] float64 unit
    face: np.ndarray  # [p] int32 a face that the probe lies on
    nearest: np.ndarray  # [q] int32 probe nearest to each corner of the facets
    mix: csr_array  # [q, p] float32 weights of probes at each corner
    average: csr_array  # [p, p] float32 each probe with its neighbours: what light is smoothed by


def build_probes(facets: Facets, exposed: Bool[np.ndarray, "q"], *, spacing: float, budget: int) -> Probes:
    """Probes about `spacing` metres apart; farther where there would be more than `budget` of them.

    Args:
      exposed: which corners stand in free air. Corners buried in another part (the top of a board under a table top) never
        stand for others; where nothing is exposed, all count.
    """
    if len(facets.position) == 0:
        empty = csr_array((0, 0), dtype=np.float32)
        return Probes(
            position=facets.position,
            normal=facets.normal,
            face=facets.face,
            nearest=np.zeros(0, np.int32),
            mix=empty,
            average=empty,
        )
    able = np.flatnonzero(exposed) if exposed.any() else np.arange(len(exposed))
    place, normal = facets.position[able], facets.normal[able]
    group, cell = _groups(place, normal, spacing), spacing
    while int(group.max()) + 1 > budget:
        cell *= 1.3
        group = _groups(place, normal, cell)
    chosen = able[_representatives(place, group)]
    feature = np.concatenate([facets.position / cell, TURN * facets.normal], axis=1)
    tree = KDTree(feature[chosen])
    mix, nearest = _mixing(tree, feature, min(NEIGHBOURS, len(chosen)), width=0.6)
    average, _ = _mixing(tree, feature[chosen], min(7, len(chosen)), width=0.9)
    return Probes(
        position=facets.position[chosen],
        normal=facets.normal[chosen],
        face=facets.face[chosen],
        nearest=nearest,
        mix=mix,
        average=average,
    )


def _groups(position: np.ndarray, normal: np.ndarray, cell: float) -> np.ndarray:
    """[q] int: number of the group of each corner, by grid cell and the axis nearest to its normal."""
    place = np.floor((position - position.min(axis=0)) / cell).astype(np.int64)
    axis = np.argmax(np.abs(normal), axis=1)
    sign = np.take_along_axis(normal, axis[:, None], axis=1)[:, 0] > 0
    key = place[:, 0] | (place[:, 1] << 18) | (place[:, 2] << 36) | ((2 * axis + sign).astype(np.int64) << 54)
    return np.unique(key, return_inverse=True)[1].ravel()


def _representatives(position: np.ndarray, group: np.ndarray) -> np.ndarray:
    """[p] the member of each group nearest to its middle, the first of equals."""
    size = np.bincount(group)
    middle = np.stack([np.bincount(group, position[:, k]) / size for k in range(3)], axis=1)
    distance = np.round(np.linalg.norm(position - middle[group], axis=1), 9)
    order = np.lexsort((distance, group))
    return order[np.cumsum(size) - size]


def _mixing(tree: KDTree, feature: np.ndarray, neighbours: int, *, width: float) -> tuple[csr_array, np.ndarray]:
    """Gaussian weights over the nearest probes of each feature, and the nearest."""
    distance, index = tree.query(feature, k=neighbours, workers=2)
    distance, index = distance.reshape(len(feature), -1), index.reshape(len(feature), -1)
    weight = np.exp(-0.5 * ((distance - distance[:, :1]) * (distance + distance[:, :1])) / width**2)
    weight = (weight / weight.sum(axis=1, keepdims=True)).astype(np.float32)
    rows = np.arange(len(feature) + 1) * neighbours
    return csr_array((weight.ravel(), index.ravel().astype(np.int32), rows), shape=(len(feature), tree.n)), index[:, 0].astype(
        np.int32
    )
