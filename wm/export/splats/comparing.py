"""Whether gaussians that a file gives back are those that were written, to the steps of its format."""

import dataclasses
from pathlib import Path

import numpy as np

from wm.export.records import Check, ExportError
from wm.splat.formats import SplatFileError, load_splats
from wm.splat.ply.standard import FLATTEST
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians


@dataclasses.dataclass(frozen=True, eq=False)
class Steps:
    """How far a number may lie from the one that was written. Means and scales: one number, or one a gaussian and axis."""

    means: float | np.ndarray  # metres
    log_scales: float | np.ndarray
    opacity: float = 0.51 / 255
    color: float = 0.51 / 255  # of what is seen, between 0 and 1
    degrees: float = 0.0  # of rotation
    share: float = 1.0  # of the gaussians, of which all else but the means must hold


@dataclasses.dataclass(frozen=True)
class Deviation:
    """The worst of one quantity."""

    what: str
    worst: float  # in steps: at most 1 is right
    text: str  # with its unit


def read_back(target: str, path: Path, wanted: Gaussians, steps: Steps) -> list[Deviation]:
    """The deviations of a file from the gaussians `wanted`, in the order of the file.

    Raises:
        ExportError: the file cannot be read, or holds another number of gaussians.
    """
    try:
        found = load_splats(path)
    except SplatFileError as error:
        raise ExportError(f"target {target}: {error}") from None
    if len(found.means) != len(wanted.means):
        raise ExportError(f"target {target}: {path} holds {len(found.means)} gaussians; {len(wanted.means)} were written")
    return deviations(found, wanted, steps)


def deviations(found: Gaussians, wanted: Gaussians, steps: Steps) -> list[Deviation]:
    """The worst of each quantity, over the share of the gaussians that must hold."""
    means = np.abs(found.means - wanted.means)
    scales = np.abs(np.maximum(found.log_scales, FLATTEST) - np.maximum(wanted.log_scales, FLATTEST))
    opacity = np.abs(_opacity(found) - _opacity(wanted))
    color = np.abs(_color(found) - _color(wanted)).max(axis=1)
    turn = _degrees(found.quats, wanted.quats)
    worst = lambda x: float(np.quantile(x, steps.share, method="lower"))  # noqa: E731
    return [
        Deviation("means", float((means / steps.means).max()), f"{1000 * means.max():.2f} mm"),
        Deviation("scales", worst((scales / steps.log_scales).max(axis=1)), f"{worst(scales.max(axis=1)):.3g} (log)"),
        Deviation("opacities", worst(opacity / steps.opacity), f"{worst(opacity):.4f}"),
        Deviation("colours", worst(color / steps.color), f"{worst(color):.4f}"),
        Deviation("rotations", worst(turn / max(steps.degrees, 1e-3)), f"{worst(turn):.2f} degrees"),
    ]


def require_within(target: str, path: Path, found: list[Deviation]) -> None:
    """Raises: ExportError: something lies further from what was written than the format's steps allow."""
    bad = [f"{d.what} by {d.text}" for d in found if not d.worst <= 1]
    if bad:
        raise ExportError(f"target {target}: {path} came back otherwise than it was written: {', '.join(bad)}")


def as_checks(target: str, found: list[Deviation]) -> list[Check]:
    """A line for each deviation."""
    return [
        Check(target=target, what=f"{d.what} of gaussians off by", value=d.text, wanted="the format's steps", passed=d.worst <= 1)
        for d in found
    ]


def _opacity(gaussians: Gaussians) -> np.ndarray:
    return 1 / (1 + np.exp(-gaussians.opacity_logits.astype(np.float64)))


def _color(gaussians: Gaussians) -> np.ndarray:
    return np.clip(0.5 + SH_C0 * gaussians.sh[:, 0].astype(np.float64), 0, 1)


def _degrees(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Of the rotation between quaternions; by the sine, which keeps digits where they are nearly equal."""
    a, b = (q.astype(np.float64) / np.linalg.norm(q.astype(np.float64), axis=1, keepdims=True) for q in (a, b))
    b = b * np.where((a * b).sum(axis=1, keepdims=True) < 0, -1, 1)
    return np.degrees(4 * np.arcsin(np.clip(np.linalg.norm(a - b, axis=1) / 2, 0, 1)))
