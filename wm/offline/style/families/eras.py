"""Decades and movements that the other families leave out."""

import dataclasses

from wm.offline.style.families.historic import BAROQUE, ROMAN, VICTORIAN
from wm.offline.style.families.regional import JAPANESE, MOROCCAN
from wm.offline.style.families.retro import MIDCENTURY
from wm.offline.style.finish import Form
from wm.offline.style.style_sheet import finish, light

SEVENTIES = dataclasses.replace(
    MIDCENTURY,
    words=("1970s", "70s", "seventies", "groovy", "disco", "hippie", "psychedelia", "flowerpower"),
    kin="midcentury",
    form=Form("tapered", "wave", "flat", "globe", softness=1.0, ornament=0.2),
    wall=finish("wallpaper_damask", "d98a34", "8a4a1f", "e8b860", scale=0.5),
    floor=finish("carpet", "a8562a", "7f3f1c", scale=0.015), ceiling=finish("paint", "f4e6c8", scale=0.02),
    rooms=(("bedroom", finish("wallpaper_stripe", "c9a02e", "8a6a1f", scale=0.16), finish("carpet", "8a7a2f", "6a5c22",
        scale=0.015)),),
    wood="9a5a2c", dark_wood="5f3418", painted="e0792a", fabric="e0792a", accent="7a8a2f", leather="7a3f1c", rug="c9702a",
    rug_border="6a4a1f", brass="c9a04a", shade="f08a2a", accents=("e0792a", "7a8a2f", "e0b030", "6f3a1c", "f4e6c8", "a83f2a"),
    light=light("ffd694", 0.75, 24, 230, "d0dce4", 0.6, "ffb45c", 0.9),
)  # fmt: skip

EIGHTIES = dataclasses.replace(
    MIDCENTURY,
    words=("1980s", "80s", "eighties", "memphis", "postmodern", "miami", "1990s", "90s", "nineties"),
    kin="midcentury",
    form=Form("column", "round_arch", "flat", "cone", softness=0.4, ornament=0.3),
    wall=finish("paint", "f2b8c0", scale=0.02), floor=finish("checker_tiles", "f6f4ee", "2f2f33", "b0b0b0", scale=0.4,
        roughness=0.2),
    ceiling=finish("paint", "fdf8f0", scale=0.02), trim=finish("lacquer", "3fb8b0", "ffffff", scale=0.05),
    rooms=(("bedroom", finish("paint", "b8d8e8", scale=0.02), finish("carpet", "8f7fb0", "7a6a9c", scale=0.01)),),
    wood="f0c84a", dark_wood="2f2f33", painted="3fb8b0", fabric="5f5fc0", accent="f06a8a", rug="f0c84a", rug_border="2f2f33",
    shade="f8e8f0", accents=("f06a8a", "3fb8b0", "f0c84a", "5f5fc0", "f6f4ee", "2f2f33"),
    slots=(("wood", finish("lacquer", "f0c84a", "ffffff", roughness=0.2)), ("dark_wood", finish("lacquer", "2f2f33", "ffffff",
        roughness=0.2))),
    light=light("fff0e0", 0.8, 38, 230, "cfe0f4", 0.75, "ffe0d0", 0.7),
)  # fmt: skip

NOUVEAU = dataclasses.replace(
    VICTORIAN,
    words=("nouveau", "jugendstil", "klimt", "mucha", "gaudi", "secession"),
    kin="victorian",
    form=Form("cabriole", "wave", "arched", "bowl", softness=0.8, ornament=0.7),
    wall=finish("wallpaper_damask", "a8b48a", "6f8458", "d9b45a", scale=0.7), wainscot=None, wainscot_height=0.0,
    floor=finish("mosaic", "e6dcc0", "5f8a7a", "b5803f", scale=0.03, roughness=0.3), rooms=(),
    wood="8a5a34", dark_wood="5a3620", fabric="5f7f5a", accent="c9903f", rug="6f8458", rug_border="d9b45a",
    accents=("5f7f5a", "c9903f", "8a4f6a", "a8c4b0", "efe2c0", "3f5a6a"),
    light=light("fff0c0", 0.7, 30, 215, "cfe4dc", 0.7, "ffd68a", 0.85),
)  # fmt: skip

