"""A process that paints a scene through the tinting server, can be killed, and goes on where it was.

    python experiments/rooms_side_by_side/painting_process.py URL FOLDER ANSWERS OVERRIDE ...

Writes a line "painting" when the scaffold is ready, and one with the figures as JSON at the end.
"""

import dataclasses
import json
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[2]))  # the loopback server lives with the tests
import tinting

from wm.artifacts.run_folder import open_run_folder
from wm.host import prepare_process
from wm.meter import StageMeter
from wm.run import load_config
from wm.services.services import Services
from wm.services.store import AnswerStore
from wm.stages.painting import paint
from wm.stages.run_context import RunContext
from wm.stages.scene import build_scene


def main(url: str, folder: str, answers: str, *overrides: str) -> None:
    prepare_process()
    config = load_config([*overrides])
    config = dataclasses.replace(config, image=tinting.Settings(url=url))
    with open_run_folder(pathlib.Path(folder), {"experiment": "rooms_side_by_side"}) as store:
        run = RunContext(config=config, folder=store, meter=StageMeter())
        scene = build_scene(run)
        image = tinting.TintedImages(config.image, Services(store=AnswerStore(pathlib.Path(answers))))
        print("painting", flush=True)
        began, used = time.perf_counter(), time.process_time()
        painted = paint(run, scene, image, tinting.TrueDepth())
        seconds, cpu = time.perf_counter() - began, time.process_time() - used
        rooms = len({view.room for view in scene.views})
        figures = {"views": len(scene.views), "rooms": rooms, "seconds": seconds, "cpu": cpu, "yield": painted.yield_share}
        print(json.dumps(figures), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
