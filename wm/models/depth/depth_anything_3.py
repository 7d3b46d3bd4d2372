"""Depth by a model in its own interpreter: Depth Anything 3, whose package asks for NumPy below 2 and a GPL reader of PLY files.

    DA3MONO-LARGE    depth up to scale and shift, as it is
    DA3METRIC-LARGE  depth in metres for a camera whose focal length is 300 pixels: z = focal * output / 300, where focal is that
                     of the camera in pixels of the output

The script that serves it was written from its source (commit 2c21ea8) and has not been run with its weights. What
wm does with its answers is tested with other workers. With `script` any other depth model is served (docs/workers.md): it must
answer with depth, not with inverse depth.

Source: Lin et al., "Depth Anything 3: Recovering the visual space from any views", 2025; ByteDance-Seed/Depth-Anything-3 on
GitHub: README, "Monocular Metric Depth", and utils/alignment.py. Licence of its code and of the weights above: Apache-2.0; of the
weights of Large, Giant and Nested: CC BY-NC 4.0.
"""

import dataclasses
import pathlib

import numpy as np
from jaxtyping import Float
from scipy import ndimage

from wm.bounds import number, setting
from wm.models.worker.asking import WorkerModel, answer_arrays, answer_values
from wm.models.worker.settings import WorkerSettings
from wm.services.faults import RefusedError, ServiceError
from wm.services.records import Quote, ServiceAnswer
from wm.services.services import Services
from wm.synth.backends import ImageResult, SceneContext
from wm.types import Camera

VERSION = "1"
SERVED = True
_SCRIPT = pathlib.Path(__file__).with_name("depth_anything_3_worker.py")


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(WorkerSettings):
    """Which weights, and at which resolution they look."""

    backend: str = setting(__name__, "Depth Anything 3 in its own interpreter.")
    checkpoint: str = setting("depth-anything/DA3MONO-LARGE", "Weights: a folder, or a name of the hub.")
    resolution: int = number(504, 14, 10_000, "Longer side of the image that the model is given.", unit="px")


class WorkerDepth:
    """The backend. It holds a process, and with it the memory of a device, until it is closed."""

    def __init__(self, model: WorkerModel):
        self.model = model

    def with_services(self, services: Services) -> "WorkerDepth":
        """The same backend, which asks through these. Both ask the same worker."""
        return WorkerDepth(self.model.with_services(services))

    def quote(self) -> Quote:
        """A local model costs no money, and nobody knows how many seconds."""
        return self.model.quote()

    def close(self) -> None:
        """Ends the worker."""
        self.model.close()

    def estimate(self, result: ImageResult, *, camera: Camera, seed: int) -> Float[np.ndarray, "h w"] | None:
        """[h, w] float32 depth of the image's pixels up to scale and shift, in metres from a metric model, NaN where there is
        none; None if the model gives nothing finite. The model draws nothing at random: the seed changes nothing.

        Raises:
          ServiceError: the worker cannot be run, or does not answer with a depth map.
        """
        rgb = np.round(np.clip(result.rgb, 0, 1) * 255).astype(np.uint8)
        request = {
            "task": "depth", "focal": np.asarray(camera.focal, np.float64).tolist(),
            "principal": np.asarray(camera.principal, np.float64).tolist(),
        }  # fmt: skip
        try:
            answer = self.model.ask(request, {"rgb": rgb})
        except RefusedError:
            return None
        depth = _told(answer, camera, str(self.model.script))
        return at_camera(depth, camera) if np.isfinite(depth).any() else None


def make(settings: Settings, context: SceneContext | None = None) -> WorkerDepth:
    """The backend. It does not use the scene. The worker is started when the first image is to be measured."""
    options = {"checkpoint": settings.checkpoint, "resolution": settings.resolution}
    return WorkerDepth(WorkerModel(settings, options, _SCRIPT))


def at_camera(depth: Float[np.ndarray, "eh ew"], camera: Camera) -> Float[np.ndarray, "h w"]:
    """[h, w] float32 depth at the size of a camera's image: linear between pixel centres, NaN where a neighbour is not finite."""
    finite = np.where(np.isfinite(depth), depth, np.nan).astype(np.float64)
    rows, columns = (
        np.clip((np.arange(many) + 0.5) * few / many - 0.5, 0, few - 1)
        for many, few in zip((camera.height, camera.width), depth.shape)
    )
    found = ndimage.map_coordinates(finite, np.meshgrid(rows, columns, indexing="ij"), order=1, mode="nearest")
    return np.asarray(found, np.float32)


def _told(answer: ServiceAnswer, camera: Camera, script: str) -> Float[np.ndarray, "h w"]:
    """The depth map of an answer, at the resolution of the model, in metres if the answer says for which focal length it is.

    Raises:
      ServiceError: it has no depth map.
    """
    depth, unit = answer_arrays(answer).get("depth"), answer_values(answer).get("focal_of_unit")
    if depth is None or depth.ndim != 2 or not np.issubdtype(depth.dtype, np.floating):
        found = "nothing of that name" if depth is None else f"{depth.dtype} of shape {depth.shape}"
        raise ServiceError(f"{script}: `depth` of an answer must be a floating-point array [h, w]; it is {found}")
    if unit is None:
        return depth.astype(np.float64)
    ratio = np.array(depth.shape[::-1]) / [camera.width, camera.height]
    return depth * (float(np.mean(np.asarray(camera.focal) * ratio)) / float(unit))
