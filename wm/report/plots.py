"""Plots of the report as inline SVG: held-out error against time, and time and memory of the stages."""

import io
from collections.abc import Sequence

import matplotlib
from markupsafe import Markup

matplotlib.use("Agg")

from matplotlib.figure import Figure

from wm.artifacts.timings import Rows
from wm.metric_table import METRICS

CURVES = {"psnr": "linear", "m_mae": "log", "n_ang_deg": "linear"}
"""Metrics that are drawn against the time of the fit, with the scale of their axes."""
INK = "#30638e"
SECOND = "#d1495b"


def plot_error_against_time(history: Sequence[dict]) -> Markup:
    """Held-out error against the wall-clock time of the fit.

    Args:
      history: rows with `seconds` and any keys of CURVES, in order.

    Returns:
      A panel for each metric that was measured; nothing if none was.
    """
    panels = [key for key in CURVES if any(row.get(key) is not None for row in history)]
    if not panels:
        return Markup()
    figure = _figure(7.2, 1.7 * len(panels) + 0.3)
    for k, key in enumerate(panels):
        rows = [row for row in history if row.get(key) is not None]
        axes = figure.add_subplot(len(panels), 1, k + 1)
        axes.plot([row["seconds"] for row in rows], [row[key] for row in rows], "o-", color=INK, markersize=4)
        axes.set_yscale(CURVES[key])
        axes.set_title(f"held-out {METRICS[key].heading}", fontsize=9)
        axes.grid(alpha=0.25, which="both")
    figure.axes[-1].set_xlabel("time of the fit (s)")
    return _svg(figure)


def plot_stages(timings: Rows) -> Markup:
    """Seconds and peak memory of each stage, as bars; a stage whose time is not known has none."""
    names = [name for name, row in timings.items() if None not in row.values()]
    figure = _figure(7.2, 0.34 * len(names) + 0.8)
    for k, (key, colour) in enumerate((("seconds", INK), ("peak_gib", SECOND))):
        axes = figure.add_subplot(1, 2, k + 1)
        bars = axes.barh(names, [timings[name][key] or 0.0 for name in names], color=colour)
        axes.bar_label(bars, fmt="%.1f", fontsize=7, padding=2)
        axes.invert_yaxis()
        axes.margins(x=0.18)
        axes.set_xlabel(METRICS[key].heading)
        if k:
            axes.set_yticklabels([])
    return _svg(figure)


def _figure(width: float, height: float) -> Figure:
    return Figure(figsize=(width, height), layout="constrained")


def _svg(figure: Figure) -> Markup:
    buffer = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "wm", "font.size": 8}):
        figure.savefig(buffer, format="svg", metadata={"Date": None}, transparent=True)
    return Markup(buffer.getvalue()[buffer.getvalue().index("<svg") :])
