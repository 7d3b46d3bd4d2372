"""Figures of the report as inline SVG: held-out error against wall-clock, time and memory of the stages."""

import io
from collections.abc import Sequence

import matplotlib

matplotlib.use("Agg")

from matplotlib.figure import Figure

INK = "#30638e"
SECOND = "#d1495b"


def plot_error_against_time(history: Sequence[dict]) -> str:
    """Held-out PSNR and depth error over the seconds of the fit.

    Args:
      history: rows with `seconds` and any of `psnr` (dB), `m_mae` (m), `n_ang_deg` (degrees), in order.
    """
    panels = [
        ("psnr", "held-out PSNR / dB", False),
        ("m_mae", "depth error M-MAE / m", True),
        ("n_ang_deg", "normal error N-Ang / deg", False),
    ]
    panels = [panel for panel in panels if any(row.get(panel[0]) is not None for row in history)]
    if not panels:
        return ""
    figure = _figure(3.6 * len(panels), 2.6)
    for k, (key, label, logarithmic) in enumerate(panels):
        rows = [row for row in history if row.get(key) is not None]
        axes = figure.add_subplot(1, len(panels), k + 1)
        axes.plot([row["seconds"] for row in rows], [row[key] for row in rows], "o-", color=INK, markersize=4)
        if logarithmic:
            axes.set_yscale("log")
        axes.set_xlabel("seconds of the fit")
        axes.set_title(label, fontsize=9)
        axes.grid(alpha=0.25)
    return _svg(figure)


def plot_stages(timings: dict[str, dict[str, float]]) -> str:
    """Seconds and peak memory of each stage, as bars."""
    names = list(timings)
    figure = _figure(7.2, 0.34 * len(names) + 0.8)
    for k, (key, label, colour) in enumerate((("seconds", "seconds", INK), ("peak_gib", "peak memory / GiB", SECOND))):
        axes = figure.add_subplot(1, 2, k + 1)
        bars = axes.barh(names, [timings[name][key] for name in names], color=colour)
        axes.bar_label(bars, fmt="%.1f", fontsize=7, padding=2)
        axes.invert_yaxis()
        axes.margins(x=0.18)
        axes.set_xlabel(label)
        if k:
            axes.set_yticklabels([])
    return _svg(figure)


def _figure(width: float, height: float) -> Figure:
    return Figure(figsize=(width, height), layout="constrained")


def _svg(figure: Figure) -> str:
    buffer = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "wm", "font.size": 8}):
        figure.savefig(buffer, format="svg", metadata={"Date": None}, transparent=True)
    return buffer.getvalue()[buffer.getvalue().index("<svg") :]
