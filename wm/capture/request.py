"""What is asked of a capture, read from the words of a command line and checked."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

from wm.errors import InputError
from wm.export.words import ExportWordsError, listed, run_and_words

FORMATS = ("nerfstudio", "npz", "tum")
PATHS = ("walk", "orbit", "views", "heldout")
_CHOICES = {"rgb": ("splats", "images"), "depth": ("scaffold", "splats")}
_BOUNDS = {"fps": (1, 240), "speed": (0.05, 50.0), "width": (8, 8192), "height": (8, 8192), "fov": (5.0, 150.0)}
KEYS = {
    "trajectory": f"{', '.join(PATHS)}, or a JSON file of cameras in nerfstudio's format; by default walk",
    "format": f"some of [{','.join(FORMATS)}]; by default all",
    "output": "the folder; by default capture/<trajectory> in the run folder",
    "rgb": "splats, or images: the painted images of views; by default splats",
    "depth": "scaffold, or splats: what the gaussians show; by default scaffold",
    "fps": "frames a second of the walk, frames of a room's orbit; by default 10",
    "speed": "of the walk, metres a second; by default 1",
    "width": "of images, pixels; by default the run's",
    "height": "of images, pixels; by default the run's",
    "fov": "vertical field of view, degrees; by default the run's",
}


class CaptureError(InputError):
    """What cannot be captured; the message says why and what would be right."""


@dataclasses.dataclass(frozen=True)
class CaptureRequest:
    """What to capture of a run, and where to. None: the run's own."""

    run: Path
    trajectory: str = "walk"
    formats: tuple[str, ...] = FORMATS
    output: Path | None = None
    rgb: str = "splats"
    depth: str = "scaffold"
    fps: int = 10
    speed: float = 1.0
    width: int | None = None
    height: int | None = None
    fov: float | None = None

    @property
    def name(self) -> str:
        """Of the trajectory: that of its file without suffix where it is one."""
        return self.trajectory if self.trajectory in PATHS else Path(self.trajectory).stem

    @property
    def folder(self) -> Path:
        return self.output or self.run / "capture" / self.name


def parse_request(words: Sequence[str]) -> CaptureRequest:
    """The request in words such as `RUN trajectory=orbit format=[tum]`.

    Raises:
        CaptureError: a word is unknown, or a value is; the message names what would be right.
    """
    try:
        run, told = run_and_words(words, KEYS)
    except ExportWordsError as error:
        raise CaptureError(str(error)) from error
    values: dict = {key: _number(key, told.pop(key)) for key in _BOUNDS if key in told}
    values |= {key: _one_of(key, told.pop(key), choices) for key, choices in _CHOICES.items() if key in told}
    if "format" in told:
        names = listed(told.pop("format")) or [""]
        values["formats"] = tuple(sorted({_one_of("format", name, FORMATS) for name in names}))
    if "output" in told:
        values["output"] = Path(told.pop("output"))
    request = CaptureRequest(run=run, **told, **values)
    return _checked(request)


def _checked(request: CaptureRequest) -> CaptureRequest:
    known = request.trajectory in PATHS
    if not known and not (request.trajectory.endswith(".json") and Path(request.trajectory).is_file()):
        raise CaptureError(
            f"trajectory={request.trajectory}: no file of that name; {', '.join(PATHS)} or a JSON file would be right"
        )
    if request.rgb == "images" and request.trajectory != "views":
        raise CaptureError(
            f"rgb=images with trajectory={request.trajectory}: only views have images; trajectory=views would be right"
        )
    if request.rgb == "images" and (request.width, request.height, request.fov) != (None, None, None):
        raise CaptureError("rgb=images: images have their size and field of view; leave out width, height and fov")
    return request


def _one_of(key: str, value: str, choices: Sequence[str]) -> str:
    if value not in choices:
        raise CaptureError(f"{key}={value}: {' or '.join(choices)} would be right")
    return value


def _number(key: str, value: str) -> float | int:
    low, high = _BOUNDS[key]
    try:
        number = type(low)(value)
    except ValueError:
        number = low - 1
    if not low <= number <= high:
        kind = "a whole number" if isinstance(low, int) else "a number"
        raise CaptureError(f"{key}={value}: {kind} from {low} to {high} would be right")
    return number
