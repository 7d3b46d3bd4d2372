"""Answers of models by the content of their request, in a folder that runs and machines can share.

One file an answer, `<folder>/<first two digits>/<key>.zip` (stored, not compressed): `answer.json` and the files of the answer.
It is written whole or not at all, and holds no secret, since requests and answers hold none.

A damaged answer is as if it were not there, and is asked for again. One that cannot be read now (no permission, too many open
files) is not: that is an error, before anything is sent. So is a folder in which the answer could not be kept.
"""

import contextlib
import errno
import io
import json
import os
import pathlib
import shutil
import threading
import zipfile
from collections.abc import Iterator
from typing import Any

from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import json_text
from wm.services.faults import ServiceError
from wm.services.records import ServiceAnswer, ServiceRequest

try:
    import fcntl
except ImportError:  # Windows has no flock: there only the threads of one process exclude each other
    fcntl = None

_RECORD = "answer.json"
_EPOCH = (1980, 1, 1, 0, 0, 0)
"""The time of every member, so that equal answers are equal files."""
_ROOM = 64 * 2**20
"""Bytes that must be free before a request is sent: several images of the largest size, since others may be under way."""


class AnswerStore:
    """The answers in a folder. The folder is made with the first answer. Several threads and processes may use it."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        self._threads: dict[str, threading.Lock] = {}
        self._guard = threading.Lock()

    def path(self, key: str) -> pathlib.Path:
        """The file of an answer, whether or not it is there."""
        return self.folder / key[:2] / f"{key}.zip"

    def get(self, key: str) -> tuple[ServiceAnswer, dict[str, Any]] | None:
        """An answer and what was noted with it; None if there is none. A damaged one is as if it were not there.

        Raises:
          ServiceError: there is one that cannot be read, or the folder is none.
        """
        with self._explained():
            try:
                content = self.path(key).read_bytes()
            except FileNotFoundError:
                return None
        try:
            with zipfile.ZipFile(io.BytesIO(content)) as archive:
                record = json.loads(archive.read(_RECORD))
                files = {name: archive.read(name) for name in record["files"]}
            return ServiceAnswer(files=files, **record["answer"]), record["noted"]
        except Exception:  # damaged bytes raise errors of many kinds
            return None

    def put(self, request: ServiceRequest, answer: ServiceAnswer, noted: dict[str, Any]) -> None:
        """Keeps an answer, with JSON values about how it came about.

        Raises:
          ServiceError: the folder cannot be written, or the disk is full.
        """
        buffer = io.BytesIO()
        asked = {"backend": request.backend, "model": request.model, "paid": request.paid}
        record = json_text({"answer": answer.record, "files": list(answer.files), "noted": noted, "request": asked})
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
            for name, content in {_RECORD: record.encode(), **answer.files}.items():
                archive.writestr(zipfile.ZipInfo(name, _EPOCH), content)
        # An answer without its name is paid again after a kill, so the name comes first; `get` notices a file that is not whole.
        with self._explained():
            write_atomically(self.path(request.key), buffer.getvalue(), sync_first=False)

    @contextlib.contextmanager
    def claim(self, key: str) -> Iterator[None]:
        """While this is held no other thread or process holds the same key: who comes second finds the first one's answer.

        Raises:
          ServiceError: an answer could not be kept here: the folder cannot be written, or the disk is nearly full.
        """
        with self._guard:
            lock = self._threads.setdefault(key, threading.Lock())
        path = self.path(key)
        with lock:
            with self._explained():
                path.parent.mkdir(parents=True, exist_ok=True)
                if shutil.disk_usage(path.parent).free < _ROOM:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
                handle = _lock(path.with_suffix(".lock"))
            try:
                yield
            finally:
                _unlock(handle, path.with_suffix(".lock"))

    @contextlib.contextmanager
    def _explained(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise ServiceError(
                f"{error.filename or self.folder}: answers cannot be kept or read here ({error.strerror or error}); what was "
                "answered is kept, and answers.folder=FOLDER names another folder"
            ) from error


def _lock(path: pathlib.Path) -> int | None:
    """Waits until no other process has locked a file, and locks it; None where files cannot be locked. Raises: OSError."""
    if fcntl is None:
        return None
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        fcntl.flock(handle, fcntl.LOCK_EX)
        if _is_file_at(handle, path):
            return handle
        os.close(handle)  # the one who held it has removed the file: this lock excludes nobody


def _unlock(handle: int | None, path: pathlib.Path) -> None:
    if handle is None:
        return
    with contextlib.suppress(OSError):
        path.unlink()
    os.close(handle)


def _is_file_at(handle: int, path: pathlib.Path) -> bool:
    try:
        there = os.stat(path)
    except FileNotFoundError:
        return False
    held = os.fstat(handle)
    return (held.st_dev, held.st_ino) == (there.st_dev, there.st_ino)
