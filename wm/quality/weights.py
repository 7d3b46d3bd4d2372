"""The files of weights: where they lie, and whether they are what they should be.

They are safetensors; pickles, as which most of them are published, are not read (experiments/quality/convert.py turns them into
safetensors). A folder may hold both pairs or one of them:

    clip_rn50.safetensors          CLIP RN50, by OpenAI's names
    clip_iqa_prompts.safetensors   the learned vectors of CLIP-IQA+: "ctx" [2, 16, 512]
    clip_vit_l14.safetensors       CLIP ViT-L/14, by OpenAI's names; its image encoder suffices
    aesthetic_head.safetensors     the aesthetic predictor: "layers.0.weight" [1024, 768] ...
"""

import dataclasses
import functools
import importlib
import pathlib
import re
from typing import Any

import jax
import jax.numpy as jnp

from wm.artifacts.digests import file_digest
from wm.errors import InputError
from wm.quality.attention import Weights
from wm.services.faults import MissingExtraError, ServiceError

RN50, PROMPTS = "clip_rn50.safetensors", "clip_iqa_prompts.safetensors"
VIT_L14, HEAD = "clip_vit_l14.safetensors", "aesthetic_head.safetensors"
FILES = (RN50, PROMPTS, VIT_L14, HEAD)
_REPOSITORY = re.compile(r"[\w.-]+/[\w.-]+@[0-9a-f]{40}")


@dataclasses.dataclass(frozen=True, eq=False)
class Checkpoint:
    """A file of weights."""

    path: pathlib.Path

    @functools.cached_property
    def digest(self) -> str:
        """20 hex digits of the content: the same on every machine."""
        return file_digest(self.path)


def find_folder(source: str) -> pathlib.Path:
    """The folder that a setting names: one of this machine, or OWNER/NAME@COMMIT of the Hugging Face hub, which is downloaded.

    Raises:
      InputError: it is neither.
      MissingExtraError: the extra `quality` is not installed.
      ServiceError: the hub does not give it.
    """
    check_source(source)
    folder = pathlib.Path(source).expanduser()
    if folder.is_dir():
        return folder
    name, _, commit = source.partition("@")
    hub = _module("huggingface_hub")
    try:
        return pathlib.Path(hub.snapshot_download(name, revision=commit, allow_patterns=list(FILES)))
    except Exception as error:  # of the hub, of its HTTP client, of the network
        line = (str(error).strip() or type(error).__name__).splitlines()[0]
        raise ServiceError(f"quality={source}: the hub does not give it ({line}); a folder would be right") from error


def check_source(source: str) -> None:
    """Raises: InputError if it is neither a folder with a pair of the files, nor a repository at a commit."""
    folder = pathlib.Path(source).expanduser()
    if not (source and folder.is_dir()) and not _REPOSITORY.fullmatch(source):
        raise InputError(
            f"quality={source!r} is no folder here; a folder with weights, or OWNER/NAME@COMMIT (40 hex digits) of the "
            "Hugging Face hub, would be right (docs/evaluation.md)"
        )
    if folder.is_dir() and not pairs_in(folder):
        raise InputError(f"quality={source}: no weights are in it; {RN50} and {PROMPTS}, or {VIT_L14} and {HEAD}, would be right")


def pairs_in(folder: pathlib.Path) -> list[tuple[str, str]]:
    """Which of the two scores a folder has the weights of."""
    return [pair for pair in ((RN50, PROMPTS), (VIT_L14, HEAD)) if all((folder / name).is_file() for name in pair)]


def read_checkpoint(file: Checkpoint, wanted: tuple[str, ...], *, prefix: str = "") -> Weights:
    """The weights of a file in float32.

    Args:
      file: a safetensors file.
      wanted: names that must be in it.
      prefix: only weights whose names begin with it are read, and those of `wanted`.

    Raises:
      InputError: it cannot be read, or lacks a weight.
      MissingExtraError: the extra `quality` is not installed.
    """
    reader = _module("safetensors")
    try:
        with reader.safe_open(file.path, framework="numpy") as opened:
            names = [name for name in sorted(opened.keys()) if name.startswith(prefix) or name in wanted]
            weights = {name: jnp.asarray(opened.get_tensor(name), jnp.float32) for name in names}
    except Exception as error:  # the reader has errors of its own, and those of the system
        raise InputError(f"{file.path} cannot be read as safetensors: {error}") from error
    lacking = [name for name in wanted if name not in weights]
    if lacking:
        raise InputError(
            f"{file.path} has no {lacking[0]}; weights by the names of OpenAI's CLIP, or of open_clip, would be right"
        )
    return jax.device_put(weights)


def _module(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise MissingExtraError(f"{error.name or name} is not installed: pip install 'wm[quality]'") from error
