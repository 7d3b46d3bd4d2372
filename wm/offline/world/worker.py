"""A world in a process of its own: shading holds Python's interpreter lock, which painting needs for other work.

The worker (wm.process) reads a recipe for a world from its first pipe, then answers every camera that arrives on one of its
pipes with a shot, one thread per pipe, until they are closed.
"""

import dataclasses
import queue
import threading
from multiprocessing.connection import Connection
from typing import Any

from wm.offline.style.finish import Style
from wm.offline.world.edit import Edit
from wm.offline.world.light import BakeSettings
from wm.offline.world.world import Shot, World
from wm.process import WorkerProcess, portable
from wm.synth.backends import SceneContext
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
        self._process = WorkerProcess(__name__, lanes=lanes)
        self.close = self._process.close
        self._free: queue.SimpleQueue[Connection] = queue.SimpleQueue()
        for lane in self._process.pipes:
            self._free.put(lane)
        self._recipe: Recipe | None = recipe
        self.labels = tuple(thing.label for thing in recipe.context.objects)  # as `World.labels`
        self._starting = threading.Lock()

    def shoot(self, camera: Camera, edit: Edit | None = None) -> Shot:
        """The image of a camera. Raises: what the world raised; RuntimeError if the process has ended."""
        lane = self._free.get()
        try:
            self._start()
            answer = _asked(lane, (camera, edit))
        except (EOFError, OSError) as error:
            code = self._process.exit_code(patience=5.0)
            raise RuntimeError(f"the process that shades the offline world ended (exit code {code})") from error
        finally:
            self._free.put(lane)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def _start(self) -> None:
        with self._starting:
            if self._recipe is not None:
                self._process.pipes[0].send(self._recipe)
                self._recipe = None


def _asked(lane: Connection, question: tuple[Camera, Edit | None]) -> Any:
    lane.send(question)
    return lane.recv()


def serve(pipes: list[Connection]) -> None:
    """Answers until every pipe is closed; where no world can be made from the recipe, every answer is the error."""
    try:
        recipe = pipes[0].recv()
    except EOFError:
        return
    try:
        world: World | BaseException = recipe.make()
    except Exception as error:
        world = portable(error)
    threads = [threading.Thread(target=_serve_lane, args=(world, pipe)) for pipe in pipes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def _shot(world: World, camera: Camera, edit: Edit | None) -> Shot | BaseException:
    try:
        return world.shoot(camera, edit)
    except Exception as error:
        return portable(error)


def _serve_lane(world: World | BaseException, pipe: Connection) -> None:
    while True:
        try:
            camera, edit = pipe.recv()
        except EOFError:
            return
        try:
            pipe.send(world if isinstance(world, BaseException) else _shot(world, camera, edit))
        except OSError:
            return
