"""The offline objects backend: parametric furniture in the style of the theme, arranged by the type of the room."""

import dataclasses

from wm.bounds import setting
from wm.offline.arrangement.furnishing import furnish_room
from wm.offline.style.theme import style_of
from wm.offline.style.words import read_theme
from wm.schema import ObjectsSettings
from wm.synth.backends import HeardTheme, SceneContext
from wm.types import SceneObject

VERSION = "2"


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(ObjectsSettings):
    """The generator has no knobs of its own."""

    backend: str = setting(__name__, "The offline generator of furnished rooms.")


@dataclasses.dataclass(frozen=True)
class ProceduralObjects:
    """Furnishes rooms according to the theme, the name of the room and the seed."""

    def furnish(self, context: SceneContext, room: int) -> list[SceneObject]:
        """The objects of one room, placed in world space.

        Args:
          room: index into the plan's rooms.

        Raises:
          ValueError: the density of the context is not between 0 and 1.
        """
        style, seed = style_of(context.theme), context.seed_of("furnish")
        return furnish_room(context.plan, room, style, seed=seed, density=context.density, around=context.objects)


def make(settings: Settings, context: SceneContext | None = None) -> ProceduralObjects:
    """The offline objects backend. It keeps no reference to the scene."""
    return ProceduralObjects()


def heard(theme: str) -> HeardTheme:
    """What the offline world makes of a theme's words."""
    reading = read_theme(theme)
    return HeardTheme(used=reading.used, idle=reading.idle, unknown=reading.unknown)
