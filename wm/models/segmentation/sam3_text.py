"""Segmentation by names: SAM 3 finds every instance of what is named, with nobody at hand.

The names are those of `labels`; else those that the language backend proposes for the room and its image (NamingBackend); else,
where it proposes none, what rooms of this sort usually have (wm.synth.lifting.usual_things). Parts of the building are not looked
for. Source: WorldMesh, supplement, "Object Segmentation", last sentence.
"""

import dataclasses
from typing import Any

from wm.bounds import number, setting
from wm.models.local_model import LocalModel
from wm.models.segmentation import masks
from wm.models.segmentation.detector import detect
from wm.models.segmentation.sam3 import EXTRA, Sam3Settings, load_detector
from wm.services.faults import RefusedError
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.backends import ImageResult, LanguageBackend, NamingBackend, SceneContext, Segment, Surroundings
from wm.synth.lifting.drawings import pixels
from wm.synth.lifting.usual_things import searchable, usual_things

VERSION = "1"
USES = ("language",)
SERVED = True


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(Sam3Settings):
    """What is looked for, and what counts as found."""

    backend: str = setting(__name__, "SAM 3, by names.")
    labels: str = setting("", "What to look for in every room, separated by commas; empty: what the language model names.")
    most_labels: int = number(40, 1, 1000, "Names that are looked for in one image.")
    threshold: float = number(0.3, 0, 1, "Score from which something counts as found.")
    mask_threshold: float = number(0.5, 0, 1, "Probability from which a pixel belongs to a thing.")
    same: float = number(0.7, 0, 1, "Intersection over union above which two masks are one thing, whatever they are called.")


@dataclasses.dataclass(frozen=True, eq=False)
class Sam3Text:
    """The backend."""

    config: Settings
    model: LocalModel[Any]
    services: Services = dataclasses.field(default_factory=Services)
    language: LanguageBackend | None = None

    def with_services(self, services: Services) -> "Sam3Text":
        return dataclasses.replace(self, services=services)

    def with_language(self, language: LanguageBackend) -> "Sam3Text":
        return dataclasses.replace(self, language=language)

    def quote(self) -> Quote:
        return self.services.quote(self.model.title, paid=False)

    def segment(self, result: ImageResult, *, where: Surroundings, seed: int) -> list[Segment]:
        """The things that are named and found, the surest first.

        Raises:
          MissingExtraError, ServiceError: the model cannot be loaded or asked.
        """
        names, image = self.names(result, where=where, seed=seed), pixels(result.rgb)
        content = {"image": image, "names": names, "threshold": self.config.threshold, "dtype": self.config.dtype}
        request = ServiceRequest(backend=__name__, model=self.model.name, content=content, paid=False)

        def send() -> ServiceAnswer:
            found = self.model.run(lambda loaded: detect(loaded, image, names, self.config.threshold))
            return ServiceAnswer(files=masks.encode(found), model_version=self.model.name, finish_reason="done")

        found = masks.decode(dict(self.services.ask(request, send).files))
        return masks.segments(found, image.shape[:2], inside=self.config.mask_threshold, most=self.config.same)

    def names(self, result: ImageResult, *, where: Surroundings, seed: int) -> list[str]:
        """What is looked for in an image: short nouns in lower case, each once, none of them a part of the building."""
        most = self.config.most_labels
        own = searchable(self.config.labels.split(","), most=most)
        return own or searchable(self._proposed(result, where, seed), most=most) or list(usual_things(where.room))[:most]

    def close(self) -> None:
        self.model.close()

    def _proposed(self, result: ImageResult, where: Surroundings, seed: int) -> list[str]:
        if not isinstance(self.language, NamingBackend):
            return []
        try:
            return self.language.name_things(where.theme, where.room, result.rgb, seed=seed)
        except RefusedError:  # it names nothing, and asking again would be answered the same
            return []


def make(config: Settings, context: SceneContext | None = None) -> Sam3Text:
    """The backend. It loads its model when it is first asked for something that is not answered yet."""
    return Sam3Text(config, LocalModel(config, load_detector, extra=EXTRA))
