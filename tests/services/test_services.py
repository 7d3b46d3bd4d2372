"""Services: asked once, kept before it is used, within the budget, written down."""

import threading

import pytest

from wm.services.budget import Budget
from wm.services.faults import BudgetError, RefusedError, ReplayError, ServiceError, TransientError
from wm.services.ledger import REQUESTS, Ledger, Spent
from wm.services.prices import Price, Prices
from wm.services.records import ServiceAnswer, ServiceRequest
from wm.services.retries import RetryPolicy
from wm.services.services import Services
from wm.services.store import AnswerStore

PRICES = Prices(as_of="2026-11-30", models={"m": Price(image=0.25, usage={"images": 1.0})})
ONE = ServiceAnswer(files={"image.png": b"\x89PNG"}, usage={"images": 1})


def request(seed: int = 0, paid: bool = True, model: str = "m-1") -> ServiceRequest:
    return ServiceRequest(backend="lab", model=model, content={"prompt": "a room", "seed": seed}, paid=paid)


class Sender:
    def __init__(self, *outcomes):
        self.outcomes, self.sent, self.lock = list(outcomes), 0, threading.Lock()

    def __call__(self) -> ServiceAnswer:
        with self.lock:
            self.sent += 1
            outcome = self.outcomes.pop(0) if self.outcomes else ONE
        if isinstance(outcome, Exception):
            raise outcome
        return outcome


def services(folder, **given) -> Services:
    ledger = Ledger(folder / REQUESTS)
    return Services(store=AnswerStore(folder / "answers"), prices=PRICES, ledger=ledger, run="run", stage="paint", **given)


def test_the_same_request_is_sent_once_now_and_by_later_runs(tmp_path):
    send = Sender()
    first = services(tmp_path)
    assert [first.ask(request(), send).files for _ in range(3)] == [ONE.files] * 3
    later = services(tmp_path)
    assert later.ask(request(), send).record == ONE.record
    assert send.sent == 1
    assert first.ledger.spent() == later.ledger.spent("paint") == Spent(requests=1, usd=0.25)


