"""What is marked in the drawings of a run, and what clicks give: the page's requests, as JSON values in and out.

Every change is in the file of its drawing before it is answered, so that nothing is lost when the page, or this process, ends.
What becomes of the masks afterwards (small ones left out, overlapping ones of one name joined, pieces apart made things of their
own; WorldMesh, supplement, "Object Segmentation") is foreseen with the run's own function. It knows no depth here, so that pieces
that something nearer divides count as apart.
"""

import base64
import dataclasses
import functools
import pathlib
import threading
from typing import Any

import numpy as np

from wm.annotation.overlay import COLORS, overlay
from wm.errors import InputError
from wm.geometry.placement.support import is_structure
from wm.synth.backends import Click, ClickedSegmentation, Segment
from wm.synth.lifting.clicks import (
    ClickedImage,
    ClickedThing,
    load_clicks,
    read_clicks,
    read_label,
    save_clicks,
    thing_as_json,
)
from wm.synth.lifting.drawings import KeptDrawing, kept_drawings, read_drawing
from wm.synth.lifting.segments import tidy_segments
from wm.synth.lifting.usual_things import usual_things

_MASKS = 256
"""Masks that are kept, so that looking at an image again asks the model nothing."""


class RequestError(InputError):
    """A request that does not fit what is there; the message is for the person at the page."""


class Session:
    """The drawings of one run folder and the model that segments them. Several threads may ask; they are answered in turn.

    Args:
      folder: the run folder.
      backend: gives the mask of clicks.
      min_area: share of an image below which a mask is left out (objects.min_area).
    """

    def __init__(self, folder: pathlib.Path, backend: ClickedSegmentation, *, min_area: float):
        self.folder, self._backend, self._min_area = folder, backend, min_area
        self._lock = threading.Lock()
        self._masks = functools.lru_cache(_MASKS)(self._segmented)

    def images(self) -> dict[str, Any]:
        """All drawings of the run as it is now, without masks."""
        with self._lock:
            drawings = kept_drawings(self.folder)
            return {"run": self.folder.resolve().name, "images": [self._summary(drawing) for drawing in drawings]}

    def picture(self, name: str) -> bytes:
        """The PNG of a drawing. Raises: RequestError, ArtifactError where it is not there, or not as it was drawn."""
        drawing = self._drawing({"image": name})
        read_drawing(self.folder, drawing)
        return (self.folder / drawing.file).read_bytes()

    def things(self, asked: dict[str, Any]) -> dict[str, Any]:
        """What is marked in an image, with masks: {"image": name, "digest": of its pixels}."""
        with self._lock:
            return self._state(self._marked(self._drawing(asked)))

    def mask(self, asked: dict[str, Any]) -> dict[str, Any]:
        """The mask of clicks that are not confirmed yet: "image", "digest", "clicks", "label", and "color" as its number."""
        with self._lock:
            drawing = self._drawing(asked)
            clicks, label = read_clicks(asked.get("clicks"), drawing), str(asked.get("label") or "thing")
            segment = self._masks(drawing, clicks)
            pieces = self._tidied([dataclasses.replace(segment, label=label)])
            return self._shown(segment, int(asked.get("color") or 0)) | {"pieces": len(pieces), "building": is_structure(label)}

    def confirm(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Adds a thing, or changes the one whose number is "replaces": as `mask`, with its "label"."""
        with self._lock:
            marked = self._marked(self._drawing(asked))
            thing = ClickedThing(read_label(str(asked.get("label") or "")), read_clicks(asked.get("clicks"), marked.drawing))
            things = list(marked.things)
            if asked.get("replaces") is None:
                things.append(thing)
            else:
                things[_number(asked["replaces"], len(things))] = thing
            return self._saved(dataclasses.replace(marked, things=tuple(things)))

    def delete(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Removes the thing whose number is "thing"."""
        with self._lock:
            marked = self._marked(self._drawing(asked))
            number = _number(asked.get("thing"), len(marked.things))
            return self._saved(dataclasses.replace(marked, things=(*marked.things[:number], *marked.things[number + 1 :])))

    def finish(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Says whether all is marked that the person wants to mark: "finished"."""
        with self._lock:
            marked = self._marked(self._drawing(asked))
            return self._saved(dataclasses.replace(marked, finished=asked.get("finished") is True))

    def _drawing(self, asked: dict[str, Any]) -> KeptDrawing:
        drawing = next((drawing for drawing in kept_drawings(self.folder) if drawing.name == asked.get("image")), None)
        if drawing is None:
            raise RequestError("this run has no such image (any more); load the page again")
        if asked.get("digest", drawing.digest) != drawing.digest:
            raise RequestError("this image was drawn anew in the meantime; load the page again")
        return drawing

    def _marked(self, drawing: KeptDrawing) -> ClickedImage:
        return load_clicks(self.folder, drawing) or ClickedImage(drawing)

    def _saved(self, marked: ClickedImage) -> dict[str, Any]:
        save_clicks(self.folder, marked)
        return self._state(marked)

    def _segmented(self, drawing: KeptDrawing, clicks: tuple[Click, ...]) -> Segment:
        return self._backend.mask_of(read_drawing(self.folder, drawing), clicks)

    def _summary(self, drawing: KeptDrawing) -> dict[str, Any]:
        marked = self._marked(drawing)
        told = {"finished": marked.finished, "marked": len(marked.things), "suggestions": usual_things(drawing.room)}
        return dataclasses.asdict(drawing) | told

    def _state(self, marked: ClickedImage) -> dict[str, Any]:
        found = [dataclasses.replace(self._masks(marked.drawing, thing.clicks), label=thing.label) for thing in marked.things]
        things = [thing_as_json(thing) | self._shown(found[k], k) for k, thing in enumerate(marked.things)]
        return {"finished": marked.finished, "things": things, "outcome": len(self._tidied(found))}

    def _tidied(self, segments: list[Segment]) -> list[Segment]:
        if not segments:
            return []
        return tidy_segments(segments, np.ones(segments[0].mask.shape, np.float32), min_area=self._min_area)

    def _shown(self, segment: Segment, number: int) -> dict[str, Any]:
        picture = base64.b64encode(overlay(segment.mask, COLORS[number % len(COLORS)])).decode()
        share = float(segment.mask.mean())
        return {"overlay": f"data:image/png;base64,{picture}", "score": round(segment.score, 3), "share": round(share, 5)}


def _number(value: Any, count: int) -> int:
    if type(value) is not int or not 0 <= value < count:
        raise RequestError("this image has no such thing (any more); load the page again")
    return value
