"""Fits the size and pose of a template to observed points.

Initial guesses are made from the points and ranked by their cost. The best ones are refined; the best result is refined further,
once with the template as it is and once with the template rebuilt at the size that was found, and the lower cost decides.

Guesses: the yaws are those of the walls and of the smallest rectangle around the points seen from above, each in four quarter
turns. For each yaw, the extent of the points is enlarged to the smallest and to the middle size of the kind, towards either side,
since part of the thing may be hidden. The support fixes part of the pose: a standing thing touches the floor, a hanging one the
ceiling, and a thing on a wall has its back to the wall.

Refinement is the algorithm of Levenberg and Marquardt, for all guesses together. Let r be the residuals and J their derivatives,
by differences, with respect to the free parameters of a box (points stay matched, as in iterated closest points). A step s solves
(J^T J + m diag J^T J) s = -J^T r; the damping m is decreased after a step that lowers the cost and increased after any other.
Source: Levenberg 1944; Marquardt 1963; Fitzgibbon, "Robust registration of 2D and 3D point sets", 2003 (LM for ICP).
"""

import dataclasses
import math

import numpy as np
import shapely
from jaxtyping import Float

from wm.geometry.placement.clearances import LIFT
from wm.geometry.placement.upright import turn_between
from wm.geometry.placement.upright_box import UprightBox
from wm.geometry.plan.site import wall_yaw
from wm.offline.reconstruction.kinds import rebuilt
from wm.offline.reconstruction.template_cost import Evidence, cost, nearest, residuals, seen_distances
from wm.offline.reconstruction.template_surface import surface_of

_ANCHORS = ((False, False), (False, True), (True, False), (True, True))
_SAME_YAW = math.radians(6.0)
_TRIED, _OF_A_YAW, _TRIES, _STEPS = 8, 2, 6, 12
"""Number of guesses that are refined, largest number of them with one yaw, steps of each, and steps of the best result."""
_RANKED = 80
"""Size of the subsample of points by which guesses are ranked."""
_DIFFERENCE = 1e-3
"""Step, in metres and radians, of the differences that approximate derivatives."""
_DAMPED, _EASED, _HARDER = 1e-2, 0.3, 5.0
"""Initial damping, and its factors after a step that lowered the cost and after one that did not."""
_LEAST = 0.005
"""Smallest length of a side, in metres."""
_NEAR_WALL = 0.7
"""Largest distance, in metres, between the points of a thing on a wall and that wall."""
_FREE = {
    "floor": (0, 1, 3, 4, 5, 6), "flat": (0, 1, 3, 4, 5), "ceiling": (0, 1, 2, 3, 4, 5), "wall": (0, 1, 2, 4, 5, 6),
    "object": (0, 1, 2, 3, 4, 5, 6),
}  # fmt: skip
"""Indices of the parameters of a box that are free, by the support of the thing."""
_SHEET = 0.12
"""Metres. If a kind on a wall is less deep, its depth is that of its template, since a depth map does not resolve it."""


@dataclasses.dataclass(frozen=True, eq=False)
class TemplateFit:
    """The result of the fit of one template."""

    box: UprightBox
    cost: float  # half the sum of squared residuals
    residual: float  # median distance between the observed points and the template, metres


def fit_template(evidence: Evidence) -> TemplateFit:
    """The box with the lowest cost for the template."""
    boxes, costs = _refined(_best_guesses(evidence), evidence, _TRIES)
    best = boxes[[int(np.argmin(costs))]]
    anew = dataclasses.replace(evidence, surface=surface_of(rebuilt(evidence.template, best[0, 4:])))
    ends = [(*_refined(best, way, _STEPS), way) for way in (evidence, anew)]
    boxes, costs, way = min(ends, key=lambda end: float(end[1][0]))
    residual = float(np.median(seen_distances(boxes, way, nearest(boxes, way))))
    return TemplateFit(UprightBox(*boxes[0].tolist()), cost=float(costs[0]), residual=residual)


