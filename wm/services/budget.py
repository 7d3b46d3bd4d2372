"""Limits of money and of requests. What is under way counts as spent, so that requests side by side cannot exceed a limit."""

import contextlib
import threading
from collections.abc import Iterator

from wm.services.faults import BudgetError


class Budget:
    """What a run may spend.

    Args:
      usd: US dollars; None for no limit.
      requests: number of paid requests; None for no limit.
      spent_usd, spent_requests: what earlier parts of the run have spent.
    """

    def __init__(self, usd: float | None = None, requests: int | None = None, *, spent_usd: float = 0.0, spent_requests: int = 0):
        self.usd, self.requests = usd, requests
        self._usd, self._requests = spent_usd, spent_requests
        self._lock = threading.Lock()

    @contextlib.contextmanager
    def reserve(self, expected: float | None) -> "Iterator[Reservation]":
        """Room for one request. What it really cost is told by `Reservation.settle`; one that is not settled was not spent.

        Raises:
          BudgetError: the request would exceed a limit; or there is a limit of money and its price (None) is not known.
        """
        if expected is None and self.usd is not None:
            raise BudgetError(
                "budget.usd is set, and conf/prices has no price for this model: add one, or set budget.requests instead"
            )
        held = Reservation(expected or 0.0)
        with self._lock:
            self._check(held.usd)
            self._usd += held.usd
            self._requests += 1
        try:
            yield held
        finally:
            with self._lock:
                self._usd += (held.settled or 0.0) - held.usd
                self._requests -= held.settled is None

    def count(self, usd: float | None) -> None:
        """Counts a request that an earlier part of the run has paid; None if its price is not known."""
        with self._lock:
            self._usd += usd or 0.0
            self._requests += 1

    def _check(self, usd: float) -> None:
        goes_on = "what was answered is kept; a larger limit goes on there"
        if self.requests is not None and self._requests + 1 > self.requests:
            raise BudgetError(f"budget.requests={self.requests} is reached ({self._requests} paid requests); {goes_on}")
        if self.usd is not None and self._usd + usd > self.usd:
            spent = f"{self._usd:.2f} USD are spent or under way, and the next request costs about {usd:.2f}"
            raise BudgetError(f"budget.usd={self.usd:g} would be exceeded: {spent}; {goes_on}")


class Reservation:
    """Room in a budget for one request."""

    def __init__(self, usd: float):
        self.usd = usd
        self.settled: float | None = None

    def settle(self, usd: float | None) -> None:
        """Says what the request has cost; None where that is not known, and then the reserved sum stands."""
        self.settled = self.usd if usd is None else usd
