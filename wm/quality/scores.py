"""`Quality`: what an image scores, by the weights that are there."""

import dataclasses
import functools
from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import UInt8

from wm.errors import InputError
from wm.quality.aesthetic import aesthetic, maps_of, prepared
from wm.quality.clip_iqa import clip_iqa, encoded_prompts
from wm.quality.image_tower import side_of_vit
from wm.quality.weights import RN50, VIT_L14, Checkpoint, check_source, find_folder, pairs_in, read_checkpoint

_BLOCK = "transformer.resblocks.0.ln_1.weight"
_TEXT = ("token_embedding.weight", "positional_embedding", "ln_final.weight", "text_projection", "logit_scale", _BLOCK)
_RESNET = ("visual.layer4.0.conv1.weight", "visual.attnpool.c_proj.weight")
_VIT = (
    "visual.conv1.weight",
    "visual.class_embedding",
    "visual.positional_embedding",
    "visual.ln_pre.weight",
    "visual.proj",
    f"visual.{_BLOCK}",
)


_Score = Callable[[UInt8[np.ndarray, "h w 3"]], float]


@dataclasses.dataclass(frozen=True, eq=False)
class Quality:
    """The scores that a folder of weights allows. Use `open_quality`. Weights are read when the first image is scored."""

    files: Mapping[str, tuple[Checkpoint, Checkpoint]]  # by the key of a score

    @property
    def identity(self) -> dict[str, list[str]]:
        """Digests of the weights of each score, for keys of what is made with them."""
        return {key: [file.digest for file in pair] for key, pair in self.files.items()}

    def score(self, rgb: UInt8[np.ndarray, "h w 3"]) -> dict[str, float]:
        """What an image scores, by key: `clip_iqa` from 0 to 1, `aesthetic` from about 1 to 10, each where its weights are there.

        Raises:
          InputError: a file of weights is not what it should be.
          MissingExtraError: the extra `quality` is not installed.
        """
        return {key: model(rgb) for key, model in self._models.items()}

    @functools.cached_property
    def _models(self) -> dict[str, _Score]:
        return {key: _READERS[key](*pair) for key, pair in self.files.items()}


def open_quality(source: str) -> Quality:
    """The scores by the weights of a folder, or of a repository OWNER/NAME@COMMIT of the Hugging Face hub.

    Raises:
      InputError, MissingExtraError, ServiceError: see `wm.quality.weights.find_folder`.
    """
    folder = find_folder(source)
    pairs = pairs_in(folder)
    if not pairs:
        raise InputError(f"quality={source}: no pair of weights is in it (docs/evaluation.md names the files)")
    return Quality(files={_KEYS[a]: (Checkpoint(path=folder / a), Checkpoint(path=folder / b)) for a, b in pairs})


def check_quality(source: str) -> None:
    """Says before a long run whether `open_quality` can work, without reading weights or asking the hub. Raises: InputError."""
    check_source(source)


def _read_iqa(clip: Checkpoint, prompts: Checkpoint) -> _Score:
    weights = read_checkpoint(clip, (*_TEXT, *_RESNET))
    context, width = read_checkpoint(prompts, ("ctx",))["ctx"], weights["positional_embedding"].shape[-1]
    if context.ndim != 3 or context.shape[0] != 2 or context.shape[2] != width:
        shape = " x ".join(map(str, context.shape))
        raise InputError(f"{prompts.path}: ctx is {shape}; 2 x 16 x {width}, the width of {clip.path.name}, would be right")
    encoded = encoded_prompts(context, weights)
    return lambda rgb: float(clip_iqa(rgb.astype(np.float32) / np.float32(255), encoded, weights))


def _read_aesthetic(clip: Checkpoint, head: Checkpoint) -> _Score:
    weights, maps = read_checkpoint(clip, _VIT, prefix="visual."), read_checkpoint(head, ())
    names, width = maps_of(maps), weights["visual.proj"].shape[-1]
    if not names or maps[f"{names[0]}weight"].shape[-1] != width:
        raise InputError(f"{head.path}: no predictor for the {width} channels of {clip.path.name}; see docs/evaluation.md")
    side = side_of_vit(weights)
    return lambda rgb: float(aesthetic(prepared(rgb, side), weights, maps))


_KEYS = {RN50: "clip_iqa", VIT_L14: "aesthetic"}
"""The key of a score, as in wm.metric_table, by the first of its files."""
_READERS: dict[str, Callable[[Checkpoint, Checkpoint], _Score]] = {"clip_iqa": _read_iqa, "aesthetic": _read_aesthetic}
