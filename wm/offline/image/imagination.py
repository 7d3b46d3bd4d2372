"""Imagined worlds: what the offline image model draws where its condition leaves something open.

All of them have the structure of the scene. World 0 is the scene itself, whose held-out views count as the truth. The others
differ in what the condition leaves open: the finish of walls, floors and ceilings, and either the furniture in the box of each
object or all of the furniture. The seed of a view selects one, so that views disagree as those of an image model do. Since there
are few worlds, light is baked once per room of a world and not once per view. For an empty room that it is asked to furnish, the
model draws FURNISHED: the finish of the scene with the furniture that the offline objects backend makes.
"""

import dataclasses

import numpy as np

from wm.offline.arrangement.furnishing import furnish_room, furnish_scene
from wm.offline.arrangement.inventory import ABSENT, FLAVOUR
from wm.offline.arrangement.room_type import room_type
from wm.offline.furniture import EQUIPMENT, KINDS, bath, kitchen, make_piece
from wm.offline.style.finish import Finish, Rgb, Style, Surfaces
from wm.offline.style.style_sheet import mix_rgb
from wm.offline.style.theme import style_of
from wm.synth.backends import SceneContext
from wm.types import SceneObject

WALLS = (("paint", 0.1), ("plaster", 1.0), ("wallpaper_damask", 0.7), ("wallpaper_stripe", 0.14), ("panelling", 0.6),
         ("brick", 0.24), ("stone_blocks", 0.6), ("wood_planks", 0.16))  # fmt: skip
FLOORS = (("wood_planks", 0.16), ("herringbone", 0.5), ("parquet", 0.45), ("stone_tiles", 0.6), ("checker_tiles", 0.5),
          ("terracotta", 0.3), ("marble", 0.8), ("carpet", 0.01))  # fmt: skip
CEILINGS = (("paint", 0.1), ("plaster", 1.0), ("wood_planks", 0.2))
"""The materials that an imagined surface may have, each with the length of its pattern in metres."""
WOODEN = frozenset({"panelling", "wood_planks", "herringbone", "parquet"})
"""Materials in the colour of the theme's woods."""
SURFACES, BOXES, FURNITURE = 1, 2, 3
"""What numbers are drawn for: finishes, furniture in the scene's boxes, furniture in other places."""
RIVALS = 5
"""Number of kinds, those of the most similar proportions, from which the substitute of an object is drawn."""
STRETCH = 2.2
"""Largest factor by which a side of a piece may be stretched to fill a box."""


@dataclasses.dataclass(frozen=True)
class Imagination:
    """Selects a world by the number of its finish and that of its furniture; 0 is the scene's own."""

    surfaces: int = 0
    furniture: int = 0
    boxed: bool = False  # whether other furniture fills the boxes of the scene's objects; otherwise it stands in other places
    furnished: bool = False  # whether the furniture is that of the offline objects backend


SCENE, FURNISHED = Imagination(), Imagination(furnished=True)


def imagined_scene(context: SceneContext, which: Imagination) -> SceneContext:
    """The scene of a world. It depends on the world's furniture only, not on its finish."""
    if which.furnished:
        return dataclasses.replace(context, objects=furnish_scene(context))
    if not which.furniture:
        return context
    things = boxed_furniture if which.boxed else other_furniture
    return dataclasses.replace(context, objects=things(context, which.furniture))


def imagined_style(context: SceneContext, which: Imagination) -> Style:
    """The style of a world. It depends on the world's finish only, not on its furniture."""
    style = style_of(context.theme)
    return refinished(style, _dice(context, which.surfaces, SURFACES)) if which.surfaces else style


def refinished(style: Style, rng: np.random.Generator) -> Style:
    """The style with other walls, floors and ceilings in every type of room, in colours of its own palette."""
    return dataclasses.replace(style, rooms=tuple((kind, _surfaces(surfaces, style, rng)) for kind, surfaces in style.rooms))


def _surfaces(own: Surfaces, style: Style, rng: np.random.Generator) -> Surfaces:
    wall, floor = (_finish(finish, table, style, rng) for finish, table in ((own.wall, WALLS), (own.floor, FLOORS)))
    tint = style.accents[int(rng.integers(len(style.accents)))]
    ceiling = _finish(own.ceiling, CEILINGS, style, rng)
    trim = dataclasses.replace(own.trim, colors=tuple(mix_rgb(color, tint, 0.35) for color in own.trim.colors))
    return Surfaces(wall=wall, floor=floor, ceiling=ceiling, trim=trim)


def _finish(own: Finish, table: tuple[tuple[str, float], ...], style: Style, rng: np.random.Generator) -> Finish:
    """A finish of another material, about as light or dark as the given one."""
    choices = [entry for entry in table if entry[0] != own.material]
    material, scale = choices[int(rng.integers(len(choices)))]
    wood = style.slot(("wood", "dark_wood", "light_wood")[int(rng.integers(3))]).colors[0]
    accent = style.accents[int(rng.integers(len(style.accents)))]
    base = wood if material in WOODEN else mix_rgb(own.colors[0], accent, float(rng.uniform(0.2, 0.55)))
    darker, lighter = mix_rgb(base, (0.0, 0.0, 0.0), 0.35), mix_rgb(base, (1.0, 1.0, 1.0), 0.3)
    return Finish(material, (base, darker, lighter), scale, roughness=own.roughness, wear=own.wear)


