"""What a style says: the vocabulary of materials and slots, and the records that name and colour them.

A *material* is a procedural function of world position and normal (wm.offline.world.materials); a *finish* is a material
with its colours and pattern parameters; a *slot* is the name a piece of furniture gives to a part of its mesh ("dark_wood",
"fabric"). Furniture and surfaces only name things here; how they look is the materials' business.
"""

import dataclasses

from wm.offline.style.reading import Request

Rgb = tuple[float, float, float]
"""sRGB-encoded colour in [0, 1]."""

MATERIALS: dict[str, str] = {
    # name: what it shows; meaning of colors[0], colors[1], colors[2]; what `scale` measures (metres)
    "plaster": "trowelled lime plaster; base, blotch; blotch size",
    "paint": "flat wall paint, faint roller texture; base; -",
    "wallpaper_damask": "damask paper; ground, figure; height of one repeat",
    "wallpaper_stripe": "striped paper; ground, stripe; width of one stripe",
    "wallpaper_gears": "paper printed with meshing gear wheels; ground, wheels; distance between two wheels' middles",
    "fresco": "painted plaster in fields parted by columns; field, every other field, lines; width of a field",
    "panelling": "framed wooden panels; wood, groove; width of one panel",
    "brick": "running-bond brick; brick, joint, odd brick; length of one brick",
    "concrete": "board-marked concrete with tie holes; base, stain; height of one lift",
    "terracotta": "square terracotta tiles; tile, joint, odd tile; tile side",
    "mosaic": "small tesserae; ground, figure, border; tessera side",
    "stone_tiles": "cut stone tiles; stone, joint, vein; tile side",
    "stone_blocks": "ashlar masonry; stone, joint, stain; block length",
    "checker_tiles": "two-tone square tiles; light, dark, joint; tile side",
    "sectile": "inlaid marble, discs and lozenges in squares; ground, second marble, third; side of a square",
    "water_tiles": "glazed tiles with a caustic shimmer; glaze, joint, caustic; tile side",
    "marble": "polished veined marble; base, vein, second vein; vein spacing",
    "wood_planks": "long boards; wood, joint, grain; board width",
    "herringbone": "herringbone parquet; wood, joint, grain; block length",
    "parquet": "basket-weave parquet; wood, joint, grain; side of a square",
    "wood": "solid wood with grain; wood, grain; spacing of the grain",
    "painted_wood": "painted wood, brush marks, worn edges; paint, wood below; brush width",
    "lacquer": "glossy lacquer; base, reflection tint; -",
    "carpet": "wall-to-wall or rug pile; pile, fleck; tuft size",
    "textile": "plain weave; thread, cross thread; weave size",
    "velvet": "velvet with sheen; pile, sheen; -",
    "tatami": "woven rush mats with cloth borders; rush, border; mat width",
    "woven": "wicker, rattan, rope; strand, shadow; strand width",
    "leather": "leather with pores and creases; hide, crease; crease size",
    "metal": "brushed or polished metal; base, reflection tint; brush width",
    "glass": "clear or tinted glass; tint; -",
    "mirror": "silvered glass; tint, sky tint; -",
    "ceramic": "glazed ceramic; glaze; -",
    "paper": "paper and card; sheet, print; -",
    "painting": "a painted canvas; ground, figure, accent; size of the figure",
    "leaf": "foliage; leaf, vein; leaf length",
    "soil": "earth; base, fleck; crumb size",
    "wax": "candle wax; base; -",
    "capsule": "moulded panels with rounded corners; panel, seam, shade at the edges; height of one panel",
    "riveted": "metal plates with rivets along their edges; metal, joint, odd plate; width of a plate",
    "rock": "living rock, uneven and cracked; rock, cracks, veins; size of the bulges",
    "glow": "a surface that gives light: flame, bulb, screen, ember; base; -",
}
"""Every material a finish may name."""


@dataclasses.dataclass(frozen=True)
class Finish:
    """A material with its colours and pattern parameters."""

    material: str  # key of MATERIALS
    colors: tuple[Rgb, ...]  # base first, then as MATERIALS says; at least one
    scale: float = 0.1  # characteristic length of the pattern, metres
    contrast: float = 1.0  # 0 flat .. 1 the material's full contrast
    roughness: float = 0.7  # 0 mirror .. 1 matt
    wear: float = 0.2  # 0 new .. 1 derelict


