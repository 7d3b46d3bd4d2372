"""Krippendorff's alpha: how far raters agree beyond chance. 1 is perfect agreement, 0 is that of answers shuffled at random.

    alpha = 1 - D_o / D_e
    D_o = sum_ck o_ck d_ck / n,    D_e = sum_ck n_c n_k d_ck / (n (n - 1))

o_ck counts pairs of values (c, k) that two raters gave to one unit, each unit of m values weighted 1 / (m - 1); n_c are its row
sums and n their sum. The difference d_ck is 0 or 1 for names; for ranks it is the squared number of values between the two,
(n_c / 2 + sum of n_g strictly between + n_k / 2)². Units with fewer than two values say nothing.

Source: Krippendorff, Computing Krippendorff's Alpha-Reliability, University of Pennsylvania, 2011.
"""

from collections.abc import Iterable, Sequence
from typing import Literal

import numpy as np
from jaxtyping import Float


def krippendorff_alpha(units: Iterable[Sequence[int] | Sequence[str]], level: Literal["nominal", "ordinal"]) -> float | None:
    """The agreement of raters.

    Args:
      units: for each thing that was rated, the values that its raters gave, in any order. Raters may have left things out.
      level: whether values are names, or ranks in Python's order.

    Returns:
      Alpha, at most 1; None where it is undefined: no unit has two values, or all values are the same.
    """
    paired = [list(unit) for unit in units if len(unit) > 1]
    values = sorted({value for unit in paired for value in unit})
    if len(values) < 2:
        return None
    place = {value: number for number, value in enumerate(values)}
    coincidences = np.zeros((len(values), len(values)))
    for unit in paired:
        counts = np.bincount([place[value] for value in unit], minlength=len(values)).astype(float)
        coincidences += (np.outer(counts, counts) - np.diag(counts)) / (len(unit) - 1)
    totals = coincidences.sum(axis=0)
    apart = _differences(totals, level)
    observed = (coincidences * apart).sum()
    expected = (np.outer(totals, totals) * apart).sum() / (totals.sum() - 1)
    return float(1 - observed / expected)


def _differences(totals: Float[np.ndarray, " k"], level: Literal["nominal", "ordinal"]) -> Float[np.ndarray, "k k"]:
    """d_ck for values that occur `totals` times."""
    if level == "nominal":
        return 1 - np.eye(len(totals))
    middles = np.cumsum(totals) - totals / 2  # the middle of each value among all sorted ones
    return (middles[:, None] - middles[None, :]) ** 2
