"""`report.html`: one self-contained page with what a run made and its metrics."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from wm.artifacts.timings import Rows
from wm.geometry import FloorPlan
from wm.metric_table import METRICS, Metric
from wm.report.floorplan import CAMERA_COLOURS, draw_floorplan
from wm.report.paper import paper_figure
from wm.report.pictures import DEPTH_ERROR_RANGE, data_uri, depth_error_image, media_uri
from wm.report.plots import plot_error_against_time, plot_stages
from wm.report.templating import fill
from wm.types import SceneObject, View

THUMBNAIL = 400
HERO = 860


@dataclasses.dataclass(frozen=True, eq=False)
class SheetRow:
    """One view in the contact sheet."""

    name: str
    note: str  # edge recall, attempts and style reference, in words
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
    timings: Rows
    history: Sequence[dict]
    video: bytes | None
    heard: str = ""  # what was made of the theme's words, in one line
    paid: str = ""  # what was paid to models, in one line


def render_page(data: ReportData) -> str:
    """The page as HTML text. It loads nothing from elsewhere: pictures and video are part of it."""
    return fill(
        "page.html",
        data=data,
        title=data.scene.replace("_", " "),
        video=data.video and media_uri(data.video, "video/mp4"),
        heroes=[{"title": _title(room), "image": data_uri(image, max_width=HERO)} for room, image in data.heroes.items()],
        plan=draw_floorplan(data.plan, data.objects, data.views),
        cameras=CAMERA_COLOURS,
        metrics=[_metric_row(data, metric) for metric in METRICS.values()],
        curve=plot_error_against_time(data.history),
        stages=plot_stages(data.timings),
        sheets=[{"title": _title(room), "rows": [_sheet_row(row) for row in rows]} for room, rows in data.sheets.items()],
        depth_error_cm=f"{DEPTH_ERROR_RANGE * 100:.0f}",
    )


def _title(room: str) -> str:
    return room.replace("_", " ").capitalize()


def _metric_row(data: ReportData, metric: Metric) -> dict:
    ours, paper = data.metrics.get(metric.key), paper_figure(data.variant, metric.key)
    return {"metric": metric, "ours": metric.text(ours), "paper": metric.text(paper)}


def _sheet_row(row: SheetRow) -> dict:
    error = depth_error_image(row.splat_depth, row.scaffold_depth)
    images = [data_uri(image, max_width=THUMBNAIL) for image in (row.condition, row.generated, row.splats, error)]
    return {"images": images, "caption": f"{row.name} · {row.note}"}
