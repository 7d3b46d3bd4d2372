"""A checkpoint of SAM 3: which one, and how its models are loaded.

The hub's facebook/sam3 holds two models that share an image encoder: the detector, which takes words, and the tracker, which
takes clicks. transformers fills weights that a file lacks with random numbers and only logs it, so missing weights are refused.
"""

import contextlib
import dataclasses
import functools
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np
from jaxtyping import UInt8

from wm.artifacts.digests import content_digest, digest
from wm.bounds import choice, setting
from wm.schema import BESIDE, BackendSettings
from wm.services.faults import MissingExtraError, ServiceError

_SAMPLE = 1 << 16
"""Bytes at either end of a file of weights that tell it from others."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Sam3Settings(BackendSettings):
    """Which checkpoint of SAM 3, and where it is computed."""

    model: str = setting("facebook/sam3", "A checkpoint of the hub (its licence has to be accepted there once), or a folder.")
    revision: str | None = setting(None, "Commit or branch of the hub; null: the newest.")
    device: str = setting("auto", "Where it is computed, such as cuda:1 or cpu; auto: a GPU if there is one.", **BESIDE)
    dtype: str = choice("float32", ("float32", "bfloat16", "float16"), "Numbers that the model computes with.")


def model_name(settings: Sam3Settings) -> str:
    """What tells a checkpoint from others: name and revision on the hub; of a folder its name and a digest of what is in it."""
    folder = pathlib.Path(settings.model)
    if folder.is_dir():
        return f"{folder.resolve().name}@{_fingerprint(folder.resolve())}"
    return settings.model if settings.revision is None else f"{settings.model}@{settings.revision}"


def load_model(kind: str, settings: Sam3Settings) -> Any:
    """A model of transformers, ready to be asked.

    Args:
      kind: the name of its class.

    Raises:
      MissingExtraError: torch or transformers is not installed.
      ServiceError: the checkpoint cannot be loaded, or lacks weights.
    """
    torch, transformers = libraries()
    if pathlib.Path(settings.model).is_absolute() and not pathlib.Path(settings.model).is_dir():
        raise ServiceError(f"segmentation.model={settings.model}: there is no such folder")
    with _told(settings), _quiet(transformers):
        model, report = getattr(transformers, kind).from_pretrained(
            settings.model, revision=settings.revision or "main", dtype=getattr(torch, settings.dtype), use_safetensors=True,
            output_loading_info=True,
        )  # fmt: skip
    if missing := sorted(report["missing_keys"]):
        raise ServiceError(
            f"segmentation.model={settings.model} lacks {len(missing)} weights of {kind} ({', '.join(missing[:2])} ...): it was "
            "saved without this part of SAM 3; the whole checkpoint is facebook/sam3"
        )
    return model.eval().to(device(settings))


def load_tokenizer(settings: Sam3Settings) -> Any:
    """The tokenizer of a checkpoint.

    Raises:
      MissingExtraError, ServiceError: as `load_model`.
    """
    _, transformers = libraries()
    with _told(settings), _quiet(transformers):
        return transformers.CLIPTokenizerFast.from_pretrained(settings.model, revision=settings.revision or "main")


def device(settings: Sam3Settings) -> str:
    """Where the model is computed."""
    torch, _ = libraries()
    if settings.device != "auto":
        return settings.device
    return "cuda" if torch.cuda.is_available() else "cpu"


def image_tensor(rgb: UInt8[np.ndarray, "h w 3"], model: Any) -> Any:
    """[1, 3, s, s] in [-1, 1]: the image stretched to the square that the model takes, as Sam3ImageProcessor does it.

    Source: transformers 5.24, models/sam3/image_processing_sam3.py (resized as bytes, with antialiasing).
    """
    torch, _ = libraries()
    side = model.config.vision_config.image_size
    tensor = torch.from_numpy(np.ascontiguousarray(rgb)).permute(2, 0, 1)[None]
    resized = torch.nn.functional.interpolate(tensor, (side, side), mode="bilinear", antialias=True, align_corners=False)
    return ((resized.float() / 255 - 0.5) / 0.5).to(device=model.device, dtype=model.dtype)


def version_of(model: Any) -> str:
    """The commit of the hub that a model was loaded from; empty for a folder."""
    return getattr(model.config, "_commit_hash", None) or ""


def free_memory(settings: Sam3Settings) -> None:
    """Gives memory of a GPU that nothing uses any more back to others."""
    torch, _ = libraries()
    if device(settings).startswith("cuda"):
        torch.cuda.empty_cache()


def libraries() -> tuple[Any, Any]:
    """torch and transformers.

    Raises:
      MissingExtraError: one is not installed.
    """
    try:
        import torch
        import transformers
    except ImportError as error:
        raise MissingExtraError(f"SAM 3 needs {error.name}, which is not installed: pip install 'wm[sam]'") from error
    return torch, transformers


@contextlib.contextmanager
def _told(settings: Sam3Settings) -> Iterator[None]:
    try:
        yield
    except (OSError, ValueError, RuntimeError) as error:
        said = str(error).strip().splitlines() or [type(error).__name__]
        raise ServiceError(
            f"segmentation.model={settings.model} cannot be loaded: {said[0]} Right would be a folder with the files of "
            "facebook/sam3, or that name once its licence is accepted at https://huggingface.co/facebook/sam3 (hf auth login)"
        ) from error


@contextlib.contextmanager
def _quiet(transformers: Any) -> Iterator[None]:
    """Without transformers' report of weights that were not in a file, which is checked here, and without its progress bars."""
    log = transformers.utils.logging
    level, bars = log.get_verbosity(), log.is_progress_bar_enabled()
    log.set_verbosity_error()
    log.disable_progress_bar()
    try:
        yield
    finally:
        log.set_verbosity(level)
        if bars:
            log.enable_progress_bar()


@functools.cache
def _fingerprint(folder: pathlib.Path) -> str:
    files = sorted(file for file in folder.iterdir() if file.suffix in (".json", ".safetensors", ".txt"))
    return digest(*((file.name, file.stat().st_size, content_digest(_ends(file))) for file in files))[:10]


def _ends(file: pathlib.Path) -> bytes:
    """The first and the last bytes of a file."""
    with file.open("rb") as opened:
        first = opened.read(_SAMPLE)
        opened.seek(max(file.stat().st_size - _SAMPLE, 0))
        return first + opened.read(_SAMPLE)
