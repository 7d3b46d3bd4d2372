"""Procedural materials: what each name of `wm.offline.style.finish.MATERIALS` looks like.

    material_sample  the points at which a material is sampled, and what it gives there
    wall             plaster, paint, wallpaper, fresco, canvas and paper
    wood             boards, parquet, panels, paint and lacquer over wood
    stone            stone, brick, clay, mosaic, concrete
    cloth            cloth, carpet, leather, rush and cane
    panels           moulded panels, riveted plates, living rock
    gears            gear wheels, and the wallpaper of them
    fittings         metal, glass, mirror, glaze, leaves, soil, wax, light sources
"""

from wm.offline.style.finish import Finish
from wm.offline.world.materials import cloth, fittings, gears, panels, stone, wall, wood
from wm.offline.world.materials.material_sample import Material, MaterialSample, Points, flat_points

_TABLE: dict[str, Material] = {
    "plaster": wall.plaster,
    "paint": wall.paint,
    "wallpaper_damask": wall.wallpaper_damask,
    "wallpaper_stripe": wall.wallpaper_stripe,
    "wallpaper_gears": gears.wallpaper_gears,
    "fresco": wall.fresco,
    "panelling": wood.panelling,
    "brick": stone.brick,
    "concrete": stone.concrete,
    "terracotta": stone.terracotta,
    "mosaic": stone.mosaic,
    "stone_tiles": stone.stone_tiles,
    "stone_blocks": stone.stone_blocks,
    "checker_tiles": stone.checker_tiles,
    "sectile": stone.sectile,
    "water_tiles": stone.water_tiles,
    "marble": stone.marble,
    "wood_planks": wood.wood_planks,
    "herringbone": wood.herringbone,
    "parquet": wood.parquet,
    "wood": wood.wood,
    "painted_wood": wood.painted_wood,
    "lacquer": wood.lacquer,
    "carpet": cloth.carpet,
    "textile": cloth.textile,
    "velvet": cloth.velvet,
    "tatami": cloth.tatami,
    "woven": cloth.woven,
    "leather": cloth.leather,
    "metal": fittings.metal,
    "glass": fittings.glass,
    "mirror": fittings.mirror,
    "ceramic": fittings.ceramic,
    "paper": wall.paper,
    "painting": wall.painting,
    "leaf": fittings.leaf,
    "soil": fittings.soil,
    "wax": fittings.wax,
    "capsule": panels.capsule,
    "riveted": panels.riveted,
    "rock": panels.rock,
    "glow": fittings.glow,
}


def evaluate(points: Points, finish: Finish, *, seed: int) -> MaterialSample:
    """The surface that a finish shows at the points.

    Raises:
      KeyError: the finish names no known material.
    """
    if finish.material not in _TABLE:
        raise KeyError(f"unknown material {finish.material!r}; materials: {', '.join(sorted(_TABLE))}")
    return _TABLE[finish.material](points, finish, seed)


__all__ = ["Material", "MaterialSample", "Points", "evaluate", "flat_points"]
