"""Refinement within a fixed number of gaussians: transparent ones are reused to split those whose residual stays large.

The residual at gaussian i is large if moving it on the image would lower the loss: s_i = mean of |dL / d mean2d_i| over the
visits that showed it. A dead (transparent) gaussian is reused for the one with the largest s, which is split along its longest
axis. With sigma its standard deviation there, the halves sit at +- sigma / 2 and have sqrt(3/4) sigma, so that centre and
covariance stay. One behind the other their optical depths -ln(1 - alpha) add, and the integral of that along the axis stays too,
which fixes their opacity:

    Li(o') = Li(o) / sqrt(3),  Li(o) = sum over k >= 1 of o^k / k^(3/2)   (integrate the series of the logarithm term by term)

Source: the criterion is that of Kerbl et al., "3D Gaussian Splatting" (2023), the reuse of dead ones that of Kheradmand et al.,
"3DGS as Markov Chain Monte Carlo" (2024). There the halves have the same centre and noise separates them; ours need no noise.
"""

import dataclasses

import jax
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from wm.schema import FitSettings
from wm.splat.optimization.step import TrainState, adam_state
from wm.types import Gaussians

UNTIL = 0.75
"""Share of the steps after which no gaussian is split any more, so that the last halves can converge."""

_OPACITIES = np.linspace(0, 0.99, 500)
_TERMS = np.arange(1, 500)
_DEPTHS = (_OPACITIES[:, None] ** _TERMS / _TERMS**1.5).sum(axis=1)
"""Li of these opacities, up to the rasterizer's clamp."""


@dataclasses.dataclass(frozen=True, eq=False)
class Residual:
    """The gradient of the loss with respect to the projected centres of n gaussians since the last refinement. On the host."""

    gradient_norm: np.ndarray  # [n] float32 sum of |dL / d mean2d|, per pixel
    visits: np.ndarray  # [n] int32 how many visits showed it


def no_residual(count: int) -> Residual:
    """The residual of `count` gaussians before the first visit."""
    return Residual(gradient_norm=np.zeros(count, np.float32), visits=np.zeros(count, np.int32))


def observe(residual: Residual, gradient: Float[np.ndarray, "2 n"]) -> Residual:
    """The residual after a visit, from the derivative of its loss with respect to the projected centres."""
    norm = np.hypot(*gradient)
    return Residual(gradient_norm=residual.gradient_norm + norm, visits=residual.visits + (norm > 0))


def is_due(settings: FitSettings, step: int) -> bool:
    """Whether to refine after `step` steps."""
    return settings.refine_every > 0 and step % settings.refine_every == 0 and step <= UNTIL * settings.steps


def refine(train: TrainState, residual: Residual, settings: FitSettings) -> TrainState:
    """The state with dead gaussians reused; as many as before, in the same order. On the host, no row padded.

    Both halves start without moments. Ties go to the lower index, so equal states give equal bytes.
    """
    dead, split = choose(train.gaussians, residual, settings)
    whole = jax.tree.map(lambda x: x[split], train.gaussians)
    low, high = halves(whole)

    def place(x, a, b):
        x = x.copy()
        x[split], x[dead] = a, b
        return x

    gaussians = jax.tree.map(place, train.gaussians, low, high)
    mu, nu = (jax.tree.map(lambda x: place(x, 0, 0), moment) for moment in (train.moments.mu, train.moments.nu))
    return TrainState(gaussians=gaussians, moments=adam_state(train.moments.count, mu, nu))


def choose(gaussians: Gaussians, residual: Residual, settings: FitSettings) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the dead gaussians to reuse, most transparent first, and of as many to split, largest residual first."""
    threshold = np.log(settings.refine_dead / (1 - settings.refine_dead))
    logits = gaussians.opacity_logits
    score = np.where(logits > threshold, residual.gradient_norm / np.maximum(residual.visits, 1), 0)
    dead = np.argsort(logits, kind="stable")[: np.count_nonzero(logits <= threshold)]
    split = np.argsort(-score, kind="stable")[: np.count_nonzero(score > 0)]
    most = min(len(dead), len(split), int(settings.refine_share * len(logits)))
    return dead[:most], split[:most]


def halves(whole: Gaussians) -> tuple[Gaussians, Gaussians]:
    """The two gaussians that replace each gaussian."""
    rows = np.arange(len(whole.opacity_logits))
    axis = whole.log_scales.argmax(axis=1)
    sigma = np.exp(whole.log_scales[rows, axis].astype(np.float64))
    lengths = np.linalg.norm(whole.quats, axis=1, keepdims=True)
    quats = np.where(lengths > 0, whole.quats, np.array([1.0, 0, 0, 0]))
    along = Rotation.from_quat(quats, scalar_first=True).as_matrix()[rows, :, axis]
    log_scales = whole.log_scales.copy()
    log_scales[rows, axis] += np.float32(0.5 * np.log(0.75))
    opacity = 1 / (1 + np.exp(-whole.opacity_logits.astype(np.float64)))
    opacity = np.interp(np.interp(opacity, _OPACITIES, _DEPTHS) / np.sqrt(3), _DEPTHS, _OPACITIES)
    logits = np.log(opacity / (1 - opacity)).astype(np.float32)
    offset = 0.5 * sigma[:, None] * along
    low, high = (
        dataclasses.replace(whole, means=(whole.means + move).astype(np.float32), log_scales=log_scales, opacity_logits=logits)
        for move in (-offset, offset)
    )
    return low, high
