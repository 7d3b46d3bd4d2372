"""Places far from any town: space, ice, the sea and what sails it, caves and treetops."""

import dataclasses

from wm.offline.style.families.contemporary import INDUSTRIAL, MODERN, SCANDINAVIAN
from wm.offline.style.families.regional import COASTAL, RUSTIC
from wm.offline.style.finish import Form
from wm.offline.style.style_sheet import finish, light

SPACE = dataclasses.replace(
    MODERN,
    words=("spaceship", "spacecraft", "starship", "space", "spacestation", "orbital", "rocket", "astronaut", "cosmic", "shuttle",
           "martian", "mars", "lunar", "moonbase", "galaxy", "galactic", "interstellar", "capsule", "cosmonaut"),
    kin="cyberpunk", place=True, without=("fireplace", "tapestry", "candelabra", "candles", "grandfather clock"),
    form=Form("slab", "plain", "flat", "globe", softness=0.9, ornament=0.05),
    wall=finish("capsule", "f1f2f0", "a9b4b8", "d9dedd", scale=1.15, roughness=0.3, wear=0.0),
    floor=finish("riveted", "7f888c", "4c555a", "8f989b", scale=0.9, roughness=0.4, wear=0.1),
    ceiling=finish("capsule", "fafaf8", "b8c2c6", "e2e6e6", scale=1.5, roughness=0.35, wear=0.0),
    trim=finish("lacquer", "5f6a70", "ffffff", scale=0.05, roughness=0.2),
    wet_wall=finish("capsule", "eef2f4", "9fb0b8", "d4dde0", scale=0.6, roughness=0.2),
    wet_floor=finish("stone_tiles", "8f999d", "5c666a", "848e92", scale=0.5, roughness=0.3),
    rooms=(), wood="e4e5e1", dark_wood="7a8388", painted="f4f4f1", fabric="4f7f96", accent="e0702f", leather="dfe0dc",
    linen="f4f5f4", rug="8a959a", rug_border="e0702f", metal="9aa2a6", brass="b8bec0", stone="d4d8d8", ceramic="f2f4f4",
    shade="f4fbff", accents=("e0702f", "4f7f96", "f4f4f1", "2f3a44", "c9d2d4", "e8b23f"),
    slots=(
        ("wood", finish("lacquer", "e9eae6", "ffffff", roughness=0.2)),
        ("light_wood", finish("lacquer", "f2f2ef", "ffffff", roughness=0.2)),
        ("dark_wood", finish("lacquer", "7a8388", "ffffff", roughness=0.2)),
        ("panel_wood", finish("lacquer", "c4cacb", "ffffff", roughness=0.2)),
    ),
    light=light("ffffff", 0.45, 30, 215, "20304f", 0.25, "e6f4ff", 1.0, "space"),
)  # fmt: skip

ICE = dataclasses.replace(
    SCANDINAVIAN,
    words=("igloo", "arctic", "antarctic", "polar", "glacier", "glacial", "inuit", "eskimo", "tundra", "penguin", "icicle",
        "northpole"),
    kin="scandinavian", place=True, without=("fireplace", "tapestry", "grandfather clock"),
    wall=finish("stone_blocks", "d9eaf4", "8fb6d0", "b9d8ea", scale=0.7, roughness=0.25, wear=0.1),
    floor=finish("plaster", "eef4f9", "cfe0ec", scale=0.9, roughness=0.8),
    ceiling=finish("stone_blocks", "e2f0f8", "9cc0d8", "c6e0ee", scale=0.7, roughness=0.25, wear=0.1),
    trim=finish("marble", "c6e2f0", "f4fbff", "9cc4dc", scale=0.5, roughness=0.1),
    wet_wall=finish("water_tiles", "a8d0e4", "e4f4fb", "cfeaf6", scale=0.3, roughness=0.1),
    wet_floor=finish("marble", "d0e6f2", "8fb6d0", "b0d2e6", scale=0.8, roughness=0.1),
    rooms=(), wood="b9cbd4", dark_wood="7f97a6", painted="eef5f9", fabric="f0ece2", accent="2f7fae", leather="a89a88",
    linen="f8fafb", rug="e9e4d8", rug_border="9cb8c8", metal="8fa0aa", brass="b4c4cc", stone="cfe2ec", ceramic="e2f0f6",
    shade="f2f9ff", accents=("2f7fae", "9cd0e8", "f4f8fa", "5f8aa4", "c8dce6", "3f4f5c"), upholstery="carpet", leaf="7fa89a",
    light=light("eaf4ff", 0.7, 18, 215, "a8d4f8", 1.0, "d8f0ff", 0.6, "ice"),
)  # fmt: skip

