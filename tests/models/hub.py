"""A loopback server that stands for the Hugging Face hub: folders as repositories, each at one commit.

A process that is to use it has HF_ENDPOINT=<its url>, HF_HUB_DISABLE_XET=1 and a fresh HF_HOME before it imports anything.
"""

import hashlib
import pathlib
import urllib.parse
from collections.abc import Callable, Mapping

from tests.models.loopback import Asked, Reply

COMMIT = "a" * 40


def hub(repositories: Mapping[str, pathlib.Path]) -> Callable[[Asked], Reply]:
    """What a `Loopback` answers that serves these folders by the name of their repository."""

    def answer(asked: Asked) -> Reply:
        path = urllib.parse.unquote(urllib.parse.urlsplit(asked.path).path)
        for name, folder in repositories.items():
            if path.startswith(f"/{name}/resolve/"):
                return _file(folder / path.split("/resolve/")[1].partition("/")[2])
            if path.startswith(f"/api/models/{name}/tree/"):
                return _tree(folder, path.split("/tree/")[1].partition("/")[2])
            if path.startswith(f"/api/models/{name}"):
                files = [{"rfilename": str(file.relative_to(folder))} for file in _files(folder)]
                known = {"_id": "x", "id": name, "modelId": name, "sha": COMMIT, "private": False, "siblings": files}
                return Reply(body=known, headers={"x-repo-commit": COMMIT})
        return Reply(404, {}, {"x-error-code": "RepoNotFound"})

    return answer


def _file(file: pathlib.Path) -> Reply:
    if not file.is_file():
        return Reply(404, b"", {"x-error-code": "EntryNotFound", "x-repo-commit": COMMIT})
    content = file.read_bytes()
    return Reply(body=content, headers={"etag": f'"{hashlib.sha1(content).hexdigest()}"', "x-repo-commit": COMMIT})


def _tree(folder: pathlib.Path, below: str) -> Reply:
    files = [file for file in _files(folder) if str(file.relative_to(folder)).startswith(below)]
    if below and not files:
        return Reply(404, {}, {"x-error-code": "EntryNotFound"})
    row = {"type": "file", "oid": "b" * 40}
    return Reply(body=[row | {"path": str(file.relative_to(folder)), "size": file.stat().st_size} for file in files])


def _files(folder: pathlib.Path) -> list[pathlib.Path]:
    return sorted(file for file in folder.rglob("*") if file.is_file())
