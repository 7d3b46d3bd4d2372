"""The offline depth model: the depth that the painter drew, with the errors of a monocular depth estimator.

Such estimators give relative depth: with an unknown scale and shift, a relative error that varies slowly over the image, and
edges that are blurred.
"""

import dataclasses

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter

from wm.bounds import number, setting
from wm.schema import BackendSettings
from wm.synth.backends import ImageResult, SceneContext
from wm.synth.registry import DRAWN
from wm.types import Camera

VERSION = "1"
REQUIRES = (DRAWN,)
_KNOT = 24.0  # pixels over which the error is correlated, at 688 wide


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """The errors of the estimates."""

    backend: str = setting(__name__, "The offline depth model.")
    noise: float = number(0.01, 0, 10, "Relative error of the depth.")
    softness: float = number(0.35, 0, 100, "Distance over which edges are blurred.", unit="px")


@dataclasses.dataclass(frozen=True)
class ProceduralDepth:
    """The backend."""

    config: Settings

    def estimate(self, result: ImageResult, *, camera: Camera | None = None, seed: int) -> Float[np.ndarray, "h w"] | None:
        """[h, w] float32 depth up to scale and shift, NaN where nothing was drawn; None for an image without drawn depth."""
        if result.drawn_depth is None:
            return None
        rng = np.random.default_rng(np.random.SeedSequence([seed, 0xDE97]))
        depth = result.drawn_depth.astype(np.float32)
        drawn = depth > 0
        soft = _softened(depth, drawn, self.config.softness)
        noise = gaussian_filter(rng.normal(size=depth.shape), _KNOT * depth.shape[1] / 688, mode="nearest")
        noise /= max(float(noise.std()), 1e-9)
        scale, shift = np.exp(rng.normal() * 0.2), rng.uniform(0.0, 0.3)
        estimate = scale * soft * (1 + self.config.noise * noise) + shift
        return np.where(drawn, estimate, np.nan).astype(np.float32)


def make(config: Settings, context: SceneContext | None) -> ProceduralDepth:
    """The offline depth backend. It does not use the scene."""
    return ProceduralDepth(config=config)


def _softened(depth: np.ndarray, drawn: np.ndarray, sigma: float) -> np.ndarray:
    """Depth blurred by a gaussian of `sigma` pixels, averaged over drawn pixels only."""
    if sigma <= 0:
        return depth
    weight = gaussian_filter(drawn.astype(np.float32), sigma, mode="nearest")
    return gaussian_filter(depth * drawn, sigma, mode="nearest") / np.maximum(weight, 1e-6)
