"""One table that compares several runs in the columns of the paper's ablation, with the paper's figures below ours.

    python -m wm.report.sweep outputs/gothic

Runs that differ only in their seed share a row: the mean over the seeds, and the largest distance of a seed from it.
"""

import argparse
import dataclasses
import json
import pathlib
import sys
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from tabulate import tabulate

from wm.errors import InputError
from wm.metric_table import METRICS, MISSING, Metric, read_metrics
from wm.report.paper import PAPER_COLUMNS, PAPER_ROWS

_COLUMNS = tuple(METRICS[key] for key in (*PAPER_COLUMNS, "psnr", "ssim", "yield", "atm", "seconds"))
_NAMED = ("seed", "variant", "scene")
"""Parts of the configuration that a row's name does not give as `key=value`."""


@dataclasses.dataclass(frozen=True, eq=False)
class RunResult:
    """A finished run, read from its folder."""

    config: Mapping[str, Any]  # as in manifest.json
    metrics: Mapping[str, float | None]


def read_runs(folders: Iterable[pathlib.Path]) -> list[RunResult]:
    """The runs in these folders, in order. Raises: InputError where a folder holds no finished run."""
    return [_read(folder) for folder in folders]


def _read(folder: pathlib.Path) -> RunResult:
    try:
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
        metrics = read_metrics(folder / "metrics.json")
        match manifest["header"]["config"]:
            case {"scene": {"name": str()}, "variant": str(), "seed": int()} as config if metrics is not None:
                return RunResult(config=config, metrics=metrics)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        pass
    raise InputError(f"{folder} holds no finished run: manifest.json and metrics.json must both be in it")


def sweep_table(runs: Sequence[RunResult]) -> str:
    """A Markdown table with a row for each configuration and the best value of each column in bold, and below it the paper's row
    for each variant.

    A row is named by its variant, by its scene if there are several, and by every other key in which such runs differ.
    """
    groups = _grouped(runs)
    best = {metric.key: _best([_mean(members, metric.key) for members in groups.values()], metric) for metric in _COLUMNS}
    rows = [[name, *(_cell(members, metric, best[metric.key]) for metric in _COLUMNS)] for name, members in groups.items()]
    variants = [variant for variant in dict.fromkeys(run.config["variant"] for run in runs) if variant in PAPER_ROWS]
    theirs = [[f"*paper: {variant}*", *(_paper_cell(variant, metric) for metric in _COLUMNS)] for variant in variants]
    headings = ["", *(f"{metric.heading} {metric.arrow}" for metric in _COLUMNS)]
    return tabulate([*rows, *theirs], headings, tablefmt="github", disable_numparse=True)


def _grouped(runs: Sequence[RunResult]) -> dict[str, list[RunResult]]:
    """The runs of each row, by the name of the row."""
    several = len({run.config["scene"]["name"] for run in runs}) > 1
    kinds = [(run.config["scene"]["name"],) * several + (run.config["variant"],) for run in runs]
    leaves = [{key: x for key, x in _leaves(run.config).items() if key.partition(".")[0] not in _NAMED} for run in runs]
    firsts = dict(reversed(list(zip(kinds, leaves))))
    pairs = [(leaf, firsts[kind]) for kind, leaf in zip(kinds, leaves)]
    differing = sorted({key for leaf, first in pairs for key in leaf | first if leaf.get(key) != first.get(key)})
    groups: dict[str, list[RunResult]] = {}
    for run, kind, leaf in zip(runs, kinds, leaves):
        groups.setdefault(" ".join([*kind, *(f"{key}={leaf.get(key)}" for key in differing)]), []).append(run)
    return groups


def _leaves(tree: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    leaves: dict[str, Any] = {}
    for key, value in tree.items():
        leaves |= _leaves(value, f"{prefix}{key}.") if isinstance(value, Mapping) else {f"{prefix}{key}": value}
    return leaves


def _values(runs: Sequence[RunResult], key: str) -> list[float]:
    return [value for run in runs if (value := run.metrics.get(key)) is not None]


def _mean(runs: Sequence[RunResult], key: str) -> float | None:
    values = _values(runs, key)
    return float(np.mean(values)) if values else None


def _best(values: Sequence[float | None], metric: Metric) -> float | None:
    """The best of a column; None where no value is better than another."""
    known = {value for value in values if value is not None}
    if len(known) < 2 or metric.better is None:
        return None
    return max(known) if metric.better == "higher" else min(known)


def _cell(runs: Sequence[RunResult], metric: Metric, best: float | None) -> str:
    mean, values = _mean(runs, metric.key), _values(runs, metric.key)
    if mean is None:
        return MISSING
    text = metric.number(mean)
    if len(values) > 1:
        text += f" ± {metric.number(max(abs(value - mean) for value in values))}"
    return f"**{text}**" if mean == best else text


def _paper_cell(variant: str, metric: Metric) -> str:
    return metric.number(PAPER_ROWS[variant][metric.key]) if metric.key in PAPER_ROWS[variant] else ""


def main() -> None:
    """The command line: prints the table of every finished run under the given folders."""
    parser = argparse.ArgumentParser(prog="python -m wm.report.sweep", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folders", nargs="*", type=pathlib.Path, default=[pathlib.Path("outputs")], help="with runs in them")
    roots = parser.parse_args().folders
    folders = [path.parent for root in roots for path in sorted(root.rglob("metrics.json"))]
    if not folders:
        sys.exit(f"wm: no finished run under {', '.join(map(str, roots))}: no metrics.json was found")
    runs = []
    for folder in folders:
        try:
            runs.append(_read(folder))
        except InputError as error:
            print(f"wm: left out: {error}", file=sys.stderr)
    if not runs:
        sys.exit(1)
    print(sweep_table(runs))


if __name__ == "__main__":
    main()
