"""Error against time along a fit: when it is measured, and what is measured."""

import dataclasses

import numpy as np

from wm.schema import FitSettings

MEANS = ("loss", "l1", "dissimilarity", "depth")
"""Terms of the loss whose means the curve shows."""

HELDOUT = ("psnr", "m_mae", "n_ang_deg")
"""Errors of held-out views that it shows."""


@dataclasses.dataclass(frozen=True)
class FitPoint:
    """A fit at one step: means of the loss terms since the last point, and held-out error if there are such views.

    Attributes:
        seconds: wall-clock since the fit began
        step: steps of this room so far
        room: its index
        loss: mean of the whole loss
        l1: mean absolute difference of colours
        dissimilarity: mean 1 - SSIM
        depth: mean absolute difference of depths, metres
        psnr: held-out, dB; NaN without held-out views
        m_mae: held-out, metres; NaN without held-out views or without depth
        n_ang_deg: held-out, degrees between normals; NaN likewise
    """

    seconds: float
    step: int
    room: int
    loss: float
    l1: float
    dissimilarity: float
    depth: float
    psnr: float
    m_mae: float
    n_ang_deg: float


def curve_steps(settings: FitSettings) -> list[int]:
    """Steps after which a fit is measured: `curve_points` of them from the start to the end, denser early on."""
    if settings.curve_points < 1:
        return []
    share = np.linspace(0, 1, settings.curve_points) ** 2 if settings.curve_points > 1 else np.ones(1)
    return sorted({round(s * settings.steps) for s in share})
