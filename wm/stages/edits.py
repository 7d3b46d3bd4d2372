"""Files of the run folder that a user has changed by hand: they are used, and never overwritten without a copy.

An entry of the manifest holds the digest of its file as the run made it. A file that differs from it and can be read is an edit.
It is recorded under a key of its own, made of the key that the configuration asks for and of the file's digest, so that
everything that depends on the file is made again, and the edit holds for as long as the configuration stays. Where another
configuration makes the file anew, or it cannot be read, it is first copied beside itself.
"""

import shutil

from wm import console
from wm.artifacts.digests import content_digest, file_digest
from wm.stages.run_context import RunContext

_EDITED = "edited-"
"""What the keys of edited entries begin with."""


def edited_key(run: RunContext, name: str, file: str, key: str) -> str | None:
    """The key of an entry whose file the user has changed.

    Args:
      name: the entry.
      file: its file that may be changed, relative to the run folder.
      key: the key that the configuration asks for.

    Returns:
      None where the file is as it was made, is not there, or belongs to another configuration.
    """
    entry, path = run.folder.entry(name), run.folder.path / file
    if entry is None or file not in entry["files"] or not path.is_file():
        return None
    made, found = entry["files"][file], file_digest(path)
    if entry["key"] == key:
        return None if found == made else _edited(run, name, key, found)
    return _edited(run, name, key, found) if entry["key"] == _edited(run, name, key, made) else None


def accept(run: RunContext, name: str, key: str, files: list[str], consequence: str) -> None:
    """Records the edited files of an entry, and says what they redo. An edit that is recorded already is nothing new."""
    entry = run.folder.entry(name)
    if entry is None or entry["key"] != key:
        console.say(f"{run.folder.path / files[-1]}: edited by hand, and used as it is; {consequence}")
        run.folder.record(name, key, files)


def keep_copy(run: RunContext, name: str, file: str, content: str) -> None:
    """Copies a file that a user has changed and that is about to be overwritten with other content; says where the copy is."""
    entry, path = run.folder.entry(name), run.folder.path / file
    if not path.is_file() or (found := file_digest(path)) == content_digest(content.encode()):
        return
    if entry is not None and entry["files"].get(file) == found and not entry["key"].startswith(_EDITED):
        return  # as the run made it
    copy = path.with_name(f"{path.name}.before-{found[:8]}")
    if not copy.exists():
        shutil.copyfile(path, copy)
    console.say(f"{path}: changed by hand, and now made again; what it was is kept in {copy.name}")


def _edited(run: RunContext, name: str, key: str, digest: str) -> str:
    return _EDITED + run.key(name, key, digest)
