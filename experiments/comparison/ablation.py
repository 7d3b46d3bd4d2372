"""How the figures of consistency order the eight rows of the ablation, with a perfect image model and with a flawed one.

    python -m experiments.comparison.ablation outputs/gothic [seeds=0,1,2] [frames=60] [size=688x384] [output=outputs/order]

The folder holds the runs of `wm +scene=gothic variant=... image=...`, as outputs/gothic/VARIANT/SEED; runs of another image model
in a folder of their own. All rows of one scene and seed are driven along the paths of its full row, so that they see the same
places: the house and its furniture are the same in all.
"""

import json
import pathlib
import sys

from tabulate import tabulate

from wm.compare.comparison import compare
from wm.compare.table import COLUMNS
from wm.compare.trajectories import DEFAULT
from wm.compare.words import parse

VARIANTS = (
    "full", "no_edge_recall", "no_pcd_init", "no_depth_loss",
    "no_init_no_depth", "depth_objects", "depth_walls_bboxes", "depth_only",
)  # fmt: skip


def main(words: list[str]) -> None:
    told = dict(word.split("=", 1) for word in words if "=" in word)
    roots = [pathlib.Path(word) for word in words if "=" not in word]
    output = pathlib.Path(told.pop("output", "outputs/order"))
    seeds = told.pop("seeds", "0").split(",")
    settings = [f"{key}={value}" for key, value in told.items()]
    for root in roots:
        rows = [_seed(root, seed, output / root.name / seed, settings) for seed in seeds]
        print(f"\n{root}\n{_table(rows)}")


def _seed(root: pathlib.Path, seed: str, output: pathlib.Path, settings: list[str]) -> dict[str, dict[str, float]]:
    """The figures of each variant, means over the paths of the full row."""
    runs = {variant: root / variant / seed for variant in VARIANTS if (root / variant / seed / "splats.ply").is_file()}
    compare(parse([f"full={runs['full']}", *settings, f"output={output / 'paths'}"]))
    figures: dict[str, list[dict[str, float]]] = {variant: [] for variant in runs}
    for name in DEFAULT:
        path = output / "paths" / "cameras" / "full" / f"{name}.json"
        words = [f"{variant}:ours={folder}" for variant, folder in runs.items()]
        compare(parse([*words, *settings, f"trajectories={path}", f"output={output / name}"]))
        methods = json.loads((output / name / "comparison.json").read_text())["methods"]
        for variant in runs:
            figures[variant].append(methods[variant]["figures"])
    return {variant: _means(rows) for variant, rows in figures.items()}


def _means(rows: list[dict[str, float]]) -> dict[str, float]:
    values = {metric.key: [row[metric.key] for row in rows if row.get(metric.key) is not None] for metric in COLUMNS}
    return {key: sum(found) / len(found) for key, found in values.items() if found}


def _table(rows: list[dict[str, dict[str, float]]]) -> str:
    shown = [metric for metric in COLUMNS if metric.key not in ("seconds", "peak_gib") and metric.key in rows[0]["full"]]
    lines = []
    for variant in rows[0]:
        cells = []
        for metric in shown:
            values = [row[variant][metric.key] for row in rows if metric.key in row.get(variant, {})]
            mean = sum(values) / len(values)
            spread = max(abs(value - mean) for value in values)
            cells.append(f"{metric.number(mean)} ± {metric.number(spread)}" if len(values) > 1 else metric.number(mean))
        lines.append([variant, *cells])
    return tabulate(lines, ["", *(f"{m.heading} {m.arrow}" for m in shown)], tablefmt="github", disable_numparse=True)


if __name__ == "__main__":
    main(sys.argv[1:])