EGYPTIAN = dataclasses.replace(
    ROMAN,
    words=("egyptian", "egypt", "pharaoh", "pyramid", "cleopatra", "nile", "sphinx", "aztec", "mayan", "inca", "babylonian"),
    kin="roman",
    wall=finish("stone_blocks", "d9b578", "9a7440", "c8a264", scale=0.9, roughness=0.8), wainscot=finish("fresco", "2f5f8a",
        "c9a040", "efe0b4", scale=0.5),
    wainscot_height=0.9, floor=finish("stone_tiles", "cfae76", "94703f", "be9c64", scale=0.7), ceiling=finish("paint",
        "24406a", scale=0.02),
    rooms=(), fabric="1f4f8a", accent="c9a040", rug="8a3f24", rug_border="c9a040", brass="d9ac3f", stone="d9b578",
    accents=("1f4f8a", "c9a040", "b04a2a", "2f8a7a", "efe0b4", "1b1b1d"),
    light=light("ffdc94", 0.9, 48, 225, "c4d8ec", 0.6, "ffb454", 0.9),
)  # fmt: skip

CHINESE = dataclasses.replace(
    JAPANESE,
    words=("chinese", "china", "beijing", "shanghai", "mandarin", "ming", "pagoda", "dragon", "dynasty"),
    kin="japanese",
    form=Form("straight", "panel", "slats", "lantern", softness=0.4, ornament=0.7),
    wall=finish("panelling", "b52a22", "4a0f0c", "c8442f", scale=0.7, roughness=0.35), floor=finish("stone_tiles", "5f5a54",
        "3a3632", "54504a", scale=0.5, roughness=0.3),
    ceiling=finish("wood_planks", "5a2418", "2a0f0a", "4a1c12", scale=0.25), trim=finish("lacquer", "c9a040", "fff0c0",
        scale=0.05, roughness=0.2),
    wood="7a2f1f", dark_wood="421610", painted="a8241c", fabric="c9a040", accent="1f7a5a", rug="8f1f1c", rug_border="e0b84a",
    shade="e0402a", accents=("c8281f", "e0b84a", "1f7a5a", "2f4a7a", "f4e4c0", "2a1410"),
    light=light("ffe0a8", 0.55, 28, 215, "d0d8e0", 0.5, "ffae54", 0.9),
)  # fmt: skip

MEXICAN = dataclasses.replace(
    MOROCCAN,
    words=("mexican", "mexico", "frida", "hacienda", "cuban", "havana", "latin", "brazilian", "fiesta"),
    kin="moroccan",
    form=Form("turned", "slats", "raised", "lantern", softness=0.7, ornament=0.5),
    wall=finish("plaster", "e8a02f", "d08a1f", scale=0.8, wear=0.3), wainscot=finish("plaster", "1f6fb0", "185a94",
        scale=0.8), wainscot_height=0.9,
    rooms=(("bedroom", finish("plaster", "d84a7a", "c03a68", scale=0.8, wear=0.3), finish("terracotta", "b8623f", "8a5238",
        "a04f30", scale=0.25)),),
    painted="1f8a7a", fabric="d84a7a", accent="2fa05a", rug="d8452f", rug_border="f0c040",
    accents=("d84a7a", "1f6fb0", "f0c040", "2fa05a", "e8702a", "f4ead0"), light=light("ffe4a8", 1.0, 50, 225, "8fc8f4", 0.8,
        "ffbc64", 0.7),
)  # fmt: skip

CIRCUS = dataclasses.replace(
    BAROQUE,
    words=("circus", "carnival", "fairground", "clown", "carousel", "funfair", "vaudeville", "magician"),
    kin="baroque",
    wall=finish("wallpaper_stripe", "c8302a", "f6ead0", scale=0.35, roughness=0.9), wainscot=None, wainscot_height=0.0,
    floor=finish("wood_planks", "a8743f", "5a3a1c", "94642f", scale=0.2, wear=0.4), ceiling=finish("textile", "f6e2b8",
        "e6c884", scale=0.02), rooms=(),
    trim=finish("lacquer", "e0b030", "fff0c0", scale=0.05), painted="2f6fb0", fabric="2f5fa8", accent="e0b030", rug="c8302a",
    rug_border="e0b030", accents=("c8302a", "e0b030", "2f6fb0", "f6ead0", "3f9a5c", "8a3f9a"),
    light=light("ffe4b0", 0.6, 30, 215, "c4d4ec", 0.5, "ffc860", 1.0),
)  # fmt: skip
