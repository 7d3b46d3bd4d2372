"""The paper's figure of navigability for every scene, for a point and for a body. See README.md.

    python experiments/navigability/run.py                 all scenes of conf/scene, seed 0
    python experiments/navigability/run.py gothic seed=3   one of them; further words go to wm.run

Only plan and furniture are made, a second or two a scene. Writes navigability.png and result.csv.
"""

import csv
import dataclasses
import pathlib
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from scipy.ndimage import distance_transform_edt
from shapely.geometry.base import BaseGeometry

from wm.finished import FinishedRun, open_finished
from wm.geometry import navigability
from wm.geometry.placement.clearances import STEP
from wm.geometry.placement.navigation import Navigability, cells_inside, outlines, walkable_floor
from wm.pipeline import run
from wm.run import load_config, options
from wm.types import SceneObject

HERE = pathlib.Path(__file__).parent
REACHED, LOST, SEED = "#8fc99a", "#f08c2e", "#14532d"
WALL, THING, LINE = "#5d6470", "#b4bac4", "#2b2f36"
_GIVE = 1e-4
"""Metres by which a body gives way, as in wm.geometry.placement.navigation."""


@dataclasses.dataclass(frozen=True, eq=False)
class Scene:
    """A furnished scene and where one can walk in it."""

    name: str
    run: FinishedRun
    walk: Navigability
    floor: BaseGeometry
    things: BaseGeometry  # outlines of the obstacles

    @property
    def body(self) -> list[BaseGeometry]:
        """Where the centre of a body can be, the largest connected piece first."""
        area = self.floor.difference(self.things).buffer(_GIVE - self.run.navigation.body_radius)
        return sorted(shapely.get_parts(area), key=lambda part: -part.area)

    @property
    def seed(self) -> np.ndarray:
        """[2] metres: the point of the largest component that is farthest from all that is not it."""
        inside = np.pad(self.walk.component == 1, 1)
        row, column = np.unravel_index(distance_transform_edt(inside).argmax(), inside.shape)
        return self.walk.origin + self.walk.cell * (np.array([column, row]) - 0.5)


def furnished(name: str, words: list[str], folder: pathlib.Path) -> Scene:
    run(load_config([f"+scene={name}", "until=furnish", *words]), folder)
    opened = open_finished(folder)
    settings = opened.navigation
    low = (_corners(thing) for thing in opened.objects if thing.support in ("floor", "object"))
    return Scene(
        name=name,
        run=opened,
        walk=navigability(opened.plan, opened.objects, settings),
        floor=walkable_floor(opened.plan),
        things=outlines(low, STEP, settings.obstacle_height),
    )


def _corners(thing: SceneObject) -> np.ndarray:
    return thing.vertices[thing.faces]


def draw_cells(axes: Axes, scene: Scene) -> None:
    """The paper's figure: cells reached from the seed, obstacles, cells cut off."""
    walk = scene.walk
    house = shapely.union_all([shapely.Polygon(room.polygon) for room in scene.run.plan.rooms]).buffer(0.075, join_style="mitre")
    image = np.ones((*walk.free.shape, 4))
    image[..., 3] = 0
    for colour, where in (
        (WALL, cells_inside(house, walk.origin, walk.cell, walk.free.shape)),
        (THING, cells_inside(scene.floor, walk.origin, walk.cell, walk.free.shape)),
        (REACHED, walk.component == 1),
        (LOST, walk.component > 1),
    ):
        image[where] = matplotlib.colors.to_rgba(colour)
    high = walk.origin + walk.cell * np.array(walk.free.shape[::-1])
    _fill(axes, house.difference(scene.floor), facecolor=WALL)
    axes.imshow(image, origin="lower", extent=(walk.origin[0], high[0], walk.origin[1], high[1]), interpolation="nearest")
    _lines(axes, scene)
    axes.plot(*scene.seed, "o", color=SEED, markersize=6, markeredgecolor="white", zorder=5)
    _frame(axes, house, f"{scene.name.replace('_', ' ')}: {100 * walk.share:.2f} %")


