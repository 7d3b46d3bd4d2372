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
    bathing    pool, sauna, fish tank, boiler
    cabinets   filing cabinet, lockers, server rack, display case, safe, arcade machine
    ceremony   pew and throne
    childhood  cot, changing table, toy box, play mat, rocking horse, bunk bed
    cinema     rows of folding seats, and the screen
    clinic     hospital bed, examination table, drip stand, barber chair
    games      billiard table, table tennis table, dartboard
    garage     car, bicycle, tyres, workbench, anvil
    gym        treadmill, exercise bike, weight bench, dumbbell rack, punching bag, yoga mat
    hallway    coat rack and umbrella stand
    counters    bar with stools, shop counter with a till, counter of cakes
    joinery    parts of equipment: posts, wheels, boards, jars, bottles, boxes
    laundry    washing machine, ironing board, drying rack
    music      upright piano, drum kit, music stand
    outdoors   deck chair, railing planter, potting bench, fountain
    school     pupil desk, blackboard, easel, lab bench, telescope
    shelving   open shelves with what is kept on them
    stable     horse stall, hay bale, trough, barrel
"""

from wm.offline.furniture.catalog import EQUIPMENT, KINDS, make_piece
from wm.offline.furniture.piece import FurnitureKind, Piece, Top

__all__ = ["EQUIPMENT", "KINDS", "FurnitureKind", "Piece", "Top", "make_piece"]
