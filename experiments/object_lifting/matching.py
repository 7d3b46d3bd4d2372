"""True things against their reconstructions, and what that comes to in figures."""

import dataclasses
from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from wm.geometry.placement.upright import levelled, turn_between
from wm.geometry.placement.upright_box import UprightBox, box_iou, box_of
from wm.synth.backends import SceneContext
from wm.synth.lifting.lifted import LiftedRoom
from wm.types import SceneObject

FOUND = 0.25
"""Intersection over union from which a thing counts as found."""
SEEN = 300
"""Pixels from which a thing counts as seen in an image."""
_ROUND = ("lamp", "candelabra", "candle", "vase", "bowl", "plant", "flowers", "chandelier", "globe", "column", "stool", "statue",
          "round", "basket", "mushroom", "chess", "side table", "rug", "mat")  # fmt: skip
"""Words of what looks alike from several sides, or whose sides are of no kind: its yaw says nothing."""


@dataclasses.dataclass(frozen=True)
class Match:
    """One true thing and what became of it."""

    scene: str
    seed: int
    room: str
    label: str
    support: str
    pixels: int  # in the image that shows most of it
    iou: float  # of the reconstruction; 0 where there is none
    iou_placed: float
    center_m: float  # NaN where there is no reconstruction
    yaw_deg: float  # NaN too where the thing is round


def matches(
    scene: str, context: SceneContext, room: int, true: Sequence[SceneObject], lifted: LiftedRoom
) -> list[Match]:
    """Every true thing of a room against its reconstruction: one to one, of one label, for the largest sum of overlaps."""
    mine = [k for k, thing in enumerate(true) if thing.room == room]
    made = [levelled(thing) for thing in lifted.things]
    gain = np.array([[_gain(true[k], thing) for thing in made] for k in mine]).reshape(len(mine), len(made))
    partner = {i: j for i, j in zip(*linear_sum_assignment(-gain)) if gain[i, j] > 0}
    placed = dict(zip(lifted.placement.source, lifted.placement.objects))
    rows = []
    for i, k in enumerate(mine):
        thing, j = true[k], partner.get(i)
        pixels = max((int((drawing.result.drawn_object == k).sum()) for drawing in lifted.drawings), default=0)
        row = Match(scene, context.seed, context.plan.rooms[room].name, thing.label, thing.support, pixels, 0, 0, np.nan, np.nan)
        if j is not None:
            row = dataclasses.replace(row, **_errors(box_of(thing), box_of(made[j]), thing.label))
            row = dataclasses.replace(row, iou_placed=box_iou(box_of(thing), box_of(placed[j])) if j in placed else 0.0)
        rows.append(row)
    return rows


def _gain(truth: SceneObject, made: SceneObject) -> float:
    if truth.label != made.label:
        return 0.0
    a, b = box_of(truth), box_of(made)
    distance = float(np.linalg.norm(a.center - b.center))
    return box_iou(a, b) + (1e-3 / (1 + distance) if distance < 1.0 else 0.0)


def _errors(truth: UprightBox, made: UprightBox, label: str) -> dict[str, float]:
    center = np.array([truth.x - made.x, truth.y - made.y, truth.z + truth.height / 2 - made.z - made.height / 2])
    turn = np.nan if any(word in label for word in _ROUND) else abs(np.degrees(turn_between(truth.yaw, made.yaw)))
    return {"iou": box_iou(truth, made), "center_m": float(np.linalg.norm(center)), "yaw_deg": float(turn)}


def summary(rows: list[Match]) -> dict[str, float]:
    """One row of the table."""
    seen = [row for row in rows if row.pixels >= SEEN]
    found = [row for row in seen if row.iou >= FOUND]
    yaws = np.array([row.yaw_deg for row in found if np.isfinite(row.yaw_deg)])
    return {
        "things": len(rows),
        "seen": round(len(seen) / max(len(rows), 1), 3),
        "recall_seen": round(len(found) / max(len(seen), 1), 3),
        "recall_all": round(sum(row.iou >= FOUND for row in rows) / max(len(rows), 1), 3),
        "iou_mean": round(float(np.mean([row.iou for row in seen])), 3),
        "iou_median": round(float(np.median([row.iou for row in seen])), 3),
        "iou_placed_mean": round(float(np.mean([row.iou_placed for row in seen])), 3),
        "center_cm_median": round(100 * _median([row.center_m for row in seen]), 1),
        "yaw_deg_median": round(_median(yaws), 1),
        "yaw_within_10": round(float((yaws < 10).mean()), 3) if len(yaws) else np.nan,
        "yaw_within_10_or_flipped": round(float((np.minimum(yaws, 180 - yaws) < 10).mean()), 3) if len(yaws) else np.nan,
    }


def _median(values) -> float:
    finite = np.asarray(values, float)[np.isfinite(values)]
    return float(np.median(finite)) if len(finite) else np.nan
