"""`report.html`: one self-contained page that shows what a run made and how good it is."""

import base64
import dataclasses
import html
import importlib.resources
import string
from collections.abc import Sequence

import numpy as np

from wm.geometry import FloorPlan
from wm.metric_table import METRICS, Metric
from wm.report.floorplan import camera_legend, draw_floorplan
from wm.report.paper import paper_figure
from wm.report.pictures import DEPTH_ERROR_RANGE, data_uri, depth_error_image
from wm.report.plots import plot_error_against_time, plot_stages
from wm.types import SceneObject, View

THUMBNAIL = 400
HERO = 860


@dataclasses.dataclass(frozen=True, eq=False)
class SheetRow:
    """One view in the contact sheet."""

    name: str
    note: str  # recall and attempts, say
    condition: np.ndarray  # [h, w, 3]
    generated: np.ndarray  # [h, w, 3]
    splats: np.ndarray  # [h, w, 3]
    splat_depth: np.ndarray  # [h, w] metres
    scaffold_depth: np.ndarray  # [h, w] metres, 0 where nothing is hit


@dataclasses.dataclass(frozen=True, eq=False)
class ReportData:
    """Everything the page shows."""

    scene: str
    theme: str
    variant: str
    preset: str
    seed: int
    plan: FloorPlan
    objects: Sequence[SceneObject]
    views: Sequence[View]
    sheets: dict[str, list[SheetRow]]  # room id -> rows
    heroes: dict[str, np.ndarray]  # room id -> a held-out render [h, w, 3]
    metrics: dict[str, float | int | None]
    timings: dict[str, dict[str, float]]
    history: Sequence[dict]
    video: bytes | None


def render_page(data: ReportData) -> str:
    """The whole page as HTML text; it loads nothing from anywhere."""
    pick = {
        "title": html.escape(data.scene.replace("_", " ")),
        "theme": html.escape(data.theme),
        "facts": html.escape(f"variant {data.variant} · preset {data.preset} · seed {data.seed}"),
        "video": _video(data.video),
        "heroes": "".join(_hero(name, image) for name, image in data.heroes.items()),
        "plan": draw_floorplan(data.plan, data.objects, data.views),
        "legend": camera_legend(),
        "metrics": "".join(_metric_row(data, metric) for metric in METRICS.values()),
        "curve": plot_error_against_time(data.history) or "<p>No held-out evaluation was asked for.</p>",
        "stages": plot_stages(data.timings),
        "sheets": "".join(_sheet(name, rows) for name, rows in data.sheets.items()),
        "range": f"{DEPTH_ERROR_RANGE * 100:.0f}",
    }
    template = importlib.resources.files("wm.report").joinpath("template.html").read_text(encoding="utf-8")
    return string.Template(template).substitute(pick)


def _video(video: bytes | None) -> str:
    if not video:
        return ""
    uri = "data:video/mp4;base64," + base64.b64encode(video).decode()
    return f'<video controls muted loop autoplay playsinline src="{uri}"></video>'


def _title(room: str) -> str:
    return html.escape(room.replace("_", " ").capitalize())


def _hero(name: str, image: np.ndarray) -> str:
    picture = f'<img loading="lazy" src="{data_uri(image, max_width=HERO)}">'
    return f"<figure>{picture}<figcaption>{_title(name)}</figcaption></figure>"


def _metric_row(data: ReportData, metric: Metric) -> str:
    cells = [
        f"<td title='{html.escape(metric.definition)}'>{metric.label} {metric.arrow}</td>",
        f"<td class='n'>{metric.text(data.metrics.get(metric.key))}</td>",
        f"<td class='n'>{metric.text(paper_figure(data.variant, metric.key))}</td>",
    ]
    return f"<tr>{''.join(cells)}</tr>"


def _sheet(name: str, rows: list[SheetRow]) -> str:
    def cell(image: np.ndarray) -> str:
        return f'<td><img loading="lazy" src="{data_uri(image, max_width=THUMBNAIL)}"></td>'

    body = "".join(
        "<tr>"
        + cell(row.condition)
        + cell(row.generated)
        + cell(row.splats)
        + cell(depth_error_image(row.splat_depth, row.scaffold_depth))
        + f"</tr><tr class='cap'><td colspan='4'>{html.escape(row.name)} · {html.escape(row.note)}</td></tr>"
        for row in rows
    )
    head = "<tr><th>condition</th><th>generated</th><th>splat render</th><th>depth error</th></tr>"
    return f"<h3>{_title(name)}</h3><table class='sheet'>{head}{body}</table>"
