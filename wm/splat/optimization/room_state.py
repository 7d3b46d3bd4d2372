"""The state of the fit of a room: all that the next step reads, so that a fit which stops and resumes ends in the same bytes."""

import dataclasses
import math

import numpy as np

from wm.splat.optimization.curve import MEANS, FitPoint
from wm.splat.optimization.divergence_monitor import DivergenceMonitor
from wm.splat.optimization.padding import pad_rows, unpad_rows
from wm.splat.optimization.refinement import Residual
from wm.splat.optimization.step import TrainState, start_state
from wm.splat.rasterizer.checks import check_gaussians
from wm.types import Gaussians

NOTHING_SINCE = np.zeros((0, len(MEANS)))


@dataclasses.dataclass(frozen=True, eq=False)
class RoomState:
    """A room after some steps. Between runs everything is on the host and nothing is padded."""

    train: TrainState
    step: int = 0  # steps done
    history: tuple[FitPoint, ...] = ()
    since: np.ndarray = dataclasses.field(default_factory=lambda: NOTHING_SINCE)  # [k, means] of each step since the last point
    exposure: np.ndarray | None = None  # [views, 2, 3] of exposure.py, once it is used
    residual: Residual | None = None  # since the last refinement, once there is one to come
    monitor: DivergenceMonitor | None = None  # None between rounds
    stopped: str | None = None  # why it ended early, in one sentence

    @property
    def running_monitor(self) -> DivergenceMonitor:
        """The monitor, which is there while the steps of a round run."""
        assert self.monitor is not None
        return self.monitor


def initial_state(gaussians: Gaussians, name: str = "gaussians") -> RoomState:
    """The state of a room before its first step.

    Raises: TypeError or ValueError naming a leaf (of `name`) that is no array of its shape, or how many are not finite.
    """
    check_gaussians(gaussians, name)
    n = len(gaussians.opacity_logits)
    gaussians = pad_rows(gaussians, n)
    leaves = [np.asarray(leaf).reshape(n, math.prod(np.shape(leaf)[1:])) for leaf in vars(gaussians).values()]
    wrong = ~np.isfinite(np.concatenate(leaves, axis=1)).all(axis=1)
    if wrong.any():
        raise ValueError(f"{wrong.sum()} of {n} gaussians to start from are not finite, the first at {int(wrong.argmax())}")
    return RoomState(train=unpad_rows(start_state(gaussians), n))
