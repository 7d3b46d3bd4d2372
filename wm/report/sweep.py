"""One table of several runs: the rows of an ablation in the paper's columns, over seeds, with the paper's figures below.

    python -m wm.report.sweep outputs/gothic

Runs that differ in nothing but their seed share a row: the mean, and how far the seeds lie from it at most.
"""

import argparse
import dataclasses
import json
import pathlib
import sys
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from wm.errors import InputError
from wm.report.paper import PAPER_ROWS

# key, heading, how a value is written, whether more (+1) or less (-1) is better, 0: neither
_COLUMNS = (
    ("reproj_mae_norm", "MAE-norm", "{:.4f}", -1),
    ("reproj_absrel", "AbsRel", "{:.4f}", -1),
    ("m_mae", "M-MAE", "{:.4f}", -1),
    ("m_rmse", "M-RMSE", "{:.4f}", -1),
    ("n_cos", "N-Cos", "{:.4f}", 1),
    ("n_ang_deg", "N-Ang", "{:.2f}", -1),
    ("psnr", "PSNR", "{:.2f}", 1),
    ("ssim", "SSIM", "{:.4f}", 1),
    ("yield", "yield", "{:.3f}", 0),
    ("atm", "Atm", "{:.2f}", 0),
    ("seconds", "seconds", "{:.0f}", 0),
)
_NAMED = ("seed", "variant", "scene")
"""Parts of the configuration that name a row, or that runs of one row differ in."""
_ARROWS = {1: " ↑", -1: " ↓", 0: ""}


@dataclasses.dataclass(frozen=True, eq=False)
class RunResult:
    """A finished run, as its folder tells."""

    config: Mapping[str, Any]  # as in manifest.json
    metrics: Mapping[str, float | None]


def read_runs(folders: Iterable[pathlib.Path]) -> list[RunResult]:
    """The runs in these folders, in order. Raises: InputError for a folder that holds no finished run."""
    return [_read(folder) for folder in folders]


def _read(folder: pathlib.Path) -> RunResult:
    try:
        manifest, metrics = (json.loads((folder / name).read_text()) for name in ("manifest.json", "metrics.json"))
        match manifest["header"]["config"]:
            case {"scene": {"name": str()}, "variant": str(), "seed": int()} as config:
                return RunResult(config=config, metrics=dict(metrics))
    except (OSError, ValueError, KeyError, TypeError):
        pass
    raise InputError(f"{folder} holds no finished run: manifest.json and metrics.json belong in it")


def sweep_table(runs: Sequence[RunResult]) -> str:
    """A Markdown table with a row for each configuration, the best of each column in bold; then the paper's rows of the variants.

    A row is named by its variant, its scene if there are several, and by whatever else differs between such runs.
    """
    groups = _grouped(runs)
    best = {key: _best([_mean(members, key) for members in groups.values()], sense) for key, *_, sense in _COLUMNS}
    rows = [[name, *(_cell(members, *column, best[column[0]]) for column in _COLUMNS)] for name, members in groups.items()]
    variants = [variant for variant in dict.fromkeys(run.config["variant"] for run in runs) if variant in PAPER_ROWS]
    theirs = [[f"*paper: {variant}*", *(_paper_cell(variant, *column) for column in _COLUMNS)] for variant in variants]
    return _aligned([["", *(heading + _ARROWS[sense] for _, heading, _, sense in _COLUMNS)], *rows, *theirs])


def _grouped(runs: Sequence[RunResult]) -> dict[str, list[RunResult]]:
    """Runs by the name of their row."""
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


def _best(values: Sequence[float | None], sense: int) -> float | None:
    known = [value for value in values if value is not None]
    return max(known, key=lambda value: sense * value) if known and sense and len(values) > 1 else None


def _cell(runs: Sequence[RunResult], key: str, heading: str, form: str, sense: int, best: float | None) -> str:
    mean, values = _mean(runs, key), _values(runs, key)
    if mean is None:
        return "–"
    text = form.format(mean)
    if len(values) > 1:
        text += f" ± {form.format(max(abs(value - mean) for value in values))}"
    return f"**{text}**" if mean == best else text


def _paper_cell(variant: str, key: str, heading: str, form: str, sense: int) -> str:
    return form.format(PAPER_ROWS[variant][key]) if key in PAPER_ROWS[variant] else ""


def _aligned(rows: Sequence[Sequence[str]]) -> str:
    widths = [max(len(row[j]) for row in rows) for j in range(len(rows[0]))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |" for row in rows]
    rule = "|" + "|".join("-" * (width + 2) for width in widths) + "|"
    return "\n".join([lines[0], rule, *lines[1:]])


def main() -> None:
    """The command line: every finished run under the folders it is given."""
    parser = argparse.ArgumentParser(prog="python -m wm.report.sweep", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folders", nargs="*", type=pathlib.Path, default=[pathlib.Path("outputs")], help="with runs below")
    roots = parser.parse_args().folders
    folders = [path.parent for root in roots for path in sorted(root.rglob("metrics.json"))]
    if not folders:
        sys.exit(f"wm: no finished run under {', '.join(map(str, roots))}: a run folder holds metrics.json")
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
