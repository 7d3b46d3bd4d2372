"""The state of a room between rounds, as named arrays that a run folder can keep and bring back bit by bit."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from wm.splat.room_fit import FitPoint, pad_rows, unpad_rows
from wm.splat.step import TrainState, adam_state, start_state
from wm.types import Gaussians

_LEAVES = ("means", "quats", "log_scales", "opacity_logits", "sh")


@dataclasses.dataclass(frozen=True, eq=False)
class RoomState:
    """A room after some steps, on the host: nothing padded."""

    train: TrainState
    history: tuple[FitPoint, ...] = ()
    stopped: str | None = None


def initial_state(gaussians: Gaussians) -> RoomState:
    """The state of a room before its first step."""
    gaussians = pad_rows(gaussians, len(gaussians.opacity_logits))
    return RoomState(train=unpad_rows(start_state(gaussians), len(gaussians.opacity_logits)))


def to_arrays(state: RoomState) -> dict[str, np.ndarray]:
    """The state as arrays: `gaussians.means`, `mu.means`, `nu.means` ..., `count`, `history` [points, fields], `stopped`."""
    moments = state.train.moments
    groups = {"gaussians": state.train.gaussians, "mu": moments.mu, "nu": moments.nu}
    arrays = {f"{group}.{leaf}": np.asarray(getattr(record, leaf)) for group, record in groups.items() for leaf in _LEAVES}
    history = np.array([dataclasses.astuple(point) for point in state.history], np.float64)
    return arrays | {
        "count": np.asarray(moments.count),
        "history": history.reshape(-1, len(dataclasses.fields(FitPoint))),
        "stopped": np.array(state.stopped or ""),
    }


def from_arrays(arrays: Mapping[str, np.ndarray]) -> RoomState:
    """The state that `to_arrays` wrote.

    Raises: ValueError naming what is missing.
    """
    names = [f"{group}.{leaf}" for group in ("gaussians", "mu", "nu") for leaf in _LEAVES]
    missing = [name for name in [*names, "count", "history", "stopped"] if name not in arrays]
    if missing:
        raise ValueError(f"a stored room has no {', '.join(missing)}: not written by this version")
    gaussians, mu, nu = (
        Gaussians(**{leaf: np.asarray(arrays[f"{group}.{leaf}"]) for leaf in _LEAVES}) for group in ("gaussians", "mu", "nu")
    )
    names = [field.name for field in dataclasses.fields(FitPoint)]
    rows = [dict(zip(names, row.tolist())) for row in arrays["history"]]
    history = tuple(FitPoint(**row | {"step": int(row["step"]), "room": int(row["room"])}) for row in rows)
    train = TrainState(gaussians=gaussians, moments=adam_state(np.asarray(arrays["count"]), mu, nu))
    return RoomState(train=train, history=history, stopped=str(arrays["stopped"]) or None)
