"""Words that belong together, words that negate, and words that carry no meaning of their own."""

PHRASES: dict[tuple[str, ...], str] = {
    ("space", "station"): "spaceship", ("space", "ship"): "spaceship", ("star", "ship"): "spaceship", ("moon",
    "base"): "spaceship",
    ("tree", "house"): "treehouse", ("living", "space"): "room", ("open", "space"): "room", ("work", "space"): "room",
    ("outer", "space"): "spaceship",
    ("art", "deco"): "deco", ("art", "nouveau"): "nouveau", ("mid", "century"): "midcentury",
    ("sci", "fi"): "scifi", ("science", "fiction"): "scifi", ("steam", "punk"): "steampunk", ("cyber", "punk"): "cyberpunk",
    ("film", "noir"): "noir", ("ice", "palace"): "igloo", ("ice", "hotel"): "igloo", ("ice", "castle"): "igloo",
    ("tea", "house"): "teahouse", ("log", "cabin"): "cabin", ("light", "house"): "lighthouse", ("candle", "light"): "candlelit",
    ("candle", "lit"): "candlelit", ("fire", "lit"): "firelit", ("moon", "light"): "moonlit", ("moon", "lit"): "moonlit",
    ("sun", "lit"): "sunny", ("sun", "drenched"): "sunny", ("post", "apocalyptic"): "apocalyptic", ("new", "york"): "newyork",
    ("ginger", "bread"): "gingerbread", ("doll", "house"): "dollhouse", ("night", "club"): "nightclub",
    ("operating", "theatre"): "hospital", ("noodle", "bar"): "ramen", ("sushi", "bar"): "ramen", ("coffee", "shop"): "cafe",
    ("pastry", "shop"): "bakery", ("wild", "west"): "western", ("bottle", "green"): "bottle-green", ("sky", "blue"): "sky-blue",
    ("forest", "green"): "forest-green", ("baby", "blue"): "baby-blue", ("brick", "red"): "brick-red", ("snow", "white"): "white",
    ("off", "white"): "offwhite", ("slate", "grey"): "slate-grey", ("slate", "gray"): "slate-grey", ("navy", "blue"): "navy",
    ("dark", "ages"): "medieval", ("middle", "ages"): "medieval", ("nineteen", "seventies"): "1970s",
    ("19th", "century"): "victorian", ("18th", "century"): "baroque", ("nineteenth", "century"): "victorian",
    ("eighteenth", "century"): "baroque", ("roaring", "twenties"): "1920s", ("bell", "epoque"): "nouveau",
    ("belle", "epoque"): "nouveau", ("class", "room"): "school", ("fairy", "tale"): "fairytale", ("wrought", "iron"): "iron",
    ("stainless", "steel"): "steel", ("stained", "glass"): "cathedral", ("tree", "top"): "treehouse", ("under",
    "water"): "underwater",
    ("polka", "dot"): "playful", ("four", "poster"): "bed", ("book", "shelf"): "shelf", ("book", "case"): "shelf",
    ("arm", "chair"): "armchair", ("fire", "place"): "fireplace", ("bath", "tub"): "bathtub", ("wall", "paper"): "wallpaper",
}  # fmt: skip
"""Words in a row -> the one word that they mean."""

NEGATIONS: frozenset[str] = frozenset(
    {"no", "not", "without", "never", "nor", "neither", "non", "avoid", "lacking", "minus", "zero"}
)
LISTED: frozenset[str] = frozenset({"or", "nor"})
"""Words after which a negation goes on."""
POSTFIX: frozenset[str] = frozenset({"of", "in", "are", "is", "painted", "made", "from", "covered", "be", "done", "finished"})
"""Words between a noun and the colours or materials that are said of it: "walls of brick", "walls painted yellow"."""

_FILLERS = """
free a an the and or of in on at to for with by from into over under near as but its it is are be that this these those all every
each some any my our your his her their very quite rather really somewhat slightly mostly mainly partly lots many much few
full made done like look looking style styled inspired themed theme feel feeling atmosphere vibe type kind sort design
designed decor decorated interior interiors room rooms house houses home homes building buildings place places flat
residence dwelling abode quarters set scene world city town street inside outside where there who which has have
having please make create want would i we you one two three four five old new big large small little tiny huge great tall
high low long wide whole other own real nice beautiful lovely pretty cute cool traditional classic elegant stylish detail
details revival period century accent accents touch touches element elements colour colours color colors coloured colored
tone tones toned palette scheme everywhere throughout covered curved rounded round smooth shiny polished glossy matte matt
raw exposed reclaimed rough natural fine heavy thick thin panelled-out bar station hut estate retreat tower hall parlour
lounge s t don so up down out off no not without never furnished filled lit
"""
FILLERS: frozenset[str] = frozenset(_FILLERS.split())
"""Words that are neither used nor reported as unknown."""

ROOM_NOUNS: frozenset[str] = frozenset(
    {
        "kitchen", "kitchenette", "bathroom", "bedroom", "corridor", "hallway", "entrance", "vestibule", "landing", "pantry",
        "larder", "nursery", "study", "laundry", "cloakroom", "toilet", "wc", "lavatory", "cellar", "basement", "attic", "loft",
        "balcony", "ensuite",
    }
)  # fmt: skip
"""Words that name one room of a house; so does any other with "room" at its end or after it. A restaurant, a gallery or a shop is
not one of them: such a word stands for all of the scene."""
