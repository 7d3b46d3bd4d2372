"""`DrawingModel`: an image backend that asks a service. How a service is asked, its `DrawingService` knows."""

import dataclasses
from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

from wm.models.image.drawing import DrawingRequest, drawing_of
from wm.models.image.pictures import decoded
from wm.models.image.registration import ImageCanvas, cut_out
from wm.models.prompt_files import Prompts
from wm.services.faults import RefusedError
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.attempt import as_float
from wm.synth.backends import ImageRequest, ImageResult


@runtime_checkable
class DrawingService(Protocol):
    """How one service is asked for images."""

    def canvas(self, width: int, height: int) -> ImageCanvas:
        """What it is asked to draw for a view of this size, in pixels."""
        ...

    def deciding(self, canvas: ImageCanvas) -> Mapping[str, Any]:
        """The settings that the image depends on, by name, beside the model, the seed and the drawing."""
        ...

    @property
    def expected(self) -> Mapping[str, float]:
        """What an image is expected to use, where the settings decide it (`ServiceRequest.expected`)."""
        ...

    def send(self, drawing: DrawingRequest, *, seed: int) -> ServiceAnswer:
        """Sends a request once; as `Services.ask` wants it. Without a refusal the answer has one file, the image."""
        ...

    def close(self) -> None:
        """Closes connections."""
        ...


@dataclasses.dataclass(frozen=True, eq=False)
class DrawingModel:
    """The backend. Several threads may ask at the same time.

    Args:
      backend: dotted path of the module that made it.
      model: as the service names it.
      service: how it is asked.
      prompts: of the model's family: paint and furnish.
      at_once: requests that should be under way.
      services: what it asks through.
    """

    backend: str
    model: str
    service: DrawingService
    prompts: Prompts
    at_once: int
    services: Services = dataclasses.field(default_factory=Services)

    def with_services(self, services: Services) -> "DrawingModel":
        """The same backend, which asks through these."""
        return dataclasses.replace(self, services=services)

    def quote(self) -> Quote:
        """What one image is expected to cost."""
        usd = self.services.prices.expected(self.model, self.service.expected)
        return dataclasses.replace(self.services.quote(self.model, at_once=self.at_once), usd=usd)

    def generate(self, request: ImageRequest) -> ImageResult:
        """The image of a view.

        Raises:
          RefusedError: the model gave no image, one that cannot be read, or one of another shape than the canvas. The answer is
            kept all the same: it was paid, and asking again would be paid again.
          ServiceError: it cannot be reached, or must not be asked any more.
          MissingExtraError, MissingKeyError: the SDK or the key is missing, and there is no kept answer.
          PromptError: a prompt of the user's cannot be filled in.
        """
        camera = request.view.camera
        drawing = drawing_of(request, self.service.canvas(camera.width, camera.height), self.prompts)
        deciding = {**self.service.deciding(drawing.canvas), "seed": request.seed}
        asked = ServiceRequest(
            backend=self.backend,
            model=self.model,
            content={**drawing.content, **deciding},
            expected=self.service.expected,
        )
        answer = self.services.ask(asked, lambda: self.service.send(drawing, seed=request.seed))
        (content,) = answer.files.values()
        try:
            rgb = cut_out(decoded(content), drawing.canvas, camera.width, camera.height)
        except RefusedError as refusal:
            raise RefusedError(f"{self.model}: {refusal}") from None
        told = {"model": self.model, "prompt": drawing.prompt, **deciding}
        return ImageResult(rgb=as_float(rgb), record={**answer.record, **told})

    def close(self) -> None:
        """Closes the connections; the next request opens others."""
        self.service.close()
