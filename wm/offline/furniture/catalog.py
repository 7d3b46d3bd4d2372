"""All kinds of furniture by name, and the function that builds a piece of a kind."""

import numpy as np

from wm.offline.furniture import (
    bath,
    bathing,
    beds,
    cabinets,
    ceremony,
    childhood,
    cinema,
    clinic,
    clockwork,
    counters,
    games,
    garage,
    greenery,
    gym,
    hallway,
    kitchen,
    laundry,
    lighting,
    music,
    outdoors,
    school,
    sculpture,
    seating,
    shelving,
    stable,
    storage,
    tables,
    tabletop,
    textiles,
    walls,
)
from wm.offline.furniture.piece import FurnitureKind, Piece, Size, assemble
from wm.offline.style.finish import Style

EQUIPMENT: dict[str, FurnitureKind] = {
    **bathing.KINDS,
    **cabinets.KINDS,
    **ceremony.KINDS,
    **childhood.KINDS,
    **cinema.KINDS,
    **clinic.KINDS,
    **counters.KINDS,
    **games.KINDS,
    **garage.KINDS,
    **gym.KINDS,
    **hallway.KINDS,
    **laundry.KINDS,
    **music.KINDS,
    **outdoors.KINDS,
    **school.KINDS,
    **shelving.KINDS,
    **stable.KINDS,
}
"""Kinds that belong in rooms of some sorts only: a treadmill stands in a gym, and nowhere else."""

KINDS: dict[str, FurnitureKind] = {
    **seating.KINDS,
    **tables.KINDS,
    **beds.KINDS,
    **storage.KINDS,
    **lighting.KINDS,
    **textiles.KINDS,
    **walls.KINDS,
    **greenery.KINDS,
    **sculpture.KINDS,
    **tabletop.KINDS,
    **kitchen.KINDS,
    **bath.KINDS,
    **clockwork.KINDS,
    **EQUIPMENT,
}


def make_piece(kind: str, style: Style, rng: np.random.Generator, *, size: Size | None = None) -> Piece:
    """One piece of a kind in its own frame.

    Args:
      kind: key of KINDS; it is also the piece's label.
      size: nominal width, depth and height in metres; if None, they are drawn from the range of the kind. Splayed legs, cornices
        and taps may extend a few centimetres beyond them; `size` of the piece is the size that was built.

    Raises:
      KeyError: no such kind.
    """
    if kind not in KINDS:
        raise KeyError(f"unknown furniture kind {kind!r}; kinds: {', '.join(KINDS)}")
    entry = KINDS[kind]
    if size is None:
        share = rng.random(3)
        low, high = np.array(entry.low), np.array(entry.high)
        w, d, h = (low + share * (high - low)).tolist()
        size = (w, d, h)
    return assemble(kind, entry.support, entry.build(style, rng, size), style)
