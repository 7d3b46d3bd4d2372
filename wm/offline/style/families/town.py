"""Places of a town: where people are healed, taught, fed and entertained."""

import dataclasses

from wm.offline.style.families.contemporary import INDUSTRIAL, MINIMALIST, SCANDINAVIAN
from wm.offline.style.families.historic import VICTORIAN
from wm.offline.style.families.regional import COASTAL, JAPANESE
from wm.offline.style.families.retro import MIDCENTURY
from wm.offline.style.finish import Form
from wm.offline.style.style_sheet import finish, light

CLINIC = dataclasses.replace(
    MINIMALIST,
    words=("hospital", "clinic", "ward", "surgery", "medical", "doctor", "dentist", "sanatorium", "asylum", "laboratory", "lab",
           "infirmary", "pharmacy", "morgue"),
    kin="minimalist", place=True, without=("fireplace", "tapestry", "rug", "round rug"),
    wall=finish("paint", "dcece8", scale=0.02, roughness=0.7, wear=0.05),
    wainscot=finish("stone_tiles", "fbfcfc", "b4c6c6", "f0f4f4", scale=0.16, roughness=0.15), wainscot_height=1.35,
    floor=finish("stone_tiles", "a9cdc4", "8fb6ac", "a0c4bb", scale=1.4, roughness=0.25, wear=0.1),
    ceiling=finish("stone_tiles", "f6f8f8", "cfd6d8", "eef2f2", scale=0.6, roughness=0.9),
    trim=finish("metal", "b9c2c4", "ffffff", scale=0.05, roughness=0.3),
    wet_wall=finish("stone_tiles", "fbfcfc", "b4c6c6", "f0f4f4", scale=0.15, roughness=0.15),
    wet_floor=finish("stone_tiles", "9fc4c0", "7fa8a4", "94bab6", scale=0.3, roughness=0.3),
    wood="eef1f1", dark_wood="b4bec0", painted="f6f8f8", fabric="5fa8a4", accent="3f8ac0", leather="4f8f8a", linen="fafcfc",
    rug="b4d0cc", rug_border="8fb0ac", metal="b4bcbf", brass="c4cacc", stone="e2e8e8", ceramic="fafcfc", shade="f4fbff",
    accents=("5fa8a4", "3f8ac0", "f4f8f8", "b4d0cc", "dfe8ea", "c23f3a"),
    slots=(("wood", finish("painted_wood", "eef1f1", "c0c8ca", roughness=0.4)),
           ("dark_wood", finish("metal", "b4bcbf", "ffffff", scale=0.004, roughness=0.3)),
           ("panel_wood", finish("painted_wood", "dfe6e6", "c0c8ca", roughness=0.4))),
    light=light("f4faff", 0.5, 40, 215, "dfeefc", 0.8, "eef8ff", 1.0),
)  # fmt: skip

SCHOOL = dataclasses.replace(
    MIDCENTURY,
    words=("school", "classroom", "schoolhouse", "academy", "university", "college", "gymnasium", "kindergarten", "teacher"),
    kin="midcentury", place=True, without=("fireplace", "tapestry"),
    form=Form("straight", "panel", "flat", "dome", softness=0.2, ornament=0.1),
    wall=finish("paint", "efe4c0", scale=0.02, wear=0.15),
    wainscot=finish("painted_wood", "4f7a5c", "3a5c46", scale=0.1, roughness=0.35, wear=0.3), wainscot_height=1.25,
    floor=finish("parquet", "c08a48", "7a5228", "ad7a3e", scale=0.45, roughness=0.4, wear=0.3),
    ceiling=finish("stone_tiles", "f4f2e8", "d4d0c0", "ece8dc", scale=0.6, roughness=0.9),
    trim=finish("painted_wood", "3f6450", "2f4c3c", scale=0.05),
    wet_wall=finish("stone_tiles", "f4f2e4", "c4c0a8", "e8e4d4", scale=0.15), rooms=(),
    wood="c8924e", dark_wood="7f5730", painted="4f7a5c", fabric="c8503a", accent="e0b030", rug="4f7a9a", rug_border="e0b030",
    metal="5f6a6c", accents=("c8503a", "3f6fa8", "e0b030", "4f9a5c", "f4eed8", "2f4c3c"),
    light=light("fff6e0", 0.85, 40, 215, "cfe4f6", 0.9, "fff4dc", 0.8),
)  # fmt: skip

