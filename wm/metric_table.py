"""The metrics of a run: how each is called and written, which way is better, and what it means.

`metrics.json` has a key for each row of METRICS, and everything that shows a metric (the report, the table of a sweep, the plots,
the summary, the README) takes its label, unit and format from here. To add a metric, add a row here and compute its key in
`wm/stages/evaluation.py`.

    python -m wm.metric_table > docs/metrics.md

The definitions are ours, since the paper gives none. Metrics of held-out views are computed for each view, or each pair of views,
and averaged.
"""

import dataclasses
import json
import pathlib
from typing import Any, Literal

from tabulate import tabulate

MISSING = "–"
"""Stands for a value that was not measured."""


@dataclasses.dataclass(frozen=True)
class Metric:
    """One row of the table."""

    key: str  # in metrics.json
    label: str
    unit: str  # "" for a number without one; "%": the value is a share, 0 to 1, and written in percent
    format: str  # format specification of the number, without the unit
    better: Literal["higher", "lower"] | None  # None: neither
    definition: str  # one sentence

    @property
    def arrow(self) -> str:
        """Which way is better: "↑", "↓", or nothing."""
        return {"higher": "↑", "lower": "↓", None: ""}[self.better]

    @property
    def heading(self) -> str:
        """The label with the unit, for a column or an axis of bare numbers: "M-MAE (m)"."""
        return f"{self.label} ({self.unit})" if self.unit else self.label

    def number(self, value: float | int | None) -> str:
        """A value without its unit; MISSING for None."""
        if value is None:
            return MISSING
        return format(100 * value if self.unit == "%" else value, self.format)

    def text(self, value: float | int | None) -> str:
        """A value with its unit: "0.0196 m", "7.49°"; MISSING for None."""
        if value is None or not self.unit:
            return self.number(value)
        return f"{self.number(value)}{'' if self.unit == '°' else ' '}{self.unit}"


_ROWS = (
    Metric("psnr", "PSNR", "dB", ".2f", "higher",
           "-10 log10 of the mean squared error of the render, clipped to [0, 1], against the image that the world would show "
           "there; only where the image model knows its world."),
    Metric("ssim", "SSIM", "", ".4f", "higher",
           "Structural similarity of the same two images: a gaussian window of 11 x 11 pixels with sigma 1.5, C1 = 0.01², "
           "C2 = 0.03²."),
    Metric("m_mae", "M-MAE", "m", ".4f", "lower",
           "Mean |D - D_S| over the pixels that hit the scaffold, D being the depth of the splats and D_S that of the scaffold."),
    Metric("m_rmse", "M-RMSE", "m", ".4f", "lower",
           "Square root of the mean of (D - D_S)² over the same pixels."),
    Metric("n_cos", "N-Cos", "", ".4f", "higher",
           "Mean cosine of the angle between the normals of the splat depth (by central differences) and those of the scaffold, "
           "over the pixels whose 3 x 3 neighbourhood is one surface."),
    Metric("n_ang_deg", "N-Ang", "°", ".2f", "lower",
           "Mean of the same angle over the same pixels."),
    Metric("reproj_mae_norm", "MAE-norm", "", ".4f", "lower",
           "Mean |z_ij - D_j| / median D_j, z_ij being the splat depth of view i moved into view j of the same room and D_j the "
           "splat depth there, over the pixels at which both views see the same point of the scaffold."),
    Metric("reproj_absrel", "AbsRel", "", ".4f", "lower",
           "Mean |z_ij - D_j| / D_j over the same pixels."),
    Metric("holes", "Holes", "%", ".2f", "lower",
           "Share of the pixels that hit the scaffold at which the opacity of the splats is below 0.5."),
    Metric("clip_iqa", "IQA+", "", ".4f", "higher",
           "CLIP-IQA+ of the render, from 0 to 1: how likely CLIP takes it for a good photo rather than a bad one; only where "
           "`evaluate.quality` has its weights."),
    Metric("aesthetic", "Aesthetic", "", ".4f", "higher",
           "LAION's aesthetic score of the render, from about 1 to 10: the mark that people would give it, predicted from its "
           "CLIP embedding; only where `evaluate.quality` has its weights."),
    Metric("navigability", "Navigability", "%", ".1f", "higher",
           "Share of the free cells of the floor (a grid of 0.15 m; objects that stand on the floor are obstacles) that lie in "
           "the largest 4-connected component."),
    Metric("navigability_body", "Navigability of a body", "%", ".1f", "higher",
           "Share of the area that the centre of a body of 0.25 m radius can be in that is its largest connected piece."),
    Metric("coverage_1", "Surface seen once", "%", ".1f", "higher",
           "Share, by area, of the surface in sight of a visitor that is in at least one planned view."),
    Metric("coverage_3", "Surface seen three times", "%", ".1f", "higher",
           "Share, by area, of the same surface that is in at least three planned views."),
    Metric("yield", "Yield", "%", ".1f", "higher",
           "Share of the planned views that were accepted."),
    Metric("atm", "Atm", "", ".2f", "lower",
           "Mean number of attempts per accepted view."),
    Metric("rooms", "Rooms", "", ",.0f", None,
           "Number of rooms of the plan."),
    Metric("views", "Views", "", ",.0f", None,
           "Number of planned views; held-out views are not among them."),
    Metric("gaussians", "Gaussians", "", ",.0f", None,
           "Number of gaussians of the scene."),
    Metric("seconds", "Time", "s", ".1f", "lower",
           "Wall-clock time of all stages together, on the machine of the run."),
    Metric("usd", "Paid to models", "USD", ".2f", "lower",
           "What the requests of the run to models have cost, by the price table; not measured where nothing was paid."),
    Metric("peak_gib", "Peak memory", "GiB", ".2f", "lower",
           "Highest resident memory, over all stages, of the process and of the processes that it started."),
)  # fmt: skip

METRICS: dict[str, Metric] = {metric.key: metric for metric in _ROWS}
"""Every metric by its key, in the order in which they are shown."""


def read_metrics(file: pathlib.Path) -> dict[str, float | int | None] | None:
    """The metrics that a run has left in a file, each a finite number or None; None if the file is anything else."""
    try:
        values = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return values if isinstance(values, dict) and all(map(_is_figure, values.values())) else None


def _is_figure(value: Any) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300)


def metrics_page() -> str:
    """The text of docs/metrics.md."""
    rows = [(f"`{m.key}`", m.label, m.unit, m.better or "", m.definition.replace("|", "\\|")) for m in _ROWS]
    table = tabulate(rows, ("key", "metric", "unit", "better", "definition"), tablefmt="github", disable_numparse=True)
    intro = (
        "What each key of `metrics.json` means. Shares are stored as 0 to 1 and shown in percent; a metric that was not measured "
        "is `null`.\nMetrics from PSNR to Aesthetic are computed for each held-out view, or for each pair of them, and averaged. "
        "The definitions are ours, since the paper gives none.\nThis page is printed by `python -m wm.metric_table`."
    )
    return f"# Metrics\n\n{intro}\n\n{table}\n"


if __name__ == "__main__":
    print(metrics_page(), end="")