SUBMARINE = dataclasses.replace(
    INDUSTRIAL,
    words=("submarine", "nautilus", "bathyscaphe", "uboat", "submersible"),
    kin="industrial", place=True, without=("fireplace", "tapestry", "candelabra", "candles", "grandfather clock"),
    form=Form("straight", "plain", "flat", "dome", softness=0.4, ornament=0.2),
    wall=finish("riveted", "5f7a70", "2f3f3a", "6f8a80", scale=0.8, roughness=0.4, wear=0.5),
    floor=finish("riveted", "4a4f50", "26292a", "55595a", scale=0.45, roughness=0.5, wear=0.5),
    ceiling=finish("riveted", "7a8f86", "3f4f49", "869a91", scale=0.8, roughness=0.45, wear=0.4),
    trim=finish("metal", "b0823f", "e0b870", scale=0.05, roughness=0.3),
    wet_wall=finish("riveted", "7f9a94", "44554f", "8ca69f", scale=0.6, roughness=0.3, wear=0.4),
    wet_floor=finish("riveted", "4a4f50", "26292a", "55595a", scale=0.45, roughness=0.5, wear=0.5),
    rooms=(), wood="7a5230", dark_wood="4a3220", painted="56706a", fabric="3f4f5a", accent="c23f2a", rug="3f4a4c",
    rug_border="b0823f", metal="5a6462", brass="c0903f", stone="7f8a86", ceramic="a8bcb4", shade="e8c26a",
    accents=("c23f2a", "c0903f", "3f6a6a", "2f3f4a", "8fa89e", "e0c060"),
    light=light("9fe0e0", 0.08, 60, 215, "1f6f80", 0.4, "ffc878", 0.8, "deep_sea"),
)  # fmt: skip

SHIP = dataclasses.replace(
    RUSTIC,
    words=("ship", "pirate", "galleon", "frigate", "sailing", "schooner", "corsair", "buccaneer", "captain", "privateer",
        "cutlass",
           "boat", "barge", "houseboat", "deck"),
    kin="rustic", place=True, without=("fireplace",),
    form=Form("turned", "panel", "raised", "lantern", softness=0.6, ornament=0.6),
    wall=finish("wood_planks", "6f4a2a", "1f130a", "5a3a20", scale=0.24, roughness=0.6, wear=0.6),
    floor=finish("wood_planks", "a5804f", "1f150c", "8f6c40", scale=0.14, roughness=0.7, wear=0.5),
    ceiling=finish("wood_planks", "54371f", "150c06", "452c18", scale=0.28, roughness=0.7, wear=0.5),
    trim=finish("metal", "a87a34", "e0b860", scale=0.05, roughness=0.35),
    wet_wall=finish("wood_planks", "6a5034", "1f150c", "5a4229", scale=0.2),
    wet_floor=finish("wood_planks", "8f7048", "1f150c", "7a5f3c", scale=0.14),
    rooms=(), wood="7d5230", dark_wood="3f2614", painted="2f3f3c", fabric="8a1f24", accent="c9a040", leather="54301a",
    linen="e2d3b0", rug="7a1f24", rug_border="c9a040", metal="3a3a3a", brass="c2933c", stone="8f8474", ceramic="a89a78",
    shade="ffca70", accents=("8a1f24", "c9a040", "1f3f54", "e2d3b0", "3f2614", "4f6a4a"),
    light=light("ffd0a0", 0.4, 14, 225, "8ab8cc", 0.6, "ffae50", 0.95, "open_sea"),
)  # fmt: skip

CAVE = dataclasses.replace(
    RUSTIC,
    words=("cave", "cavern", "grotto", "prehistoric", "neanderthal", "troglodyte", "mine", "dwarven", "dwarf", "burrow",
        "underground",
           "volcano", "lair"),
    kin="rustic", place=True, without=("tapestry", "picture"),
    wall=finish("rock", "8f7d68", "3a2f25", "6f5f4e", scale=1.2, roughness=0.95, wear=0.3),
    floor=finish("rock", "7a6a57", "3f342a", "66584a", scale=0.8, roughness=0.95, wear=0.3),
    ceiling=finish("rock", "6f604f", "2c231b", "574a3c", scale=1.4, roughness=0.95, wear=0.3),
    trim=finish("rock", "665747", "2c231b", "54473a", scale=0.5, roughness=0.9),
    wet_wall=finish("rock", "7f7a70", "38342e", "645f57", scale=0.9, roughness=0.4),
    wet_floor=finish("rock", "6a655c", "38342e", "5a554d", scale=0.6, roughness=0.4),
    rooms=(), wood="6f4e30", dark_wood="42301e", fabric="8a6a48", accent="c4652a", rug="9a7a54", rug_border="5a4430",
    stone="857664", upholstery="carpet", light=light("ffd8a8", 0.2, 20, 225, "9fb4c4", 0.35, "ff9a40", 1.0),
)  # fmt: skip

