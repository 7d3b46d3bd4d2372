"""Is a fit still getting better? A watch over the losses of its views, cheap enough for every step.

Losses of different views do not compare, so every view is held against itself: against the lowest loss it had so far and, when
it is seen for the first time with a loss well above that of the views before, against what the best state has for it, measured.
A visit is bad if its loss is `WORSE` times that. Half of the last `PATIENCE` visits bad: the fit diverges. The best state
is the one that began the pass (every view once) of the lowest mean loss: one that has shown itself, not one that looks promising.

Work: a few comparisons a step, a copy of the gaussians a pass, a measurement only where something looks wrong.
"""

import dataclasses
from collections.abc import Callable

import numpy as np

from wm.types import Gaussians

WORSE = 3.0
"""Times its own lowest loss at which a view is called bad: what fits that go well were never seen to reach."""

SUSPECT = 2.0
"""Times the median of the known losses at which a view's first loss is not believed to be that of a good state."""

PATIENCE = 8
"""Visits that are looked back on: Adam's first steps may overshoot and come back."""

FLOOR = 0.01
"""A loss below this, a hundredth of the range of colours, is as good as none: ratios to it say nothing."""


@dataclasses.dataclass(frozen=True, eq=False)
class Watch:
    """What is known of a fit that is under way. On the host."""

    best: Gaussians  # the best state so far, unpadded
    best_step: int
    lowest: float  # mean loss of the pass that it began; infinite before a pass has ended
    latest: Gaussians  # the state that began this pass, likewise
    latest_step: int
    known: np.ndarray  # [views, terms] weighted terms of each view's lowest loss; NaN: not seen yet
    recent: np.ndarray  # [<= PATIENCE] bool: which of the last visits were bad
    passing: np.ndarray  # [< views] losses of this pass so far
    bad_view: int  # of the latest bad visit
    bad_terms: np.ndarray  # [terms] of the same


def start_watch(gaussians: Gaussians, step: int, views: int, terms: int) -> Watch:
    """A watch that knows nothing yet but the state it starts from (NumPy, unpadded)."""
    return Watch(
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


def watch_visit(watch: Watch, view: int, terms: np.ndarray, measure: Callable[[], np.ndarray]) -> Watch:
    """The watch after a visit.

    Args:
        watch: before.
        view: which.
        terms: [terms] the weighted terms of its loss, which is their sum; finite.
        measure: gives the same terms for the best state; called only if the view is new and suspicious.
    """
    known = watch.known[view]
    if np.isnan(known).any():
        seen = watch.known[~np.isnan(watch.known).any(axis=1)].sum(axis=1)
        suspicious = len(seen) > 0 and terms.sum() > SUSPECT * max(float(np.median(seen)), FLOOR)
        known = measure() if suspicious else terms
    known = known if known.sum() <= terms.sum() else terms
    bad = bool(terms.sum() > WORSE * max(float(known.sum()), FLOOR))
    table = watch.known.copy()
    table[view] = known
    return dataclasses.replace(
        watch,
        known=table,
        recent=np.append(watch.recent, bad)[-PATIENCE:],
        passing=np.append(watch.passing, terms.sum()),
        bad_view=view if bad else watch.bad_view,
        bad_terms=terms if bad else watch.bad_terms,
    )


def watch_step(watch: Watch, step: int, current: Callable[[], Gaussians]) -> Watch:
    """The watch after a step, whose visits it has seen; `current` gives a copy of the gaussians and is called at most once."""
    views = len(watch.known)
    if len(watch.passing) < views:
        return watch
    mean = float(watch.passing[:views].mean())
    if mean < watch.lowest and not watch.recent.any():
        watch = dataclasses.replace(watch, best=watch.latest, best_step=watch.latest_step, lowest=mean)
    return dataclasses.replace(watch, passing=watch.passing[views:], latest=current(), latest_step=step)


def diverges(watch: Watch, *, ended: bool = False) -> bool:
    """Whether half of the last visits were bad; before `PATIENCE` visits only a fit that has ended is judged."""
    return bool(watch.recent.any()) and 2 * int(watch.recent.sum()) >= (len(watch.recent) if ended else PATIENCE)
