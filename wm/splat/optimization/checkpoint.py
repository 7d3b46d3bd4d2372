"""The state of a room as named arrays that a run folder can keep and bring back bit by bit, between rounds or within one."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from wm.splat.optimization.curve import FitPoint
from wm.splat.optimization.divergence_monitor import DivergenceMonitor
from wm.splat.optimization.refinement import Residual
from wm.splat.optimization.room_state import RoomState
from wm.splat.optimization.step import TrainState, adam_state
from wm.types import GAUSSIAN_FIELDS, Gaussians

_GROUPS = ("gaussians", "mu", "nu")
_OTHERS = ("count", "step", "history", "since", "stopped")


def to_arrays(state: RoomState) -> dict[str, np.ndarray]:
    """The state as arrays: `gaussians.means`, `mu.means`, `nu.means` ..., `count`, `history` [points, fields], `stopped` ...

    What the settings leave out is not stored: `exposure`, `residual.*`; nor, at the end of a round, `monitor.*`.
    """
    moments = state.train.moments
    groups = dict(zip(_GROUPS, (state.train.gaussians, moments.mu, moments.nu)))
    arrays = {f"{group}.{leaf}": np.asarray(getattr(one, leaf)) for group, one in groups.items() for leaf in GAUSSIAN_FIELDS}
    history = np.array([dataclasses.astuple(point) for point in state.history], np.float64)
    arrays |= {
        "count": np.asarray(moments.count),
        "step": np.array(state.step),
        "history": history.reshape(-1, len(dataclasses.fields(FitPoint))),
        "since": state.since,
        "stopped": np.array(state.stopped or ""),
    }
    if state.exposure is not None:
        arrays["exposure"] = state.exposure
    for name in ("residual", "monitor"):
        record = getattr(state, name)
        arrays |= {} if record is None else _flat(name, record)
    return arrays


def from_arrays(arrays: Mapping[str, np.ndarray]) -> RoomState:
    """The state that `to_arrays` wrote.

    Raises: ValueError naming what is missing, or that the history has other fields.
    """
    needed = [*(f"{group}.{leaf}" for group in _GROUPS for leaf in GAUSSIAN_FIELDS), *_OTHERS]
    for prefix, kind in (("residual", Residual), ("monitor", DivergenceMonitor)):
        needed += _names(kind, prefix) if _has(prefix, arrays) else []
    missing = [name for name in needed if name not in arrays]
    if missing:
        raise ValueError(f"a stored room has no {', '.join(missing)}: not written by this version")
    gaussians, mu, nu = (_gaussians(group, arrays) for group in _GROUPS)
    names = [field.name for field in dataclasses.fields(FitPoint)]
    if arrays["history"].shape[1:] != (len(names),):
        raise ValueError(f"a stored room has a history of {arrays['history'].shape}, not of {names}: not written by this version")
    rows = [dict(zip(names, row.tolist())) for row in arrays["history"]]
    return RoomState(
        train=TrainState(gaussians=gaussians, moments=adam_state(np.asarray(arrays["count"]), mu, nu)),
        step=int(arrays["step"]),
        history=tuple(FitPoint(**row | {"step": int(row["step"]), "room": int(row["room"])}) for row in rows),
        since=np.asarray(arrays["since"]),
        exposure=arrays.get("exposure"),
        residual=_record(Residual, "residual", arrays),
        monitor=_record(DivergenceMonitor, "monitor", arrays),
        stopped=str(arrays["stopped"]) or None,
    )


def _flat(prefix: str, record) -> dict[str, np.ndarray]:
    """The fields of a record as arrays; those that are gaussians leaf by leaf."""
    arrays = {}
    for field in dataclasses.fields(record):
        name, value = f"{prefix}.{field.name}", getattr(record, field.name)
        arrays |= _flat(name, value) if isinstance(value, Gaussians) else {name: np.asarray(value)}
    return arrays


def _gaussians(prefix: str, arrays: Mapping[str, np.ndarray]) -> Gaussians:
    return Gaussians(**{leaf: np.asarray(arrays[f"{prefix}.{leaf}"]) for leaf in GAUSSIAN_FIELDS})


def _has(prefix: str, arrays: Mapping[str, np.ndarray]) -> bool:
    """Whether any of a record is there."""
    return any(name.startswith(f"{prefix}.") for name in arrays)


def _names(kind, prefix: str) -> list[str]:
    """The names under which `_flat` writes a record."""
    names = []
    for field in dataclasses.fields(kind):
        name = f"{prefix}.{field.name}"
        names += [f"{name}.{leaf}" for leaf in GAUSSIAN_FIELDS] if field.type is Gaussians else [name]
    return names


def _record(kind, prefix: str, arrays: Mapping[str, np.ndarray]):
    """The record that `_flat` wrote, scalars as Python numbers; None if it wrote none."""
    if not _has(prefix, arrays):
        return None
    values = {}
    for field in dataclasses.fields(kind):
        name = f"{prefix}.{field.name}"
        if field.type is Gaussians:
            values[field.name] = _gaussians(name, arrays)
        else:
            value = np.asarray(arrays[name])
            values[field.name] = value if value.ndim else value.item()
    return kind(**values)
