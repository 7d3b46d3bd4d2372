"""The models that lift a room, made together and closed together."""

import contextlib
import dataclasses
import pathlib
from typing import Any

from wm.synth.backends import (
    DepthBackend,
    ImageBackend,
    LanguageBackend,
    ModelSettings,
    NamedSegmentation,
    ReconstructionBackend,
    SceneContext,
    SegmentationBackend,
)
from wm.synth.registry import BackendError, close_backend, make_backend, mismatch


@dataclasses.dataclass(frozen=True, eq=False)
class Models:
    """The backends that lift a room."""

    image: ImageBackend
    depth: DepthBackend
    segmentation: SegmentationBackend
    reconstruction: ReconstructionBackend
    language: LanguageBackend | None = None  # names what the segmentation looks for; None where it asks for no names
    folder: pathlib.Path | None = None  # the run folder

    def close(self) -> None:
        """Closes all of them, the last one first, also where closing one of them fails."""
        with contextlib.ExitStack() as done:
            for backend in (self.image, self.depth, self.language, self.segmentation, self.reconstruction):
                done.callback(close_backend, backend)


def make_models(asked: ModelSettings, context: SceneContext, image: ImageBackend | None = None) -> Models:
    """The models that settings select for a scene, with `image` for the image model if it is given. The caller closes them.

    Raises:
      BackendError: a backend cannot be made, or those selected do not go together.
    """
    if image is None:
        faults = mismatch("depth", asked.depth, asked.image) + mismatch("segmentation", asked.segmentation, asked.image)
        if faults:
            raise BackendError("; ".join(faults))

    def made(group: str, settings: Any) -> Any:
        return make_backend(group, settings, context, asked.services)

    drawing: ImageBackend = image if image is not None else made("image", asked.image)
    depth, segmentation, language = made("depth", asked.depth), made("segmentation", asked.segmentation), None
    if isinstance(segmentation, NamedSegmentation) and asked.language is not None:
        language = make_backend("language", asked.language, None, asked.services)
        segmentation = segmentation.with_language(language)
    return Models(
        image=drawing, depth=depth, segmentation=segmentation, reconstruction=made("reconstruction", asked.reconstruction),
        language=language, folder=asked.folder,
    )  # fmt: skip
