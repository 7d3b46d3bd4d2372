"""What a run asks of models: the services that its backends ask through, and what that will cost, said before it costs.

The number of requests is known only as far as the run is: before there are views, it is estimated from the number of rooms.
"""

import dataclasses
import math
from collections.abc import Iterator
from pathlib import Path

from tabulate import tabulate

from wm import console
from wm.artifacts.confined import confined
from wm.artifacts.digests import digest
from wm.schema import STAGES, BackendSettings, CameraSettings, RunConfig
from wm.services.budget import Budget
from wm.services.ledger import REQUESTS, Ledger
from wm.services.prices import Prices
from wm.services.records import Quote
from wm.services.retries import RetryPolicy
from wm.services.services import Services
from wm.services.store import AnswerStore
from wm.synth.backends import ServedBackend
from wm.synth.registry import backend_module, is_served, make_backend, missing_secrets

BOOTSTRAP_VIEWS = 2
"""Views of a room beside those that the configuration counts (wm.geometry.cameras.views)."""
ATTEMPTS_A_VIEW = 1.5
"""Images of a view: the paper reports 1.35 to 1.68 for its models."""
PLANS = 2.0
"""Answers until a floor plan is valid: the paper's language models need 1.3 to 3.2."""
DRAWINGS_A_ROOM = 2
"""Images that a room's furniture is lifted from."""
PIECES_A_ROOM = 12
"""Pieces of furniture that are reconstructed."""


@dataclasses.dataclass(frozen=True)
class Expected:
    """Requests of a stage to one model."""

    stage: str
    group: str
    quote: Quote
    requests: int
    at_once: int = 1  # of these, how many are under way at the same time

    @property
    def usd(self) -> float | None:
        return None if self.quote.usd is None else self.quote.usd * self.requests

    @property
    def seconds(self) -> float | None:
        return None if self.quote.seconds is None else self.quote.seconds * math.ceil(self.requests / self.at_once)


def open_services(config: RunConfig, folder: Path) -> Services:
    """The services of a run: its answers, its prices, and its budget less what its earlier parts have spent.

    Raises:
      ArtifactError: a link leads out of the folder.
      OSError: what the earlier parts have spent cannot be read.
    """
    ledger = Ledger(confined(folder, REQUESTS))
    spent = ledger.spent()
    services = Services(
        store=AnswerStore(Path(config.answers.folder)),
        replay=config.answers.replay,
        budget=Budget(config.budget.usd, config.budget.requests, spent_usd=spent.usd, spent_requests=spent.requests),
        prices=Prices(as_of=config.prices.as_of, models=config.prices.models),
        ledger=ledger,
        retries=RetryPolicy(patience=config.answers.patience),
        run=digest(str(folder.resolve())),
        say=console.say,
    )
    said: set[Expected] = set()

    def announce() -> None:
        """A later stage says again what it costs only where that is known better by now."""
        rows = set(expected(config, services, services.stage))
        if not rows <= said:
            console.say(announcement(config, services))
        said.update(rows)

    services.announce = announce
    return services


def announcement(config: RunConfig, services: Services) -> str:
    """What the stage that asks now, and those after it, will ask of models that cost something, and the limits of it."""
    rows, spent = list(expected(config, services, services.stage)), services.ledger.spent()
    usd, requests = (f" ({part} spent)" * bool(spent.requests) for part in (_money(spent.usd), spent.requests))
    limits = [f"budget.usd={config.budget.usd:g}{usd}"] if config.budget.usd is not None else []
    limits += [f"budget.requests={config.budget.requests}{requests}"] if config.budget.requests is not None else []
    cells = [(row.stage, row.quote.model, _requests(row.requests), _money(row.usd), _time(row.seconds)) for row in rows]
    known = [row.usd for row in rows if row.usd is not None]
    total = f"about {_money(sum(known, 0.0))} in all" + (" for those with a price" if len(known) < len(rows) else "")
    limit = f"limited by {' and '.join(limits)}" if limits else "no limit is set (budget.usd, budget.requests)"
    table = tabulate(cells, tablefmt="plain", colalign=("left", "left", "right", "right", "right"), disable_numparse=True)
    head = f"before models are paid (prices of {config.prices.as_of}; answers that are kept cost nothing):"
    return "\n".join([head, table, f"{total}; {limit}", *_stops(config, rows)])