@dataclasses.dataclass(frozen=True)
class Surfaces:
    """Finishes of a room's structure."""

    wall: Finish
    floor: Finish
    ceiling: Finish
    trim: Finish  # reveals, jambs, skirting, cornice
    wainscot: Finish | None = None  # the lower wall, up to wainscot_height
    wainscot_height: float = 0.0  # metres; 0 without wainscot


@dataclasses.dataclass(frozen=True)
class Form:
    """How a style shapes furniture."""

    legs: str  # turned | tapered | straight | cabriole | hairpin | column | slab
    back: str  # pointed_arch | round_arch | spindle | slats | panel | klismos | plain | wave: chair backs and headboards
    panel: str  # pointed | raised | flat | arched | slats | plain: fronts of cupboards, chests, fireplaces
    lamp: str  # cone | drum | globe | lantern | candle | tripod | paper | rattan | dome | bowl | cluster: lamps and pendants
    softness: float  # 0..1: thickness and roundness of cushions and edges
    ornament: float  # 0..1: finials, mouldings, tufting, extra clutter
    low: float = 1.0  # factor on seat and bed heights (a tea house sits low)


OUTLOOKS: tuple[str, ...] = ("country", "space", "deep_sea", "open_sea", "ice", "dunes", "city")
"""What may lie outside of the windows."""


@dataclasses.dataclass(frozen=True)
class Light:
    """The scene's light: sun and sky through the windows, and lamps."""

    sun_color: Rgb
    sun_strength: float  # 0 night .. 1 full sun
    sun_elevation: float  # radians above the horizon
    sun_azimuth: float  # radians counter-clockwise from +x, where the sun stands
    sky_color: Rgb
    sky_strength: float  # 0..1
    lamp_color: Rgb
    lamp_strength: float  # 0..1
    fire_color: Rgb = (1.0, 0.55, 0.2)
    outlook: str = "country"  # one of OUTLOOKS: what lies outside of the windows


@dataclasses.dataclass(frozen=True)
class Wish:
    """What a theme asks of some kinds of furniture."""

    kinds: tuple[str, ...]  # labels of pieces
    slots: tuple[str, ...] = ()  # the slots that change where a piece has them
    slot: str = ""  # the slot that they become: another material; "" leaves the material
    color: Rgb | None = None  # of those slots; None leaves it
    absent: bool = False  # the pieces are left out


@dataclasses.dataclass(frozen=True)
class Style:
    """What a theme's words mean."""

    theme: str
    family: str
    rooms: tuple[tuple[str, Surfaces], ...]  # by room type; "other" is always there
    slots: tuple[tuple[str, Finish], ...]  # one finish for each of SLOTS
    form: Form
    light: Light
    accents: tuple[Rgb, ...]  # colours for books, cushions, pictures, vases; at least five
    wishes: tuple[Wish, ...] = ()  # what the theme asks of some kinds of furniture
    asked: tuple[Request, ...] = ()  # what it asks of the surfaces of one sort of room (wm.offline.style.requests.surfaces_in)

    def surfaces(self, room_type: str) -> Surfaces:
        """Finishes of a room's structure, those of "other" where the type has none of its own."""
        table = dict(self.rooms)
        return table.get(room_type, table["other"])

    def slot(self, name: str) -> Finish:
        """Finish of a furniture slot.

        Raises:
          KeyError: no such slot; the slots are SLOTS.
        """
        for slot, finish in self.slots:
            if slot == name:
                return finish
        raise KeyError(f"unknown furniture slot {name!r}; slots: {', '.join(SLOTS)}")


PERIOD = frozenset({"gothic", "victorian", "baroque", "roman", "rustic", "japanese", "moroccan", "clockwork", "surreal"})
"""Families without screens and swivel chairs, and with cast-iron stoves."""

SLOTS: tuple[str, ...] = (
    "wood", "dark_wood", "light_wood", "panel_wood", "painted_wood", "lacquer",
    "fabric", "fabric_accent", "velvet", "leather", "linen", "pillow", "blanket", "curtain", "rug", "rug_border", "woven",
    "metal", "dark_metal", "brass", "chrome", "steel", "stone", "marble", "tile", "ceramic", "glass", "mirror", "water",
    "paper", "book", "painting", "leaf", "flower", "soil", "terracotta", "wax",
    "lamp_shade", "bulb", "flame", "ember", "screen", "appliance", "soot", "foliage",
)  # fmt: skip
"""Every slot a piece of furniture may name. `SceneObject.slots` may repeat a name with different colours (books)."""
