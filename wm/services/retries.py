"""Waiting between tries of a request: bounded, growing, with jitter, and as long as the service asks for.

    wait(n) = max(after, min(longest, first * 2^n) * u),  u uniform in [1/2, 1]

after the n-th failure (n = 0, 1, ...), where `after` is what the service asked for (Retry-After), if anything. Jitter keeps
requests that failed together from coming back together. Work that may be stopped, as by the failure of another room, says by
`PAUSE` how its thread waits: nothing is then waited for, or sent again, for work that has ended.
"""

import contextvars
import dataclasses
import random
import time
from collections.abc import Callable
from typing import TypeVar

from wm.services.faults import ServiceError, TransientError

T = TypeVar("T")

PAUSE: contextvars.ContextVar[Callable[[float], None]] = contextvars.ContextVar("PAUSE", default=time.sleep)
"""How this thread waits so many seconds: a function that raises as soon as its work is stopped."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class RetryPolicy:
    first: float = 1.0  # seconds before the second try
    longest: float = 60.0  # seconds: waits grow up to this
    patience: float = 900.0  # seconds since the first try after which no new one begins


def with_retries(
    send: Callable[[], T],
    policy: RetryPolicy,
    what: str,
    *,
    sleep: Callable[[float], None] | None = None,
    clock: Callable[[], float] = time.monotonic,
    draw: Callable[[], float] = random.random,
    waiting: Callable[[str], None] = lambda line: None,
) -> T:
    """The result of `send`, tried again as long as it raises TransientError and the policy's patience lasts.

    Args:
      send: sends the request once.
      policy: how long to wait between tries, and in all.
      what: what is asked, for messages.
      sleep, clock, draw: waiting (None: `PAUSE`), the time in seconds, and uniform numbers in [0, 1).
      waiting: told in a line why and how long it waits.

    Raises:
      ServiceError: the patience is over; the message has the last fault. A service that asks for a wait beyond the patience is
        not waited for.
      Exception: what `PAUSE` raises where the work is stopped.
    """
    started, tries = clock(), 0
    while True:
        try:
            return send()
        except TransientError as fault:
            wait = max(fault.after or 0.0, min(policy.longest, policy.first * 2.0 ** min(tries, 60)) * (1 + draw()) / 2)
            tries += 1
            if clock() - started + wait > policy.patience:
                asked = f", and asks to wait for {fault.after:g} s" if fault.after else ""
                count = "1 try" if tries == 1 else f"{tries} tries"
                raise ServiceError(
                    f"{what}: no answer after {count} in {clock() - started:.0f} s: {fault}{asked}; what was answered is kept, "
                    "and the same command goes on there"
                ) from fault
            waiting(f"{what}: {fault}; next try in {wait:.0f} s")
        (sleep or PAUSE.get())(wait)
