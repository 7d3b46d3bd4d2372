"""Names of files that stay inside their folder.

A manifest may come from anybody, and a folder may hold links. A name is used only if it leads to a place below the folder, by its
text and through every link on the way.
"""

import os
import pathlib

from wm.errors import ArtifactError

LONGEST_NAME, LONGEST_PATH = 255, 1024
"""Bytes of one part of a name, and of all of it, that file systems take."""


def is_plain(relative: str) -> bool:
    """Whether a name, by its text, is that of a file below a folder: parts between "/" that are names, none of them "..", and
    nothing that another system takes for a drive or a separator."""
    parts = relative.split("/")
    named = all(part not in ("", ".", "..") and len(part.encode(errors="replace")) <= LONGEST_NAME for part in parts)
    return named and relative.isprintable() and not set(relative) & set("\\:") and len(relative) <= LONGEST_PATH


def confined(folder: pathlib.Path, relative: str, *, replaced: bool = False) -> pathlib.Path:
    """The path of a file of a folder.

    Args:
      folder: the folder, which itself may be a link.
      relative: the name of the file, with "/" between its parts.
      replaced: the file is going to be replaced or removed: a link of that name is then replaced itself and may lead anywhere.

    Raises:
      ArtifactError: the name leads out of the folder.
    """
    if not is_plain(relative):
        raise ArtifactError(f"{folder}: {relative!r} is no name of a file in this folder")
    path, top = folder / relative, os.path.realpath(folder)
    real = os.path.realpath(path.parent if replaced else path)
    if os.path.commonpath((top, real)) != top:
        raise ArtifactError(f"{path} leads through a link out of the run folder; remove the link, or choose another (output=...)")
    return path
