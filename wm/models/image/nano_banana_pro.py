"""Google's Gemini image models ("Nano Banana"), by google-genai: condition, style reference and prompt in, an image out.

The service offers ten shapes in three sizes. The condition goes onto the canvas of the nearest shape, and the view is cut out of
the answer (wm.models.image.registration). The seed is sent, and makes an image likelier to come again, but not certain: only the
store of answers does that.

An answer holds parts. Those that are marked as thoughts may hold interim images, and are passed over.

Source: the SDK (google-genai 3.6), https://ai.google.dev/gemini-api/docs/image-generation for shapes and sizes.
"""

import dataclasses
import re
from collections.abc import Mapping
from typing import Any

from wm.bounds import choice, number, setting
from wm.models.access import optional_module, secret
from wm.models.http_client import LazyClient, http_client
from wm.models.http_faults import sdk_fault, status_fault
from wm.models.image.drawing import DrawingRequest
from wm.models.image.drawing_model import DrawingModel
from wm.models.image.pictures import as_png
from wm.models.image.registration import ImageCanvas, nearest_canvas
from wm.models.prompt_files import Prompts, prompts_setting
from wm.schema import BESIDE, BackendSettings
from wm.services.faults import ServiceError, TransientError
from wm.services.records import ServiceAnswer
from wm.synth.backends import SceneContext

VERSION = "1"
SERVED = True
_EXTRA = "gemini"
_KEY = "GEMINI_API_KEY"
_SIZES = {"1K": 1, "2K": 2, "4K": 4}
"""The sizes that the service offers, as multiples of the smallest."""
_SHAPES = {
    "1:1": (1024, 1024), "2:3": (848, 1264), "3:2": (1264, 848), "3:4": (896, 1200), "4:3": (1200, 896),
    "4:5": (928, 1152), "5:4": (1152, 928), "9:16": (768, 1376), "16:9": (1376, 768), "21:9": (1584, 672),
}  # fmt: skip
"""The shapes that the service offers, and their pixels at 1K."""
_IMAGE_TOKENS = {
    "gemini-3-pro-image": {"1K": 1120.0, "2K": 1120.0, "4K": 2000.0},
    "gemini-nano-banana-2.1": {"1K": 1120.0, "2K": 1680.0, "4K": 3780.0},
}
"""Tokens of an image put out, by model (https://ai.google.dev/gemini-api/docs/pricing, 2026-10-09)."""
_ENDINGS = {"image/png": "png", "image/jpeg": "jpg", "image/webp": "webp"}


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """How a Gemini image model is asked. The key is read from GEMINI_API_KEY."""

    backend: str = setting(__name__, "A Gemini image model, by Google's service.")
    model: str = setting("gemini-3-pro-image", "Name of the model, as the service knows it.")
    image_size: str = choice("1K", tuple(_SIZES), "Size of the images that the model draws; views are cut out of them.")
    prompts: str | None = prompts_setting()
    base_url: str | None = setting(None, "Address of the service, without a version; null: Google's own.", **BESIDE)
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
        service=GeminiImages(config),
        prompts=Prompts("image/nano_banana", config.prompts),
        at_once=config.requests_at_once,
    )


def canvases(image_size: str) -> list[ImageCanvas]:
    """What the condition may go onto: all shapes, up to the size that is drawn."""
    sizes = [times for times in _SIZES.values() if times <= _SIZES[image_size]]
    return [ImageCanvas(times * width, times * height, ratio) for ratio, (width, height) in _SHAPES.items() for times in sizes]