def _stops(config: RunConfig, rows: list[Expected]) -> Iterator[str]:
    """A line for each secret that is not set, with the first stage that will stop for it."""
    stages = {name: row.stage for row in reversed(rows) for name in missing_secrets(getattr(config, row.group))}
    for name, stage in stages.items():
        yield f"{stage} will stop: the environment variable {name} is not set"


def expected(config: RunConfig, services: Services, first: str = STAGES[0]) -> Iterator[Expected]:
    """The requests of a run to models from stage `first` on, as far as they can be told; `services.views` says how many views
    are left."""
    to_come = STAGES[STAGES.index(first) : STAGES.index(config.until) + 1]
    rooms = len(config.scene.rooms) or 1
    views = services.views if services.views is not None else _views(config.cameras, rooms)
    images = round(views * (min(ATTEMPTS_A_VIEW, config.verify.max_attempts) if config.verify.enabled else 1))
    counts: list[tuple[str, str, int]] = [("plan", "language", round(PLANS))] if config.plan.file is None else []
    if config.furnish.enabled:
        each = dict.fromkeys(("image", "depth", "segmentation"), DRAWINGS_A_ROOM) | {"reconstruction": PIECES_A_ROOM}
        used = getattr(backend_module(config.objects.backend), "USES", ())
        counts += [("furnish", group, rooms * each[group]) for group in used if group in each]
        if "segmentation" in used and "language" in getattr(backend_module(config.segmentation.backend), "USES", ()):
            counts.append(("furnish", "language", rooms * DRAWINGS_A_ROOM))  # names what is looked for
    counts += [("paint", "image", images)] + [("paint", "depth", images)] * config.verify.enabled
    for stage, group, requests in counts:
        if stage not in to_come:
            continue
        quote = _quote(group, getattr(config, group), services)
        if quote is not None:
            # Plans follow one another, and so do the rooms that are furnished; rooms are painted side by side.
            yield Expected(stage, group, quote, requests, min(quote.at_once, rooms) if stage == "paint" else 1)


def _views(cameras: CameraSettings, rooms: int) -> int:
    """Views of that many rooms that one door each joins to the others."""
    return rooms * (BOOTSTRAP_VIEWS + cameras.perimeter + cameras.overhead) + 2 * (rooms - 1) * cameras.doorway


def paid(services: Services) -> str:
    """What a run has paid, in words; nothing if it has paid nothing."""
    spent = services.ledger.spent()
    if not spent.requests:
        return ""
    stages = {stage: services.ledger.spent(stage) for stage in STAGES}
    parts = ", ".join(f"{stage} {part.requests} for {_money(part.usd)}" for stage, part in stages.items() if part.requests)
    unpriced = f" ({spent.unpriced} without a price in conf/prices)" if spent.unpriced else ""
    return f"paid to models: {_requests(spent.requests)}, {_money(spent.usd)}{unpriced}: {parts}"


def _quote(group: str, settings: BackendSettings, services: Services) -> Quote | None:
    if not is_served(settings):
        return None
    backend = make_backend(group, settings, None, services)
    return backend.quote() if isinstance(backend, ServedBackend) else None


def _requests(count: int) -> str:
    return "1 request" if count == 1 else f"{count} requests"


def _money(usd: float | None) -> str:
    if usd is None:
        return "no price known"
    return "less than 0.01 USD" if 0 < usd < 0.005 else f"{usd:.2f} USD"


def _time(seconds: float | None) -> str:
    if seconds is None:
        return "time not known"
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
