"""Light of the offline world.

    bake         bake: the light that every light point of a room receives
    sources      panes, sun and lamps as sample points
    transport    the rays between sources and light points
    environment  what the middle of a room sees all about
    luxels       the light points of a room: on its structure and on its objects
    charts       light points on the structure
    facets       light points on the triangles of objects
    probes       the few of those at which light is computed
"""

from wm.offline.world.light.bake import BakeSettings, LightField, Sources
from wm.offline.world.light.charts import RoomCharts, chart_places, luxel_positions, room_charts
from wm.offline.world.light.environment import look_up
from wm.offline.world.light.facets import Facets, build_facets, facet_weights
from wm.offline.world.light.luxels import LightPoints
from wm.offline.world.light.probes import Probes, build_probes
from wm.offline.world.light.sources import (
    Emitter,
    ceiling_emitters,
    glow_color,
    lamp_emitters,
    pane_emitters,
    soften,
    sun_direction,
)
from wm.offline.world.light.transport import in_free_air

__all__ = [
    "BakeSettings", "Emitter", "Facets", "LightField", "LightPoints", "Probes", "RoomCharts", "Sources", "build_facets",
    "build_probes", "ceiling_emitters", "chart_places", "facet_weights", "glow_color", "in_free_air", "lamp_emitters", "look_up",
    "luxel_positions", "pane_emitters", "room_charts", "soften", "sun_direction",
]  # fmt: skip