def restyled(style: Style, rng: np.random.Generator) -> Style:
    """The style with other shapes of furniture (legs, backs, fronts, lamps) and other colours in every slot."""
    form = dataclasses.replace(
        style.form,
        legs=str(rng.choice(["turned", "tapered", "straight", "cabriole", "hairpin", "column", "slab"])),
        back=str(rng.choice(["pointed_arch", "round_arch", "spindle", "slats", "panel", "klismos", "plain", "wave"])),
        panel=str(rng.choice(["pointed", "raised", "flat", "arched", "slats", "plain"])),
        lamp=str(rng.choice(["cone", "drum", "globe", "lantern", "candle", "tripod"])),
        softness=float(rng.uniform(0.1, 0.9)),
    )
    slots = tuple((name, _recolored(finish, style.accents, rng)) for name, finish in style.slots)
    accents = tuple(style.accents[int(k)] for k in rng.permutation(len(style.accents)))
    return dataclasses.replace(style, form=form, slots=slots, accents=accents)


def _recolored(finish: Finish, accents: tuple[Rgb, ...], rng: np.random.Generator) -> Finish:
    accent, share = accents[int(rng.integers(len(accents)))], float(rng.uniform(0.25, 0.6))
    if finish.material == "glow":
        return finish
    return dataclasses.replace(finish, colors=tuple(mix_rgb(color, accent, share) for color in finish.colors))


def boxed_furniture(context: SceneContext, number: int) -> tuple[SceneObject, ...]:
    """For every object of the scene another that fills its box: of another kind, style and colours."""
    rng = _dice(context, number, BOXES)
    style = restyled(style_of(context.theme), rng)
    rooms = [room_type(room.name) for room in context.plan.rooms]
    return tuple(_stand_in(thing, rooms[thing.room], style, rng) for thing in context.objects)


def _stand_in(thing: SceneObject, room: str, style: Style, rng: np.random.Generator) -> SceneObject:
    rotation, origin = thing.T_world_object[:3, :3], thing.T_world_object[:3, 3]
    local = (thing.vertices - origin) @ rotation
    low, high = local.min(axis=0), local.max(axis=0)
    size = np.maximum(high - low, 1e-3)
    kinds = _rivals(thing, size, room, style.family)
    kind = kinds[int(rng.integers(len(kinds)))]
    width, depth, tall = _natural(kind, size).tolist()
    piece = make_piece(kind, style, rng, size=(width, depth, tall))
    start = piece.vertices.min(axis=0)
    stretch = (high - low) / np.maximum(piece.vertices.max(axis=0) - start, 1e-6)
    vertices = (low + (piece.vertices - start) * stretch) @ rotation.T + origin
    return SceneObject(
        label=piece.label, room=thing.room, support=thing.support, vertices=vertices, faces=piece.faces,
        face_slot=piece.face_slot, slots=piece.slots, slot_colors=piece.slot_colors,
        T_world_object=thing.T_world_object, size=high - low, emission=piece.emission,
    )  # fmt: skip


def _natural(kind: str, size: np.ndarray) -> np.ndarray:
    """The size, within the range of a kind, that is nearest to the wanted one."""
    return np.clip(size, KINDS[kind].low, KINDS[kind].high)


def _rivals(thing: SceneObject, size: np.ndarray, room: str, family: str) -> list[str]:
    """The kinds, other than that of the thing, that need the least stretching to fill a box of this size."""
    others = [kind for kind in KINDS if kind != thing.label and _belongs(kind, room, family)]
    others = [kind for kind in others if KINDS[kind].support == thing.support] or others

    def stretch(kind: str) -> float:
        return float(np.abs(np.log(_natural(kind, size) / size)).max())

    ranked = sorted(others, key=lambda kind: (stretch(kind), kind))
    fitting = [kind for kind in ranked if stretch(kind) <= np.log(STRETCH)]
    return (fitting or ranked[:1])[:RIVALS]


def _belongs(kind: str, room: str, family: str) -> bool:
    """Whether a family would have a kind of furniture in a type of room."""
    if kind in ABSENT.get(family, ()) or kind in EQUIPMENT:
        return False
    if kind in bath.KINDS or kind in kitchen.KINDS:
        return room == ("bathroom" if kind in bath.KINDS else "kitchen")
    flavours = {name for name, pieces in FLAVOUR.items() if any(piece == kind for piece, _ in pieces)}
    return not flavours or family in flavours


def other_furniture(context: SceneContext, number: int) -> tuple[SceneObject, ...]:
    """Every room furnished anew, as if nothing had ever stood there."""
    rng = _dice(context, number, FURNITURE)
    style = restyled(style_of(context.theme), rng)
    seed = int(rng.integers(2**31))
    rooms = range(len(context.plan.rooms))
    return tuple(thing for room in rooms for thing in furnish_room(context.plan, room, style, seed=seed))


def _dice(context: SceneContext, number: int, purpose: int) -> np.random.Generator:
    seed = context.seed_of("finish" if purpose == SURFACES else "furnish")
    return np.random.default_rng(np.random.SeedSequence([seed, number, purpose, 0x13A6]))
