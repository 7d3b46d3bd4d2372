"""The clearances that whoever furnishes a room keeps, each declared once.

"May this stand here?" is answered by two engines, because they know different things and are held to different ends:

    wm.offline.arrangement.layout   designs a room. It knows the true outline of every piece and is free to choose another place,
                                    so it leaves more than the least: ways 0.66 m wide, free floor before drawers, nothing
                                    closed off. A piece that spoils the room is refused, and the next candidate is tried.
    wm.geometry.placement.occupancy corrects a room. It is given measured boxes that already stand somewhere, nearly right and
                                    slightly overlapping. It keeps each as near to that place as it can, and asks only that
                                    boxes do not overlap and that a body still passes.

Held to the ends of the first, the second would throw out furniture that a picture plainly shows; held to those of the second,
the first would build rooms that only a slim body can cross. They share the room (wm.geometry.plan.site), the boxes
(upright_box) and the numbers below.
"""

from wm.schema import NavigationSettings

_DEFAULTS = NavigationSettings()

BODY = _DEFAULTS.body_radius
"""Radius in metres of the body that furniture leaves way for. It is the default of the body that navigability is measured with
and does not follow the configuration, so that where things stand does not depend on how they are judged."""

HEADROOM = _DEFAULTS.obstacle_height
"""Metres above the floor below which a thing is in that body's way; a default like BODY, for the same reason."""

STEP = 0.1
"""Metres above the floor below which a thing is stepped on: a rug, a threshold."""

LIFT = 0.002
"""Metres between a thing and what it stands on or hangs from, so that no two faces share a plane."""

WALL_GAP = 0.005
"""Metres between a wall and the back of what hangs on it, so that no two faces share a plane."""

FLAT = 0.008
"""Metres that a thing lying flat on the floor is high at most: less than the feet of what stands on it may sink in."""


def in_the_way(low: float, high: float) -> bool:
    """Whether a thing between two heights, metres, can be run into by a body on the floor."""
    return low < HEADROOM and high > STEP
