"""Files that are written whole or not at all, and stay written when the machine loses its power."""

import contextlib
import errno
import os
import pathlib
import re
import tempfile
from collections.abc import Callable
from typing import Any

TEMPORARY = ".part-wm-"
"""How the name of a file begins while it is being written. It tells ours from other programs' partial files."""
_TEMPORARY_NAME = re.compile(re.escape(TEMPORARY) + r"[a-z0-9_]{8}(\.\w+)?")

_UMASK = os.umask(0)
os.umask(_UMASK)  # a process can read it only by setting it
_unfinished: set[str] = set()
"""Temporary files that this process is writing now."""

Writer = Callable[[pathlib.Path], Any]


def write_atomically(path: pathlib.Path, write: Writer | bytes | str, *, sync_first: bool = True) -> None:
    """Writes a file under a temporary name beside `path`, then renames it: readers see the old file or the new one.

    With `sync_first` that holds for a loss of power too: the content is on the disk before the name. Without it the name comes
    some milliseconds earlier, and after a loss of power the file may be empty: for files whose readers check that they are whole.

    Args:
      path: the file; its folder is made.
      write: the content (text becomes UTF-8), or a function that writes it to the path it is given.

    Raises:
      OSError: the disk is full, the folder is not writable, or a folder has the file's name; no partial file remains. The error
        names `path` and not the temporary file.
    """
    if path.is_dir() and not path.is_symlink():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    made = _make_folder(path.parent)
    name = None
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=TEMPORARY, suffix=path.suffix)
        _unfinished.add(name)
        os.close(handle)
        if callable(write):
            write(pathlib.Path(name))
        else:
            pathlib.Path(name).write_bytes(write.encode() if isinstance(write, str) else write)
        os.chmod(name, 0o666 & ~_UMASK)
        if sync_first:
            _sync_file(name)
        os.replace(name, path)
        if not sync_first:
            _sync_file(path)
    except BaseException as error:
        if name is not None:
            with contextlib.suppress(OSError):
                os.unlink(name)
        if isinstance(error, OSError):
            _name_the_file(error, path)
        raise
    finally:
        _unfinished.discard(name or "")
    for folder in (path.parent, *made):
        _sync_folder(folder)


def is_temporary(name: str) -> bool:
    """Whether this is the name of a file that `write_atomically` had not finished."""
    return _TEMPORARY_NAME.fullmatch(name) is not None


def discard_unfinished() -> None:
    """Removes the temporary files that this process is writing. For a process that ends at once."""
    for name in list(_unfinished):
        with contextlib.suppress(OSError):
            os.unlink(name)


def _make_folder(folder: pathlib.Path) -> list[pathlib.Path]:
    """Makes a folder and those above it; returns the folders that have gained a member."""
    missing = [level for level in (folder, *folder.parents) if not level.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return [level.parent for level in missing]


def _sync_file(path: str | pathlib.Path) -> None:
    with open(path, "rb+") as file:
        os.fsync(file.fileno())


def _sync_folder(folder: pathlib.Path) -> None:
    """Brings a folder's list of files to the disk: without it a power loss may undo a rename. Not every platform can."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _name_the_file(error: OSError, path: pathlib.Path) -> None:
    """Of a full disk Python names no file, and of a failed rename the temporary one."""
    if error.filename is None or is_temporary(os.path.basename(os.fsdecode(error.filename))):
        error.filename, error.filename2 = str(path), None
