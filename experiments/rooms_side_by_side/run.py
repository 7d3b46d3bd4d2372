"""Rooms painted side by side: how long, what it costs the host, what a killed run pays twice, what it does to the metrics.

    python experiments/rooms_side_by_side/run.py latency [--seconds 10]
    python experiments/rooms_side_by_side/run.py kills [--kills 20] [--seconds 1]
    python experiments/rooms_side_by_side/run.py references
    python experiments/rooms_side_by_side/run.py metrics OLD NEW

`latency` and `kills` start the tinting server and processes that paint through it. `references` compares schemes of style
references on the five scenes, without painting. `metrics` reads two folders of finished runs, by the names of the runs in them.
"""

import argparse
import hashlib
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[2]))  # the loopback server lives with the tests
from schemes import SCHEMES, scene_views
from tinting import TintingServer

from wm.metric_table import METRICS
from wm.run import options

HERE = pathlib.Path(__file__).parent
SMALL = ("+scene=gothic", "preset=draft")
LARGE = ("+scene=gothic", "preset=standard")
SHOWN = ("psnr", "ssim", "m_mae", "n_ang_deg", "reproj_mae_norm", "yield", "atm")


def painting(url: str, folder: pathlib.Path, answers: pathlib.Path, overrides: Sequence[str]) -> "subprocess.Popen[str]":
    command = [sys.executable, str(HERE / "painting_process.py"), url, str(folder), str(answers), *overrides]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def figures(process: "subprocess.Popen[str]") -> dict:
    """What a process has written in its last line. Raises: RuntimeError where it failed."""
    text, _ = process.communicate()
    if process.returncode:
        raise RuntimeError(f"the process ended with {process.returncode}")
    return json.loads(text.splitlines()[-1])


def latency(seconds: float, overrides: Sequence[str]) -> None:
    with tempfile.TemporaryDirectory() as folder, TintingServer(seconds) as server:
        place = pathlib.Path(folder)
        found = figures(painting(server.url, place / "run", place / "answers", overrides))
        asked = len(server.delivered)
    load = ", ".join(f"{x:.1f}" for x in os.getloadavg())
    print(f"{found['rooms']} rooms, {found['views']} views, {asked} requests of {seconds:g} s, at most {server.most} under way")
    print(f"paint: {found['seconds']:.0f} s; one after the other: {asked * seconds:.0f} s of waiting alone")
    print(f"host: {found['cpu']:.1f} s of processor time, {found['cpu'] / found['views']:.3f} s a view (load {load})")


def kills(count: int, seconds: float, seed: int) -> None:
    draw = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder, TintingServer(seconds) as server:
        place = pathlib.Path(folder)
        figures(painting(server.url, place / "whole", place / "whole answers", SMALL))
        whole = len(server.delivered)
        delivered: Counter[str] = Counter()
        lost = stored_and_asked = 0
        for kill in range(count + 1):
            server.asked.clear()
            server.delivered.clear()
            stored = kept(place / "answers")
            process = painting(server.url, place / "killed", place / "answers", SMALL)
            if kill < count:
                kill_at_some_time(process, draw.uniform(0, 2.5 * seconds))
            else:
                figures(process)
            delivered.update(server.keys())  # to the process: what the server sends from now on, nobody hears
            asked = {one.json["key"] for one in server.asked}
            lost += len(asked - kept(place / "answers"))
            stored_and_asked += len(asked & stored)
            time.sleep(seconds + 1)  # replies to nobody
        print(f"{whole} requests without a kill; {count} kills while painting")
        print(f"requests asked again whose answer was kept: {stored_and_asked}")
        print(f"requests asked again whose reply had come in full: {sum(delivered.values()) - len(delivered)}")
        print(f"requests under way at a kill, and asked again: {lost}")
        one, other = contents(place / "whole"), contents(place / "killed")
        print(f"files of a run: {len(one)}; those of the killed one are {'the same bytes' if one == other else 'OTHERS'}")


def kill_at_some_time(process: "subprocess.Popen[str]", after: float) -> None:
    """Kills a process some seconds after it has begun to paint. Raises: RuntimeError where it was finished by then."""
    assert process.stdout is not None
    while process.stdout.readline() not in ("painting\n", ""):
        pass
    time.sleep(after)
    if process.poll() is not None:
        raise RuntimeError("the run was finished before the last kill: fewer kills, or more seconds")
    process.kill()
    process.wait()


def kept(answers: pathlib.Path) -> set[str]:
    """Keys of the answers in a store."""
    return {file.stem for file in answers.glob("*/*.zip")}


def contents(folder: pathlib.Path) -> dict[str, str]:
    """Digests of the files of a run by name, but for those that depend on the clock."""
    files = [file for file in folder.rglob("*") if file.is_file() and file.name not in ("layout.json", "timings.json")]
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


def compare_schemes() -> None:
    print("| scene | scheme | similarity, mean | least | in the own room | rounds of requests |")
    print("|---|---|---|---|---|---|")
    for scene in options("scene"):
        views = scene_views(scene)
        for name, scheme in SCHEMES.items():
            found = scheme(views)
            near = np.array(found.similarities)
            print(f"| {scene} | {name} | {near.mean():.3f} | {near.min():.3f} | {found.own_room:.0%} | {found.rounds} |")


def compare_metrics(old: pathlib.Path, new: pathlib.Path) -> None:
    print("| run | " + " | ".join(METRICS[key].label for key in SHOWN) + " |")
    print("|---" * (len(SHOWN) + 1) + "|")
    for folder in sorted(file.parent for file in new.glob("*/metrics.json")):
        before, after = (json.loads((where / folder.name / "metrics.json").read_text()) for where in (old, new))
        cells = [f"{METRICS[key].text(before[key])} -> {METRICS[key].text(after[key])}" for key in SHOWN]
        print(f"| {folder.name} | " + " | ".join(cells) + " |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("latency", "kills", "references", "metrics"))
    parser.add_argument("folders", nargs="*", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, help="until the model answers; 10 for latency, 1 for kills")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    if given.what == "latency":
        latency(given.seconds or 10.0, LARGE)
    elif given.what == "kills":
        kills(given.kills, given.seconds or 1.0, given.seed)
    elif given.what == "references":
        compare_schemes()
    else:
        compare_metrics(*given.folders)


if __name__ == "__main__":
    main()
