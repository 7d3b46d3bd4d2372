"""Padding to common shapes, so that rooms, views and steps share compiled functions: rows of gaussians, and plans of one
capacity."""

import contextlib
import threading
from collections.abc import Hashable, Iterator

import jax
import numpy as np

from wm.schema import RasterSettings
from wm.splat.rasterizer.planner import plan_outside_jit
from wm.splat.rasterizer.projection import Projected
from wm.splat.rasterizer.tiles import TilePlan
from wm.types import Gaussians

CULLED_LOGIT = -50.0
"""Opacity logit of padding: far below any alpha cut, so that padding is culled by the projection and has no gradient."""

HEADROOM = 3.0
"""Factor between the capacity of a plan and what the first view needs, since gaussians grow while they are fitted."""


class Capacity:
    """The number of plan entries for which steps are compiled, shared by all fits of a scene. It only grows, by factors of 1.5.

    It bounds recompilation and changes no result: entries beyond a plan's own are padding.
    """

    def __init__(self) -> None:
        self._entries: int | None = None
        self._lock = threading.Lock()
        self._compiled: set[tuple[Hashable, ...]] = set()
        self._compiling = threading.Lock()

    @property
    def entries(self) -> int | None:
        return self._entries

    def grow(self, entries: int) -> None:
        with self._lock:
            self._entries = max(self._entries or 0, entries)

    @contextlib.contextmanager
    def compiled(self, *kind: Hashable) -> Iterator[None]:
        """A context for a step of a kind (its shapes, its device). The first of a kind runs alone, so that only one thread
        compiles it."""
        if kind in self._compiled:
            yield
            return
        with self._compiling:
            yield
            self._compiled.add(kind)


def plan_with(projected: Projected, width: int, height: int, raster: RasterSettings, capacity: Capacity) -> TilePlan:
    """The plan of one image, at the shared capacity."""
    room = capacity.entries
    plan = plan_outside_jit(projected, width, height, raster, capacity=room)
    if room is None:
        plan = plan_outside_jit(projected, width, height, raster, capacity=int(len(plan.ids) * HEADROOM))
    capacity.grow(len(plan.ids))
    return plan


def host(tree):
    """The arrays of a record on the host."""
    return jax.tree.map(np.asarray, tree)


def pad_gaussians(gaussians: Gaussians, size: int) -> Gaussians:
    """Gaussians in new NumPy float32 arrays of `size` rows; the added rows are culled in every view."""
    padded = pad_rows(gaussians, size)
    padded.opacity_logits[len(gaussians.opacity_logits) :] = CULLED_LOGIT
    return padded


def pad_rows(record, size: int):
    """A record of arrays as fresh NumPy float32 arrays with `size` rows, those added zero; scalars are left alone."""

    def pad(x):
        x = np.asarray(x)
        return np.concatenate([x.astype(np.float32), np.zeros((size - len(x), *x.shape[1:]), np.float32)]) if x.ndim else x

    return jax.tree.map(pad, record)


def unpad_rows(record, size: int):
    """The first `size` rows of every array of a record, as fresh NumPy arrays; scalars are left alone."""
    return jax.tree.map(lambda x: np.array(x)[:size].copy() if np.ndim(x) else np.array(x), record)
