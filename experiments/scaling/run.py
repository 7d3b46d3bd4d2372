"""The paper's table of scaling and cost: houses of 4 to 12 rooms, and of 24 and 48. See README.md.

    python experiments/scaling/run.py                             4 6 8 12 24 48 rooms, draft size
    python experiments/scaling/run.py --rooms 4 6 8 12 --standard
    python experiments/scaling/run.py --rooms 4 12 image=like_distilled evaluate.quality=FOLDER

Further words go to wm.run. Each house is a run in a process of its own. Runs are kept below --root; a second call with the same
arguments runs nothing.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys

from fit import exponent
from tabulate import tabulate

from wm.artifacts.timings import read_rows
from wm.finished import open_finished
from wm.geometry import interior_polygon
from wm.metric_table import METRICS, read_metrics

HERE = pathlib.Path(__file__).parent
KINDS = ("great hall", "library", "dining room", "kitchen", "bedroom", "bathroom")
THEME = "gothic revival mansion with ornate detail and dark wood"
ERRORS = ("reproj_mae_norm", "reproj_absrel", "m_mae", "m_rmse", "n_cos", "n_ang_deg", "clip_iqa", "aesthetic", "psnr")
COLUMNS = (*ERRORS, "atm", "yield", "views", "gaussians", "seconds", "peak_gib", "usd")
SCORED = "evaluate.quality="
"""A word that adds two metrics to a run and makes no other run of it."""
COSTS = ("seconds", "peak_gib", "views", "gaussians")
PAPER = (
    (4, 80, 0.11, 0.07, 0.02, 0.07, 0.75, 34.72, 0.49, 5.56, 1.20, 0.74, 0.8),
    (6, 144, 0.19, 0.10, 0.05, 0.18, 0.61, 45.93, 0.54, 5.54, 1.22, 0.86, 1.0),
    (8, 192, 0.15, 0.05, 0.05, 0.15, 0.63, 44.59, 0.62, 5.56, 1.24, 0.71, 1.2),
    (12, 256, 0.23, 0.08, 0.05, 0.16, 0.61, 45.88, 0.54, 5.55, 1.24, 0.82, 1.5),
)
"""Rooms, square metres, the first eight of ERRORS, Atm, Yield, hours: with NB Pro, whose rooms are painted side by side."""


def house(rooms: int, root: pathlib.Path, words: list[str]) -> pathlib.Path:
    """The folder of a house's run, which is made if it is not there; the kinds of rooms come in turn."""
    folder = root / f"rooms_{rooms}"
    known, scored = read_metrics(folder / "metrics.json"), any(word.startswith(SCORED) for word in words)
    if known is None or (scored and known.get("clip_iqa") is None and known.get("aesthetic") is None):
        kinds = [KINDS[k % len(KINDS)] for k in range(rooms)]
        scene = [f"scene.name=rooms_{rooms}", f"scene.theme={json.dumps(THEME)}", f"scene.rooms={json.dumps(kinds)}"]
        command = [sys.executable, "-m", "wm.run", *scene, f"output={folder}", "report.enabled=false", *words]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return folder


def record(rooms: int, folder: pathlib.Path) -> dict[str, float | None]:
    """The metrics of a house, its floor, and the seconds of each stage."""
    metrics, stages = read_metrics(folder / "metrics.json") or {}, read_rows(folder / "timings.json") or {}
    plan = open_finished(folder).plan
    area = sum(interior_polygon(plan, index).area for index in range(len(plan.rooms)))
    times = {f"{name}_seconds": stage["seconds"] for name, stage in stages.items()}
    return {"rooms": rooms, "floor_m2": area} | {key: metrics.get(key) for key in COLUMNS} | times


def table(records: list[dict[str, float | None]]) -> str:
    """Our rows, the exponents of the costs below them, and the paper's rows."""
    rows = [[f"{r['rooms']} ({r['floor_m2']:.0f} m²)", *(METRICS[key].number(r[key]) for key in COLUMNS)] for r in records]
    if len(records) > 1:
        rows.append(["exponent (95 %)", *(growth(records, key) if key in COSTS else "" for key in COLUMNS)])
    for rooms, area, *values in PAPER:
        known = dict(zip((*ERRORS[:8], "atm", "yield"), values)) | {"seconds": 3600 * values[-1]}
        rows.append(
            [f"*paper: {rooms} ({area} m²)*", *(METRICS[key].number(known[key]) if key in known else "" for key in COLUMNS)]
        )
    headings = ["rooms", *(f"{METRICS[key].heading} {METRICS[key].arrow}" for key in COLUMNS)]
    return tabulate(rows, headings, tablefmt="github", disable_numparse=True)


def growth(records: list[dict[str, float | None]], key: str) -> str:
    known = [(row["rooms"], row[key]) for row in records if row["rooms"] and row[key]]
    return str(exponent(*zip(*known))) if len(known) > 1 else ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rooms", type=int, nargs="+", default=[4, 6, 8, 12, 24, 48])
    parser.add_argument("--standard", action="store_true", help="preset=standard instead of draft")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path("outputs/scaling"), help="where the runs are kept")
    parser.add_argument("--out", default="result", help="name of the tables beside this file")
    further = [word for word in sys.argv[1:] if "=" in word and not word.startswith("-")]
    arguments = parser.parse_args([word for word in sys.argv[1:] if word not in further])
    words = [f"preset={'standard' if arguments.standard else 'draft'}", *further]
    root = arguments.root.resolve() / "_".join(word.replace("/", "-") for word in words if not word.startswith(SCORED))
    records = []
    for rooms in sorted(arguments.rooms):
        records.append(record(rooms, house(rooms, root, words)))
        print(json.dumps({key: records[-1][key] for key in ("rooms", "seconds", "peak_gib", "m_mae", "psnr")}), flush=True)
    text = table(records)
    (HERE / f"{arguments.out}.md").write_text(text + "\n", encoding="utf-8")
    with (HERE / f"{arguments.out}.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in records for key in row)), lineterminator="\n")
        writer.writeheader()
        writer.writerows(records)
    print(text)


if __name__ == "__main__":
    main()
