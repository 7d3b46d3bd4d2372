"""Segmentation by clicks: what a person has marked in the drawings of the run folder (wm.annotate), segmented by SAM 3.

A run draws all rooms, and stops where drawings are not marked yet; once they are, the same command goes on without anybody.
Source: WorldMesh, supplement, "Object Segmentation".
"""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import UInt8

from wm.bounds import setting
from wm.geometry.placement.support import is_structure
from wm.models.segmentation import masks
from wm.models.segmentation.sam3 import Sam3Settings
from wm.models.segmentation.tracker import Tracker
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.backends import Click, ImageResult, SceneContext, Segment, Surroundings
from wm.synth.lifting.clicks import ClickedImage, ClicksError, clicks_state, load_clicks
from wm.synth.lifting.drawings import KeptDrawing, pixel_digest, pixels

VERSION = "1"
SERVED = True


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(Sam3Settings):
    """The checkpoint."""

    backend: str = setting(__name__, "SAM 3, by a person's clicks.")


@dataclasses.dataclass(frozen=True, eq=False)
class Sam3Clicks:
    """The backend."""

    config: Settings
    tracker: Tracker
    services: Services = dataclasses.field(default_factory=Services)

    def with_services(self, services: Services) -> "Sam3Clicks":
        return dataclasses.replace(self, services=services)

    def quote(self) -> Quote:
        return self.services.quote(self.tracker.model.title, paid=False)

    def prepare(self, drawn: Sequence[tuple[ImageResult, Surroundings]]) -> None:
        """Looks whether a person has marked all drawings.

        Raises:
          ClicksError: some are not marked, or the run has no folder.
        """
        missing = [where for result, where in drawn if not _is_finished(_marked(result, where))]
        if missing:
            raise _not_marked(missing, of=len(drawn))

    def segment(self, result: ImageResult, *, where: Surroundings, seed: int) -> list[Segment]:
        """One segment for each instance that a person has marked, but for parts of the building.

        Raises:
          ClicksError: the image is not marked.
          MissingExtraError, ServiceError: the model cannot be loaded or asked.
        """
        marked = _marked(result, where)
        if marked is None or not marked.finished:
            raise _not_marked([where], of=1)
        image = pixels(result.rgb)
        things = [thing for thing in marked.things if not is_structure(thing.label)]
        found = [dataclasses.replace(self.mask_of(image, thing.clicks), label=thing.label) for thing in things]
        return [segment for segment in found if segment.mask.any()]

    def mask_of(self, rgb: UInt8[np.ndarray, "h w 3"], clicks: Sequence[Click]) -> Segment:
        """The thing that clicks mean; the mask may be empty.

        Raises:
          MissingExtraError, ServiceError: the model cannot be loaded or asked.
        """
        told = [[click.x, click.y, click.on] for click in clicks]
        content = {"image": rgb, "clicks": told, "dtype": self.config.dtype}
        request = ServiceRequest(backend=__name__, model=self.tracker.model.name, content=content, paid=False)

        def send() -> ServiceAnswer:
            files = masks.encode(self.tracker.mask(rgb, clicks))
            return ServiceAnswer(files=files, model_version=self.tracker.model.name, finish_reason="done")

        found = masks.decode(dict(self.services.ask(request, send).files))
        mask = masks.resized(found.logits[0].astype(np.float32), rgb.shape[:2]) > 0
        return Segment("", mask, found.scores[0])

    def close(self) -> None:
        self.tracker.close()


def make(config: Settings, context: SceneContext | None = None) -> Sam3Clicks:
    """The backend. It loads its model when it is first asked for something that is not answered yet."""
    return Sam3Clicks(config, Tracker(config))


def reads(folder: Path) -> Any:
    """What stands for the clicks in a run folder."""
    return clicks_state(folder)


def _marked(result: ImageResult, where: Surroundings) -> ClickedImage | None:
    if where.folder is None:
        raise ClicksError("segmentation=sam3_clicks reads a person's clicks in the run folder, and there is none")
    height, width = result.rgb.shape[:2]
    return load_clicks(where.folder, KeptDrawing(where.view.name, where.room, width, height, pixel_digest(result.rgb)))


def _is_finished(marked: ClickedImage | None) -> bool:
    return marked is not None and marked.finished


def _not_marked(missing: Sequence[Surroundings], *, of: int) -> ClicksError:
    names = ", ".join(where.view.name for where in missing[:4]) + (", ..." if len(missing) > 4 else "")
    return ClicksError(
        f"a person has to mark the furniture in {len(missing)} of {of} images first ({names}): "
        f"python -m wm.annotate {missing[0].folder} - then the same command goes on; what was made is kept"
    )
