"""FLUX.2 [klein] of Black Forest Labs, on this machine: a distilled image model that is shown the condition and the reference.

A view is drawn on a canvas whose sides are multiples of 16 and whose area is at most a megapixel, since the model would scale
larger conditions by itself and they would no longer register with what it draws. One view is drawn at a time: the pipeline shares
the images of a batch between its prompts.

Source: diffusers' Flux2KleinPipeline. Licences: 4B Apache-2.0, 9B FLUX Non-Commercial.
"""

import bisect
import dataclasses
import io
from typing import Any

import numpy as np
from PIL import Image

from wm.bounds import choice, number, setting
from wm.models.access import optional_module
from wm.models.image.canvas import canvas_size, scaled
from wm.models.local_model import WEIGHTS, LocalModel, LocalSettings
from wm.models.weights import Weights, load, load_whole
from wm.schema import BESIDE
from wm.services.faults import ServiceError
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.backends import ImageRequest, ImageResult, SceneContext

VERSION = "1"
SERVED = True
_EXTRA = "diffusers"
_SIDE = 16  # pixels: sides are multiples of it (a patch of 2 x 2 latents of 8 pixels)
_LEAST_SIDE = 64  # pixels: smaller images are refused by the pipeline
_LARGEST = 1024 * 1024  # pixels: larger conditions are scaled down by the pipeline
_TOKENS = 512  # what the pipeline reads of a prompt
_IMAGE, _PROMPT = "image.png", "prompt.txt"
_TYPES = ("bfloat16", "float32", "float16")


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(LocalSettings):
    """Which weights, and how they draw."""

    backend: str = setting(__name__, "FLUX.2 [klein] on this machine.")
    model: str = setting("black-forest-labs/FLUX.2-klein-4B@e7b7dc27f91deacad38e78976d1f2b499d76a294", WEIGHTS)
    dtype: str = choice("bfloat16", _TYPES, "Type of the weights and of the arithmetic.")
    steps: int = number(4, 1, 1000, "Denoising steps; distilled weights need 4, base weights about 50.")
    guidance: float = number(1.0, 1, 30, "Strength of the prompt, for base weights only; 1: off.")
    least_megapixels: float = number(
        0.25, 0, 1, "Smaller views are drawn on a canvas of this area and scaled down.", unit="megapixels"
    )
    offload: str = choice(
        "none", ("none", "model", "sequential"),
        "What stays in main memory while it does not compute: nothing, whole parts (slower), single layers (slowest).", **BESIDE,
    )  # fmt: skip


@dataclasses.dataclass(frozen=True, eq=False)
class Flux2Klein:
    """The backend."""

    settings: Settings
    model: LocalModel[Any]
    services: Services = dataclasses.field(default_factory=Services)

    def with_services(self, services: Services) -> "Flux2Klein":
        return dataclasses.replace(self, services=services)

    def quote(self) -> Quote:
        return self.services.quote(self.model.title, paid=False)

    def close(self) -> None:
        self.model.close()

    def generate(self, request: ImageRequest) -> ImageResult:
        """One image of the view, drawn over its condition.

        Raises:
          RefusedError: the image has values that are not numbers.
          ServiceError: the model cannot be loaded, does not fit into memory, or cannot read so long a prompt.
          MissingExtraError: diffusers is not installed.
        """
        camera = request.view.camera
        shown = {"condition": self._on_canvas(request.condition.rgb)}
        if request.reference is not None:
            shown["reference"] = self._on_canvas(request.reference)
        asked = {
            "prompt": request.prompt, "seed": request.seed, "steps": self.settings.steps, "guidance": self.settings.guidance,
            "dtype": self.settings.dtype, **shown,
        }  # fmt: skip
        answer = self.services.ask(
            ServiceRequest(backend=__name__, model=self.model.name, content=asked, paid=False),
            lambda: self.model.run(lambda pipe: self._drawn(pipe, request, list(shown.values()))),
        )
        record = answer.record | {"model": self.model.name}
        if _PROMPT in answer.files:
            record["prompt"] = answer.files[_PROMPT].decode()
        return ImageResult(rgb=scaled(_decoded(answer.files[_IMAGE]), camera.width, camera.height), record=record)

    def _on_canvas(self, rgb: np.ndarray) -> np.ndarray:
        height, width = rgb.shape[:2]
        smallest = min(round(self.settings.least_megapixels * 1e6), _LARGEST)
        size = canvas_size(width, height, multiple=_SIDE, largest=_LARGEST, smallest=max(smallest, 1), least_side=_LEAST_SIDE)
        return np.round(np.clip(scaled(rgb, *size), 0, 1) * 255).astype(np.uint8)

    def _drawn(self, pipe: Any, request: ImageRequest, shown: list[np.ndarray]) -> ServiceAnswer:
        generator = optional_module("torch", _EXTRA).Generator("cpu")  # the same noise on every device
        height, width = shown[0].shape[:2]
        prompt = fitting_prompt(request.prompt, request.theme, lambda text: _tokens(pipe.tokenizer, text))
        if prompt != request.prompt:
            self.services.say(f"{self.model.name} reads {_TOKENS} tokens of a prompt: the end of the theme is left out")
        rgb = pipe(
            prompt=prompt, image=[Image.fromarray(rgb) for rgb in shown], height=height, width=width,
            num_inference_steps=self.settings.steps, guidance_scale=self.settings.guidance,
            generator=generator.manual_seed(request.seed), output_type="np",
        ).images[0]  # fmt: skip
        if not np.isfinite(rgb).all():
            return ServiceAnswer(refusal=f"the image has values that are not numbers; dtype={_TYPES[1]} may help")
        files = {_IMAGE: _encoded(rgb)} | ({_PROMPT: prompt.encode()} if prompt != request.prompt else {})
        return ServiceAnswer(files=files, model_version=self.model.name, finish_reason="done", usage={"images": 1, "requests": 1})


