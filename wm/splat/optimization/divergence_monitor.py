"""Detects a fit that diverges, from the losses of its views; cheap enough for every step.

Losses of different views do not compare, so the loss of a view is compared with the lowest loss that the same view had so far. A
view that is seen for the first time, with a loss well above those of the other views, is compared with its loss under the best
state, which is measured then. A visit is bad if its loss is `WORSE` times that. The fit diverges if half of the last `PATIENCE`
visits were bad. The best state is the one at the beginning of the pass (every view once) with the lowest mean loss.

Work: a few comparisons per step, a copy of the gaussians per pass, a measurement only where a loss is suspicious.
"""

import dataclasses
from collections.abc import Callable

import numpy as np

from wm.types import Gaussians

WORSE = 3.0
"""A visit whose loss is this many times the lowest of its view is bad; fits that converge were never seen to reach it."""

SUSPECT = 2.0
"""A first loss of a view that is this many times the median of the known losses is suspicious, and measured again."""

PATIENCE = 8
"""The number of latest visits that are judged: Adam's first steps may overshoot and come back."""

FLOOR = 0.01
"""Losses are compared with this at least, a hundredth of the range of colours: ratios to smaller losses say nothing."""


@dataclasses.dataclass(frozen=True, eq=False)
class DivergenceMonitor:
    """The record over a fit that is under way. On the host."""

    best: Gaussians  # the best state so far, unpadded
    best_step: int
    lowest: float  # mean loss of the pass that the best state began; infinite before a pass has ended
    latest: Gaussians  # the state that began this pass, unpadded
    latest_step: int
    known: np.ndarray  # [views, terms] weighted terms of each view's lowest loss; NaN: not seen yet
    recent: np.ndarray  # [<= PATIENCE] bool: which of the last visits were bad
    passing: np.ndarray  # [< views] losses of this pass so far
    bad_view: int  # of the latest bad visit
    bad_terms: np.ndarray  # [terms] of the same


def start_monitor(gaussians: Gaussians, step: int, views: int, terms: int) -> DivergenceMonitor:
    """The monitor before the first visit, from the initial state (NumPy, unpadded)."""
    return DivergenceMonitor(
        best=gaussians,
        best_step=step,
        lowest=float("inf"),
        latest=gaussians,
        latest_step=step,
        known=np.full((views, terms), np.nan),
        recent=np.zeros(0, bool),
        passing=np.zeros(0),
        bad_view=0,
        bad_terms=np.zeros(terms),
    )


def monitor_visit(
    monitor: DivergenceMonitor, view: int, terms: np.ndarray, measure: Callable[[], np.ndarray]
) -> DivergenceMonitor:
    """The monitor after a visit.

    Args:
        monitor: before the visit.
        view: the index of the view.
        terms: [terms] the weighted terms of its loss, which is their sum; finite.
        measure: returns the same terms for the best state; called only if the view is new and its loss suspicious.
    """
    known = monitor.known[view]
    if np.isnan(known).any():
        seen = monitor.known[~np.isnan(monitor.known).any(axis=1)].sum(axis=1)
        suspicious = len(seen) > 0 and terms.sum() > SUSPECT * max(float(np.median(seen)), FLOOR)
        known = measure() if suspicious else terms
    known = known if known.sum() <= terms.sum() else terms
    bad = bool(terms.sum() > WORSE * max(float(known.sum()), FLOOR))
    table = monitor.known.copy()
    table[view] = known
    return dataclasses.replace(
        monitor,
        known=table,
        recent=np.append(monitor.recent, bad)[-PATIENCE:],
        passing=np.append(monitor.passing, terms.sum()),
        bad_view=view if bad else monitor.bad_view,
        bad_terms=terms if bad else monitor.bad_terms,
    )


def monitor_step(monitor: DivergenceMonitor, step: int, current: Callable[[], Gaussians]) -> DivergenceMonitor:
    """The monitor after a step and its visits; `current` returns a copy of the gaussians and is called at most once."""
    views = len(monitor.known)
    if len(monitor.passing) < views:
        return monitor
    mean = float(monitor.passing[:views].mean())
    if mean < monitor.lowest and not monitor.recent.any():
        monitor = dataclasses.replace(monitor, best=monitor.latest, best_step=monitor.latest_step, lowest=mean)
    return dataclasses.replace(monitor, passing=monitor.passing[views:], latest=current(), latest_step=step)


def diverges(monitor: DivergenceMonitor, *, ended: bool = False) -> bool:
    """Whether half of the last visits were bad; a fit of fewer than `PATIENCE` visits is judged only when it has ended."""
    return bool(monitor.recent.any()) and 2 * int(monitor.recent.sum()) >= (len(monitor.recent) if ended else PATIENCE)
