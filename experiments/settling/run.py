"""Six furnished houses let loose in MuJoCo: how far does what stands move, and does anything tip? See README.md."""

import argparse
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))
from wm.export.simulation import mjcf
from wm.export.simulation.house import simulated
from wm.export.simulation.settling import settle
from wm.finished import open_finished

HERE = Path(__file__).parent
SCENES = ("beach_house", "clockwork_garden", "gothic", "roman_estate", "scandinavian")
HOUSES = {**{scene: [f"+scene={scene}"] for scene in SCENES}, "gothic lifted": ["+scene=gothic", "objects=lifted"]}


def furnish(words: list[str], folder: Path) -> None:
    """Runs a house as far as its furniture; a folder that has it already is left as it is."""
    command = [sys.executable, "-m", "wm.run", *words, "preset=draft", "until=furnish", f"output={folder}"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def measure(house: str, folder: Path) -> dict[str, str | int]:
    """A row of result.csv."""
    run = open_finished(folder)
    bodies = simulated(run).bodies
    with tempfile.TemporaryDirectory() as made:
        settled = settle(mjcf.write(run, Path(made))[0])
    return {
        "house": house,
        "objects": len(bodies),
        "parts": sum(len(body.hulls) for body in bodies),
        "open parts": sum(body.open_parts for body in bodies),
        "standing": len(settled.names),
        "still": len(settled.names) - len(settled.moved),
        "upright": len(settled.names) - len(settled.tipped),
        "median mm": f"{1000 * np.median(settled.distance):.1f}",
        "most mm": f"{1000 * settled.distance.max():.1f}",
        "most degrees": f"{settled.lean.max():.2f}",
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=Path, help="a folder for the six runs, kept and used again; without it a temporary one")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        runs = arguments.runs or Path(temporary)
        rows = []
        for house, words in HOUSES.items():
            folder = runs / house.replace(" ", "_")
            furnish(words, folder)
            rows.append(measure(house, folder))
            print(rows[-1], flush=True)
    with open(HERE / "result.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    sys.exit(any(row["still"] != row["standing"] or row["upright"] != row["standing"] for row in rows))


if __name__ == "__main__":
    main()
