"""The instance that clicks mean, segmented by Sam3TrackerModel.

Positions: x of a click is in pixels of the image, with the first pixel's middle at 0.5. The model takes pixels of its square of
side s and adds the half itself, so that it is given x s / w - 1/2.
Of one click the model offers three masks (a part, a thing, a group), and the one that it says is best is taken; more clicks say
what is meant, and it is asked for one mask. Source: transformers 5.24, models/sam3_tracker.
"""

import collections
from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import UInt8

from wm.models.access import optional_module
from wm.models.local_model import LocalModel
from wm.models.segmentation.masks import FoundMasks, halves
from wm.models.segmentation.sam3 import EXTRA, Sam3Settings, check_finite, image_tensor, load_tracker
from wm.synth.backends import Click
from wm.synth.lifting.drawings import pixel_digest

_IMAGES = 4
"""Images whose embeddings are kept, 20 MB each."""


class Tracker:
    """The model, with the embeddings of the last images."""

    def __init__(self, settings: Sam3Settings):
        self.model: LocalModel[Any] = LocalModel(settings, load_tracker, extra=EXTRA)
        self._embedded: collections.OrderedDict[str, list[Any]] = collections.OrderedDict()
        self.encoded = 0
        """Images that it has encoded."""

    def mask(self, rgb: UInt8[np.ndarray, "h w 3"], clicks: Sequence[Click]) -> FoundMasks:
        """The one mask that the clicks mean, with the IoU that the model expects it to have as score; the label is empty.

        Raises:
          MissingExtraError, ServiceError: the model cannot be loaded, or computes values that are not finite.
        """
        return self.model.run(lambda model: self._mask(model, rgb, clicks))

    def close(self) -> None:
        """Gives the memory back. Asking again loads the model again."""
        self._embedded.clear()
        self.model.close()

    def _mask(self, model: Any, rgb: np.ndarray, clicks: Sequence[Click]) -> FoundMasks:
        points, signs = _prompt(model, rgb.shape[:2], clicks)
        out = model(
            image_embeddings=self._embeddings(model, rgb),
            input_points=points,
            input_labels=signs,
            multimask_output=len(clicks) == 1,
        )
        scores, masks = out.iou_scores[0, 0].float(), out.pred_masks[0, 0].float()
        check_finite(str(model.dtype).removeprefix("torch."), scores, masks)
        best = int(scores.argmax())
        score = min(max(float(scores[best]), 0.0), 1.0)
        return FoundMasks(halves(masks[best].cpu().numpy())[None], ("",), (score,))

    def _embeddings(self, model: Any, rgb: np.ndarray) -> list[Any]:
        key = pixel_digest(rgb)
        if key not in self._embedded:
            self._embedded[key] = model.get_image_embeddings(image_tensor(rgb, model))
            self.encoded += 1
        self._embedded.move_to_end(key)
        while len(self._embedded) > _IMAGES:
            self._embedded.popitem(last=False)
        return self._embedded[key]


def _prompt(model: Any, shape: tuple[int, ...], clicks: Sequence[Click]) -> tuple[Any, Any]:
    """[1, 1, n, 2] points and [1, 1, n] labels, 1 on the thing and 0 beside it."""
    torch = optional_module("torch", EXTRA)
    scale = model.config.vision_config.image_size / np.array([shape[1], shape[0]], np.float64)
    points = np.array([[click.x, click.y] for click in clicks], np.float64) * scale - 0.5
    signs = [int(click.on) for click in clicks]
    # not of the model's type: bfloat16 has steps of 4 pixels there, and the model converts them once they are in [-1, 1]
    as_points = torch.tensor(points, dtype=torch.float32, device=model.device)[None, None]
    return as_points, torch.tensor(signs, dtype=torch.int64, device=model.device)[None, None]
