"""What stands in each type of room that has equipment of its own: a table, a row for each type.

A row names the groups that make the room what it is, placed first and in their order; then what may stand along its walls
besides, tried until the room holds enough, and whether its windows have curtains and its walls pictures.
"""

from wm.offline.arrangement.assemblies import conference
from wm.offline.arrangement.equipped import (
    Equipped,
    asleep,
    at,
    carpet,
    desk,
    desks,
    dining,
    hung,
    laid,
    middle,
    row,
    served,
    some,
    walls,
)
from wm.offline.arrangement.wet_groups import lavatory

GREEN = ("plant", "planter", "plant", "topiary", "plant")

EQUIPPED: dict[str, Equipped] = {
    # a house's own rooms
    "entrance": Equipped(
        (walls("coat rack", where="corner"), walls("bench", "umbrella stand", "shoe rack"), carpet),
        ("console table", "plant"),
        soft=True,
    ),
    "cloakroom": Equipped((walls("coat rack", where="corner"), walls("shoe rack", "umbrella stand")), ("bench", "wardrobe")),
    "utility": Equipped(
        (walls("washing machine", "storage rack"),), ("ironing board", "basket", "storage rack", "basket", "stool")
    ),
    "laundry": Equipped(
        (walls("washing machine", "washing machine"), walls("ironing board", "drying rack"), walls("basket", where="corner")),
        ("basket", "storage rack"),
    ),
    "pantry": Equipped((walls("larder shelf", "larder shelf"),), ("larder shelf", "basket", "barrel", "larder shelf")),
    "storage": Equipped((walls("storage rack", "storage rack"),), ("storage rack", "chest", "basket", "storage rack", "bicycle")),
    "closet": Equipped(
        (walls("clothes rack", "wardrobe", "shoe rack"), hung("mirror", 1.1)), ("clothes rack", "dresser", "ottoman")
    ),
    "wc": Equipped((lavatory,)),
    "nursery": Equipped(
        (walls("cot", where="corner"), walls("changing table", "toy box"), laid("play mat", 1)),
        ("armchair", "wardrobe", "rocking horse", "bookshelf", "basket"),
        soft=True,
        sparse=0.8,
    ),
    "kids": Equipped(
        (asleep("single bed", 99.0, "nightstand"), walls("toy box"), laid("play mat", 1)),
        ("wardrobe", "bookshelf", "rocking horse", "desk", "toy box"),
        soft=True,
        sparse=0.8,
    ),
    "playroom": Equipped(
        (laid("play mat", 2), walls("toy box", "rocking horse", "toy box")),
        ("bookshelf", "ottoman", "easel", "basket"),
        soft=True,
        sparse=0.8,
    ),
    "dormitory": Equipped((asleep("bunk bed", 5.0), walls("lockers")), ("chest", "stool", "lockers"), soft=True),
    "balcony": Equipped(
        (walls("railing planter", "deck chair", "deck chair"), middle("side table")), ("railing planter", *GREEN)
    ),
    "garden": Equipped(
        (middle("fountain"), walls("bench", "planter", "plant")), (*GREEN, "bench", "deck chair", "planter"), sparse=1.0
    ),
    "greenhouse": Equipped(
        (walls("potting bench", "planter", "plant"), some("plant", 7.0)), ("potting bench", *GREEN, "planter"), sparse=1.0
    ),
    "conservatory": Equipped(
        (middle("round table", rug=True), walls("armchair", "armchair", "plant", where="corner")),
        (*GREEN, "bench", "planter"),
        sparse=1.0,
    ),
    "aquarium": Equipped((walls("fish tank", "fish tank"),), ("fish tank", "bench", "plant", "fish tank")),
    # work
    "workshop": Equipped(
        (at("workbench", "stool"), walls("storage rack")), ("workbench", "lockers", "storage rack", "chest", "stool")
    ),
    "forge": Equipped((middle("anvil"), walls("workbench", "barrel")), ("weapon rack", "trough", "barrel", "storage rack")),
    "garage": Equipped(
        (middle("car"), walls("workbench", "pile of tyres")), ("bicycle", "storage rack", "pile of tyres", "storage rack")
    ),
    "boiler room": Equipped((walls("boiler"), hung("wall pipes", 1.2)), ("boiler", "workbench", "storage rack", "barrel")),
    "office": Equipped((desks, walls("filing cabinet")), ("filing cabinet", "bookshelf", "plant", "filing cabinet"), soft=True),
    "meeting": Equipped((conference, hung("wall screen", 1.5)), ("sideboard", "plant", "plant"), soft=True),
    "reception": Equipped(
        (served("shop counter", "bookshelf"), walls("bench", "chair", "chair", "plant")),
        ("chair", "armchair", "plant", "chair"),
        soft=True,
    ),
    "control room": Equipped(
        (hung("wall screen", 1.6), desks, walls("server rack")), ("server rack", "server rack", "filing cabinet")
    ),
    "server room": Equipped(
        (walls("server rack", "server rack", "server rack"),), ("server rack", "server rack", "filing cabinet")
    ),
    "laboratory": Equipped(
        (at("lab bench", "stool", 12.0), walls("filing cabinet")), ("display case", "lab bench", "lockers", "stool")
    ),
    "observatory": Equipped(
        (middle("telescope"), walls("globe", where="corner"), walls("bookshelf")),
        ("bookshelf", "orrery", "desk", "armchair", "lectern"),
        soft=True,
    ),
    "atelier": Equipped((some("easel", 9.0), at("workbench", "stool")), ("stool", "statue", "chest", "plant", "easel")),
    "classroom": Equipped((row("pupil desk", "blackboard", 1.6, seat="chair"),), ("bookshelf", "globe", "lectern", "plant")),
    # company
    "bar": Equipped(
        (served("bar counter", "bottle shelf", stools="bar stool"), dining(9.0)), ("bottle shelf", "plant", "barrel"), soft=True
    ),
    "restaurant": Equipped((dining(6.0), walls("sideboard")), ("plant", "sideboard", "plant", "coat rack"), soft=True),
    "bakery": Equipped(
        (served("cake counter", "larder shelf"), walls("stove")), ("larder shelf", "kitchen counter", "larder shelf", "basket")
    ),
    "shop": Equipped(
        (walls("shop shelf", "shop shelf"), served("shop counter", "shop shelf")),
        ("shop shelf", "shop shelf", "basket", "shop shelf"),
        sparse=0.8,
    ),
    "barber": Equipped(
        (walls("barber chair"), hung("mirror", 1.4), walls("barber chair", "dresser")), ("chair", "bench", "plant", "coat rack")
    ),
    "museum": Equipped(
        (some("display case", 12.0), walls("display case", "statue", where="corner")),
        ("statue", "column", "display case", "bench", "suit of armour"),
        soft=True,
        sparse=0.8,
    ),
    "chapel": Equipped(
        (row("pew", "altar table", 1.1, most=6), walls("candelabra", "candelabra", where="corner")),
        ("lectern", "statue", "column"),
    ),
    "crypt": Equipped(
        (walls("altar table"), walls("column", "column", "candelabra", where="corner")),
        ("statue", "column", "chest", "candelabra"),
    ),
    "throne room": Equipped(
        (walls("throne", where="centre"), walls("candelabra", "column", "column", where="corner"), hung("tapestry", 1.8), carpet),
        ("statue", "column", "bench", "suit of armour", "chest"),
        soft=True,
    ),
    "ballroom": Equipped(
        (at("piano", "stool"), walls("bench", "chair", "chair")),
        ("chair", "chair", "console table", "candelabra", "plant"),
        soft=True,
    ),
    # body and mind
    "gym": Equipped(
        (walls("treadmill", "weight bench", "dumbbell rack"), laid("yoga mat", 2), hung("mirror", 1.3)),
        ("exercise bike", "treadmill", "punching bag", "lockers", "exercise bike"),
        sparse=0.8,
    ),
    "yoga": Equipped(
        (laid("yoga mat", 6), walls("plant", where="corner"), hung("mirror", 1.3)), ("plant", "bench", "basket"), sparse=0.6
    ),
    "dance": Equipped((hung("mirror", 1.2), hung("mirror", 1.2), hung("mirror", 1.2), at("piano", "stool")), ("bench", "plant")),
    "changing room": Equipped((walls("lockers", "lockers", "bench"), hung("mirror", 1.4)), ("lockers", "bench", "basket")),
    "sauna": Equipped((walls("sauna bench"), walls("sauna stove", where="corner")), ("basket",), sparse=0.0),
    "pool": Equipped((middle("pool"), walls("deck chair", "deck chair")), ("deck chair", "plant", "plant", "bench")),
    "hospital": Equipped(
        (asleep("hospital bed", 7.0, "drip stand"), walls("drip stand")), ("nightstand", "chair", "filing cabinet", "washbasin")
    ),
    "surgery": Equipped((walls("examination table", "washbasin"), desk), ("filing cabinet", "chair", "drip stand")),
    # play
    "music": Equipped(
        (at("piano", "stool"), some("music stand", 12.0), walls("drum kit", where="corner")),
        ("bookshelf", "chair", "armchair", "plant", "music stand"),
        soft=True,
        sparse=0.8,
    ),
    "games": Equipped(
        (middle("tennis table"), walls("arcade machine", "arcade machine"), hung("dartboard", 1.7)),
        ("arcade machine", "stool", "plant"),
        soft=True,
    ),
    "billiard": Equipped(
        (middle("billiard table"), hung("dartboard", 1.7)), ("bench", "bottle shelf", "armchair", "plant"), soft=True
    ),
    "cinema": Equipped((row("cinema seats", "wall screen", 1.7),), ("plant",), sparse=0.2),
    # keep
    "cellar": Equipped(
        (walls("barrel", "barrel", "bottle shelf"),), ("barrel", "bottle shelf", "chest", "barrel", "larder shelf")
    ),
    "vault": Equipped((walls("safe", "chest", "chest"),), ("safe", "chest", "display case", "chest")),
    "armoury": Equipped(
        (walls("weapon rack", "suit of armour", "weapon rack"),), ("weapon rack", "suit of armour", "chest", "bench"), sparse=0.8
    ),
    "stable": Equipped(
        (walls("horse stall", "horse stall", where="corner"), walls("hay bale", "trough"), walls("hay bale")),
        ("hay bale", "horse stall", "barrel", "hay bale"),
    ),
    "cell": Equipped((walls("bunk bed", "toilet", where="corner"), walls("washbasin")), ("stool",), sparse=0.0),
    # a name that says nothing
    "other": Equipped(
        (carpet, walls("bench")), ("console table", "plant", "chair", "floor lamp", "plant"), soft=True, sparse=0.6
    ),
}
"""The types of rooms that a table furnishes."""
