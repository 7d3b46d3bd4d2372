"""The offline objects backend: parametric furniture in the theme's style, arranged by the room's type."""

import dataclasses

from wm.bounds import setting
from wm.offline.arrangement.furnishing import furnish_room
from wm.offline.style.theme import style_of
from wm.offline.style.words import read_theme
from wm.schema import BackendSettings
from wm.synth.backends import HeardTheme, SceneContext
from wm.types import SceneObject

VERSION = "2"


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """The generator has no knobs."""

    backend: str = setting(__name__, "The offline generator of furnished rooms.")


@dataclasses.dataclass(frozen=True)
class ProceduralObjects:
    """Furnishes rooms out of the theme's words, the room's name and the seed."""

    def furnish(self, context: SceneContext, room: int) -> list[SceneObject]:
        """The objects of one room, placed in world space.

        Args:
          room: index into the plan's rooms.

        Raises:
          ValueError: the context's density is not a share.
        """
        seed = context.seed_of("furnish")
        return furnish_room(context.plan, room, style_of(context.theme), seed=seed, density=context.density)


def make(settings: Settings, context: SceneContext | None = None) -> ProceduralObjects:
    """The offline objects backend; it keeps nothing of the scene it is made for."""
    return ProceduralObjects()


def heard(theme: str) -> HeardTheme:
    """What the offline world makes of a theme's words."""
    reading = read_theme(theme)
    return HeardTheme(used=reading.used, idle=reading.idle, unknown=reading.unknown)
