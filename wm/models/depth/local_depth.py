"""`LocalDepth`: a depth model in this process, asked for one image at a time; what it says is kept as an array."""

import dataclasses
import io
from collections.abc import Callable
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from wm.models.local_model import LocalModel, LocalSettings
from wm.services.faults import RefusedError
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.backends import ImageResult
from wm.types import Camera

_DEPTH = "depth.npy"


@dataclasses.dataclass(frozen=True, eq=False)
class LocalDepth:
    """A depth backend.

    Args:
      backend: dotted path of the module that made it.
      settings: weights and where they compute.
      model: the model.
      predict: the model's own output for an image, at the image's size, before it is turned into depth.
      depth: z-depth in metres from that output, by the camera.
    """

    backend: str
    settings: LocalSettings
    model: LocalModel[Any]
    predict: Callable[[Any, UInt8[np.ndarray, "h w 3"]], Float[np.ndarray, "h w"]]
    depth: Callable[[Float[np.ndarray, "h w"], Camera], Float[np.ndarray, "h w"]]
    services: Services = dataclasses.field(default_factory=Services)

    def with_services(self, services: Services) -> "LocalDepth":
        return dataclasses.replace(self, services=services)

    def quote(self) -> Quote:
        return self.services.quote(self.model.title, paid=False)

    def close(self) -> None:
        self.model.close()

    def estimate(self, result: ImageResult, *, camera: Camera, seed: int) -> Float[np.ndarray, "h w"] | None:
        """[h, w] float32 z-depth in metres, NaN where there is none; None if the model gives nothing finite. The model draws
        nothing at random, so that the seed changes nothing.

        Raises:
          ServiceError: the model cannot be loaded, or does not fit into memory.
          MissingExtraError: torch or transformers is not installed.
        """
        rgb = np.round(np.clip(result.rgb, 0, 1) * 255).astype(np.uint8)
        asked = {"image": rgb, "dtype": self.settings.dtype}
        try:
            answer = self.services.ask(
                ServiceRequest(backend=self.backend, model=self.model.name, content=asked, paid=False),
                lambda: self.model.run(lambda model: self._answer(self.predict(model, rgb))),
            )
        except RefusedError:
            return None
        depth = self.depth(np.load(io.BytesIO(answer.files[_DEPTH]), allow_pickle=False), camera)
        return np.where(np.isfinite(depth), depth, np.nan).astype(np.float32)

    def _answer(self, output: np.ndarray) -> ServiceAnswer:
        if not np.isfinite(output).any():
            return ServiceAnswer(refusal="the depth has no value that is a number")
        buffer = io.BytesIO()
        np.save(buffer, output.astype(np.float32))
        return ServiceAnswer(
            files={_DEPTH: buffer.getvalue()}, model_version=self.model.name, finish_reason="done", usage={"requests": 1}
        )
