"""Which values a configuration may hold: every choice and every range of wm.schema, checked at once.

Hydra checks names and types; this checks what they mean, for callers from Python too. Imports nothing heavy.
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from wm.errors import InputError
from wm.schema import BACKEND_KEYS, COMPOSITORS, EXECUTORS, PLANNERS, RunConfig

CHOICES: Mapping[str, tuple[str, ...]] = {
    "condition.objects": ("textured", "boxes", "none"),
    "raster.compositor": COMPOSITORS,
    "raster.planner": PLANNERS,
    "fit.init": ("flat", "isotropic", "random"),
    "executor": EXECUTORS,
}

# key: (lowest, highest), both allowed but for BELOW. Counts that index arrays have a ceiling that catches a slip of the keyboard.
RANGES: Mapping[str, tuple[float, float]] = {
    "plan.max_iterations": (1, 1000),
    "cameras.width": (16, 16384),
    "cameras.height": (16, 16384),
    "cameras.fov": (5, 150),
    "cameras.eye_height": (0.2, 5),
    "cameras.perimeter": (0, 1000),
    "cameras.overhead": (0, 1000),
    "cameras.wall_offset": (0.05, 5),
    "cameras.prune_angle": (0, 180),
    "cameras.clearance": (0, 2),
    "cameras.heldout_per_room": (0, 1000),
    "furnish.density": (0, 1),
    "texture.texel_size": (0.001, 1),
    "texture.min_facing": (0, 1),
    "texture.occlusion_tolerance": (0, 1),
    "texture.opaque_weight": (1e-6, 1e6),
    "verify.low": (0, 1),
    "verify.high": (0, 1),
    "verify.dilation": (0, 1000),
    "verify.min_recall": (0, 1),
    "verify.tolerance": (0, 10),
    "verify.max_disagreement": (0, 1),
    "verify.max_attempts": (1, 1000),
    "raster.blur": (0, 100),
    "raster.alpha_min": (1e-30, 1),
    "raster.alpha_max": (0, 1),
    "raster.transmittance_min": (0, 1),
    "raster.near": (1e-6, 10),
    "raster.frustum_margin": (1, 10),
    "raster.tile": (1, 64),
    "raster.chunk": (1, 1024),
    "raster.block": (1, 4096),
    "fit.spacing": (0.001, 1),
    "fit.detail_spacing": (0.001, 1),
    "fit.opacity": (0.001, 0.999),
    "fit.steps": (0, 10_000_000),
    "fit.batch": (1, 1000),
    "fit.rounds": (1, 1000),
    "fit.ssim_weight": (0, 1),
    "fit.normal_weight": (0, 1000),
    "fit.depth_weight": (0, 1000),
    "fit.lr_means": (0, 10),
    "fit.lr_quats": (0, 10),
    "fit.lr_scales": (0, 10),
    "fit.lr_opacities": (0, 10),
    "fit.lr_sh": (0, 10),
    "fit.lr_final": (1e-9, 1),
    "fit.lr_exposure": (0, 10),
    "fit.refine_every": (0, 10_000_000),
    "fit.refine_share": (0, 0.5),
    "fit.refine_spare": (0, 10),
    "fit.refine_dead": (1e-6, 0.5),
    "fit.sh_degree": (0, 3),
    "fit.curve_points": (0, 1000),
    "navigation.cell": (0.01, 1),
    "navigation.body_radius": (0, 2),
    "navigation.obstacle_height": (0, 10),
    "evaluate.min_overlap": (0, 1),
    "report.fps": (1, 240),
    "report.walking_speed": (0.05, 50),
    "image.drift": (0, 1),
    "image.imaginations": (0, 100),
    "image.exposure": (0, 1),
    "image.phase": (0, 1000),
    "image.softness": (0, 1000),
    "image.closed": (0, 1),
    "image.missing": (0, 1),
    "image.added": (0, 1),
    "image.moved": (0, 1),
    "image.texel_size": (0.001, 1),
    "image.supersampling": (1, 16),
    "objects.image_width": (16, 16384),
    "objects.image_height": (16, 16384),
    "objects.fov": (5, 150),
    "objects.min_area": (0, 1),
    "objects.ragged": (0, 100),
    "objects.merged": (0, 1),
    "objects.missed": (0, 1),
    "depth.noise": (0, 10),
    "depth.softness": (0, 100),
    "seed": (0, 2**63 - 1),
}


BELOW = frozenset({"texture.min_facing", "raster.transmittance_min"})
"""Keys whose highest value is not reached: one divides by what is left to 1; at the other nothing would be rendered."""


class ConfigError(InputError):
    """A configuration that cannot be run; the message names key, value and what would be right."""


def validate_config(config: RunConfig, *, backends: Mapping[str, tuple[str, ...]]) -> None:
    """Checks every value.

    Args:
      config: the composed run.
      backends: group -> names that can be selected (wm.synth.backends.CHOICES).

    Raises:
      ConfigError: naming every key that is wrong, its value, and the choices or the range.
    """
    values = dict(_leaves(config))
    choices = dict(CHOICES) | {BACKEND_KEYS[group]: names for group, names in backends.items()}
    wrong = {key: names for key, names in choices.items() if values[key] not in names}
    problems = [f"{key}={values[key]!r}: choose one of {', '.join(names)}" for key, names in wrong.items()]
    for key, (low, high) in RANGES.items():
        below = key in BELOW
        if not _within(values[key], low, high) or (below and values[key] == high):
            problems.append(f"{key}={values[key]!r}: must be a number from {low:g} to {'below ' * below}{high:g}")
    if config.workers is not None and not _within(config.workers, 1, 1000):
        problems.append(f"workers={config.workers!r}: must be a number from 1 to 1000, or null for one room per core")
    if config.raster.compositor in ("kernels", "interpreted") and config.raster.tile.bit_count() != 1:
        problems.append(f"raster.tile={config.raster.tile!r}: kernels want a power of two")
    problems += _scene_problems(config)
    if config.verify.low > config.verify.high:
        problems.append(f"verify.low={config.verify.low!r}: must not exceed verify.high={config.verify.high!r}")
    low, high = config.raster.alpha_min, config.raster.alpha_max
    if low >= high:
        problems.append(f"raster.alpha_min={low!r}: must be below raster.alpha_max={high!r}")
    if problems:
        raise ConfigError("; ".join(problems))


def _scene_problems(config: RunConfig) -> Iterator[str]:
    scene = config.scene
    for key, value in (("scene.name", scene.name), ("variant", config.variant), ("preset", config.preset)):
        if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", value):
            yield f"{key}={value!r}: names a folder, so letters, digits, '_', '-' and '.' only"
    if not scene.theme.strip():
        yield "scene.theme='': say in words what the scene should be"
    if not scene.rooms and config.plan.file is None:
        yield "scene.rooms=[]: name at least one room, or give a plan.file"
    for room in scene.rooms:
        if not room.strip() or not room.isprintable() or len(room) > 200:
            yield f"scene.rooms has {room!r}: a room's name has 1 to 200 printable characters"


def _leaves(record: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    for field in fields(record):
        value = getattr(record, field.name)
        if is_dataclass(value):
            yield from _leaves(value, f"{prefix}{field.name}.")
        else:
            yield f"{prefix}{field.name}", value


def _within(value: Any, low: int | float, high: int | float) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value) and low <= value <= high
