"""OpenAI's GPT image models, by the images edit endpoint: condition, style reference and prompt in, an image out.

The models draw every size within limits, so the condition goes onto a canvas of the view's own shape, to within 1 % (older ones
know three sizes). They draw their own samples and know no seed: another seed is another request, and equal requests give equal
images only through the store of answers.

Source: the SDK (openai 3.57), https://developers.openai.com/api/docs/guides/image-generation.
"""

import base64
import binascii
import dataclasses
from collections.abc import Mapping
from typing import Any

from wm.bounds import choice, number, setting
from wm.models.access import optional_module, secret
from wm.models.http_client import LazyClient, http_client
from wm.models.http_faults import body_fault, sdk_fault
from wm.models.image.drawing import DrawingRequest
from wm.models.image.drawing_model import DrawingModel
from wm.models.image.pictures import as_png
from wm.models.image.registration import ImageCanvas, SizeLimits, nearest_canvas
from wm.models.prompt_files import Prompts, prompts_setting
from wm.schema import BESIDE, BackendSettings
from wm.services.faults import TransientError
from wm.services.records import ServiceAnswer
from wm.synth.backends import SceneContext

VERSION = "1"
SERVED = True
_EXTRA = "openai"
_KEY = "OPENAI_API_KEY"
_LIMITS = SizeLimits(step=16, edge=3840, low=655_360, high=8_294_400, widest=3.0)
"""Sizes that gpt-image-2 and its successors draw."""
_PIXELS = {"1K": 1024 * 1024, "2K": 2560 * 1440, "4K": 3840 * 2160}
_FIXED = [ImageCanvas(1024, 1024), ImageCanvas(1536, 1024), ImageCanvas(1024, 1536)]
"""Sizes that models before gpt-image-2 draw."""
_IMAGE_TOKENS = {"low": 196.0, "medium": 439.0, "high": 1756.0, "xhigh": 3122.0, "max": 7024.0}
"""Tokens of an image of 1024 x 1024 put out by gpt-image-2.5 (https://www.s-anand.net/blog, 2026-09-26)."""
_REFUSALS = ("moderation_blocked", "content_policy_violation")
"""Codes of the status 400 with which the service refuses what it was asked, or what it has drawn."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """How a GPT image model is asked. The key is read from OPENAI_API_KEY."""

    backend: str = setting(__name__, "A GPT image model, by OpenAI's service.")
    model: str = setting("gpt-image-2.6-sunburst", "Name of the model, as the service knows it.")
    image_size: str = choice(
        "1K", tuple(_PIXELS), "About how large the images are that the model draws: 1, 3.7 or 8.3 megapixels."
    )
    quality: str = choice("high", ("auto", *_IMAGE_TOKENS), "How much the model works on an image; older models know up to high.")
    prompts: str | None = prompts_setting()
    base_url: str | None = setting(None, "Address of the service, with /v1; null: OpenAI's own.", **BESIDE)
    time_limit: float = number(300.0, 1, 86400, "Time after which a request is given up and sent again.", unit="s", **BESIDE)
    requests_at_once: int = number(8, 1, 256, "Requests that are under way at the same time.", **BESIDE)


def secrets(config: Settings) -> list[str]:
    """Names of the environment variables that hold what a request needs."""
    return [_KEY]


def make(config: Settings, context: SceneContext | None = None) -> DrawingModel:
    """The backend. It does not use the scene.

    Raises:
      PromptError: a prompt of the user's cannot be used.
    """
    return DrawingModel(
        backend=__name__,
        model=config.model,
        service=OpenAIImages(config),
        prompts=Prompts("image/gpt_image", config.prompts),
        at_once=config.requests_at_once,
    )


class OpenAIImages:
    """The service, as a `DrawingService`."""

    def __init__(self, config: Settings):
        self._config = config
        self._client = LazyClient(self._make_client)

    def canvas(self, width: int, height: int) -> ImageCanvas:
        if self._config.model.startswith("gpt-image-1"):
            return nearest_canvas(_FIXED, width, height)
        return _LIMITS.nearest(width, height, _PIXELS[self._config.image_size])

    def deciding(self, canvas: ImageCanvas) -> Mapping[str, Any]:
        return {"size": _size(canvas), "quality": self._config.quality}

    @property
    def expected(self) -> Mapping[str, float]:
        config = self._config
        if config.quality not in _IMAGE_TOKENS or not config.model.startswith(("gpt-image-2.5", "gpt-image-2.6")):
            return {}
        return {"image_tokens": _IMAGE_TOKENS[config.quality] * _PIXELS[config.image_size] / _PIXELS["1K"]}

    def send(self, drawing: DrawingRequest, *, seed: int) -> ServiceAnswer:
        openai, config = optional_module("openai", _EXTRA), self._config
        client = self._client.get()
        names = ("guide.png", "reference.png")
        images = [(name, as_png(image), "image/png") for name, image in zip(names, drawing.images)]
        faithful = {"input_fidelity": "high"} if config.model.startswith("gpt-image-1.5") else {}  # later ones always are
        try:
            reply = client.images.edit(
                model=config.model, prompt=drawing.prompt, image=images, size=_size(drawing.canvas), quality=config.quality,
                output_format="png", background="opaque", n=1, **faithful,
            )  # fmt: skip
            return _answer(reply, config.model, client.api_key)
        except openai.APIError as error:
            if getattr(error, "status_code", None) == 400 and error.code in _REFUSALS:
                return ServiceAnswer(refusal=f"the safety system refused it ({error.code})", usage={"requests": 1.0})
            raise sdk_fault(error, key=_KEY, secret=client.api_key) from None
        except ValueError as error:  # of a reply that is no JSON
            raise TransientError(f"the reply is not one of the service: {type(error).__name__}") from None

    def close(self) -> None:
        self._client.close()

    def _make_client(self) -> Any:
        openai, limit = optional_module("openai", _EXTRA), self._config.time_limit
        return openai.OpenAI(
            api_key=secret(_KEY), base_url=self._config.base_url, timeout=limit, max_retries=0, http_client=http_client(limit)
        )


def _size(canvas: ImageCanvas) -> str:
    return f"{canvas.width}x{canvas.height}"


def _answer(reply: Any, model: str, key: str) -> ServiceAnswer:
    """What a reply says. The service does not report a version of the model.

    Raises:
      TransientError: it is not one of the service.
      ServiceError: it is an error that no later try helps.
    """
    if getattr(reply, "error", None):
        raise body_fault({"error": reply.error}, key=_KEY, secret=key)
    images = getattr(reply, "data", None)
    if not isinstance(images, list):
        raise TransientError(f"the reply is not one of the service: {type(reply).__name__} without a list of images")
    usage = {"requests": 1.0, **_usage(reply.usage)}
    if not images or not images[0].b64_json:
        return ServiceAnswer(refusal="the answer has no image", usage=usage)
    try:
        content = base64.b64decode(images[0].b64_json, validate=True)
    except binascii.Error as error:
        return ServiceAnswer(refusal=f"its image cannot be read: {error}", usage=usage)
    return ServiceAnswer(
        files={"image.png": content},
        model_version=model,
        response_id=getattr(reply, "_request_id", None) or "",
        usage={**usage, "images": 1.0},
    )


def _usage(usage: Any) -> dict[str, float]:
    """Tokens. A service that does not tell texts from images has put out images only."""
    if usage is None:
        return {}
    texts = getattr(usage.output_tokens_details, "text_tokens", 0) or 0
    images = (usage.output_tokens or 0) - texts
    return {"input_tokens": float(usage.input_tokens or 0), "output_tokens": float(texts), "image_tokens": float(images)}
