"""What an image model is shown and told for a view."""

import dataclasses
from typing import Any

import numpy as np
from jaxtyping import UInt8

from wm.color import to_bytes
from wm.models.image.registration import ImageCanvas, placed
from wm.models.prompt_files import Prompts
from wm.synth.backends import ImageRequest


@dataclasses.dataclass(frozen=True, eq=False)
class DrawingRequest:
    """One request to an image model."""

    canvas: ImageCanvas
    prompt: str
    guide: UInt8[np.ndarray, "H W 3"]  # the condition, on the canvas
    reference: UInt8[np.ndarray, "h w 3"] | None  # as it is

    @property
    def images(self) -> list[np.ndarray]:
        """What goes with the prompt, in the order in which the prompt speaks of it."""
        return [self.guide] if self.reference is None else [self.guide, self.reference]

    @property
    def content(self) -> dict[str, Any]:
        """All of it by name, as `wm.services.records.ServiceRequest` wants it."""
        return {"prompt": self.prompt, "guide": self.guide, "reference": self.reference}


def drawing_of(request: ImageRequest, canvas: ImageCanvas, prompts: Prompts) -> DrawingRequest:
    """What a model of a family is asked for a view.

    Args:
      request: what is wanted.
      canvas: the image that the model is to draw.
      prompts: of the model's family: paint and furnish.

    Raises:
      PromptError: a prompt of the user's cannot be filled in.
    """
    return DrawingRequest(
        canvas=canvas,
        prompt=_prompt(request, prompts),
        guide=placed(to_bytes(request.condition.rgb), canvas),
        reference=None if request.reference is None else to_bytes(request.reference),
    )


def _prompt(request: ImageRequest, prompts: Prompts) -> str:
    """Our own prompt for the model; that of the method where the request does not say what it was written from."""
    if not request.theme:
        return request.prompt
    told: dict[str, Any] = {"theme": request.theme, "room": request.room, "sights": list(request.sights)}
    if request.task == "paint":
        told["objects"] = request.condition.objects
    return prompts.write(request.task, reference=request.reference is not None, **told)
