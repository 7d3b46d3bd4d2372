"""The offline objects backend: parametric furniture in the theme's style, arranged by the room's type."""

import dataclasses

from wm.geometry.plan.site import room_site
from wm.offline.arrangement.arrange import furnish_site, scene_object
from wm.offline.arrangement.room_type import room_type
from wm.offline.style.theme import style_of
from wm.schema import ObjectsConfig
from wm.synth.backends import SceneContext
from wm.types import SceneObject


@dataclasses.dataclass(frozen=True)
class ProceduralObjects:
    """Furnishes rooms out of the theme's words, the room's name and the seed."""

    config: ObjectsConfig

    def furnish(self, context: SceneContext, room: int, *, density: float = 1.0) -> list[SceneObject]:
        """The objects of one room, placed in world space.

        Args:
          room: index into the plan's rooms.
          density: 0..1, the share of the optional pieces that are tried.

        Raises:
          ValueError: the density is not a share.
        """
        if not 0.0 <= density <= 1.0:
            raise ValueError(f"furnish.density is {density}; it is the share of the optional pieces, between 0 and 1")
        kind = room_type(context.plan.rooms[room].name)
        placed = furnish_site(
            room_site(context.plan, room), kind, style_of(context.theme), seed=context.seed, room=room, density=density
        )
        return [scene_object(p, room) for p in placed]


def make(config: ObjectsConfig, context: SceneContext | None = None) -> ProceduralObjects:
    """The offline objects backend; it keeps nothing of the scene it is made for."""
    return ProceduralObjects(config)
