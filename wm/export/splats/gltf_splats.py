"""Target `gltf_splats`: textured scaffold and gaussians in one GLB file, by KHR_gaussian_splatting; y up, one on the other.

A viewer without the extension shows the scaffold and coloured points. The scaffold is that of the run folder, unchanged.
"""

from pathlib import Path

from wm.artifacts.atomic import write_atomically
from wm.export.records import Check, ExportError
from wm.export.splats.comparing import Deviation, Steps, as_checks, read_back, require_within
from wm.finished import FinishedRun
from wm.splat.formats import SplatFileError, to_y_up
from wm.splat.formats.glb_file import GlbFile, glb_bytes, parse_glb
from wm.splat.formats.gltf_splats import with_gaussians
from wm.splat.ply.standard import packable
from wm.types import Gaussians

TARGET, FILE, NODE = "gltf_splats", "scaffold_splats.glb", "gaussians"
_STEPS = Steps(means=1e-9, log_scales=1e-5, opacity=1e-6, color=1e-6, degrees=0.01)


def write(run: FinishedRun, folder: Path) -> list[Path]:
    """Writes the file, reads it back and compares gaussians and scaffold. Raises: ExportError."""
    path = folder / FILE
    extras = {"antialias": bool(run.raster.antialias)}
    try:
        both = with_gaussians(_scaffold(run), _gaussians(run), node=NODE, extras=extras)
    except SplatFileError as error:
        raise ExportError(f"target {TARGET}: {error}") from None
    write_atomically(path, glb_bytes(both))
    require_within(TARGET, path, _compared(run, path))
    if not _holds_scaffold(run, path):
        raise ExportError(f"target {TARGET}: {path} came back with another scaffold than the run's")
    return [path]


def check(run: FinishedRun, folder: Path) -> list[Check]:
    """How far the file's gaussians lie from the run's, and whether its meshes are the scaffold's."""
    same = _holds_scaffold(run, folder / FILE)
    value = "the same" if same else "others"
    scaffold = Check(target=TARGET, what="meshes and scaffold.glb's", value=value, wanted="the same", passed=same)
    return [*as_checks(TARGET, _compared(run, folder / FILE)), scaffold]


def _gaussians(run: FinishedRun) -> Gaussians:
    return packable(to_y_up(run.gaussians))


def _compared(run: FinishedRun, path: Path) -> list[Deviation]:
    return read_back(TARGET, path, _gaussians(run), _STEPS)


def _scaffold(run: FinishedRun) -> GlbFile:
    return parse_glb(str(run.scaffold_file), run.scaffold_file.read_bytes())


def _holds_scaffold(run: FinishedRun, path: Path) -> bool:
    """Whether what comes before the gaussians is the scaffold, byte for byte."""
    found, wanted = parse_glb(str(path), path.read_bytes()), _scaffold(run)
    same = [
        found.document.get(k, [])[: len(v)] == v
        for k, v in wanted.document.items()
        if k in ("nodes", "meshes", "materials", "accessors")
    ]
    return all(same) and found.binary.startswith(wanted.binary)
