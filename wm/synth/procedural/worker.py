"""A world in a process of its own: shading holds Python's interpreter lock, and painting has other work for it.

The worker is this module run as a program: it reads a recipe for a world from its first pipe, then answers every camera that
arrives on one of its pipes with a shot, a thread a pipe, until they are closed. It is started by name and neither forked nor
spawned, so that it needs nothing of the caller's `__main__` and shares no lock with the caller's threads. It has a session of
its own, since Ctrl-C is for the caller, which then ends it; and it ends with the caller, however that comes about: of its
standard input, a pipe, the caller holds the other end.
"""

import dataclasses
import os
import queue
import subprocess
import sys
import threading
import weakref
from multiprocessing.connection import Connection, Pipe
from typing import Any

from wm.host import prepare_process
from wm.synth.backends import SceneContext
from wm.synth.procedural.edit import Edit
from wm.synth.procedural.finish import Style
from wm.synth.procedural.light import BakeSettings
from wm.synth.procedural.world import Shot, World
from wm.types import Camera


@dataclasses.dataclass(frozen=True, eq=False)
class Recipe:
    """What a world is made from."""

    context: SceneContext
    supersampling: int
    settings: BakeSettings
    style: Style | None = None  # None: that of the context's theme

    def make(self) -> World:
        return World(self.context, supersampling=self.supersampling, settings=self.settings, style=self.style)


class WorkerWorld:
    """`World.shoot` in another process, for as many threads at once as it has lanes. POSIX only."""

    def __init__(self, recipe: Recipe, *, lanes: int):
        pipes = [Pipe() for _ in range(lanes)]
        theirs = [pipe.fileno() for _, pipe in pipes]
        paths = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}  # this wm, wherever it was imported from
        command = [sys.executable, "-m", __name__, *map(str, theirs)]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, pass_fds=theirs, env=paths, start_new_session=True)
        for _, pipe in pipes:
            pipe.close()
        ours = [pipe for pipe, _ in pipes]
        self.close = weakref.finalize(self, _end, self._process, ours)
        self._free: queue.SimpleQueue[Connection] = queue.SimpleQueue()
        for lane in ours:
            self._free.put(lane)
        self._recipe: Recipe | None = recipe
        self.labels = tuple(thing.label for thing in recipe.context.objects)  # as `World.labels`
        self._first, self._starting = ours[0], threading.Lock()

    def shoot(self, camera: Camera, edit: Edit | None = None) -> Shot:
        """The image of a camera. Raises: what the world raised; RuntimeError if the process has ended."""
        lane = self._free.get()
        try:
            self._start()
            answer = _asked(lane, (camera, edit))
        except (EOFError, OSError) as error:
            raise RuntimeError(f"the process that shades the offline world ended (exit code {self._process.wait()})") from error
        finally:
            self._free.put(lane)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def _start(self) -> None:
        with self._starting:
            if self._recipe is not None:
                self._first.send(self._recipe)
                self._recipe = None


def _asked(lane: Connection, question: tuple[Camera, Edit | None]) -> Any:
    lane.send(question)
    return lane.recv()


def _end(process: subprocess.Popen, pipes: list[Connection]) -> None:
    for pipe in pipes:
        pipe.close()
    process.terminate()
    process.communicate()


def serve(pipes: list[Connection]) -> None:
    """Answers until every pipe is closed."""
    try:
        world = pipes[0].recv().make()
    except EOFError:
        return
    threads = [threading.Thread(target=_serve_lane, args=(world, pipe)) for pipe in pipes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def _serve_lane(world: World, pipe: Connection) -> None:
    while True:
        try:
            camera, edit = pipe.recv()
        except EOFError:
            return
        try:
            answer: Shot | Exception = world.shoot(camera, edit)
        except Exception as error:
            answer = error
        try:
            pipe.send(answer)
        except OSError:
            return


def _end_with_the_caller() -> None:
    """Waits for the end of standard input, which nothing is ever written to: whatever is under way then is for nobody."""
    os.read(0, 1)
    os._exit(1)


if __name__ == "__main__":
    threading.Thread(target=_end_with_the_caller, daemon=True).start()
    prepare_process()
    serve([Connection(int(number)) for number in sys.argv[1:]])
