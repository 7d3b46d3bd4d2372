"""One trajectory of one scene: its frames rendered once, for the video and for every figure."""

import dataclasses
import itertools
import time
from collections.abc import Callable, Sequence

import numpy as np

from wm.artifacts.atomic import write_atomically
from wm.color import to_bytes
from wm.compare.agreement import agreement
from wm.compare.consistency import STEP, Consistency, DrawnFrame, consistency, frame_of, means
from wm.compare.drawing import Drawer
from wm.compare.store import Store
from wm.compare.trajectories import Picture, Trajectory, file_text
from wm.memory import MemoryProbe
from wm.quality import Quality
from wm.report import write_video
from wm.stages.ordered import in_order
from wm.types import Camera

SCORED = 6
"""Every so many frames one is scored by `wm.quality`: a quarter of a second."""
VERSION = 1
"""To be raised when the same trajectory comes to be measured otherwise."""


def measure(
    trajectory: Trajectory,
    draw: Drawer,
    store: Store,
    method: str,
    picture: Picture,
    *,
    done: Callable[[], object],
    quality: Quality | None = None,
) -> dict[str, float | int | None]:
    """Renders a trajectory, writes its video and cameras, and returns its figures by key.

    Args:
        done: called after every frame.
        quality: what scores every SCORED-th frame.
    """
    began, probe, peak = time.perf_counter(), MemoryProbe(), 0.0
    frames: list[DrawnFrame] = []
    for frame in in_order(lambda camera: _frame(draw, camera), trajectory.cameras):
        frames.append(frame)
        peak = max(peak, probe.resident_gib())
        done()
    rendering = time.perf_counter() - began
    write_atomically(store.cameras(method, trajectory.name), file_text(trajectory, picture))
    video = store.video(method, trajectory.name)
    write_atomically(video, lambda path: write_video(path, (to_bytes(frame.rgb) for frame in frames), fps=picture.fps))
    figures = figures_of(frames) | _scores(frames, quality)
    peak = max(peak, probe.resident_gib())
    return figures | {
        "frames": len(frames),
        "render_seconds": round(rendering, 3),
        "seconds": round(time.perf_counter() - began, 3),
        "peak_gib": round(peak, 3),
    }


def figures_of(frames: Sequence[DrawnFrame]) -> dict[str, float | int | None]:
    """What the frames of a path tell of the scene's consistency, by key. A figure that nothing tells is None."""
    pairs = list(zip(frames, frames[STEP:])) or list(itertools.pairwise(frames))
    parts: list[Consistency] = list(in_order(lambda pair: consistency(*pair), pairs))
    errors = agreement(frames)
    told = dict.fromkeys(("absrel", "mae", "depth", "agreeing")) if errors is None else dataclasses.asdict(errors)
    keys = ("warp_color", "warp_explained", "warp_depth", "warp_lost")
    return {
        **{f"reproj_{name}": value for name, value in told.items()},
        **dict.fromkeys(keys),
        **means(parts),
        "holes": float(np.mean([frame.holes for frame in frames])),
    }


def _scores(frames: Sequence[DrawnFrame], quality: Quality | None) -> dict[str, float]:
    """Means over every SCORED-th frame, by key."""
    if quality is None:
        return {}
    rows = [quality.score(to_bytes(frame.rgb)) for frame in frames[::SCORED]]
    return {key: float(np.mean([row[key] for row in rows])) for key in rows[0]}


def _frame(draw: Drawer, camera: Camera) -> DrawnFrame:
    render = draw(camera)
    return frame_of(camera, np.asarray(render.rgb), np.asarray(render.depth), np.asarray(render.alpha))
