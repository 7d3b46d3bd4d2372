"""One picture of each room and the prompt, for methods that start from an image or from words.

image/ROOM.png    the first generated view of the room
image/prompt.txt  the theme
"""

import pathlib

from wm.artifacts.atomic import write_atomically
from wm.finished import FinishedRun, UnfinishedRunError


def write_image(run: FinishedRun, folder: pathlib.Path) -> list[pathlib.Path]:
    """Writes the pictures and the prompt; returns the pictures. Raises: UnfinishedRunError."""
    pictures = []
    for room, name in enumerate(run.rooms):
        first = next((view for view in run.views if view.room == room), None)
        if first is None:
            raise UnfinishedRunError(f"{run.folder}: room {name} has no view")
        write_atomically(folder / f"{name}.png", run.file(f"views/{first.name}.png").read_bytes())
        pictures.append(folder / f"{name}.png")
    write_atomically(folder / "prompt.txt", f"{run.theme}\n")
    return pictures
