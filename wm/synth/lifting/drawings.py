"""The images that an image model drew of furnished rooms, kept in the run folder as soon as they are drawn.

    drawings/index.json            the drawings of this run: name, room, size, digest
    drawings/<room>/furnish0.png   each of them, sRGB with 8 bits a channel

A person sees them there, and marks the furniture in them (wm.annotation). The digest is that of the pixels, so that it holds
whatever wrote the file.
"""

import dataclasses
import io
import json
import pathlib
from collections.abc import Callable

import numpy as np
from jaxtyping import Num, UInt8
from PIL import Image

from wm.artifacts.atomic import write_atomically
from wm.artifacts.confined import confined
from wm.artifacts.digests import digest, json_text
from wm.errors import ArtifactError

FOLDER = "drawings"
INDEX = f"{FOLDER}/index.json"


@dataclasses.dataclass(frozen=True)
class KeptDrawing:
    """A drawing in the run folder."""

    name: str  # of its view, such as hall/furnish0
    room: str  # name of the room
    width: int  # pixels
    height: int
    digest: str  # of its pixels: `pixel_digest`

    @property
    def file(self) -> str:
        """The name of its file in the run folder."""
        return f"{FOLDER}/{self.name}.png"


def pixels(rgb: Num[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "h w 3"]:
    """An image as 8-bit sRGB; floating values are in [0, 1], clipped and rounded."""
    return rgb if rgb.dtype == np.uint8 else np.round(np.clip(rgb, 0, 1) * 255).astype(np.uint8)


def pixel_digest(rgb: Num[np.ndarray, "h w 3"]) -> str:
    """20 hex digits that stand for the pixels of an image, as 8-bit sRGB."""
    return digest("pixels", pixels(rgb))


def keep_drawing(folder: pathlib.Path, name: str, room: str, rgb: Num[np.ndarray, "h w 3"]) -> KeptDrawing:
    """Writes a drawing of a room, whole or not at all, and then lists it.

    Raises:
      OSError: the folder cannot be written, or the disk is full.
      ArtifactError: a link leads out of the folder.
    """
    image = pixels(rgb)
    drawing = KeptDrawing(name, room, image.shape[1], image.shape[0], pixel_digest(image))
    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, format="PNG")
    write_atomically(confined(folder, drawing.file, replaced=True), buffer.getvalue())
    _list(folder, [*(other for other in kept_drawings(folder) if other.name != name), drawing])
    return drawing


def kept_drawings(folder: pathlib.Path) -> list[KeptDrawing]:
    """The drawings of a run folder, by name; none if there is no list of them, or a damaged one."""
    try:
        listed = json.loads(confined(folder, INDEX).read_text(encoding="utf-8"))["drawings"]
        found = [KeptDrawing(**item) for item in listed]
    except (OSError, ValueError, KeyError, TypeError):
        return []
    return sorted((drawing for drawing in found if _is_sound(folder, drawing)), key=lambda drawing: drawing.name)


def read_drawing(folder: pathlib.Path, drawing: KeptDrawing) -> UInt8[np.ndarray, "h w 3"]:
    """The pixels of a drawing.

    Raises:
      ArtifactError: its file is not there, or not as it was drawn; the same run draws it again.
    """
    try:
        with Image.open(confined(folder, drawing.file)) as image:
            rgb = np.asarray(image.convert("RGB"))
    except (OSError, ValueError, SyntaxError) as error:  # Pillow raises SyntaxError for a broken PNG
        raise ArtifactError(f"{folder / drawing.file}: cannot be read; the same run again draws it anew") from error
    if pixel_digest(rgb) != drawing.digest:
        raise ArtifactError(f"{folder / drawing.file}: not as it was drawn; the same run again draws it anew")
    return rgb


def drop_drawings(folder: pathlib.Path, stale: Callable[[str], bool]) -> None:
    """Removes the drawings of whose names `stale` says that they are those of a former plan."""
    found = kept_drawings(folder)
    dropped = [drawing for drawing in found if stale(drawing.name)]
    if dropped:
        _list(folder, [drawing for drawing in found if drawing not in dropped])
    for drawing in dropped:
        confined(folder, drawing.file, replaced=True).unlink(missing_ok=True)


def drawing_files(folder: pathlib.Path) -> list[str]:
    """The names of all files that this module has written in a run folder, and that are there."""
    files = [INDEX, *(drawing.file for drawing in kept_drawings(folder))]
    return [file for file in files if confined(folder, file, replaced=True).is_file()]


def _list(folder: pathlib.Path, drawings: list[KeptDrawing]) -> None:
    listed = [dataclasses.asdict(drawing) for drawing in sorted(drawings, key=lambda drawing: drawing.name)]
    write_atomically(confined(folder, INDEX, replaced=True), json_text({"version": 1, "drawings": listed}))


def _is_sound(folder: pathlib.Path, drawing: KeptDrawing) -> bool:
    """Whether an entry of the list, which anybody may have written, has the types and the place that it should have."""
    kinds = {"name": str, "room": str, "width": int, "height": int, "digest": str}
    if not all(isinstance(getattr(drawing, name), kind) for name, kind in kinds.items()):
        return False
    try:
        confined(folder, drawing.file, replaced=True)
    except ArtifactError:
        return False
    return True