BAKERY = dataclasses.replace(
    COASTAL,
    words=("bakery", "patisserie", "cafe", "cake", "confectionery", "baker", "boulangerie", "teashop", "bistro", "sweetshop",
           "icecream", "gelato", "chocolaterie"),
    kin="midcentury", place=True, without=("fireplace", "tapestry"),
    form=Form("tapered", "round_arch", "raised", "dome", softness=0.7, ornament=0.4),
    wall=finish("wallpaper_stripe", "f8e8cf", "f0cfb4", scale=0.11, roughness=0.8),
    wainscot=finish("stone_tiles", "fbf8f0", "d4b89c", "f4ece0", scale=0.15, roughness=0.2), wainscot_height=1.15,
    floor=finish("checker_tiles", "f6ead6", "a8643f", "d4b08c", scale=0.3, roughness=0.3),
    ceiling=finish("paint", "fdf6e8", scale=0.02),
    trim=finish("painted_wood", "b5654a", "8a452f", scale=0.05),
    wet_wall=finish("stone_tiles", "fbf8f0", "d4b89c", "f4ece0", scale=0.12, roughness=0.2),
    wet_floor=finish("checker_tiles", "f6ead6", "a8643f", "d4b08c", scale=0.2, roughness=0.3), rooms=(),
    wood="c98f52", dark_wood="8a5530", painted="f3d3c8", fabric="d98a94", accent="8fbcae", leather="a5643c", linen="fdf4e6",
    rug="e6b8a8", rug_border="a8643f", metal="8a6a4a", brass="cf9f54", stone="e8d8c0", ceramic="f8e4d4", shade="fff0cf",
    accents=("d98a94", "8fbcae", "e6b054", "b5654a", "fbeedd", "7a4a34"),
    light=light("ffe8bc", 0.95, 35, 215, "d8e8f4", 0.8, "ffd594", 0.8),
)  # fmt: skip

RAMEN = dataclasses.replace(
    JAPANESE,
    words=("ramen", "izakaya", "noodle", "sushi", "takeaway", "yakitori", "alley", "teppanyaki"),
    kin="japanese", place=True,
    form=Form("straight", "slats", "slats", "paper", softness=0.3, ornament=0.4),
    wall=finish("wood_planks", "4a2f22", "160c08", "3a241a", scale=0.14, roughness=0.5, wear=0.3),
    wainscot=finish("stone_tiles", "8f2a22", "2f0f0c", "7a221c", scale=0.12, roughness=0.2), wainscot_height=1.0,
    floor=finish("concrete", "55504c", "403c39", scale=1.2, roughness=0.4, wear=0.4),
    ceiling=finish("wood_planks", "2c1d16", "0f0806", "221610", scale=0.2),
    trim=finish("wood", "b0302a", "7a1f1a", scale=0.05, roughness=0.3),
    wet_wall=finish("stone_tiles", "e9e4d8", "8f2a22", "d8d0c0", scale=0.12, roughness=0.2),
    wet_floor=finish("stone_tiles", "55504c", "2f2c2a", "4a4642", scale=0.3), rooms=(),
    wood="a5683a", dark_wood="3f2418", painted="b0302a", fabric="b0302a", accent="e8b23f", leather="8f2a22", linen="f0e2c4",
    rug="4a2a24", rug_border="b0302a", metal="3a3534", brass="c09040", stone="5f5954", ceramic="2f4a5f", shade="e0452f",
    accents=("c8352a", "e8b23f", "2f4a6a", "f0e2c4", "1f7f7a", "d86a9a"),
    light=light("ff9ac0", 0.2, 14, 250, "7a3fa8", 0.5, "ffa860", 1.0, "city"),
)  # fmt: skip

