"""Iterations and processor time of the propose - validate - correct loop over many seeds; writes results.csv and
prints the table.

python experiments/layout_statistics/measure.py --seeds 200
"""

import argparse
import csv
import time
from pathlib import Path

import numpy as np
import shapely
from tabulate import tabulate

from wm.offline.language.grammar import Settings as LanguageSettings
from wm.offline.language.programme import room_kind_of
from wm.run import load_config, options
from wm.synth.proposing import ProposalError, propose_plan
from wm.synth.registry import make_backend

HERE = Path(__file__).parent
KINDS = ("living room", "kitchen", "bathroom", "bedroom", "dining room", "study", "library", "bedroom", "pantry", "music room")
MAX_ITERATIONS = 8


def programmes() -> dict[str, tuple[str, list[str]]]:
    """The scenes of conf/, and programmes of 1 to 32 rooms for a stately mansion."""
    scenes = {name: load_config([f"+scene={name}"]).scene for name in options("scene")}
    named = {name: (scene.theme, scene.rooms) for name, scene in scenes.items()}
    sized = {f"mansion_{n}": ("stately mansion", ["hall", *(KINDS * 4)[: n - 1]]) for n in (1, 2, 4, 8, 12, 16, 24, 32)}
    return named | sized


def measure(theme: str, rooms: list[str], seeds: int) -> dict[str, float]:
    """One row of the table; processor time, which a busy machine does not inflate as it does the clock."""
    backend = make_backend("language", LanguageSettings())
    iterations, seconds, areas, fits, failed, shapes = [], [], [], [], 0, set()
    for seed in range(seeds):
        start = time.process_time()
        try:
            proposal = propose_plan(backend, theme, rooms, seed=seed, max_iterations=MAX_ITERATIONS)
        except ProposalError:
            failed += 1
            continue
        seconds.append(time.process_time() - start)
        iterations.append(proposal.iterations)
        polygons = [shapely.Polygon(room.polygon) for room in proposal.plan.rooms]
        areas.append(sum(polygon.area for polygon in polygons))
        shapes.add(proposal.transcript[-1].text)
        for room, polygon in zip(proposal.plan.rooms, polygons):
            low, high = room_kind_of(room.name).area
            if room_kind_of(room.name).name != "corridor":
                fits.append(0.9 * low <= polygon.area <= 1.1 * high)
    return {
        "rooms": len(rooms),
        "seeds": seeds,
        "failed": failed,
        "mean_iterations": round(float(np.mean(iterations)), 3),
        "max_iterations": max(iterations),
        "mean_cpu_ms": round(1e3 * float(np.mean(seconds)), 1),
        "p95_cpu_ms": round(1e3 * float(np.percentile(seconds, 95)), 1),
        "mean_area_m2": round(float(np.mean(areas)), 1),
        "rooms_of_fitting_area": round(float(np.mean(fits)), 3),
        "different_plans": len(shapes),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=200)
    seeds = parser.parse_args().seeds
    rows = [{"programme": name} | measure(theme, rooms, seeds) for name, (theme, rooms) in programmes().items()]
    with (HERE / "results.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    print(tabulate(rows, "keys", tablefmt="github", disable_numparse=True))


if __name__ == "__main__":
    main()
