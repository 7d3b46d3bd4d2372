"""Times plan rules and structure against the number of rooms. See README.md."""

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
    """Seconds of the fastest of REPEATS runs; every run starts from text, so that nothing is cached."""
    text = plan_to_json(random_plan(0, rooms))
    check, build = [], []
    faces = 0
    for _ in range(REPEATS):
        start = time.perf_counter()
        plan = parse_plan(text)
        parsed = time.perf_counter()
        # A plan of its own: parse_plan leaves the walls of the one it returns in the cache.
        fresh = type(plan)(plan.rooms, plan.wall_thickness, plan.default_ceiling_height)
        begin = time.perf_counter()
        faces = len(build_structure(fresh).faces)
        build.append(time.perf_counter() - begin)
        check.append(parsed - start)
    return {"rooms": rooms, "faces": faces, "parse_and_rules_s": round(min(check), 5), "structure_s": round(min(build), 5)}


def main() -> None:
    measure(12)  # warm: imports, allocator
    results = [measure(rooms) for rooms in ROOMS]
    for result in results:
        print(json.dumps(result))
    large = [result for result in results if result["rooms"] >= 12]
    slope = np.polyfit(*(np.log([result[key] for result in large]) for key in ("rooms", "structure_s")), 1)[0]
    print(f"structure time grows as rooms^{slope:.2f} from 12 rooms on")
    (HERE / "results.json").write_text(json.dumps({"rows": results, "exponent": round(float(slope), 3)}, indent=2) + "\n")


if __name__ == "__main__":
    main()
