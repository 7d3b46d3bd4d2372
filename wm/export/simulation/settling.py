"""The settle test: does everything that stands stay where it stands, once physics is let loose on it?"""

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from wm.export.simulation.library import library

FARTHEST = 0.02  # metres
STEEPEST = 5.0  # degrees by which an object leans


@dataclasses.dataclass(frozen=True, eq=False)
class Settled:
    """What each free body of a model did; arrays are in the order of `names`. The most of all moments counts, not the last."""

    names: tuple[str, ...]
    distance: np.ndarray  # [b] metres from where the body's frame was at first
    lean: np.ndarray  # [b] degrees between its upward axis and that at first

    @property
    def moved(self) -> list[str]:
        """Bodies that moved FARTHEST or more."""
        return [name for name, distance in zip(self.names, self.distance) if not distance < FARTHEST]

    @property
    def tipped(self) -> list[str]:
        return [name for name, lean in zip(self.names, self.lean) if not lean < STEEPEST]


def settle(path: Path, seconds: float = 2.0) -> Settled:
    """Steps a model file of MuJoCo for some seconds of its own time; how far each free body moves and leans.

    A simulation that breaks up counts as moved and tipped: MuJoCo starts it anew or leaves numbers that are not finite.
    """
    mujoco = library("mujoco")

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    free = [k for k in range(1, model.nbody) if model.body_dofnum[k] == 6]
    place, up = data.xpos[free].copy(), _upward(data, free)
    distance, upright = np.zeros(len(free)), np.ones(len(free))
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
        distance = np.maximum(distance, np.linalg.norm(data.xpos[free] - place, axis=1))
        upright = np.minimum(upright, np.einsum("bi,bi->b", up, _upward(data, free)))
    lean = np.degrees(np.arccos(np.clip(upright, -1, 1)))
    if any(data.warning[kind].number for kind in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQACC)):
        distance, lean = np.full(len(free), np.inf), np.full(len(free), np.inf)
    return Settled(names=tuple(model.body(k).name for k in free), distance=distance, lean=lean)


def _upward(data: Any, bodies: list[int]) -> Float[np.ndarray, "b 3"]:
    return data.xmat[bodies].reshape(-1, 3, 3)[:, :, 2].copy()
