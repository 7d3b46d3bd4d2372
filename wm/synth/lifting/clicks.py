"""What a person has marked in the drawings of a run: clicks on things and beside them, and what the things are called.

One file a drawing, `clicks/<room>/furnish0.json` in the run folder, written whole by wm.annotation and read by backends that
segment by clicks. It belongs to the person: no run changes or removes it.

    {"version": 1,
     "image": {"name": "hall/furnish0", "width": 640, "height": 480, "digest": "0f3c..."},   the pixels that were clicked at
     "finished": true,                                    whether the person has marked all that they want to mark
     "instances": [{"label": "sofa", "clicks": [[212.5, 301.0, "+"], [180.0, 260.5, "-"]]}]}

x and y are pixels from the upper left corner of the image, where the middle of the first pixel is at (0.5, 0.5). Every instance
has at least one "+". Clicks at other pixels than those of the digest hold no longer.
"""

import dataclasses
import json
import pathlib
from typing import Any

from wm.artifacts.atomic import write_atomically
from wm.artifacts.confined import confined
from wm.artifacts.digests import digest, json_text
from wm.errors import InputError
from wm.synth.backends import Click
from wm.synth.lifting.drawings import KeptDrawing

FOLDER = "clicks"
FORMAT = 1
"""Version of the file's form."""
LONGEST_LABEL = 60
"""Characters of a label."""
MOST_CLICKS = 200
"""Clicks of one instance."""


class ClicksError(InputError):
    """Clicks that are not there, not finished, or cannot be used; the message says what a person can do."""


@dataclasses.dataclass(frozen=True)
class ClickedThing:
    """One instance."""

    label: str
    clicks: tuple[Click, ...]


@dataclasses.dataclass(frozen=True)
class ClickedImage:
    """What is marked in one drawing."""

    drawing: KeptDrawing
    things: tuple[ClickedThing, ...] = ()
    finished: bool = False


def clicks_file(name: str) -> str:
    """The name, in the run folder, of the file with the clicks at a drawing."""
    return f"{FOLDER}/{name}.json"


def load_clicks(folder: pathlib.Path, drawing: KeptDrawing) -> ClickedImage | None:
    """What is marked in a drawing; None if nothing is, or if it was another image that was marked.

    Raises:
      ClicksError: the file cannot be read, or is not of the form above.
      ArtifactError: a link leads out of the folder.
    """
    path = confined(folder, clicks_file(drawing.name))
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, ValueError, RecursionError) as error:
        raise ClicksError(f"{path}: cannot be read ({error}); correct or remove it") from error
    if not isinstance(found, dict) or found.get("version") != FORMAT:
        raise ClicksError(f"{path}: not of version {FORMAT}, which is the one that this wm reads; correct or remove it")
    try:
        if found["image"]["digest"] != drawing.digest:
            return None
        things = tuple(read_thing(item, drawing) for item in found["instances"])
        return ClickedImage(drawing, things, finished=found["finished"] is True)
    except (KeyError, TypeError) as error:
        raise ClicksError(f"{path}: {error} is missing or of another type; correct or remove it") from error
    except ClicksError as error:
        raise ClicksError(f"{path}: {error}") from error


def save_clicks(folder: pathlib.Path, image: ClickedImage) -> None:
    """Writes what is marked in a drawing, whole or not at all. What was marked in a former image of this name is first copied
    beside it, as `furnish0.json.before-*`.

    Raises:
      OSError: the folder cannot be written, or the disk is full.
      ArtifactError: a link leads out of the folder.
    """
    drawing = image.drawing
    told = {"name": drawing.name, "width": drawing.width, "height": drawing.height, "digest": drawing.digest}
    things = [thing_as_json(thing) for thing in image.things]
    text = json_text({"version": FORMAT, "image": told, "finished": image.finished, "instances": things})
    path = confined(folder, clicks_file(drawing.name), replaced=True)
    _keep_former(path, drawing)
    write_atomically(path, text)


def thing_as_json(thing: ClickedThing) -> dict[str, Any]:
    """An instance as the file has it."""
    return {"label": thing.label, "clicks": [[click.x, click.y, "+" if click.on else "-"] for click in thing.clicks]}


def read_thing(item: Any, drawing: KeptDrawing) -> ClickedThing:
    """An instance out of JSON that anybody may have written.

    Raises:
      ClicksError: it has no label, no click on the thing, or clicks outside the image.
    """
    match item:
        case {"label": str(label), "clicks": list(clicks)} if label.strip():
            return ClickedThing(read_label(label), read_clicks(clicks, drawing))
    raise ClicksError("an instance has a label, and clicks as a list of [x, y, '+' or '-']")


def read_label(label: str) -> str:
    """A label with single spaces.

    Raises:
      ClicksError: it is too long, or has characters that are not printed.
    """
    plain = " ".join(label.split())
    if not plain.isprintable() or not 0 < len(plain) <= LONGEST_LABEL:
        raise ClicksError(f"a label has 1 to {LONGEST_LABEL} characters that can be printed")
    return plain


def read_clicks(clicks: Any, drawing: KeptDrawing) -> tuple[Click, ...]:
    """Clicks out of JSON that anybody may have written.

    Raises:
      ClicksError: they are of another form, outside the image, too many, or none is on the thing.
    """
    if not isinstance(clicks, list) or len(clicks) > MOST_CLICKS:
        raise ClicksError(f"clicks are a list of at most {MOST_CLICKS}")
    read = tuple(_click(click, drawing) for click in clicks)
    if not any(click.on for click in read):
        raise ClicksError("at least one click of an instance must be on it ('+')")
    return read


def clicks_state(folder: pathlib.Path) -> list[list[str]]:
    """Name and digest of each file of clicks in a run folder."""
    files = sorted((folder / FOLDER).rglob("*.json")) if (folder / FOLDER).is_dir() else []
    return [[file.relative_to(folder).as_posix(), digest(file.read_bytes())] for file in files if file.is_file()]


def _keep_former(path: pathlib.Path, drawing: KeptDrawing) -> None:
    if not path.is_file() or path.is_symlink():
        return
    former = path.read_bytes()
    try:
        same = json.loads(former)["image"]["digest"] == drawing.digest
    except (ValueError, KeyError, TypeError, RecursionError):
        same = False
    if not same:
        write_atomically(path.with_name(f"{path.name}.before-{digest(former)[:8]}"), former)


def _click(click: Any, drawing: KeptDrawing) -> Click:
    match click:
        case [int() | float() as x, int() | float() as y, "+" | "-" as sign] if bool not in (type(x), type(y)):
            if 0 <= x <= drawing.width and 0 <= y <= drawing.height:  # which NaN is not
                return Click(float(x), float(y), sign == "+")
            raise ClicksError(f"click {x}, {y} is outside the image of {drawing.width} x {drawing.height} pixels")
    raise ClicksError("a click is [x, y, '+' or '-']")
