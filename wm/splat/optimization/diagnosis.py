"""Sentences that say what is wrong with a fit: which term of the loss, of which view, and what would help."""

import numpy as np

from wm.schema import FitSettings
from wm.splat.optimization.divergence_monitor import DivergenceMonitor
from wm.splat.optimization.step import StepTerms, Target

TERMS = ("l1", "dissimilarity", "depth", "normal")
"""The terms of the loss, in the order of `weighted`."""


def weighted_terms(terms: StepTerms, settings: FitSettings) -> np.ndarray:
    """[terms] each of `TERMS` times its weight; their sum is the loss."""
    weights = (1 - settings.ssim_weight, settings.ssim_weight, settings.depth_weight, settings.normal_weight)
    return np.array([weight * float(getattr(terms, name)) for weight, name in zip(weights, TERMS)])


def not_finite(terms: StepTerms, target: Target) -> str | None:
    """Which terms of a view's loss or which leaves of its gradient are not finite; None if all are."""
    lost = [f"{name} {float(getattr(terms, name))}" for name in TERMS if not np.isfinite(getattr(terms, name))]
    parts = {**vars(terms.finite), **vars(terms.finite.gaussians)}
    leaves = [name for name, finite in parts.items() if isinstance(finite, np.ndarray | np.bool_) and not finite]
    if not lost and not leaves:
        return None
    what = "loss not finite: " + ", ".join(lost) if lost else "gradient not finite: of " + ", ".join(leaves)
    depth = np.asarray(target.depth)
    wrong = int((~np.isfinite(depth)).sum())
    return what + (f"; the scaffold's depth is not finite at {wrong} of its {depth.size} pixels" if wrong else "")


def divergence(monitor: DivergenceMonitor) -> str:
    """Which term of the loss grew most in the latest bad visit of a fit that diverges."""
    now, known = monitor.bad_terms, monitor.known[monitor.bad_view]
    worst = int((now - known).argmax())
    return (
        f"the fit diverges: loss {now.sum():.3g} where it had {known.sum():.3g}, most of it {TERMS[worst]} "
        f"({now[worst]:.3g}, it had {known[worst]:.3g}); lower learning rates (fit.lr_*) or a lower weight would help"
    )
