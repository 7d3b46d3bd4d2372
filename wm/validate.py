"""Checks whether a configuration can be run, and reports all its errors together.

Hydra checks the names and types of keys. This module checks their values, also for callers from Python: each value against the
range or the options that are declared with its field (`wm.bounds`), and values against each other. It imports nothing heavy.
"""

import re
from collections.abc import Iterator

from wm.bounds import outside
from wm.errors import InputError
from wm.schema import LONGEST_ROOM_NAME, RunConfig


class ConfigError(InputError):
    """A configuration that cannot be run; the message names the key, its value and the expected values."""


def validate_config(config: RunConfig) -> None:
    """Checks all values, including the settings of backends. Whether the backends exist is checked by wm.synth.registry.

    Raises:
      ConfigError: names each wrong key, its value, and its options or its range.
    """
    problems = list(_values_not_allowed(config))
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
        yield 'scene.rooms=[]: name at least one room (--rooms "hall, kitchen"), or give a plan.file'
    for room in scene.rooms:
        if not room.strip() or not room.isprintable() or len(room) > LONGEST_ROOM_NAME:
            yield f"scene.rooms has {room!r}: a room's name has 1 to {LONGEST_ROOM_NAME} printable characters"


def _values_not_allowed(config: RunConfig) -> Iterator[str]:
    for key, metadata, value in outside(config):
        if "options" in metadata:
            yield f"{key}={value!r}: choose one of {', '.join(metadata['options'])}"
        else:
            bounds = metadata["bounds"]
            yield f"{key}={value!r}: must be {bounds.kind(value)} from {bounds.span}"
