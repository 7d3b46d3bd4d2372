"""The table of a comparison: a row for each method, and below it the paper's row of the same system."""

import csv
import dataclasses
import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from tabulate import tabulate

from wm.compare.paper import PAPER
from wm.compare.records import System
from wm.metric_table import MISSING, Metric

Figures = Mapping[str, float | int | None]

COLUMNS = (
    Metric("reproj_mae_norm", "MAE-norm", "", ".4f", "lower",
           "Mean |z - D| of frames half a second apart, moved both ways, over the median of all depths of the method."),
    Metric("reproj_absrel", "AbsRel", "", ".4f", "lower", "Mean |z - D| / D of the same frames."),
    Metric("reproj_agreeing", "Agreeing", "%", ".1f", "higher",
           "Share of the pixels with a counterpart that come back to within 2 pixels when moved there and back: what the two "
           "errors are measured over."),
    Metric("warp_explained", "Motion explained", "%", ".1f", "higher",
           "Share of the change of colours between frames a sixth of a second apart that the scene's depths account for."),
    Metric("warp_color", "Warp colour", "", ".4f", "lower",
           "Mean difference of colours (sRGB from 0 to 1) between a frame and what a later frame shows at the places that its "
           "depths tell, over what both see."),
    Metric("warp_depth", "Warp depth", "%", ".2f", "lower", "Mean relative difference of the depths there."),
    Metric("warp_lost", "Lost", "%", ".2f", "lower",
           "Share of what a frame shows whose place is empty in a later frame, with something far behind it."),
    Metric("holes", "Holes", "%", ".2f", "lower", "Share of the pixels that less than half an opacity covers."),
    Metric("clip_iqa", "IQA+", "", ".4f", "higher", "CLIP-IQA+ of the frames, where its weights are there."),
    Metric("aesthetic", "Aesthetic", "", ".4f", "higher", "LAION's aesthetic score of the frames, where its weights are there."),
    Metric("seconds", "Time", "s", ".1f", "lower", "To render and measure all trajectories, on this machine."),
    Metric("peak_gib", "Peak memory", "GiB", ".2f", "lower", "Highest resident memory while they were rendered."),
)  # fmt: skip
"""The columns, with what each means."""

_COSTS = {"seconds", "peak_gib"}


@dataclasses.dataclass(frozen=True, eq=False)
class MethodRow:
    """One method of a comparison."""

    method: str
    adapter: str
    system: System
    figures: Figures


def summary(measured: Sequence[Figures]) -> dict[str, float | int | None]:
    """The figures of a method over its trajectories: means; times together; the highest memory; MAE over one scale."""
    keys = {key for figures in measured for key in figures} - {"frames", "render_seconds", "reproj_mae", "reproj_depth"}
    means = {key: _mean([figures.get(key) for figures in measured]) for key in keys - _COSTS}
    scale, mae = ([figures.get(f"reproj_{name}") for figures in measured] for name in ("depth", "mae"))
    known = [value for value in scale if value]
    error = _mean(mae)
    return means | {
        "reproj_mae_norm": error / float(np.median(known)) if known and error is not None else None,
        "seconds": sum(value for figures in measured if (value := figures.get("seconds")) is not None),
        "peak_gib": max((value for figures in measured if (value := figures.get("peak_gib")) is not None), default=None),
    }


def _mean(values: Sequence[float | int | None]) -> float | None:
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None


def markdown(rows: Sequence[MethodRow]) -> str:
    """A Markdown table, the best of each column in bold."""
    best = {metric.key: _best([row.figures.get(metric.key) for row in rows], metric) for metric in COLUMNS}
    lines = []
    for row in rows:
        lines.append([row.method, *(_cell(row.figures.get(metric.key), metric, best[metric.key]) for metric in COLUMNS)])
    for adapter in dict.fromkeys(row.adapter for row in rows):
        if adapter in PAPER:
            told = PAPER[adapter]
            lines.append(
                [f"*paper: {adapter}*", *(metric.number(told[metric.key]) if metric.key in told else "" for metric in COLUMNS)]
            )
    headings = ["", *(f"{metric.heading} {metric.arrow}" for metric in COLUMNS)]
    return tabulate(lines, headings, tablefmt="github", disable_numparse=True) + "\n"


def _best(values: Sequence[float | int | None], metric: Metric) -> float | int | None:
    known = {value for value in values if value is not None}
    if len(known) < 2:
        return None
    return max(known) if metric.better == "higher" else min(known)


def _cell(value: float | int | None, metric: Metric, best: float | int | None) -> str:
    if value is None:
        return MISSING
    text = metric.number(value)
    return f"**{text}**" if value == best and metric.key not in _COSTS else text


def as_csv(rows: Sequence[MethodRow]) -> str:
    """The same figures with all their digits."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["method", "adapter", *(metric.key for metric in COLUMNS)])
    for row in rows:
        writer.writerow([row.method, row.adapter, *(row.figures.get(metric.key) for metric in COLUMNS)])
    return file.getvalue()


def as_json(rows: Sequence[MethodRow], measured: Mapping[str, Mapping[str, Figures]]) -> dict[str, Any]:
    """Every figure: of each method, of each of its trajectories, and of the paper; and what each file was taken for."""
    methods = {
        row.method: {
            "adapter": row.adapter,
            "system": dataclasses.asdict(row.system),
            "figures": dict(row.figures),
            "trajectories": dict(measured[row.method]),
        }
        for row in rows
    }
    return {"version": 1, "methods": methods, "paper": {row.adapter: PAPER[row.adapter] for row in rows if row.adapter in PAPER}}
