"""The command python -m wm.compare inputs RUN to=[...]: what is asked for, and where it is written."""

import pathlib
from collections.abc import Callable, Sequence

from wm.compare.drawing import drawer_of
from wm.compare.errors import CompareError
from wm.compare.inputs.image import write_image
from wm.compare.inputs.panorama import write_panorama
from wm.compare.inputs.spatialgen import write_spatialgen
from wm.compare.records import ComparedScene
from wm.compare.words import words_in
from wm.finished import FinishedRun, open_finished
from wm.stages.progress import progress


def _panorama(run: FinishedRun, folder: pathlib.Path) -> list[pathlib.Path]:
    return write_panorama(run, drawer_of(ComparedScene(method="ours", run=run, antialias=run.raster.antialias)), folder)


WRITERS: dict[str, Callable[[FinishedRun, pathlib.Path], list[pathlib.Path]]] = {
    "spatialgen": write_spatialgen,
    "panorama": _panorama,
    "image": write_image,
}


def write_inputs(words: Sequence[str]) -> list[pathlib.Path]:
    """Writes what the words ask for; returns the folders. Raises: InputError."""
    settings = dict(word.split("=", 1) for word in words if "=" in word)
    paths = [word for word in words if "=" not in word]
    unknown = [key for key in settings if key not in ("to", "output")]
    if len(paths) != 1 or unknown:
        wrong = f"{unknown[0]}= is no setting" if unknown else f"{len(paths)} run folders are given"
        raise CompareError(f"inputs: {wrong}; inputs RUN to=[{','.join(WRITERS)}] output=FOLDER would be right")
    targets = words_in(settings["to"]) if "to" in settings else list(WRITERS)
    for target in targets:
        if target not in WRITERS:
            raise CompareError(f"inputs: to={target}: one of {', '.join(WRITERS)} would be right")
    run = open_finished(paths[0])
    output = pathlib.Path(settings["output"]) if "output" in settings else run.folder / "export" / "inputs"
    with progress("inputs", len(targets)) as bar:
        for target in targets:
            bar.set_postfix_str(target)
            WRITERS[target](run, output / target)
            bar.update()
    return [output / target for target in targets]