TREEHOUSE = dataclasses.replace(
    RUSTIC,
    words=("treehouse", "treetop", "forest", "woodland", "elven", "elf", "elves", "sylvan", "druid", "jungle", "rainforest",
        "tarzan"),
    kin="rustic", place=True,
    form=Form("straight", "slats", "slats", "rattan", softness=0.6, ornament=0.3),
    wall=finish("wood_planks", "8a7448", "3f3418", "6f5f38", scale=0.26, roughness=0.85, wear=0.4),
    floor=finish("wood_planks", "a58a5a", "4a3a1f", "8f774c", scale=0.2, roughness=0.8, wear=0.3),
    ceiling=finish("leaf", "4f7a34", "86a858", scale=0.35, roughness=0.8),
    trim=finish("wood", "5f4a2a", "3a2c18", scale=0.06),
    wet_wall=finish("wood_planks", "7a8a54", "3f4a28", "66764a", scale=0.2),
    wet_floor=finish("stone_tiles", "8a8a70", "545540", "78785f", scale=0.35),
    rooms=(), wood="8f7040", dark_wood="5a4526", painted="5f7a40", fabric="5a7a3a", accent="d9b050", rug="6a8a48",
    rug_border="c9b070", shade="f0e4a0", accents=("5a7a3a", "d9b050", "a85a34", "8fa86a", "efe6c0", "3f5a34"), leaf="4f8a34",
    light=light("f4ffb8", 0.85, 50, 215, "a8e08a", 0.85, "ffe08a", 0.6),
)  # fmt: skip

UNDERWATER = dataclasses.replace(
    COASTAL,
    words=("underwater", "aquarium", "mermaid", "atlantis", "coral-reef", "reef", "aquatic", "undersea", "poseidon"),
    kin="coastal", place=True, without=("fireplace", "tapestry", "candelabra", "candles", "grandfather clock"),
    wall=finish("water_tiles", "2f86a8", "9fe4ec", "5fc0d4", scale=0.5, roughness=0.1),
    floor=finish("plaster", "dccb9c", "c2ad7a", scale=0.5),
    ceiling=finish("water_tiles", "4fb4cc", "d4f8f8", "9fe8ee", scale=0.7, roughness=0.1),
    trim=finish("mosaic", "e58a7a", "f4d8c0", "5fc0b8", scale=0.04),
    rooms=(), wood="7fb0a8", dark_wood="3f7a80", painted="8fd0cc", fabric="e5806a", accent="f0c85a", rug="3f9aa8",
    rug_border="f0d8a8", accents=("e5806a", "2f86a8", "f0c85a", "9fe4dc", "b060a0", "f4ead4"),
    light=light("b8fff4", 0.5, 70, 215, "3fb8e0", 1.0, "b8f4ff", 0.6, "deep_sea"),
)  # fmt: skip

DESERT = dataclasses.replace(
    RUSTIC,
    words=("desert", "pueblo", "sahara", "oasis", "bedouin", "tatooine", "dune", "canyon", "mesa"),
    kin="moroccan", place=True,
    form=Form("straight", "slats", "flat", "lantern", softness=0.8, ornament=0.2, low=0.9),
    wall=finish("plaster", "d7a873", "bb8a55", scale=0.7, roughness=0.95, wear=0.3),
    floor=finish("plaster", "c9a878", "a98958", scale=0.5, roughness=0.9),
    ceiling=finish("wood_planks", "a88458", "5a4426", "937048", scale=0.3),
    trim=finish("wood", "7a5a38", "4f3820", scale=0.06),
    wet_wall=finish("plaster", "e0bc8c", "c49c68", scale=0.7), wet_floor=finish("terracotta", "b8774a", "8a5a38", "a5683f",
        scale=0.3),
    rooms=(), wood="94704a", dark_wood="5f452b", fabric="c4834a", accent="2f7f86", rug="a8452f", rug_border="e0c08a",
    stone="d0b088", accents=("a8452f", "2f7f86", "e0c08a", "6f4a30", "d9822f", "efe0c4"), leaf="7f8a4f",
    light=light("ffe0a0", 1.0, 52, 225, "bcd8f0", 0.8, "ffb860", 0.5, "dunes"),
)  # fmt: skip
