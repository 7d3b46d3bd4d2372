"""Times whole runs of houses of 4 to 12 rooms. See README.md."""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).parent
KINDS = ("great hall", "library", "dining room", "kitchen", "bedroom", "bathroom")
THEME = "gothic revival mansion with ornate detail and dark wood"


def measure(rooms: int, options: list[str], folder: Path) -> dict[str, float]:
    """One run in a process of its own; the kinds of rooms come in turn."""
    kinds = [KINDS[k % len(KINDS)] for k in range(rooms)]
    scene = [f"scene.name=rooms_{rooms}", f"scene.theme={json.dumps(THEME)}", f"scene.rooms={json.dumps(kinds)}"]
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-m", "wm.run", *scene, f"output={folder}", *options], check=True, stdout=subprocess.DEVNULL)
    seconds = time.perf_counter() - begin
    metrics = json.loads((folder / "metrics.json").read_text())
    stages = json.loads((folder / "timings.json").read_text())
    row = {"rooms": rooms, "seconds": seconds, "seconds_per_room": seconds / rooms}
    row |= {name: metrics[name] for name in ("views", "gaussians", "peak_gib", "psnr", "m_mae")}
    return row | {f"{name}_per_room": stage["seconds"] / rooms for name, stage in stages.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rooms", type=int, nargs="+", default=[4, 6, 8, 10, 12])
    parser.add_argument("options", nargs="*", default=["preset=draft"], help="for wm.run")
    arguments = parser.parse_args()
    rows = []
    for rooms in arguments.rooms:
        with tempfile.TemporaryDirectory() as name:
            rows.append(measure(rooms, arguments.options, Path(name) / "run"))
        print(json.dumps({key: round(value, 3) for key, value in rows[-1].items()}), flush=True)
    with (HERE / "result.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: f"{value:.6g}" for key, value in row.items()} for row in rows)


if __name__ == "__main__":
    main()
