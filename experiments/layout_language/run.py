"""Iterations and seconds until a floor plan is valid, for every configured language backend. See README.md.

    python experiments/layout_language/run.py                       all backends of conf/language, 10 runs each
    python experiments/layout_language/run.py grammar --runs 200    one of them, more often

Writes result.csv (a row for each run) and table.md. A backend that cannot be asked has a row that says why. Answers are not
kept, so that every second is one of the model's; requests cost what they cost, and --usd limits them for each backend.
"""

import argparse
import collections
import contextlib
import csv
import dataclasses
import pathlib
import socket
import urllib.parse
from collections.abc import Iterator

import numpy as np
from tabulate import tabulate

from wm.errors import InputError
from wm.run import load_config, options
from wm.schema import BackendSettings, RunConfig
from wm.services.budget import Budget
from wm.services.faults import ServiceError
from wm.services.prices import Prices
from wm.services.services import Services
from wm.synth.proposing import Attempt, ProposalError, propose_plan
from wm.synth.registry import close_backend, make_backend, missing_secrets

HERE = pathlib.Path(__file__).parent
THEME = "stately mansion"
KINDS = ("living room", "kitchen", "bathroom", "bedroom", "dining room", "study", "library", "bedroom", "pantry", "music room")
SIZES = (2, 4, 6, 8, 12)
"""Rooms of a programme; runs take them in turn, with a seed of their own."""
MAX_ITERATIONS = 8
PAPER = (
    ("Opus 4.6", 1.30, "79"),
    ("Qwen2.5-Coder-32B, RTX A5000", 1.40, "252"),
    ("gpt-oss-20b, RTX A5000", 2.60, "229"),
    ("Haiku 4.5", 3.20, "101"),
)


@dataclasses.dataclass(frozen=True)
class Run:
    """One floor plan."""

    backend: str
    rooms: int
    seed: int
    valid: bool
    iterations: int
    seconds: float
    usd: float  # paid to the model
    broken: str  # rules that its answers broke, each with how often: "opening 2; overlap 1"


def programme(rooms: int) -> list[str]:
    return ["hall", *(KINDS * 4)[: rooms - 1]]


def measured(name: str, config: RunConfig, runs: int, usd: float | None) -> Iterator[Run]:
    """The runs of a backend. Raises: what asking it raises."""
    prices = Prices(as_of=config.prices.as_of, models=config.prices.models)
    services = Services(replay="off", prices=prices, budget=Budget(usd, None))
    backend = make_backend("language", config.language, services=services)
    with contextlib.ExitStack() as done:
        done.callback(close_backend, backend)
        paid = 0.0
        for seed in range(runs):
            rooms = SIZES[seed % len(SIZES)]
            try:
                proposal = propose_plan(backend, THEME, programme(rooms), seed=seed, max_iterations=MAX_ITERATIONS)
                attempts, valid = proposal.transcript, True
            except ProposalError as error:
                attempts, valid = error.transcript, False
            seconds = sum(attempt.seconds for attempt in attempts)
            before, paid = paid, services.ledger.spent().usd
            yield Run(name, rooms, seed, valid, len(attempts), round(seconds, 4), round(paid - before, 6), broken(attempts))


def broken(attempts: tuple[Attempt, ...]) -> str:
    """The rules that answers broke, the most frequent first. A violation reads "room hall: overlap: ..."."""
    rules = collections.Counter(line.split(": ")[1] for attempt in attempts for line in attempt.violations)
    return "; ".join(f"{rule} {count}" for rule, count in rules.most_common())


def obstacle(settings: BackendSettings) -> str:
    """Why a backend cannot be asked here; empty if it can."""
    if secrets := missing_secrets(settings):
        return f"{', '.join(secrets)} not set"
    address = urllib.parse.urlsplit(getattr(settings, "base_url", None) or "")
    if address.hostname is None:
        return ""
    try:
        with socket.create_connection((address.hostname, address.port or 443), timeout=3):
            return ""
    except OSError:
        return f"no server at {address.scheme}://{address.netloc}"


def row(name: str, runs: list[Run], why: str) -> list[str]:
    """A row of the table: means over the runs, the spread of the iterations, and what went wrong."""
    if not runs:
        return [name, "–", "–", "–", "–", why]
    iterations, seconds = [run.iterations for run in runs], [run.seconds for run in runs]
    rules = collections.Counter()
    for run in runs:
        rules.update({rule: int(count) for rule, count in (part.rsplit(" ", 1) for part in run.broken.split("; ") if part)})
    told = ", ".join(f"{rule} {count}" for rule, count in rules.most_common()) or "none"
    return [
        name,
        f"{sum(run.valid for run in runs)} of {len(runs)}",
        f"{np.mean(iterations):.2f} ({min(iterations)} to {max(iterations)})",
        f"{np.mean(seconds):.3g} ({min(seconds):.2g} to {max(seconds):.2g})",
        f"{sum(run.usd for run in runs):.2f}",
        told + (f"; stopped: {why}" if why else ""),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("backends", nargs="*", help="of conf/language; all by default")
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--usd", type=float, default=2.0, help="the most that each backend may cost")
    arguments = parser.parse_args()
    records: list[Run] = []
    rows: list[list[str]] = []
    for name in arguments.backends or sorted(options("language"), key=lambda name: (name != "grammar", name)):
        config = load_config(["+scene=gothic", f"language={name}"])
        own, why = [], obstacle(config.language)
        if not why:
            try:
                for run in measured(name, config, arguments.runs, arguments.usd):
                    own.append(run)
            except (InputError, ServiceError) as error:
                why = str(error).splitlines()[0]
        records += own
        rows.append(row(name, own, why))
        print(*rows[-1], sep=" | ", flush=True)
    rows += [[f"*paper: {model}*", "10 of 10", f"{iterations:.2f}", seconds, "", ""] for model, iterations, seconds in PAPER]
    headings = (
        "backend",
        "valid",
        "iterations, mean (range)",
        "seconds, mean (range)",
        "USD",
        "rules broken, or why it was not asked",
    )
    (HERE / "table.md").write_text(tabulate(rows, headings, tablefmt="github", disable_numparse=True) + "\n", encoding="utf-8")
    if records:
        with (HERE / "result.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, dataclasses.asdict(records[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(map(dataclasses.asdict, records))


if __name__ == "__main__":
    main()