class GeminiImages:
    """The service, as a `DrawingService`."""

    def __init__(self, config: Settings):
        self._config = config
        self._http = LazyClient(lambda: http_client(config.time_limit))
        self._client = LazyClient(self._make_client)

    def canvas(self, width: int, height: int) -> ImageCanvas:
        return nearest_canvas(canvases(self._config.image_size), width, height)

    def deciding(self, canvas: ImageCanvas) -> Mapping[str, Any]:
        return {"shape": canvas.ratio, "size": self._config.image_size}

    @property
    def expected(self) -> Mapping[str, float]:
        tokens = next((sizes for name, sizes in _IMAGE_TOKENS.items() if self._config.model.startswith(name)), None)
        return {} if tokens is None else {"image_tokens": tokens[self._config.image_size]}

    def send(self, drawing: DrawingRequest, *, seed: int) -> ServiceAnswer:
        genai, httpx2 = optional_module("google.genai", _EXTRA), optional_module("httpx2", _EXTRA)
        client, key = self._client.get(), secret(_KEY)
        types = genai.types
        images = [types.Part.from_bytes(data=as_png(image), mime_type="image/png") for image in drawing.images]
        config = types.GenerateContentConfig(
            seed=seed % 2**31,  # the service takes 32 bits with a sign
            response_modalities=["IMAGE"],
            image_config=types.ImageConfig(aspect_ratio=drawing.canvas.ratio, image_size=self._config.image_size),
        )
        try:
            return _answer(
                client.models.generate_content(model=self._config.model, contents=[drawing.prompt, *images], config=config)
            )
        except genai.errors.APIError as error:
            raise _fault(error, key) from None
        except (httpx2.HTTPError, httpx2.InvalidURL) as error:
            raise sdk_fault(error, key=_KEY, secret=key) from None
        except ValueError as error:  # of a reply that is no JSON, or other JSON
            raise TransientError(f"the reply is not one of the service: {type(error).__name__}") from None

    def close(self) -> None:
        self._client.close()
        self._http.close()  # the SDK leaves a client that it was given open

    def _make_client(self) -> Any:
        genai, limit = optional_module("google.genai", _EXTRA), self._config.time_limit
        options = genai.types.HttpOptions(
            base_url=self._config.base_url, timeout=round(limit * 1000), httpx_client=self._http.get()
        )
        return genai.Client(api_key=secret(_KEY), vertexai=False, http_options=options)


def _fault(error: Any, key: str) -> TransientError | ServiceError:
    """The fault that an error reply stands for. The service says how long to wait in the body, not in a header."""
    headers, details = dict(error.response.headers), error.details
    inner = details.get("error", details) if isinstance(details, dict) else {}
    listed = inner.get("details") if isinstance(inner, dict) else None
    waits = [one.get("retryDelay") for one in listed or () if isinstance(one, dict)]
    for wait in waits:
        if isinstance(wait, str) and re.fullmatch(r"[\d.]+s", wait):
            headers.setdefault("retry-after", wait[:-1])
    return status_fault(error.code, headers, str(error.message or ""), key=_KEY, secret=key)


def _answer(response: Any) -> ServiceAnswer:
    """What a reply says.

    Raises:
      TransientError: it is not one of the service.
    """
    candidates, feedback = response.candidates, response.prompt_feedback
    if candidates is None and feedback is None and response.usage_metadata is None:
        raise TransientError("the reply is not one of the service: it has neither candidates nor a reason why")
    first = candidates[0] if candidates else None
    parts = [part for part in (first.content.parts if first and first.content else None) or () if not part.thought]
    images = [part.inline_data for part in parts if part.inline_data is not None and part.inline_data.data]
    reason = _name(first.finish_reason) if first else ""
    return ServiceAnswer(
        files={f"image.{_ENDINGS.get(images[-1].mime_type, 'bin')}": images[-1].data} if images else {},
        refusal="" if images else _refusal(_name(feedback.block_reason) if feedback else "", first, reason, parts),
        model_version=response.model_version or "",
        response_id=response.response_id or "",
        finish_reason=reason,
        usage={"requests": 1.0, "images": float(len(images[-1:])), **_usage(response.usage_metadata, bool(images))},
    )


def _refusal(block: str, first: Any, reason: str, parts: list[Any]) -> str:
    """Why there is no image."""
    if first is None:
        return f"the prompt was blocked ({block})" if block else "the answer has no candidate"
    text = " ".join(part.text for part in parts if part.text)
    said = " ".join(text.split())[:200]
    why = f"finish reason {reason}" if reason else "no reason given"
    return f"{'a text in place of an image' if text else 'no image'} ({why}){f': {said}' if said else ''}"


def _usage(usage: Any, drawn: bool) -> dict[str, float]:
    """Tokens. Thoughts are charged like text; a service that does not tell texts from images has put out images only."""
    if usage is None:
        return {}
    put_out, details = usage.candidates_token_count or 0, usage.candidates_tokens_details or []
    images = sum(one.token_count or 0 for one in details if _name(one.modality) == "IMAGE") if details else put_out * drawn
    written = put_out - images + (usage.thoughts_token_count or 0)
    return {"input_tokens": float(usage.prompt_token_count or 0), "output_tokens": float(written), "image_tokens": float(images)}


def _name(member: Any) -> str:
    return getattr(member, "value", None) or ""