def fitting_prompt(prompt: str, theme: str, tokens: Any, most: int = _TOKENS) -> str:
    """The prompt, with as many of the theme's last words left out as it takes to come down to `most` tokens.

    Args:
      prompt: what the model is to be told.
      theme: the part of it that may be shortened.
      tokens: the number of tokens of a text.
      most: the number of tokens that the model reads.

    Raises:
      ServiceError: the rest of the prompt alone is too long.
    """
    if tokens(prompt) <= most:
        return prompt
    words = theme.split()
    shorter = [prompt.replace(theme, " ".join(words[:kept])) for kept in range(1, len(words))] if theme in prompt else []
    fitting = bisect.bisect_right(shorter, most, key=tokens)
    if not fitting:
        raise ServiceError(f"the prompt has {tokens(prompt)} tokens, and the model reads {most}: a shorter theme would be right")
    return shorter[fitting - 1]


def _tokens(tokenizer: Any, prompt: str) -> int:
    """Tokens of a prompt as the pipeline puts it to its text model."""
    said = [{"role": "user", "content": prompt}]
    text = tokenizer.apply_chat_template(said, tokenize=False, add_generation_prompt=True, enable_thinking=False)
    return len(tokenizer(text)["input_ids"])


def _encoded(rgb: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(np.round(np.clip(rgb, 0, 1) * 255).astype(np.uint8)).save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()


def _decoded(png: bytes) -> np.ndarray:
    with Image.open(io.BytesIO(png)) as image:
        return np.asarray(image.convert("RGB")).astype(np.float32) / np.float32(255)


def _load(weights: Weights, device: str, dtype: Any, offload: str) -> Any:
    """The pipeline. Its parts are loaded one by one, so that none lacks weights."""
    diffusers, transformers = (optional_module(name, _EXTRA) for name in ("diffusers", "transformers"))
    kinds = {
        "transformer": diffusers.Flux2Transformer2DModel, "vae": diffusers.AutoencoderKLFlux2,
        "text_encoder": transformers.Qwen3ForCausalLM,
    }  # fmt: skip
    parts = {name: load_whole(kind, weights, subfolder=name, dtype=dtype) for name, kind in kinds.items()}
    pipe = load(diffusers.Flux2KleinPipeline, weights, **parts)
    pipe.set_progress_bar_config(disable=True)
    if device == "cpu" or offload == "none":
        pipe.to(device)
    elif offload == "model":
        pipe.enable_model_cpu_offload(device=device)
    else:
        pipe.enable_sequential_cpu_offload(device=device)
    return pipe


def make(settings: Settings, context: SceneContext | None) -> Flux2Klein:
    """The backend. It does not use the scene. Weights are loaded when the first image is asked for."""
    needed = ("diffusers", "accelerate")
    return Flux2Klein(settings, LocalModel(settings, _load, extra=_EXTRA, packages=needed, options=(settings.offload,)))