def _best_guesses(evidence: Evidence) -> np.ndarray:
    """[b, 7] the guesses of the lowest cost, the best first, with at most _OF_A_YAW of them for one yaw."""
    guesses = np.stack([_row(box) for box in _guesses(evidence)])
    few = dataclasses.replace(evidence, points=evidence.points[:: max(len(evidence.points) // _RANKED, 1)])
    ranked = guesses[np.argsort(cost(guesses, few), kind="stable")]
    kept = [k for k, row in enumerate(ranked) if (ranked[:k, 3] == row[3]).sum() < _OF_A_YAW]
    return ranked[kept[:_TRIED]]


def _row(box: UprightBox) -> np.ndarray:
    return np.array([box.x, box.y, box.z, box.yaw, box.width, box.depth, box.height])


def _guesses(evidence: Evidence) -> list[UprightBox]:
    template = evidence.template
    fills = (template.low, (template.low + template.high) / 2)
    if template.support != "wall":
        return [_completed(yaw, evidence, anchor, fill) for yaw in _yaws(evidence) for anchor in _ANCHORS for fill in fills]
    middle = np.median(evidence.points[:, :2], axis=0)
    far = _from_walls(middle, evidence)
    near = [int(k) for k in np.argsort(far, kind="stable") if far[k] < _NEAR_WALL] or [int(np.argmin(far))]
    yaws = [wall_yaw(evidence.site.normals[k]) for k in near]
    return [_completed(yaw, evidence, anchor, fill) for yaw in yaws for anchor in _ANCHORS for fill in fills]


def _from_walls(point: np.ndarray, evidence: Evidence) -> np.ndarray:
    """[w] distance of a point from each wall in metres: from its plane, plus the distance beyond its ends."""
    site = evidence.site
    offset = ((point - site.starts) * site.normals).sum(axis=1)
    along = ((point - site.starts) * site.directions).sum(axis=1)
    return np.abs(offset) + np.maximum(np.maximum(-along, along - site.lengths), 0.0)


def _yaws(evidence: Evidence) -> list[float]:
    """The yaws of the guesses, which differ from each other by more than _SAME_YAW."""
    yaws = [wall_yaw(normal) for normal in evidence.site.normals]
    rectangle = shapely.get_coordinates(shapely.oriented_envelope(shapely.MultiPoint(evidence.points[:, :2])))
    if len(rectangle) >= 4:
        side = rectangle[1] - rectangle[0]
        yaws += [math.atan2(side[1], side[0]) + k * math.pi / 2 for k in range(4)]
    kept: list[float] = []
    for yaw in yaws:
        if all(abs(turn_between(yaw, other)) > _SAME_YAW for other in kept):
            kept.append(yaw)
    return kept


def _completed(yaw: float, evidence: Evidence, anchor: tuple[bool, bool], fill: Float[np.ndarray, "3"]) -> UprightBox:
    """The bounding box of the points at a yaw, enlarged to at least `fill`; its upper end stays along the axes in `anchor`."""
    template, points = evidence.template, evidence.points
    frame = UprightBox(0.0, 0.0, 0.0, yaw, 1.0, 1.0, 1.0).transform[:3, :3]
    local = points @ frame
    low, high = np.quantile(local, [0.01, 0.99], axis=0)
    size = np.clip(high - low, [*fill[:2], template.low[2]], np.maximum(template.high, high - low))
    start = np.where([*anchor, True], high - size, low)  # the top is kept, since it is visible for most things
    middle = frame @ (start + size / 2)
    width, depth, height = size.tolist()
    box = UprightBox(float(middle[0]), float(middle[1]), float(start[2]), yaw, width, depth, height)
    return _held(box, evidence)


def _held(box: UprightBox, evidence: Evidence) -> UprightBox:
    """The box moved and resized so that it rests on its support."""
    template = evidence.template
    if template.support == "floor":
        top = max(box.top, 0.05)
        return dataclasses.replace(box, z=LIFT, height=max(top - LIFT, 0.05))
    if template.support == "flat":
        return dataclasses.replace(box, z=LIFT, height=float(template.piece.size[2]))
    if template.support == "ceiling":
        return dataclasses.replace(box, height=max(evidence.site.ceiling - LIFT - box.z, 0.05))
    if template.support == "wall":
        depth = float(template.piece.size[1]) if template.high[1] < _SHEET else box.depth
        return UprightBox(*_hung(_row(dataclasses.replace(box, depth=depth)), evidence).tolist())
    return box


def _hung(row: np.ndarray, evidence: Evidence) -> np.ndarray:
    """The box moved and turned so that its back is at the wall that it faces away from."""
    site = evidence.site
    facing = np.abs([turn_between(float(row[3]), wall_yaw(normal)) for normal in site.normals])
    k = int(np.argmin(_from_walls(row[:2], evidence) + 10 * facing))
    offset = float((row[:2] - site.starts[k]) @ site.normals[k])
    hung = row.copy()
    hung[:2] += (0.005 + row[5] / 2 - offset) * site.normals[k]
    hung[3] = wall_yaw(site.normals[k])
    return hung


def _moved(boxes: np.ndarray, steps: np.ndarray, free: list[int], evidence: Evidence) -> np.ndarray:
    """[b, 7] boxes after steps [b, k] of their free parameters, still at the ceiling or the wall if that is their support."""
    moved = boxes.copy()
    moved[:, free] += steps
    if evidence.template.support == "ceiling":  # the lower end moves and the top stays
        moved[:, 6] = boxes[:, 6] + boxes[:, 2] - moved[:, 2]
    moved[:, 4:] = np.maximum(moved[:, 4:], _LEAST)
    return np.stack([_hung(row, evidence) for row in moved]) if evidence.template.support == "wall" else moved


def _refined(boxes: np.ndarray, evidence: Evidence, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """(boxes [b, 7] after `steps` steps of Levenberg-Marquardt, their costs [b])."""
    free = _free(evidence)
    damping = np.full(len(boxes), _DAMPED)
    r, J = _linearised(boxes, free, evidence)
    for _ in range(steps):
        A, g = np.einsum("bkr,bjr->bkj", J, J), np.einsum("bkr,br->bk", J, r)
        scale = np.einsum("bkk->bk", A) + 1e-9
        step = np.linalg.solve(A + (damping[:, None] * scale)[:, :, None] * np.eye(len(free)), -g[..., None])[..., 0]
        after = _moved(boxes, step, free, evidence)
        r_after, J_after = _linearised(after, free, evidence)
        better = (r_after**2).sum(axis=1) < (r**2).sum(axis=1)
        boxes = np.where(better[:, None], after, boxes)
        r, J = np.where(better[:, None], r_after, r), np.where(better[:, None, None], J_after, J)
        damping = damping * np.where(better, _EASED, _HARDER)
    return boxes, 0.5 * (r**2).sum(axis=1)


def _free(evidence: Evidence) -> list[int]:
    template = evidence.template
    sheet = template.support == "wall" and template.high[1] < _SHEET
    return [k for k in _FREE[template.support] if not (sheet and k == 5)]


def _linearised(boxes: np.ndarray, free: list[int], evidence: Evidence) -> tuple[np.ndarray, np.ndarray]:
    """(residuals [b, r], their derivatives [b, k, r] with respect to the free parameters)."""
    count = len(free) + 1
    steps = np.concatenate([np.zeros((1, len(free))), _DIFFERENCE * np.eye(len(free))])
    rows = _moved(np.repeat(boxes, count, axis=0), np.tile(steps, (len(boxes), 1)), free, evidence)
    matched = np.repeat(nearest(boxes, evidence), count, axis=0)
    found = residuals(rows, evidence, matched).reshape(len(boxes), count, -1)
    return found[:, 0], (found[:, 1:] - found[:, :1]) / _DIFFERENCE
