"""Times plan rules and structure against the number of rooms. See README.md."""

import dataclasses
import json
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))  # the plan generator lives with the tests
from tests.geometry.plans import random_plan
from wm.geometry import build_structure, parse_plan, plan_to_json

HERE = Path(__file__).parent
ROOMS = (1, 3, 12, 50, 200, 1000)
REPEATS = 5


def measure(rooms: int) -> dict[str, float]:
    """The fastest of REPEATS runs; every run starts from text, so that nothing is cached. Wall-clock and processor seconds."""
    text = plan_to_json(random_plan(0, rooms))
    runs = []
    faces = 0
    for _ in range(REPEATS):
        begin = _now()
        plan = parse_plan(text)
        parsed = _now()
        # A plan of its own: parse_plan leaves the walls of the one it returns in the cache.
        fresh = dataclasses.replace(plan)
        between = _now()
        faces = len(build_structure(fresh).faces)
        runs.append([*(parsed - begin), *(_now() - between)])
    rules, rules_cpu, structure, structure_cpu = np.round(np.min(runs, axis=0), 5).tolist()
    return {
        "rooms": rooms,
        "faces": faces,
        "rules_s": rules,
        "rules_cpu_s": rules_cpu,
        "structure_s": structure,
        "structure_cpu_s": structure_cpu,
    }


def _now() -> np.ndarray:
    return np.array([time.perf_counter(), time.process_time()])


def main() -> None:
    measure(12)  # warm: imports, allocator
    results = [measure(rooms) for rooms in ROOMS]
    for result in results:
        print(json.dumps(result))
    large = [result for result in results if result["rooms"] >= 12]
    slope = np.polyfit(*(np.log([result[key] for result in large]) for key in ("rooms", "structure_cpu_s")), 1)[0]
    print(f"structure time grows as rooms^{slope:.2f} from 12 rooms on")
    (HERE / "results.json").write_text(json.dumps({"rows": results, "exponent": round(float(slope), 3)}, indent=2) + "\n")


if __name__ == "__main__":
    main()
