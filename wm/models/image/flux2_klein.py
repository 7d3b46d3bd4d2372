"""FLUX.2 [klein] of Black Forest Labs, on this machine: a distilled image model that is shown the condition and the reference.

A view is drawn on a canvas whose sides are multiples of 16 and whose area is at most a megapixel, since the model would scale
larger conditions by itself and they would no longer register with what it draws. One view is drawn at a time: the pipeline shares
the images of a batch between its prompts.

Source: diffusers' Flux2KleinPipeline. Licences: 4B Apache-2.0, 9B FLUX Non-Commercial.
"""

import bisect
import dataclasses
import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from PIL import Image

from wm.bounds import choice, number, setting
from wm.color import to_bytes
from wm.models.access import optional_module
from wm.models.image.drawing import DrawingRequest, drawing_of
from wm.models.image.pictures import as_png, decoded
from wm.models.image.registration import ImageCanvas, cut_out, placed
from wm.models.local_model import WEIGHTS, LocalModel, LocalSettings
from wm.models.prompt_files import Prompts, prompts_setting
from wm.models.weights import Weights, load, load_whole
from wm.schema import BESIDE
from wm.services.faults import ServiceError
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.attempt import as_float
from wm.synth.backends import ImageRequest, ImageResult, SceneContext

VERSION = "1"
SERVED = True
_EXTRA = "diffusers"
_SIDE = 16  # pixels: sides are multiples of it (a patch of 2 x 2 latents of 8 pixels)
_LEAST_SIDE = 64  # pixels: smaller images are refused by the pipeline
_LARGEST = 1024 * 1024  # pixels: larger conditions are scaled down by the pipeline
_LONGEST = 8  # long side by short side: the pipeline refuses longer images
_TOKENS = 512  # what the pipeline reads of a prompt
_IMAGE, _PROMPT = "image.png", "prompt.txt"
_TYPES = ("bfloat16", "float32", "float16")


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(LocalSettings):
    """Which weights, and how they draw."""

    backend: str = setting(__name__, "FLUX.2 [klein] on this machine.")
    prompts: str | None = prompts_setting()
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
    """The backend.

    Args:
      settings: which weights, and how they draw.
      model: the pipeline.
      prompts: of the model's family: paint and furnish.
      services: what it asks through.
    """

    settings: Settings
    model: LocalModel[Any]
    prompts: Prompts
    services: Services = dataclasses.field(default_factory=Services)

    def with_services(self, services: Services) -> "Flux2Klein":
        """The same backend, which asks through these."""
        return dataclasses.replace(self, services=services)

    def quote(self) -> Quote:
        """What one image is expected to cost: time."""
        return self.services.quote(self.model.title, paid=False)

    def close(self) -> None:
        """Frees the memory of the model."""
        self.model.close()

    def generate(self, request: ImageRequest) -> ImageResult:
        """The image of a view, drawn over its condition.

        Raises:
          RefusedError: the image has values that are not numbers.
          ServiceError: the model cannot be loaded, does not fit into memory, or cannot read so long a prompt.
          MissingExtraError: diffusers is not installed.
          PromptError: a prompt of the user's cannot be filled in.
        """
        camera, settings = request.view.camera, self.settings
        drawing = drawing_of(request, self._canvas(camera.width, camera.height), self.prompts)
        if drawing.reference is not None:
            height, width = drawing.reference.shape[:2]
            drawing = dataclasses.replace(drawing, reference=placed(drawing.reference, self._canvas(width, height)))
        deciding = {"seed": request.seed, "steps": settings.steps, "guidance": settings.guidance, "dtype": settings.dtype}
        answer = self.services.ask(
            ServiceRequest(backend=__name__, model=self.model.name, content={**drawing.content, **deciding}, paid=False),
            lambda: self.model.run(lambda pipe: self._drawn(pipe, drawing, request)),
        )
        rgb = cut_out(decoded(answer.files[_IMAGE]), drawing.canvas, camera.width, camera.height)
        prompt = answer.files[_PROMPT].decode() if _PROMPT in answer.files else drawing.prompt
        return ImageResult(rgb=as_float(rgb), record={**answer.record, "model": self.model.name, "prompt": prompt, **deciding})

    def _canvas(self, width: int, height: int) -> ImageCanvas:
        return canvas_of(width, height, smallest=round(self.settings.least_megapixels * 1e6))

    def _drawn(self, pipe: Any, drawing: DrawingRequest, request: ImageRequest) -> ServiceAnswer:
        prompt = fitting_prompt(drawing.prompt, request.theme, lambda text: _tokens(pipe.tokenizer, text))
        shortened = {_PROMPT: prompt.encode()} if prompt != drawing.prompt else {}
        if shortened:
            self.services.say(f"{self.model.title} reads {_TOKENS} tokens of a prompt: the end of the theme is left out")
        generator = optional_module("torch", _EXTRA).Generator("cpu")  # the same noise on every device
        rgb = pipe(
            prompt=prompt, image=[Image.fromarray(rgb) for rgb in drawing.images], height=drawing.canvas.height,
            width=drawing.canvas.width, num_inference_steps=self.settings.steps, guidance_scale=self.settings.guidance,
            generator=generator.manual_seed(request.seed), output_type="np",
        ).images[0]  # fmt: skip
        if not np.isfinite(rgb).all():
            return ServiceAnswer(refusal="the image has values that are not numbers; dtype=float32 may help")
        files = {_IMAGE: as_png(to_bytes(rgb)), **shortened}
        return ServiceAnswer(files=files, model_version=self.model.name, finish_reason="done", usage={"images": 1, "requests": 1})