def test_of_equal_requests_at_the_same_time_one_is_sent(tmp_path):
    send, ours = Sender(), services(tmp_path)
    threads = [threading.Thread(target=ours.ask, args=(request(), send)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert send.sent == 1


def test_a_refusal_is_kept_and_raised_again_without_asking(tmp_path):
    send = Sender(ServiceAnswer(refusal="blocked: safety"))
    for _ in range(2):
        with pytest.raises(RefusedError, match="m-1: blocked: safety"):
            services(tmp_path).ask(request(), send)
    assert send.sent == 1


def test_what_passes_is_retried_and_what_does_not_is_not_kept(tmp_path):
    ours = services(tmp_path, retries=RetryPolicy(first=0.0, patience=5.0))
    send = Sender(TransientError("503"), TransientError("cut"), ServiceError("401: the key is not accepted"))
    with pytest.raises(ServiceError, match="401"):
        ours.ask(request(), send)
    assert ours.ask(request(), send).files == ONE.files
    assert send.sent == 4 and ours.ledger.spent() == Spent(1, 0.25)


def test_replay_only_sends_nothing(tmp_path):
    services(tmp_path).ask(request(), Sender())
    send = Sender()
    replaying = services(tmp_path, replay="only")
    assert replaying.ask(request(), send).files == ONE.files
    with pytest.raises(ReplayError, match=r"replay=only.*no answer .* of m-1"):
        replaying.ask(request(seed=1), send)
    assert send.sent == 0


def test_replay_off_asks_anew_and_keeps_nothing(tmp_path):
    send, ours = Sender(), services(tmp_path, replay="off")
    ours.ask(request(), send)
    ours.ask(request(), send)
    assert send.sent == 2 and not (tmp_path / "answers").exists()


@pytest.mark.parametrize("limits", [{"usd": 1.0}, {"requests": 4}])
def test_no_number_of_threads_exceeds_a_budget(tmp_path, limits):
    send, ours = Sender(), services(tmp_path, budget=Budget(**limits))
    stopped = []

    def ask(seed: int) -> None:
        try:
            ours.ask(request(seed), send)
        except BudgetError as error:
            stopped.append(str(error))

    threads = [threading.Thread(target=ask, args=(seed,)) for seed in range(12)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert send.sent == 4 and len(stopped) == 8
    assert all("what was answered is kept" in message for message in stopped)


def test_a_budget_counts_what_earlier_parts_spent_and_not_what_failed(tmp_path):
    budget = Budget(requests=3, spent_requests=1, spent_usd=0.25)
    ours = services(tmp_path, budget=budget)
    with pytest.raises(ServiceError):
        ours.ask(request(1), Sender(ServiceError("400")))
    ours.ask(request(2), Sender())
    ours.ask(request(3), Sender())
    with pytest.raises(BudgetError, match=r"budget\.requests=3"):
        ours.ask(request(4), Sender())


def test_a_limit_of_money_wants_a_price(tmp_path):
    ours = services(tmp_path, budget=Budget(usd=5.0))
    with pytest.raises(BudgetError, match="no price for this model"):
        ours.ask(request(model="unheard-of"), Sender())
    assert ours.ask(request(model="unheard-of", paid=False), Sender()).files == ONE.files  # what is free needs none


@pytest.mark.parametrize("usage", [{"images": 1.0}, {"images": 1.0, "image_tokens": 0.0}])
def test_an_answer_that_tells_no_tokens_costs_what_was_expected(tmp_path, usage):
    """Services that speak another's dialect leave them out; at 0 USD a request no limit would ever be reached."""
    prices = Prices(models={"m": Price(image_tokens=100.0, usage={"image_tokens": 2000.0})})
    ours = services(tmp_path, budget=Budget(usd=0.5))
    ours.prices = prices
    for seed in range(2):
        ours.ask(request(seed), Sender(ServiceAnswer(files=ONE.files, usage=usage)))
    assert ours.ledger.spent() == Spent(2, 0.4)
    with pytest.raises(BudgetError):
        ours.ask(request(2), Sender())
    services(tmp_path).ask(request(3), Sender(ServiceAnswer(files=ONE.files, usage={"image_tokens": 1})))


def test_a_local_model_is_kept_and_costs_nothing(tmp_path):
    send, ours = Sender(), services(tmp_path, budget=Budget(requests=0))
    ours.ask(request(paid=False), send)
    ours.ask(request(paid=False), send)
    assert send.sent == 1 and ours.ledger.spent() == Spent()


def test_what_a_killed_process_paid_and_could_not_write_down_is_written_down_later(tmp_path):
    services(tmp_path).ask(request(), Sender())
    (tmp_path / REQUESTS).unlink()
    resumed = services(tmp_path)
    resumed.ask(request(), Sender())
    resumed.ask(request(), Sender())
    assert resumed.ledger.spent() == Spent(1, 0.25)
    other = services(tmp_path / "other")
    other.store, other.run = AnswerStore(tmp_path / "answers"), "another run"
    other.ask(request(), Sender())
    assert other.ledger.spent() == Spent()  # that run has not paid


def test_what_is_written_down_later_counts_in_the_budget(tmp_path):
    for seed in range(2):
        services(tmp_path).ask(request(seed), Sender())
    (tmp_path / REQUESTS).unlink()  # as if killed before both were written down
    resumed, send = services(tmp_path, budget=Budget(requests=2)), Sender()
    for seed in range(2):
        resumed.ask(request(seed), send)
    with pytest.raises(BudgetError):
        resumed.ask(request(2), send)
    assert send.sent == 0


def test_a_request_that_many_threads_find_is_written_down_once(tmp_path):
    """Whether it was kept by a killed process, or is being kept by another thread now."""
    services(tmp_path).ask(request(), Sender())
    (tmp_path / REQUESTS).unlink()
    resumed, together = services(tmp_path), threading.Barrier(8, timeout=30)
    held = resumed.ledger.holds
    resumed.ledger.holds = lambda key: (held(key), threading.Event().wait(0.01))[0]  # the others come in between

    def ask() -> None:
        together.wait()
        resumed.ask(request(), Sender())

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert resumed.ledger.spent() == Spent(1, 0.25)


def test_who_finds_an_answer_before_it_is_written_down_does_not_write_it_down_too(tmp_path):
    ours = services(tmp_path)
    put = ours.store.put

    def kept_and_found(*given) -> None:
        put(*given)
        ours.ask(request(), Sender())  # what another thread does

    ours.store.put = kept_and_found
    ours.ask(request(), Sender())
    assert ours.ledger.spent() == Spent(1, 0.25)


def test_a_paid_answer_that_cannot_be_kept_is_counted_all_the_same(tmp_path):
    class Full(Sender):
        def __call__(self):
            (tmp_path / "answers" / request().key[:2] / f"{request().key}.zip").mkdir()  # stands for a disk that fills up
            return super().__call__()

    ours = services(tmp_path, budget=Budget(requests=1))
    with pytest.raises(ServiceError, match="cannot be kept"):
        ours.ask(request(), Full())
    assert Ledger(tmp_path / REQUESTS).spent() == Spent(1, 0.25)
    with pytest.raises(BudgetError):
        ours.ask(request(1), Sender())


def test_a_ledger_that_cannot_be_read_is_not_one_that_spent_nothing(tmp_path):
    (tmp_path / REQUESTS).mkdir()
    with pytest.raises(OSError):
        Ledger(tmp_path / REQUESTS)


def test_costs_are_announced_once_a_stage_before_anything_is_sent(tmp_path):
    events, send = [], Sender()
    ours = services(tmp_path)
    ours.announce = lambda: events.append((ours.stage, send.sent))
    ours.ask(request(0, paid=False), send)
    ours.ask(request(1), send)
    ours.ask(request(2), send)
    ours.stage = "furnish"
    ours.ask(request(1), send)
    ours.ask(request(3), send)
    assert events == [("paint", 1), ("furnish", 3)]


def test_half_a_line_of_the_ledger_is_dropped(tmp_path):
    file = tmp_path / REQUESTS
    row = {"key": "k", "stage": "paint", "backend": "lab", "model": "m", "usd": 0.5, "paid": True, "seconds": 1.0}
    Ledger(file).add(row)
    with file.open("ab") as out:
        out.write(b'{"key": "half')
    ledger = Ledger(file)
    ledger.add({**row, "key": "l", "usd": None})
    assert Ledger(file).spent() == Spent(requests=2, usd=0.5, unpriced=1)


def test_the_price_is_that_of_the_longest_name_that_fits():
    prices = Prices(models={"m": Price(request=1.0), "m-large": Price(input=2.0, output=10.0, image_tokens=100.0)})
    assert prices.cost("m-small", {}) == 1.0
    assert prices.cost("m-large-2026", {"input_tokens": 1e6, "output_tokens": 1e5, "image_tokens": 1e4}) == pytest.approx(4.0)
    assert prices.cost("n", {}) is None and prices.expected("n") is None
