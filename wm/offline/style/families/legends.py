"""Places of tales: castles, towers of wizards, houses of sweets, houses of dolls."""

import dataclasses

from wm.offline.style.families.historic import GOTHIC, VICTORIAN
from wm.offline.style.families.imagined import SURREAL
from wm.offline.style.finish import Form
from wm.offline.style.style_sheet import finish, light

CASTLE = dataclasses.replace(
    GOTHIC,
    words=("castle", "fortress", "keep", "citadel", "stronghold", "knights", "kingdom", "templar", "crusader", "armory"),
    kin="gothic", place=True,
    wall=finish("stone_blocks", "9c9382", "5f5749", "857c6c", scale=0.7, roughness=0.9, wear=0.4), wainscot=None,
        wainscot_height=0.0,
    floor=finish("stone_tiles", "857b6a", "4f4739", "746a5a", scale=0.7, roughness=0.8, wear=0.4),
    ceiling=finish("wood_planks", "5f4228", "2a1a0d", "4f3620", scale=0.35), rooms=(),
    fabric="8a1f24", accent="1f3f7a", rug="7a1f24", rug_border="c9a040", upholstery="textile",
    light=light("ffdcb0", 0.4, 24, 200, "b8c4d8", 0.5, "ffa84c", 1.0),
)  # fmt: skip

WIZARD = dataclasses.replace(
    GOTHIC,
    words=("wizard", "witch", "sorcerer", "alchemist", "hogwarts", "warlock", "potion", "spell", "magician-tower", "occult",
        "merlin",
           "astrologer", "fortuneteller", "coven"),
    kin="gothic", place=True,
    form=Form("cabriole", "pointed_arch", "pointed", "candle", softness=0.8, ornament=1.0),
    wall=finish("stone_blocks", "5f5f7f", "2c2c44", "505070", scale=0.5, roughness=0.85, wear=0.3),
    wainscot=finish("panelling", "3a2450", "1a0f28", "4f3468", scale=0.5, roughness=0.4), wainscot_height=0.9,
    floor=finish("parquet", "4a3040", "1f121c", "5f4052", scale=0.4, roughness=0.4),
    ceiling=finish("plaster", "1f2450", "343c7a", scale=0.6), trim=finish("metal", "c9a040", "fff0b0", scale=0.05, roughness=0.3),
    rooms=(), wood="5a3a44", dark_wood="34202c", painted="3a2a6a", fabric="5a2f8f", accent="c9a040", leather="3f2440",
        rug="3a2470",
    rug_border="d9b450", stone="6f6f90", ceramic="3f7a7a", shade="b08ae8", brass="d0a84a",
    accents=("5a2f8f", "2f8a7a", "d9b450", "2f3f8f", "8a2f5a", "c8b8e8"), leaf="3f8a6a",
    light=light("c8b8ff", 0.4, 20, 200, "a8a8e8", 0.6, "ffc070", 0.95),
)  # fmt: skip

CANDY = dataclasses.replace(
    SURREAL,
    words=("candy", "gingerbread", "lollipop", "sugar", "wonka", "marshmallow", "cupcake", "bubblegum", "unicorn"),
    kin="midcentury", place=True,
    form=Form("turned", "round_arch", "arched", "globe", softness=1.0, ornament=0.5),
    wall=finish("wallpaper_stripe", "fbd0e0", "ffffff", scale=0.18), floor=finish("checker_tiles", "fff4f8", "8fe0d4",
        "f4b8d0", scale=0.35, roughness=0.2),
    ceiling=finish("paint", "fff0f6", scale=0.02), trim=finish("lacquer", "e8506a", "ffffff", scale=0.05), rooms=(),
    wood="b5703f", dark_wood="7a4426", painted="ffb8d4", fabric="f07aa8", accent="7fd8cc", rug="b8f0e4", rug_border="f07aa8",
    metal="f4c0d8", shade="fff0a8", accents=("f07aa8", "7fd8cc", "ffd85a", "b88af0", "ffffff", "ff9a5a"),
    light=light("fff0f4", 0.9, 40, 215, "e0e8ff", 0.9, "ffe4ec", 0.7),
)  # fmt: skip

DOLLHOUSE = dataclasses.replace(
    VICTORIAN,
    words=("dollhouse", "doll", "barbie", "princess", "fairies", "ballerina", "girly"),
    kin="baroque", place=True,
    wall=finish("wallpaper_damask", "f4c0d0", "fbe0e8", "fff0f4", scale=0.4), wainscot=finish("panelling", "fdf6f4", "e0c8cc",
        "ffffff", scale=0.4), wainscot_height=0.9,
    floor=finish("parquet", "d8ae88", "a57c58", "c89c76", scale=0.3), ceiling=finish("paint", "fff6f8", scale=0.02), rooms=(),
    trim=finish("painted_wood", "fdf6f4", "e0c8cc", scale=0.05), wood="f4ece8", dark_wood="d8b8b4", painted="fbeef0",
        fabric="e87aa0",
    accent="a88ad0", rug="f0b0c8", rug_border="fdf6f4", brass="e0b878", shade="fff0f4",
    accents=("e87aa0", "a88ad0", "8fc8e0", "fbe0a8", "fdf6f4", "d8506a"),
    slots=(("wood", finish("painted_wood", "f8f0ee", "e0c8cc", roughness=0.4)), ("dark_wood", finish("painted_wood", "f0d4d8",
        "d8b8b4", roughness=0.4))),
    light=light("fff0ec", 0.85, 38, 215, "e8e4f8", 0.85, "ffe0d8", 0.7),
)  # fmt: skip
