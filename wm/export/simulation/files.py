"""The files of one target: written whole, and what an earlier export left in their folder removed."""

from collections.abc import Mapping
from pathlib import Path

from wm.artifacts.atomic import write_atomically


def write_files(folder: Path, files: Mapping[str, bytes | str], main: str) -> list[Path]:
    """Writes files by their names within a folder, the main one last, so that it never names one that is not there yet.

    Files in its folders "meshes" and "textures" that are not among them are of an earlier export, and are removed.

    Returns:
      The paths, the main file first.
    """
    names = [name for name in sorted(files) if name != main]
    for name in (*names, main):
        write_atomically(folder / name, files[name], sync_first=False)
    for kind in ("meshes", "textures"):
        for path in (folder / kind).glob("*"):
            if path.is_file() and f"{kind}/{path.name}" not in files:
                path.unlink()
    return [folder / main, *(folder / name for name in names)]
