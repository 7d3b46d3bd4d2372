"""The rasterizer on the bench scene: image and gradient against a render without cuts, over every constant of its settings.

The reference is the same code with cuts so low that nothing is left out. How far that is from the float64 twin, which no scene of
this size fits, is the row `twin`: a crowd of gaussians on a small image. A reused plan is charged its share of the planning;
what it costs is order: the far wall of the bench scene faces the camera, and its gaussians pass one another at the least move.
"""

import dataclasses
import functools
from collections.abc import Iterator

import bench
import jax
import numpy as np

from wm.schema import FitSettings, RasterSettings
from wm.splat import WIDE, plan_tiles, project, rasterize
from wm.splat.rasterizer._reference import render_reference

EXACT = RasterSettings(alpha_min=1e-6, transmittance_min=0.0)
DEFAULT = RasterSettings()
SWEEPS = {
    "alpha_min": (1 / 32, 1 / 64, 1 / 128, 1 / 255, 1 / 512, 1 / 1024, 1e-4),
    "transmittance_min": (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0),
    "tile": (4, 8, 16),
    "chunk": (4, 8, 16),
    "block": (16, 64, 256),
}
REUSE = (1, 2, 4, 8)
"""Steps that a plan is used for: error of the last of them, gaussians moving at the learning rates of a fit."""
PANELS = [("step_ms", "rgb_rms", "log"), ("step_ms", "rgb_max", "log"), ("step_ms", "gradient", "log")]


def rows(tiny: bool, world) -> Iterator[dict]:
    bench.prepare_one_core()
    speed = bench.sibling("splat_speed", "bench_scene")
    n, width, height, repeats = (2000, 64, 48, 2) if tiny else (100_000, 688, 384, 15)
    case = Case(gaussians=speed.scene(n, 1.0), camera=speed.camera_of(width, height), repeats=repeats)
    exact = case.result(EXACT)
    yield {"vary": "twin", "value": "float64", "default": False, **twin(speed)}
    for name, values in SWEEPS.items():
        for value in values:
            settings = dataclasses.replace(DEFAULT, **{name: value})
            labels = {"vary": name, "value": _label(value), "default": settings == DEFAULT}
            yield labels | errors(case.result(settings), exact) | case.times(settings, 1)
    for steps in REUSE:
        drifted = case.drifted(steps - 1)
        fresh, stale = drifted.result(DEFAULT), drifted.result(DEFAULT, planned=case.gaussians)
        labels = {"vary": "plan reuse", "value": steps, "default": steps == 1}
        yield labels | errors(stale, fresh) | case.times(DEFAULT, steps)


@dataclasses.dataclass(frozen=True, eq=False)
class Case:
    """Gaussians before a camera."""

    gaussians: object
    camera: object
    repeats: int

    def result(self, settings: RasterSettings, planned=None):
        """(rgb, vector-Jacobian product for a fixed random cotangent), planned from other gaussians if given."""
        size = (self.camera.width, self.camera.height)
        projected = _project(self.gaussians, self.camera, settings)
        source = projected if planned is None else _project(planned, self.camera, settings)
        plan = plan_tiles(source, *size, settings)
        image = _shoot(projected, plan, *size, settings)
        gradient = _pull(projected, plan, *size, settings)
        return np.asarray(image.rgb), np.concatenate([np.asarray(gradient.mean2d).ravel(), np.asarray(gradient.opacity)])

    def times(self, settings: RasterSettings, steps: int) -> dict[str, float]:
        """Median ms: planning (its share of each step), forward, and all of a step but the projection."""
        size = (self.camera.width, self.camera.height)
        projected = _project(self.gaussians, self.camera, settings)
        plan = plan_tiles(projected, *size, settings)
        ms = bench.median_ms(
            {
                "plan_ms": lambda: plan_tiles(projected, *size, settings),
                "forward_ms": functools.partial(_shoot, projected, plan, *size, settings),
                "both_ms": functools.partial(_pull, projected, plan, *size, settings),
            },
            self.repeats,
        )
        return {
            "plan_ms": ms["plan_ms"] / steps,
            "forward_ms": ms["forward_ms"],
            "step_ms": ms["plan_ms"] / steps + ms["both_ms"],
        }

    def drifted(self, steps: int) -> "Case":
        """After some steps at the rates of a fit, each gaussian in a direction of its own."""
        rates, rng = FitSettings(), np.random.default_rng(3)
        by_leaf = {"means": rates.lr_means, "quats": rates.lr_quats, "log_scales": rates.lr_scales, "sh": rates.lr_sh}
        by_leaf["opacity_logits"] = rates.lr_opacities
        moved = {
            name: leaf + np.float32(steps * by_leaf[name]) * rng.uniform(-1, 1, leaf.shape).astype(np.float32)
            for name, leaf in vars(self.gaussians).items()
        }
        return dataclasses.replace(self, gaussians=dataclasses.replace(self.gaussians, **moved))


_project = jax.jit(project, static_argnums=2)
_shoot = jax.jit(rasterize, static_argnums=(2, 3, 4), compiler_options=WIDE)


@functools.partial(jax.jit, static_argnums=(2, 3, 4), compiler_options=WIDE)
def _pull(projected, plan, width: int, height: int, settings: RasterSettings):
    """Derivative of a fixed random weighting of the colours."""
    weights = jax.random.normal(jax.random.key(1), (height, width, 3))
    return jax.grad(lambda p: (weights * rasterize(p, plan, width, height, settings).rgb).sum())(projected)


def errors(found, exact) -> dict[str, float]:
    """Root mean square and largest error of the colours; error of the derivative relative to its size."""
    difference = found[0] - exact[0]
    relative = np.linalg.norm(found[1] - exact[1]) / np.linalg.norm(exact[1])
    return {
        "rgb_rms": float(np.sqrt(np.mean(difference**2))),
        "rgb_max": float(np.abs(difference).max()),
        "gradient": float(relative),
    }


def twin(speed) -> dict[str, float]:
    """The reference's colours against float64, on a scene that float64 without tiles can hold; not timed."""
    case = Case(gaussians=speed.scene(1500, 1.0), camera=speed.camera_of(48, 32), repeats=1)
    with jax.enable_x64(True):
        gaussians, camera = jax.tree.map(lambda x: np.asarray(x, np.float64), (case.gaussians, case.camera))
        exact = np.asarray(render_reference(gaussians, camera, settings=EXACT).rgb)
    found, gradient = case.result(EXACT)
    row = errors((found, gradient), (exact, gradient))
    return {name: row[name] for name in ("rgb_rms", "rgb_max")}


def _label(value: float) -> str:
    return f"1/{round(1 / value)}" if 0 < value < 0.1 and abs(1 / value - round(1 / value)) < 1e-6 else f"{value:g}"
