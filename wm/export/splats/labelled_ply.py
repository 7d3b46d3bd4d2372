"""Target `labelled_ply`: the PLY file of the run with the room and the object of each gaussian as `int room`, `int object`.

Viewers ignore properties that they do not know. Order and axes (z up) are those of `splats.ply`, and rows of both are the same
gaussian. A JSON file beside it tells which ids the numbers stand for.
"""

import json
from pathlib import Path

import numpy as np

from wm.artifacts.atomic import write_atomically
from wm.export.records import Check, ExportError
from wm.export.splats.comparing import Steps, deviations, require_within
from wm.export.splats.labels import SplatLabels, splat_labels
from wm.finished import FinishedRun
from wm.splat import load_ply, save_ply
from wm.splat.ply import PlyError
from wm.splat.ply.body import read_tables
from wm.splat.ply.header import parse_header

TARGET, FILE, NAMES = "labelled_ply", "splats.labelled.ply", "splats.labels.json"
_EXACT = Steps(means=1e-9, log_scales=1e-9, opacity=1e-6, color=1e-6, degrees=0.01)


def write(run: FinishedRun, folder: Path) -> list[Path]:
    """Writes the file and the names, reads them back and compares. Raises: ExportError."""
    labels = splat_labels(run)
    columns = {"room": labels.room, "object": labels.object}
    path, names = folder / FILE, folder / NAMES
    antialias = bool(run.raster.antialias)
    write_atomically(path, lambda part: save_ply(part, run.gaussians, antialias=antialias, labels=columns))
    told = {"version": 1, "none": -1, "rooms": run.rooms, "objects": [thing.id for thing in run.objects]}
    write_atomically(names, json.dumps(told, indent=1) + "\n")
    require_within(TARGET, path, deviations(load_ply(path), load_ply(run.splats_file), _EXACT))
    found = read_labels(path)
    if not (np.array_equal(found.room, labels.room) and np.array_equal(found.object, labels.object)):
        raise ExportError(f"target {TARGET}: {path} came back with other labels than were written")
    return [path, names]


def check(run: FinishedRun, folder: Path) -> list[Check]:
    """Whether rows are the run's gaussians, and labels name what is there."""
    gaussians, wanted, found = load_ply(folder / FILE), load_ply(run.splats_file), read_labels(folder / FILE)
    same = len(gaussians.means) == len(wanted.means) and np.array_equal(gaussians.means, wanted.means)
    rooms = bool(np.array_equal(found.room, run.gaussian_room))
    objects = bool(((found.object >= -1) & (found.object < len(run.objects))).all())
    return [
        Check(TARGET, "rows that are those of splats.ply", "all" if same else "not all", "all", same),
        Check(TARGET, "rooms of gaussians", "right" if rooms else "wrong", "right", rooms),
        Check(TARGET, "objects that are in the run", "all" if objects else "not all", "all", objects),
    ]


def read_labels(path: Path) -> SplatLabels:
    """The room and the object of each gaussian of a labelled file.

    Raises:
        ExportError: the file is no PLY, or has no labels.
    """
    raw = path.read_bytes()
    try:
        table = read_tables(str(path), raw, parse_header(str(path), raw), ["vertex"])["vertex"]
        return SplatLabels(room=table["room"], object=table["object"])
    except (PlyError, KeyError, ValueError) as error:
        raise ExportError(f"target {TARGET}: {path} has no gaussians with labels ({error}); export it again") from None