DINER = dataclasses.replace(
    MIDCENTURY,
    words=("diner", "rockabilly", "milkshake", "jukebox", "drivein", "burger", "americana", "1950s", "50s", "fifties"),
    kin="midcentury", place=True, without=("fireplace", "tapestry"),
    form=Form("hairpin", "plain", "flat", "dome", softness=0.7, ornament=0.3),
    wall=finish("paint", "a9dcd2", scale=0.02, roughness=0.5),
    wainscot=finish("lacquer", "c9302c", "ffffff", roughness=0.15), wainscot_height=1.0,
    floor=finish("checker_tiles", "f6f4ee", "1b1b1d", "b0b0b0", scale=0.3, roughness=0.15),
    ceiling=finish("paint", "f8f6f0", scale=0.02), trim=finish("metal", "c9cdd0", "ffffff", scale=0.05, roughness=0.15),
    wet_wall=finish("stone_tiles", "a9dcd2", "f6f4ee", "98ccc2", scale=0.12, roughness=0.2),
    wet_floor=finish("checker_tiles", "f6f4ee", "c9302c", "b0b0b0", scale=0.2, roughness=0.2), rooms=(),
    wood="d8dad8", dark_wood="8f9496", painted="f2eee2", fabric="c9302c", accent="3fb0a8", leather="c9302c", linen="faf8f2",
    rug="c9302c", rug_border="f6f4ee", metal="c4c8ca", brass="c9cdd0", ceramic="f6f4ee", shade="fff4d8",
    accents=("c9302c", "3fb0a8", "f2c84a", "f6f4ee", "1b1b1d", "e88aa8"), upholstery="leather",
    slots=(("wood", finish("lacquer", "e6e4dc", "ffffff", roughness=0.2)),
           ("dark_wood", finish("metal", "c4c8ca", "ffffff", scale=0.004, roughness=0.15))),
    light=light("fff2d8", 0.8, 35, 215, "c4e0f4", 0.75, "ffe8c0", 0.9),
)  # fmt: skip

TAVERN = dataclasses.replace(
    VICTORIAN,
    words=("tavern", "pub", "saloon", "inn", "alehouse", "brewery", "whiskey", "cowboy", "irish", "bodega", "speakeasy"),
    kin="victorian", place=True,
    wall=finish("wallpaper_damask", "2f4a34", "456448", "a5874b", scale=0.5, roughness=0.8),
    wainscot=finish("panelling", "5f3a20", "2a170b", "774a2a", scale=0.45, roughness=0.35), wainscot_height=1.5,
    floor=finish("wood_planks", "6f4a2c", "26160b", "5c3c24", scale=0.18, roughness=0.6, wear=0.6),
    ceiling=finish("wood_planks", "5a3c22", "24150a", "4a301a", scale=0.3), trim=finish("wood", "4a2d18", "2a170b", scale=0.06),
    rooms=(), wood="7a4a28", dark_wood="452814", fabric="2f5a3c", accent="c9a040", leather="6a2a1c", rug="4a2a1c",
    rug_border="c9a040", shade="ffc060", upholstery="leather",
    light=light("ffcf94", 0.25, 16, 225, "8fa4bc", 0.3, "ffb054", 1.0),
)  # fmt: skip

