"""`Services`: every request to a model goes through it, and is sent at most once.

    look up -> (replay only? stop) -> reserve in the budget -> send, retry -> keep the answer -> write down its cost

A process that is killed at any point sends again only what it had no answer to.
"""

import contextlib
import dataclasses
import threading
import time
from collections.abc import Callable, Iterator

from wm.services.budget import Budget
from wm.services.faults import RefusedError, ReplayError
from wm.services.ledger import Ledger
from wm.services.prices import Prices
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.retries import RetryPolicy, with_retries
from wm.services.store import AnswerStore

AUTO, ONLY, OFF = "auto", "only", "off"
"""Values of `replay`: answers are looked up and kept; looked up and nothing is sent; neither looked up nor kept."""


@dataclasses.dataclass(eq=False)
class Services:
    """What backends of real models ask through. The default keeps nothing and has no limits, for use from Python.

    Several threads may ask at the same time. Of equal requests one is sent, and all get its answer.
    """

    store: AnswerStore | None = None
    replay: str = AUTO
    budget: Budget = dataclasses.field(default_factory=Budget)
    prices: Prices = dataclasses.field(default_factory=Prices)
    ledger: Ledger = dataclasses.field(default_factory=Ledger)
    retries: RetryPolicy = dataclasses.field(default_factory=RetryPolicy)
    run: str = ""  # what tells this run from others that share the store
    stage: str = ""  # the stage that asks now
    say: Callable[[str], None] = lambda line: None  # told why a request waits
    views: int | None = None  # views that are still to be painted, once that is known
    announce: Callable[[], None] = lambda: None  # called before the first paid request of each stage is sent
    _announced: set[str] = dataclasses.field(default_factory=set)
    _unwritten: set[str] = dataclasses.field(default_factory=set)  # answers being kept now, whose cost is not written down yet
    _guard: threading.Lock = dataclasses.field(default_factory=threading.Lock)

    def ask(self, request: ServiceRequest, send: Callable[[], ServiceAnswer]) -> ServiceAnswer:
        """The answer to a request: a kept one, or that of `send`.

        Args:
          request: what is asked.
          send: sends it once. It raises TransientError where a later try may succeed, ServiceError where none will, and returns
            an answer with `refusal` where the model gave nothing that can be used.

        Raises:
          RefusedError: the model gave nothing that can be used, now or when it was asked before.
          ReplayError: nothing may be sent, and there is no answer.
          BudgetError: the request would exceed the budget.
          ServiceError: there is no answer, and waiting does not help; or answers cannot be kept.
          OSError: what it cost cannot be written down.
        """
        answer = self._kept(request)
        if answer is None:
            with self._claim(request.key):
                answer = self._kept(request) or self._asked(request, send)
        if answer.refusal:
            raise RefusedError(f"{request.model}: {answer.refusal}")
        return answer

    def quote(self, model: str, *, at_once: int = 1, paid: bool = True) -> Quote:
        """What one request to a model is expected to cost, by the price table."""
        price = self.prices.of(model)
        usd = 0.0 if not paid else self.prices.expected(model)
        return Quote(model=model, usd=usd, seconds=None if price is None else price.seconds, at_once=at_once)

    @contextlib.contextmanager
    def _claim(self, key: str) -> Iterator[None]:
        if self.store is None or self.replay != AUTO:
            yield
            return
        with self.store.claim(key):
            yield

    def _kept(self, request: ServiceRequest) -> ServiceAnswer | None:
        kept = None if self.store is None or self.replay == OFF else self.store.get(request.key)
        if kept is None:
            return None
        answer, noted = kept
        with self._guard:
            if noted.get("run") == self.run and request.key not in self._unwritten and not self.ledger.holds(request.key):
                self._write_down(request, noted.get("usd"), float(noted.get("seconds", 0.0)))  # killed before it could
                if request.paid:
                    self.budget.count(noted.get("usd"))
        return answer

    def _asked(self, request: ServiceRequest, send: Callable[[], ServiceAnswer]) -> ServiceAnswer:
        if self.replay == ONLY:
            where = self.store.folder if self.store is not None else "the store"
            raise ReplayError(
                f"{request.backend}: answers.replay=only, and {where} has no answer {request.key} of {request.model}; "
                "answers.replay=auto sends the request"
            )
        if request.paid:
            self._announce_once()
        with self.budget.reserve(self.prices.expected(request.model, request.expected)) if request.paid else _free() as held:
            started = time.monotonic()
            answer = with_retries(send, self.retries, f"{request.backend} ({request.model})", waiting=self.say)
            seconds = round(time.monotonic() - started, 3)
            usd = self._cost(request, answer) if request.paid else 0.0
            if held is not None:
                held.settle(usd)
            self._keep(request, answer, usd, seconds)
        return answer

    def _cost(self, request: ServiceRequest, answer: ServiceAnswer) -> float | None:
        """USD of an answer. Where a service does not say how many tokens it used, what was expected: a budget must not see 0."""
        if answer.refusal or any(answer.usage.get(name) for name in ("input_tokens", "output_tokens", "image_tokens")):
            return self.prices.cost(request.model, answer.usage)
        told = {name: value for name, value in answer.usage.items() if value}
        return self.prices.expected(request.model, {**request.expected, **told})

    def _keep(self, request: ServiceRequest, answer: ServiceAnswer, usd: float | None, seconds: float) -> None:
        """Keeps an answer and writes down what it cost, also where it cannot be kept: it was paid."""
        self._unwritten.add(request.key)
        try:
            if self.store is not None and self.replay != OFF:
                self.store.put(request, answer, {"usd": usd, "seconds": seconds, "run": self.run})
        finally:
            self._write_down(request, usd, seconds)
            self._unwritten.discard(request.key)

    def _announce_once(self) -> None:
        with self._guard:  # held while it is said: no request overtakes it
            if self.stage not in self._announced:
                self._announced.add(self.stage)
                self.announce()

    def _write_down(self, request: ServiceRequest, usd: float | None, seconds: float) -> None:
        told = {"key": request.key, "stage": self.stage, "backend": request.backend, "model": request.model}
        self.ledger.add({**told, "usd": usd, "paid": request.paid, "seconds": seconds})


@contextlib.contextmanager
def _free() -> Iterator[None]:
    yield
