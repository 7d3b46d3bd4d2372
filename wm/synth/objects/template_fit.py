"""Size and pose of a thing from what images show of it: guesses by its outline, then Gauss-Newton on the template's residuals.

Guesses: the yaws of the walls and of the smallest rectangle around the points seen from above, each in four quarter turns; in
each, the extent of the points, completed to the kind's usual size on either side, for a thing may be hidden behind itself or
behind another. What holds a thing fixes part of its pose: what stands touches the floor, what hangs the ceiling, and what is on
a wall has its back to it.
"""

import dataclasses
import math

import numpy as np
import shapely
from jaxtyping import Float
from scipy.optimize import least_squares

from wm.geometry.site import wall_yaw
from wm.geometry.upright import turn_between
from wm.geometry.upright_box import UprightBox
from wm.synth.objects.template_cost import Evidence, residuals

_LIFT = 0.002
_ANCHORS = ((False, False), (False, True), (True, False), (True, True))
_SAME_YAW = math.radians(6.0)
_TRIED, _TRIES, _STEPS = 3, 4, 12
"""Guesses that are refined, by how many steps, and by how many the best of them."""
_NEAR_WALL = 0.7
"""Metres from a wall within which the points of what hangs on it lie."""


def fit_template(evidence: Evidence) -> UprightBox:
    """The box that the template fills best."""
    boxes = sorted(_guesses(evidence), key=lambda box: _cost(box, evidence))
    tried = [_refined(box, evidence, _TRIES) for box in boxes[:_TRIED]]
    best = min(tried, key=lambda box: _cost(box, evidence))
    return _refined(best, evidence, _STEPS)


def _cost(box: UprightBox, evidence: Evidence) -> float:
    return 0.5 * float((residuals(box, evidence) ** 2).sum())


def _guesses(evidence: Evidence) -> list[UprightBox]:
    if evidence.template.support != "wall":
        return [_completed(yaw, evidence, anchor) for yaw in _yaws(evidence) for anchor in _ANCHORS]
    middle = np.median(evidence.points[:, :2], axis=0)
    site = evidence.site
    offset = ((middle - site.starts) * site.normals).sum(axis=1)
    along = ((middle - site.starts) * site.directions).sum(axis=1)
    beyond = np.maximum(np.maximum(-along, along - site.lengths), 0.0)
    far = np.abs(offset) + beyond
    near = [int(k) for k in np.argsort(far, kind="stable") if far[k] < _NEAR_WALL] or [int(np.argmin(far))]
    return [_completed(wall_yaw(site.normals[k]), evidence, anchor) for k in near for anchor in _ANCHORS]


def _yaws(evidence: Evidence) -> list[float]:
    """Turns worth trying, no two alike."""
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


def _completed(yaw: float, evidence: Evidence, anchor: tuple[bool, bool]) -> UprightBox:
    """The box of the points at a yaw, made as large as the kind is at least; `anchor` says on which sides it is all seen."""
    template, points = evidence.template, evidence.points
    frame = UprightBox(0.0, 0.0, 0.0, yaw, 1.0, 1.0, 1.0).transform[:3, :3]
    local = points @ frame
    low, high = np.quantile(local, [0.01, 0.99], axis=0)
    size = np.clip(high - low, template.low, np.maximum(template.high, high - low))
    start = np.where([*anchor, True], high - size, low)  # from eye level, of most things the top is seen
    middle = frame @ (start + size / 2)
    width, depth, height = size.tolist()
    box = UprightBox(float(middle[0]), float(middle[1]), float(start[2]), yaw, width, depth, height)
    return _held(box, evidence)


def _held(box: UprightBox, evidence: Evidence) -> UprightBox:
    """The box where what holds it wants it."""
    support, site = evidence.template.support, evidence.site
    if support == "floor":
        top = max(box.top, 0.05)
        return dataclasses.replace(box, z=_LIFT, height=max(top - _LIFT, 0.05))
    if support == "flat":
        return dataclasses.replace(box, z=_LIFT, height=float(evidence.template.piece.size[2]))
    if support == "ceiling":
        return dataclasses.replace(box, height=max(site.ceiling - _LIFT - box.z, 0.05))
    if support == "wall":
        return _hung(box, evidence)
    return box


def _hung(box: UprightBox, evidence: Evidence) -> UprightBox:
    """The box with its back on the wall that it faces away from."""
    site = evidence.site
    facing = np.abs([turn_between(box.yaw, wall_yaw(normal)) for normal in site.normals])
    offset = ((box.center - site.starts) * site.normals).sum(axis=1)
    along = ((box.center - site.starts) * site.directions).sum(axis=1)
    beyond = np.maximum(np.maximum(-along, along - site.lengths), 0.0)
    k = int(np.argmin(np.abs(offset) + beyond + 10 * facing))
    center = box.center + (0.005 + box.depth / 2 - offset[k]) * site.normals[k]
    return dataclasses.replace(box, x=float(center[0]), y=float(center[1]), yaw=wall_yaw(site.normals[k]))


_FREE = {
    "floor": (0, 1, 3, 4, 5, 6), "flat": (0, 1, 3, 4, 5), "ceiling": (0, 1, 2, 3, 4, 5), "wall": (0, 1, 2, 4, 5, 6),
    "object": (0, 1, 2, 3, 4, 5, 6),
}  # fmt: skip
"""Which of (x, y, z, yaw, width, depth, height) may change, by what holds a thing."""


def _refined(box: UprightBox, evidence: Evidence, steps: int) -> UprightBox:
    """The box after at most so many Gauss-Newton steps."""
    free = list(_FREE[evidence.template.support])
    start = _vector(box)

    def moved(q: Float[np.ndarray, "k"]) -> UprightBox:
        full = start.copy()
        full[free] = q
        if evidence.template.support == "ceiling":  # the foot moves, the top stays
            full[6] = start[6] + start[2] - full[2]
        full[4:] = np.maximum(full[4:], 0.02)
        box = UprightBox(*full.tolist())
        return _hung(box, evidence) if evidence.template.support == "wall" else box

    result = least_squares(
        lambda q: residuals(moved(q), evidence), start[free], method="trf", max_nfev=steps, diff_step=1e-3, x_scale=0.1
    )
    after = moved(result.x)
    return after if _cost(after, evidence) <= _cost(box, evidence) else box


def _vector(box: UprightBox) -> np.ndarray:
    return np.array([box.x, box.y, box.z, box.yaw, box.width, box.depth, box.height])
