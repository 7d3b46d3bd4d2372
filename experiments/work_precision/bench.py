"""What the studies share: times, the scenes of the speed experiments, and a furnished room with its views."""

import dataclasses
import importlib.util
import os
import pathlib
import time
from collections.abc import Callable, Mapping
from typing import Any

import jax
import numpy as np

from wm.host import prepare_process

EXPERIMENTS = pathlib.Path(__file__).parent.parent


def sibling(experiment: str, script: str) -> Any:
    """A script of another experiment as a module, for the scene it measures."""
    spec = importlib.util.spec_from_file_location(f"{experiment}_{script}", EXPERIMENTS / experiment / f"{script}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def prepare_one_core() -> None:
    """Holds this process to one core; to be called before JAX counts them."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    prepare_process()


def median_ms(parts: Mapping[str, Callable[[], Any]], repeats: int) -> dict[str, float]:
    """Median milliseconds of each part, taken in turns so that a slow moment of the machine hits none alone."""
    for part in parts.values():
        jax.block_until_ready(part())
    times = {name: [] for name in parts}
    for _ in range(repeats):
        for name, part in parts.items():
            start = time.perf_counter()
            jax.block_until_ready(part())
            times[name].append((time.perf_counter() - start) * 1e3)
    return {name: float(np.median(values)) for name, values in times.items()}


@dataclasses.dataclass(frozen=True, eq=False)
class Room:
    """A furnished room of the offline world: views as the image backend knows them to be, and the scaffold behind them."""

    scene: Any  # wm.stages.scene.Scene
    views: list  # TrainingView, painted
    heldout: list  # TrainingView, true images
    cameras: list  # View of each held-out view


def furnished_room(folder: pathlib.Path, *, tiny: bool) -> Room:
    """The room, made up to its painted and held-out views, or read from `folder` where that was done before."""
    from wm.artifacts.run_folder import open_run_folder
    from wm.geometry import cast
    from wm.meter import StageMeter
    from wm.run import load_config
    from wm.stages.heldout import render_heldout
    from wm.stages.painting import paint
    from wm.stages.reconstruction import training_view
    from wm.stages.run_context import RunContext
    from wm.stages.scene import build_scene
    from wm.synth.registry import make_backend

    size = ["preset=draft", "cameras.width=96", "cameras.height=64", "cameras.heldout_per_room=2"] if tiny else []
    config = load_config(["+scene=gothic", "scene.rooms=[dining room]", "image.drift=0", *size])
    with open_run_folder(folder, dataclasses.asdict(config), overwrite=True) as store:
        context = RunContext(config=config, folder=store, meter=StageMeter({}))
        scene = build_scene(context)
        image = make_backend("image", config.image, scene.context)
        painted = paint(context, scene, image, make_backend("depth", config.depth, scene.context))
        truths = render_heldout(context, scene, image)
        stored = [painted.view(view) for view in scene.views]
        everywhere = np.ones((config.cameras.height, config.cameras.width), bool)
        return Room(
            scene=scene,
            views=[training_view(scene, v, s.rgb, s.mask, cast(scene.rays, v.camera)) for v, s in zip(scene.views, stored)],
            heldout=[training_view(scene, v, truths.truth(v), everywhere, cast(scene.rays, v.camera)) for v in scene.heldout],
            cameras=list(scene.heldout),
        )
