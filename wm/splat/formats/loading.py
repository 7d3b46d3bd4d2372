"""Gaussians from a file of any format: which one it is, its first bytes tell, and the suffix where a format has no header."""

from pathlib import Path

from wm.splat.formats.errors import SplatFileError
from wm.splat.formats.gaussforge import read_packed
from wm.splat.formats.gltf_splats import read_gltf_splats
from wm.splat.formats.splat_records import read_splat
from wm.splat.ply import PlyError, load_ply
from wm.types import Gaussians

FORMATS = "PLY, compressed PLY, .splat, SPZ, SOG and GLB with KHR_gaussian_splatting"
_GZIP, _SPZ_4, _ZIP, _GLB = b"\x1f\x8b", b"NGSP", b"PK\x03\x04", b"glTF"


def load_splats(path: str | Path) -> Gaussians:
    """Read gaussians (NumPy float32 leaves) from a file of any format that is common, in the axes of the file.

    PLY files of any layout that `load_ply` knows, PlayCanvas's compressed PLY, antimatter15's `.splat`, SPZ (versions 2 to 4) and
    SOG (both with the extra `splats`), and GLB with KHR_gaussian_splatting, where nodes put the gaussians in glTF's y-up axes.
    Formats of 8 bits that have an opacity of 0 or 1 give one that is finite as a logit.

    Raises:
        SplatFileError: the file is of no such format, cut short or damaged, or an extra is missing; the message names the file
            and what would be right.
        OSError: it cannot be read.
    """
    path = Path(path)
    with path.open("rb") as file:
        start = file.read(4)
    if not start:
        raise SplatFileError(f"{path}: an empty file; one of {FORMATS} would be right")
    if start.startswith(b"ply"):
        try:
            return load_ply(path)
        except PlyError as error:
            raise SplatFileError(str(error)) from None
    if start.startswith(_GZIP) or start == _SPZ_4:
        return read_packed(path, "spz")
    if start == _ZIP and path.suffix.lower() != ".usdz":
        return read_packed(path, "sog")
    if start == _GLB:
        return read_gltf_splats(str(path), path.read_bytes())
    if path.suffix.lower() == ".splat":
        return read_splat(str(path), path.read_bytes())
    raise SplatFileError(f"{path}: of no format of gaussians that is read here; one of {FORMATS} would be right")