SAUNA = dataclasses.replace(
    SCANDINAVIAN,
    words=("sauna", "spa", "wellness", "bathhouse", "banya"),
    kin="scandinavian", place=True, without=("fireplace", "tapestry"),
    wall=finish("wood_planks", "d8a866", "9a7038", "c69656", scale=0.1, roughness=0.6),
    floor=finish("stone_tiles", "5f6468", "3f4448", "54595d", scale=0.4, roughness=0.4),
    ceiling=finish("wood_planks", "e0b476", "a57c44", "cfa264", scale=0.1), trim=finish("wood", "b98548", "8a5f30", scale=0.05),
    wet_wall=finish("wood_planks", "d8a866", "9a7038", "c69656", scale=0.1), wet_floor=finish("stone_tiles", "5f6468",
        "3f4448", "54595d", scale=0.3),
    rooms=(), wood="cf9c5c", dark_wood="946634", fabric="f4f0e6", accent="5f8a6a", rug="e4dcc8", rug_border="b0a078",
    light=light("ffe4b0", 0.4, 20, 215, "c4dce4", 0.5, "ffc070", 0.9),
)  # fmt: skip

BOOKISH = dataclasses.replace(
    VICTORIAN,
    words=("library", "bookshop", "bookstore", "archive", "scholar", "professor", "literary", "academia", "detective",
        "sherlock"),
    kin="victorian", place=True,
    wall=finish("panelling", "6a4327", "33200f", "83552f", scale=0.6, roughness=0.4),
    wainscot=None, wainscot_height=0.0,
    floor=finish("herringbone", "7f5431", "38220f", "96683f", scale=0.45, roughness=0.35),
    ceiling=finish("plaster", "e6dac0", "cdbf9f", scale=1.2), rooms=(),
    fabric="2f5a44", accent="8a2f2a", leather="6a3a20", rug="7a2f2a", rug_border="c9a864", shade="3f7a54",
    light=light("ffdca4", 0.5, 24, 215, "c0d0e0", 0.5, "ffc670", 0.95),
)  # fmt: skip

PRISON = dataclasses.replace(
    INDUSTRIAL,
    words=("prison", "jail", "dungeon", "cell", "penitentiary", "alcatraz"),
    kin="industrial", place=True, without=("fireplace", "tapestry"),
    wall=finish("stone_blocks", "7f8078", "45463f", "6f7068", scale=0.5, roughness=0.9, wear=0.6),
    floor=finish("concrete", "6a6a64", "54544e", scale=1.0, wear=0.6), ceiling=finish("concrete", "7a7a74", "62625c",
        scale=1.2, wear=0.5),
    trim=finish("metal", "2c2d2f", "4a4b4e", scale=0.05), rooms=(), wood="6f5a40", dark_wood="453828", painted="4f5854",
    fabric="6a6f60", accent="c9702a", rug="5a5a54", shade="c9c4a8",
    light=light("dfe8f0", 0.2, 30, 215, "a4b0bc", 0.4, "ffe0a0", 0.6),
)  # fmt: skip

GREENHOUSE = dataclasses.replace(
    COASTAL,
    words=("greenhouse", "conservatory", "orangery", "botanical", "garden", "floral", "winter-garden", "terrarium", "flowery"),
    kin="coastal", place=True,
    wall=finish("panelling", "e4eee0", "9ab094", "f2f8ee", scale=0.45, roughness=0.5),
    wainscot=finish("brick", "a8654a", "c9b8a4", "8f4f38", scale=0.22), wainscot_height=0.7,
    floor=finish("terracotta", "b8714a", "8a6a52", "9e5c3e", scale=0.28, roughness=0.7),
    ceiling=finish("panelling", "f2f8f4", "a8bca8", "ffffff", scale=0.5), trim=finish("metal", "3f5a48", "5f7a68", scale=0.05),
    rooms=(), wood="a88458", dark_wood="6a5236", painted="5f8a6a", fabric="6a9a5a", accent="e08aa0", rug="8fae7a",
    rug_border="f0e4cc", accents=("6a9a5a", "e08aa0", "f0d07a", "b5654a", "f4f4e4", "7a6ab0"), leaf="4f9a3f",
    light=light("fff8d8", 1.0, 50, 215, "bfe4f4", 1.0, "ffe8b8", 0.4),
)  # fmt: skip
