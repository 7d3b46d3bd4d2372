"""Rooms of a plan furnished: what the offline objects backend gives, and what the offline image model draws into empty rooms."""

from collections.abc import Sequence

from wm.geometry.plan.loading import FloorPlan
from wm.geometry.plan.site import room_site
from wm.offline.arrangement.arrange import furnish_site, scene_object
from wm.offline.arrangement.room_type import room_type
from wm.offline.style.finish import Style
from wm.offline.style.theme import style_of
from wm.synth.backends import SceneContext
from wm.synth.seeds import room_number
from wm.types import SceneObject


def furnish_room(
    plan: FloorPlan, room: int, style: Style, *, seed: int, density: float = 1.0, around: Sequence[SceneObject] = ()
) -> list[SceneObject]:
    """The furniture of one room in world space, as the room's name, the style and the seed decide it.

    Args:
      room: index into the plan's rooms.
      density: 0..1, the share of the optional pieces that are tried.
      around: what stands in the rooms already, which the furniture keeps clear of.

    Raises:
      ValueError: the density is not a share.
    """
    if not 0.0 <= density <= 1.0:
        raise ValueError(f"furnish.density is {density}; it is the share of the optional pieces, between 0 and 1")
    placed = furnish_site(
        room_site(plan, room, around), room_type(plan.rooms[room].name), style, seed=seed, room=room_number(plan, room),
        density=density,
    )
    return [scene_object(piece, room) for piece in placed]


def furnish_scene(context: SceneContext) -> tuple[SceneObject, ...]:
    """The furniture of all rooms of a scene, in the style of its theme and as densely as it wants it."""
    style, rooms = style_of(context.theme), range(len(context.plan.rooms))
    return tuple(
        thing
        for room in rooms
        for thing in furnish_room(context.plan, room, style, seed=context.seed_of("furnish"), density=context.density)
    )
