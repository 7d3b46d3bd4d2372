"""How the figures of consistency order the eight rows of the ablation, with a perfect image model and with a flawed one.

    python -m experiments.comparison.ablation outputs/gothic [seeds=0,1,2] [frames=60] [size=688x384] [output=outputs/order]

A folder holds the runs of `wm +scene=gothic variant=... image=...`, as outputs/gothic/VARIANT/SEED; runs of another image model
are in a folder of their own. All rows of one scene and seed are driven along the paths of its full row, so that they see the same
places: the house and its furniture are the same in all. `ablation.csv` in the output has a line for each run; its figures are
means over the paths, and MAE-norm is divided by the median depth of each path.
"""

import csv
import json
import pathlib
import sys

from tabulate import tabulate

from wm.compare.comparison import compare
from wm.compare.table import COLUMNS
from wm.compare.trajectories import DEFAULT
from wm.compare.words import parse
from wm.metric_table import MISSING, Metric
from wm.report.paper import PAPER_ROWS

VARIANTS = ("full", *(variant for variant in PAPER_ROWS if variant != "full"))
SHOWN = [metric for metric in COLUMNS if metric.key not in ("seconds", "peak_gib")]
Row = dict[str, float]


def main(words: list[str]) -> None:
    told = dict(word.split("=", 1) for word in words if "=" in word)
    roots = [pathlib.Path(word) for word in words if "=" not in word]
    output = pathlib.Path(told.pop("output", "outputs/order"))
    seeds = told.pop("seeds", "0").split(",")
    settings = [f"{key}={value}" for key, value in told.items()]
    found = {(root.name, seed): seed_rows(root, seed, output / root.name / seed, settings) for root in roots for seed in seeds}
    write_csv(output / "ablation.csv", found)
    for root in roots:
        print(f"\n{root}\n{table([found[root.name, seed] for seed in seeds])}")


def seed_rows(root: pathlib.Path, seed: str, output: pathlib.Path, settings: list[str]) -> dict[str, Row]:
    """The figures of each variant, means over the paths of the full row. Raises: InputError where a run is missing."""
    runs = {variant: root / variant / seed for variant in VARIANTS}
    compare(parse([f"full={runs['full']}", *settings, f"output={output / 'paths'}"]))
    figures: dict[str, list[Row]] = {variant: [] for variant in runs}
    for name in DEFAULT:
        path = output / "paths" / "cameras" / "full" / f"{name}.json"
        words = [f"{variant}:ours={folder}" for variant, folder in runs.items()]
        compare(parse([*words, *settings, f"trajectories={path}", f"output={output / name}"]))
        methods = json.loads((output / name / "comparison.json").read_text())["methods"]
        for variant in runs:
            figures[variant].append(methods[variant]["figures"])
    return {variant: means(rows) for variant, rows in figures.items()}


def means(rows: list[Row]) -> Row:
    values = {metric.key: [row[metric.key] for row in rows if row.get(metric.key) is not None] for metric in SHOWN}
    return {key: sum(known) / len(known) for key, known in values.items() if known}


def write_csv(path: pathlib.Path, found: dict[tuple[str, str], dict[str, Row]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["runs", "seed", "variant", *(metric.key for metric in SHOWN)])
        for (root, seed), rows in found.items():
            for variant, row in rows.items():
                writer.writerow([root, seed, variant, *(f"{row[m.key]:.6g}" if m.key in row else "" for m in SHOWN)])


def table(rows: list[dict[str, Row]]) -> str:
    """A line for each variant; with several seeds, the largest distance of a seed from their mean."""
    shown = [metric for metric in SHOWN if any(metric.key in row["full"] for row in rows)]
    lines = [[variant, *(cell([row[variant].get(m.key) for row in rows], m) for m in shown)] for variant in VARIANTS]
    return tabulate(lines, ["", *(f"{m.heading} {m.arrow}" for m in shown)], tablefmt="github", disable_numparse=True)


def cell(values: list[float | None], metric: Metric) -> str:
    known = [value for value in values if value is not None]
    if not known:
        return MISSING
    mean = sum(known) / len(known)
    spread = f" ± {metric.number(max(abs(value - mean) for value in known))}" if len(known) > 1 else ""
    return f"{metric.number(mean)}{spread}"


if __name__ == "__main__":
    main(sys.argv[1:])
