"""Captures a trajectory: frame by frame into every format that is asked for."""

import json
from pathlib import Path
from typing import Protocol

from wm.artifacts.atomic import write_atomically
from wm.capture import nerfstudio, npz, tum
from wm.capture.frames import CapturedFrame, FrameMaker
from wm.capture.labels import label_table
from wm.capture.request import CaptureRequest
from wm.capture.trajectories import stations
from wm.finished import open_finished
from wm.stages.progress import progress


class CaptureWriter(Protocol):
    """Writes frames in one format."""

    def add(self, frame: CapturedFrame) -> None: ...

    def finish(self) -> list[Path]: ...


WRITERS = {nerfstudio.NAME: nerfstudio.NerfstudioWriter, npz.NAME: npz.NpzWriter, tum.NAME: tum.TumWriter}


def capture(request: CaptureRequest) -> int:
    """Writes the frames of a request into its folder, labels.json first; returns how many there are.

    Raises:
        InputError: the run, or what is asked of it, cannot be used.
        OSError: the folder cannot be written.
    """
    run = open_finished(request.run)
    path, table = stations(run, request), label_table(run)
    maker = FrameMaker(run, request, table)
    write_atomically(request.folder / "labels.json", json.dumps(table.json(), indent=1) + "\n")
    writers: list[CaptureWriter] = [WRITERS[name](request.folder, len(path)) for name in request.formats]
    with progress("capture", len(path)) as bar:
        for station in path:
            frame = maker.frame(station)
            for writer in writers:
                writer.add(frame)
            bar.update()
    for writer in writers:
        writer.finish()
    return len(path)