def draw_body(axes: Axes, scene: Scene) -> None:
    """The same for a body: where its centre can be."""
    house = shapely.union_all([shapely.Polygon(room.polygon) for room in scene.run.plan.rooms]).buffer(0.075, join_style="mitre")
    _fill(axes, house, facecolor=WALL)
    _fill(axes, scene.floor, facecolor="#eceef1")
    _fill(axes, scene.things.intersection(scene.floor), facecolor=THING)
    for number, part in enumerate(scene.body):
        _fill(axes, part, facecolor=LOST if number else REACHED)
    _lines(axes, scene)
    radius = scene.run.navigation.body_radius
    spot = (
        scene.body[0].representative_point() if not scene.body[0].covers(shapely.Point(scene.seed)) else shapely.Point(scene.seed)
    )
    axes.add_patch(plt.Circle((spot.x, spot.y), radius, color=SEED, zorder=5, linewidth=0))
    _frame(axes, house, f"{100 * scene.walk.share_body:.2f} %")


def _lines(axes: Axes, scene: Scene) -> None:
    _fill(axes, scene.floor, facecolor="none", edgecolor=LINE, linewidth=0.6)
    _fill(axes, scene.things.intersection(scene.floor), facecolor="none", edgecolor="#7b838f", linewidth=0.5)


def _fill(axes: Axes, shape: BaseGeometry, **style) -> None:
    style = {"edgecolor": "none", "linewidth": 0} | style
    for part in shapely.get_parts(shape):
        if part.geom_type == "Polygon":
            rings = [Path(np.asarray(ring.coords)[:, :2], closed=True) for ring in (part.exterior, *part.interiors)]
            axes.add_patch(PathPatch(Path.make_compound_path(*rings), **style))


def _frame(axes: Axes, house: BaseGeometry, title: str) -> None:
    low_x, low_y, high_x, high_y = house.bounds
    axes.set(xlim=(low_x - 0.2, high_x + 0.2), ylim=(low_y - 0.2, high_y + 0.2), aspect="equal")
    axes.set_title(title, fontsize=10, color=LINE, pad=4)
    axes.axis("off")


def sheet(scenes: list[Scene]) -> plt.Figure:
    """Two rows: the cells of a point, the floor of a body; all plans to the same scale in a row."""
    widths = [np.ptp(np.asarray(scene.floor.bounds).reshape(2, 2), axis=0) for scene in scenes]
    figure, rows = plt.subplots(
        2, len(scenes), squeeze=False, figsize=(0.28 * sum(w for w, _ in widths) + 1, 0.62 * max(h for _, h in widths) + 1.6),
        gridspec_kw={"width_ratios": [w for w, _ in widths]}, layout="constrained",
    )  # fmt: skip
    for column, scene in enumerate(scenes):
        draw_cells(rows[0][column], scene)
        draw_body(rows[1][column], scene)
    radius, cell = scenes[0].run.navigation.body_radius, scenes[0].walk.cell
    figure.text(0.005, 0.97, f"a point, cells of {cell:g} m (the paper's measure)", fontsize=10, weight="bold", va="top")
    figure.text(0.005, 0.50, f"the centre of a body of {radius:g} m radius", fontsize=10, weight="bold", va="top")
    legend = [
        Patch(color=REACHED, label="reachable"), Patch(color=THING, label="furniture"), Patch(color=WALL, label="walls"),
        Patch(color=LOST, label="free, but unreachable"),
        Line2D([], [], marker="o", color=SEED, linestyle="", label="seed, or the body to scale"),
    ]  # fmt: skip
    figure.legend(handles=legend, loc="outside lower center", ncols=5, frameon=False, fontsize=9)
    return figure


def main() -> None:
    words = [word for word in sys.argv[1:] if "=" in word]
    names = [word for word in sys.argv[1:] if "=" not in word] or sorted(options("scene"))
    with tempfile.TemporaryDirectory() as temporary:
        scenes = [furnished(name, words, pathlib.Path(temporary) / name) for name in names]
        rows = [
            {
                "scene": scene.name, "rooms": len(scene.run.plan.rooms), "objects": len(scene.run.objects),
                "floor_m2": round(scene.floor.area, 1), "free_cells": int(scene.walk.free.sum()),
                "share": round(scene.walk.share, 4), "share_body": round(scene.walk.share_body, 4),
            }
            for scene in scenes
        ]  # fmt: skip
        sheet(scenes).savefig(HERE / "navigability.png", dpi=150)
    with (HERE / "result.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    for row in rows:
        print(*row.values())
    print("mean", *(f"{np.mean([row[key] for row in rows]):.4f}" for key in ("share", "share_body")))


if __name__ == "__main__":
    main()
