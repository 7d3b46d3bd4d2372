"""SPZ and SOG through gaussforge (extra `splats`), in a process of its own: it prints on standard output, and a damaged file can
end it.

gaussforge 0.6 changes no axes; SPZ keeps the order, SOG has one of its own. Gaussians go to it and come from it as a PLY file.
"""

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Literal

from wm.splat.formats.errors import SplatFileError
from wm.splat.ply import PlyError, load_ply, save_ply
from wm.splat.ply.standard import packable
from wm.types import Gaussians

Packed = Literal["spz", "sog"]

SPZ_VERSION = 3
"""Version 4 is refused by Spark 2.2 and by NVIDIA's converter; both versions are read here."""

_PROGRAM = """
import sys
import gaussforge
source, kind, target, wanted, version = sys.argv[1:]
with open(source, "rb") as file:
    told = gaussforge.GaussForge().convert(file.read(), kind, wanted, strict=True, spz_version=int(version))
if not told.get("data"):
    sys.exit(told.get("error") or "nothing could be read")
with open(target, "wb") as file:
    file.write(told["data"])
"""


def save_packed(path: str | Path, gaussians: Gaussians, kind: Packed) -> None:
    """Write gaussians as an SPZ (version 3) or SOG file, in their axes.

    Raises:
        SplatFileError: gaussforge is not installed, or there are no gaussians.
    """
    path, g = Path(path), packable(gaussians)
    if not len(g.means):
        raise SplatFileError(f"{path}: there are no gaussians to write; {kind.upper()} holds at least one")
    with tempfile.TemporaryDirectory() as folder:
        ply, packed = Path(folder) / "gaussians.ply", Path(folder) / f"gaussians.{kind}"
        save_ply(ply, g)
        _convert(path, ply, "ply", packed, kind)
        path.write_bytes(packed.read_bytes())


def read_packed(path: Path, kind: Packed) -> Gaussians:
    """The gaussians (NumPy float32 leaves) of an SPZ or SOG file, in its axes. Opacities are finite.

    Raises:
        SplatFileError: gaussforge is not installed, or cannot read the file.
    """
    with tempfile.TemporaryDirectory() as folder:
        ply = Path(folder) / "gaussians.ply"
        _convert(path, path, kind, ply, "ply")
        try:
            gaussians = load_ply(ply)
        except PlyError as error:
            raise SplatFileError(f"{path}: no {kind.upper()} that gaussforge reads whole ({error})") from None
    return packable(gaussians)


def _convert(path: Path, source: Path, kind: str, target: Path, wanted: str) -> None:
    """Raises SplatFileError, which names `path`."""
    if importlib.util.find_spec("gaussforge") is None:
        raise SplatFileError(f"{path}: SPZ and SOG need gaussforge; install it with pip install 'wm[splats]'")
    command = [sys.executable, "-c", _PROGRAM, str(source), kind, str(target), wanted, str(SPZ_VERSION)]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace")
    if done.returncode:
        lines = done.stderr.strip().splitlines()
        reason = lines[-1] if done.returncode > 0 and lines else f"it ended with {done.returncode}"
        what = kind if kind != "ply" else wanted
        raise SplatFileError(f"{path}: gaussforge cannot convert it: {reason}; a whole {what.upper()} file would be right")
