"""Error against run time of the kernels with knobs: one CSV and one figure for each of `raster`, `fit`, `raycast`, `texture`.

    python experiments/work_precision/run.py raster          writes raster.csv and raster.png beside itself, prints a table
    python experiments/work_precision/run.py fit --tiny      the same rows at a size that only shows that the script works

`fit` and `texture` make the furnished room they need once, in `--world` (a run folder, kept for the next time).
"""

import argparse
import csv
import importlib
import pathlib
import sys

from tabulate import tabulate

HERE = pathlib.Path(__file__).parent
WORLD = pathlib.Path("outputs/work_precision")
STUDIES = ("raster", "fit", "raycast", "texture")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=STUDIES)
    parser.add_argument("--tiny", action="store_true", help="small sizes and few repeats; its rows mean nothing")
    parser.add_argument("--out", type=pathlib.Path, default=HERE, help="folder of the CSV and the figure")
    parser.add_argument("--world", type=pathlib.Path, default=WORLD, help="run folder of the room")
    arguments = parser.parse_args()
    study = importlib.import_module(f"study_{arguments.study}")
    rows = []
    for row in study.rows(arguments.tiny, arguments.world / ("tiny" if arguments.tiny else "full")):
        rows.append(row)
        print("  ".join(f"{name} {_short(value)}" for name, value in row.items()), file=sys.stderr, flush=True)
    columns = list(dict.fromkeys(name for row in rows for name in row))
    short = [[_short(row[name]) if name in row else "" for name in columns] for row in rows]
    arguments.out.mkdir(parents=True, exist_ok=True)
    path = arguments.out / arguments.study
    with path.with_suffix(".csv").open("w", newline="") as file:
        csv.writer(file).writerows([columns, *short])
    draw(rows, study.PANELS, path.with_suffix(".png"))
    print(tabulate(short, columns, tablefmt="github", disable_numparse=True))


def draw(rows: list[dict], panels: list[tuple[str, str, str]], path: pathlib.Path) -> None:
    """One panel for each (x, y, scale of y): a line for each `vary` along its values, labelled; defaults in a ring.

    Rows without x or y, and zeros on a logarithmic axis, are in the CSV only.
    """
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    colors = matplotlib.colormaps["tab20"].colors  # each full one is followed by a pale one
    figure = Figure(figsize=(5.2 * len(panels), 4.2), layout="constrained")
    for k, (x, y, scale) in enumerate(panels):
        axes = figure.add_subplot(1, len(panels), k + 1)
        axes.set_prop_cycle(color=colors[::2] + colors[1::2])
        drawn = [row for row in rows if x in row and y in row and (row[y] > 0 or scale == "linear")]
        for vary in dict.fromkeys(row["vary"] for row in drawn):
            points = [row for row in drawn if row["vary"] == vary]
            axes.plot([row[x] for row in points], [row[y] for row in points], "o-", markersize=4, label=vary)
            for row in points:
                axes.annotate(str(row["value"]), (row[x], row[y]), fontsize=6, xytext=(3, 3), textcoords="offset points")
        ringed = [row for row in drawn if row["default"]]
        axes.plot([row[x] for row in ringed], [row[y] for row in ringed], "ko", fillstyle="none", markersize=9)
        axes.set_xscale("log")
        axes.set_yscale(scale)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter("{x:g}")
        axes.tick_params(axis="x", which="both", labelsize=7)
        axes.set_xlabel(x)
        axes.set_title(y, fontsize=9)
        axes.grid(alpha=0.25)
    if figure.axes[0].lines:
        figure.axes[0].legend(fontsize=7)
    figure.savefig(path, dpi=110, metadata={"Software": None})


def _short(value) -> str:
    if isinstance(value, bool):
        return "yes" if value else ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    main()
