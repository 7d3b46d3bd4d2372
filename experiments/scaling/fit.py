"""How a cost grows with the number of rooms: the exponent p of cost = a rooms^p, with its interval.

By least squares on logarithms, y = log a + p log n. With k points and residuals r, the standard error of p is
sqrt(sum r^2 / (k - 2) / sum (x - mean x)^2), and the interval is that of Student's t with k - 2 degrees of freedom.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from scipy import stats


@dataclasses.dataclass(frozen=True)
class Exponent:
    """A fitted power."""

    value: float
    low: float  # of the interval that holds the true one with 95 % confidence; NaN of two points
    high: float

    def __str__(self) -> str:
        return f"{self.value:.2f}" if np.isnan(self.low) else f"{self.value:.2f} ({self.low:.2f} to {self.high:.2f})"


def exponent(rooms: Sequence[float], costs: Sequence[float]) -> Exponent:
    """The exponent by which costs grow with rooms.

    Raises:
      ValueError: there are not two different numbers of rooms, or a number is not positive.
    """
    n, cost = np.asarray(rooms, float), np.asarray(costs, float)
    if len(set(n)) < 2 or (n <= 0).any() or (cost <= 0).any():
        raise ValueError(f"rooms {list(rooms)} and costs {list(costs)}: two different numbers of rooms, all positive, are needed")
    fit = stats.linregress(np.log(n), np.log(cost))
    if len(n) < 3:
        return Exponent(value=float(fit.slope), low=float("nan"), high=float("nan"))
    reach = float(stats.t.ppf(0.975, len(n) - 2) * fit.stderr)
    return Exponent(value=float(fit.slope), low=float(fit.slope) - reach, high=float(fit.slope) + reach)
