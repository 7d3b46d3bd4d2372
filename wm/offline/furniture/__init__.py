"""Parametric furniture: KINDS lists every kind; make_piece builds one in its own frame (front towards -y, foot at the origin).

    catalog    KINDS and make_piece
    piece      the records of a kind and of a piece
    common     parts that many kinds share: legs, cupboard fronts, knobs, finials, candles
    solids     closed solids: boxes; turned, extruded, swept and cushioned shapes
    outlines   plane outlines: arches, rounded rectangles, frames, gears
    seating    armchairs, sofas, chairs, stools, benches
    classical  seats of antiquity
    tables     tables and desks
    beds       beds
    storage    wardrobes, bookshelves, chests, sideboards
    kitchen    kitchen counters, stove, fridge, hood
    bath       bathtub, washbasin, toilet, shower
    lighting   lamps, chandeliers, candelabra
    shades     lampshades and globes
    walls      pictures, mirrors, clocks, fireplace, folding screen
    pictures   what framed pictures show
    textiles   rugs, curtains, tapestry
    greenery   plants and flowers
    sculpture  statues, columns, armour, globes
    tabletop   small things for surfaces
    clockwork  gear trains, orrery, pipes
"""

from wm.offline.furniture.catalog import EQUIPMENT, KINDS, make_piece
from wm.offline.furniture.piece import FurnitureKind, Piece, Top

__all__ = ["EQUIPMENT", "KINDS", "FurnitureKind", "Piece", "Top", "make_piece"]
