"""Which seed each part of a scene draws from, and the number by which a room's draws differ from another room's."""

import zlib

from wm.geometry.plan.records import FloorPlan
from wm.schema import RunConfig

PARTS = ("plan", "furnish", "finish", "light")
"""Parts of a scene with a seed of their own, named as their records in RunConfig."""


def seed_of(config: RunConfig, part: str) -> int:
    """The seed of one of PARTS: its own where the configuration gives one, otherwise that of the run."""
    own: int | None = getattr(config, part).seed
    return config.seed if own is None else own


def room_number(plan: FloorPlan, room: int) -> int:
    """A number in [0, 2**32) for the draws of a room, from its name and from how many rooms of that name come before it.

    It does not depend on other rooms, so that a room added to a plan leaves the draws of the others as they are.
    """
    name = _plain(plan.rooms[room].name)
    before = sum(_plain(other.name) == name for other in plan.rooms[:room])
    return numbered_name(name, before)


def numbered_name(name: str, before: int) -> int:
    """The number of a room that has this name, with `before` rooms of the same name before it."""
    return zlib.crc32(f"{_plain(name)}#{before}".encode())


def _plain(name: str) -> str:
    return " ".join(name.casefold().replace("_", " ").split())
