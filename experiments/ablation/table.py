"""The table of the ablation: means with their spread over seeds, the paper's figures beside ours, and whether the order holds.

Notation: x[v, c, s] is a metric of variant v in scene c with seed s. A cell shows the mean over scenes and seeds; its spread is
the largest distance of a seed's mean over the scenes from it:

    m[v, s] = mean_c x[v, c, s],   mean_s m[v, s] ± max_s |m[v, s] - mean_s m[v, s]|
"""

import dataclasses
from collections.abc import Iterable, Sequence

import numpy as np
from tabulate import tabulate

from wm.metric_table import METRICS, MISSING, Metric
from wm.report.paper import PAPER_COLUMNS, PAPER_ROWS
from wm.report.sweep import RunResult

COST = ("seconds", "peak_gib", "usd")
"""Columns that every table has beside its errors. They are of one run: a scene with a seed."""
COLUMNS = (*PAPER_COLUMNS, "psnr", "yield", "atm", *COST)


@dataclasses.dataclass(frozen=True)
class Cell:
    """A metric of a variant."""

    seeds: tuple[float, ...]  # of each seed the mean over the scenes

    @property
    def mean(self) -> float:
        return float(np.mean(self.seeds))

    @property
    def spread(self) -> float:
        """The largest distance of a seed from the mean; 0 of a single seed."""
        return float(max(abs(seed - self.mean) for seed in self.seeds))


def cells(runs: Sequence[RunResult], variant: str) -> dict[str, Cell]:
    """The cells of a variant by metric, where every one of its runs measured it."""
    own = [run for run in runs if run.config["variant"] == variant]
    seeds = sorted({run.config["seed"] for run in own})
    found = {}
    for key in COLUMNS:
        values = [[run.metrics.get(key) for run in own if run.config["seed"] == seed] for seed in seeds]
        if own and all(value is not None for row in values for value in row):
            found[key] = Cell(seeds=tuple(float(np.mean(row)) for row in values))
    return found


def verdict(full: Cell, other: Cell, metric: Metric) -> str:
    """How a variant stands to the full method: "behind" or "ahead" where all of its seeds are on one side of all of the full
    method's, else "level"."""
    sign = 1 if metric.better == "higher" else -1
    ours, theirs = [sign * x for x in full.seeds], [sign * x for x in other.seeds]
    if max(theirs) < min(ours):
        return "behind"
    return "ahead" if min(theirs) > max(ours) else "level"


def markdown(runs: Sequence[RunResult], variants: Iterable[str]) -> str:
    """Our rows, and below each of them the paper's."""
    rows = []
    for variant in variants:
        own = cells(runs, variant)
        rows.append([variant, *(_text(own.get(key), METRICS[key]) for key in COLUMNS)])
        paper = PAPER_ROWS[variant]
        rows.append([f"*paper: {variant}*", *(METRICS[key].number(paper[key]) if key in paper else "" for key in COLUMNS)])
    headings = ["", *(f"{METRICS[key].heading} {METRICS[key].arrow}" for key in COLUMNS)]
    return tabulate(rows, headings, tablefmt="github", disable_numparse=True)


def order(runs: Sequence[RunResult], variants: Iterable[str]) -> str:
    """Whether each variant is behind the full method in a column, level with it or ahead of it; in the paper all are behind."""
    full, rows = cells(runs, "full"), []
    for variant in variants:
        if variant == "full":
            continue
        own = cells(runs, variant)
        ours = [verdict(full[key], own[key], METRICS[key]) if key in own and key in full else MISSING for key in PAPER_COLUMNS]
        rows.append([variant, *ours])
    return tabulate(rows, ["", *(METRICS[key].label for key in PAPER_COLUMNS)], tablefmt="github", disable_numparse=True)


def records(runs: Sequence[RunResult]) -> list[dict[str, object]]:
    """A row for each run, for a CSV file."""
    names = [{"scene": run.config["scene"]["name"], "variant": run.config["variant"], "seed": run.config["seed"]} for run in runs]
    return [name | {key: run.metrics.get(key) for key in COLUMNS} for name, run in zip(names, runs)]


def _text(cell: Cell | None, metric: Metric) -> str:
    if cell is None:
        return MISSING
    return metric.number(cell.mean) + (f" ± {metric.number(cell.spread)}" if len(cell.seeds) > 1 else "")
