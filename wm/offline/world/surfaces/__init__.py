"""How a room's structure is dressed: every planar surface as a sheet of texels, before light falls on it.

    texel_sheet  TexelSheet, and the layers that one is dressed with
    wall         finish, wainscot, skirting, cornice and casings of walls
    frieze       the ornamental band below a cornice
    level        floors and ceilings
    reveal       jambs, heads and thresholds
    window       panes
    outlook      what is seen through them
"""

from wm.geometry.plan.site import WallOpening
from wm.offline.world.surfaces.level import ceiling_sheet, floor_sheet
from wm.offline.world.surfaces.reveal import reveal_sheet
from wm.offline.world.surfaces.texel_sheet import Chart, Interior, TexelSheet, grid
from wm.offline.world.surfaces.wall import wall_sheet
from wm.offline.world.surfaces.window import pane_sheet
from wm.types import SurfaceKind


def dress(chart: Chart, openings: tuple[WallOpening, ...], interior: Interior) -> TexelSheet:
    """The sheet of one surface of a room.

    Args:
      openings: the openings in a wall, in the chart's own metres; not used for other kinds of surface.
    """
    if chart.kind == SurfaceKind.WALL:
        return wall_sheet(chart, openings, interior)
    if chart.kind == SurfaceKind.FLOOR:
        return floor_sheet(chart, interior)
    if chart.kind == SurfaceKind.CEILING:
        return ceiling_sheet(chart, interior)
    if chart.kind == SurfaceKind.PANE:
        return pane_sheet(chart, interior)
    return reveal_sheet(chart, interior)


__all__ = ["Chart", "Interior", "TexelSheet", "dress", "grid"]