def canvas_of(width: int, height: int, *, smallest: int = 0) -> ImageCanvas:
    """What is drawn for a view: sides are multiples of 16 from 64 pixels on, and the area is at most 1024^2 pixels, near the
    view's own or, for small views, `smallest`. Of these sizes that whose shape is nearest to the view's, and then the largest.

    Raises:
      ServiceError: there is none; the view is more than 8 times as long as it is high, or as high as it is long.
    """
    scale = max(1.0, math.sqrt(smallest / (width * height)), _LEAST_SIDE / min(width, height))
    scale = min(scale, math.sqrt(_LARGEST / (width * height)))

    def sides(length: int) -> list[int]:
        near = math.floor(length * scale / _SIDE)
        return [side for side in range((near - 1) * _SIDE, (near + 3) * _SIDE, _SIDE) if side >= _LEAST_SIDE]

    sizes = [(w, h) for w, h in itertools.product(sides(width), sides(height)) if w * h <= _LARGEST]
    fitting = [size for size in sizes if max(size) <= _LONGEST * min(size)]
    if not fitting:
        raise ServiceError(f"FLUX.2 draws no image of {width} x {height} pixels: no side may be {_LONGEST} times the other")
    return ImageCanvas(*min(fitting, key=lambda s: (round(abs(math.log(s[0] * height / (s[1] * width))), 9), -s[0] * s[1])))


def fitting_prompt(prompt: str, theme: str, tokens: Callable[[str], int], most: int = _TOKENS) -> str:
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
    shorter = (
        [prompt.replace(theme, " ".join(words[:kept])) for kept in range(1, len(words))] if theme and theme in prompt else []
    )
    fitting = bisect.bisect_right(shorter, most, key=tokens)
    if not fitting:
        raise ServiceError(f"the prompt has {tokens(prompt)} tokens, and the model reads {most}: a shorter theme would be right")
    return shorter[fitting - 1]


def _tokens(tokenizer: Any, prompt: str) -> int:
    """Tokens of a prompt as the pipeline puts it to its text model."""
    said = [{"role": "user", "content": prompt}]
    text = tokenizer.apply_chat_template(said, tokenize=False, add_generation_prompt=True, enable_thinking=False)
    return len(tokenizer(text)["input_ids"])


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
    model = LocalModel(settings, _load, extra=_EXTRA, packages=needed, options=(settings.offload,))
    return Flux2Klein(settings, model, Prompts("image/flux2_klein", settings.prompts))
