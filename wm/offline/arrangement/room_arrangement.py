"""One room while it is being furnished: what every group of furniture is placed with, and places relative to a piece."""

import dataclasses
import math

import numpy as np

from wm.offline.arrangement.clutter import add_clutter
from wm.offline.arrangement.layout import Layout, Placed
from wm.offline.furniture import KINDS, Piece, make_piece
from wm.offline.style.finish import Style


@dataclasses.dataclass(frozen=True, eq=False)
class RoomArrangement:
    """One room being furnished: its layout so far, the style, and the random generator that all choices are drawn from."""

    layout: Layout
    style: Style
    rng: np.random.Generator
    density: float

    def piece(self, kind: str, size: tuple[float, float, float] | None = None) -> Piece:
        return make_piece(kind, self.style, self.rng, size=size)

    def dressed(self, placed: Placed | None) -> Placed | None:
        if placed is not None:
            add_clutter(self.layout, placed, self.style, self.rng, density=self.density)
        return placed

    def at_wall(
        self,
        kind: str,
        *,
        where: str = "any",
        mates: frozenset[str] = frozenset(),
        size: tuple[float, float, float] | None = None,
    ) -> Placed | None:
        """A piece of a kind with its back to a wall, its surfaces dressed."""
        piece = self.piece(kind, size)
        return self.dressed(self.layout.against_wall(piece, self.rng, front=KINDS[kind].front, where=where, mates=mates))

    def chance(self, share: float) -> bool:
        """Whether an event of probability `share` times the density happens; one number is drawn whatever the density."""
        return bool(self.rng.random() < share * self.density)


def local(placed: Placed, dx: float, dy: float) -> tuple[float, float]:
    """World (x, y) of a point of a placed piece's frame."""
    c, s = math.cos(placed.yaw), math.sin(placed.yaw)
    return placed.x + c * dx - s * dy, placed.y + s * dx + c * dy


def beside(
    room: RoomArrangement,
    placed: Placed,
    piece: Piece,
    side: float,
    *,
    gap: float = 0.06,
    flush: str = "back",
    turned: float = 0.0,
) -> Placed | None:
    """A piece next to another, on its right (side 1) or left (-1), backs or fronts in line."""
    w, d = float(placed.piece.size[0]), float(placed.piece.size[1])
    dy = (d - float(piece.size[1])) / 2 * (1.0 if flush == "back" else -1.0)
    x, y = local(placed, side * (w / 2 + gap + float(piece.size[0]) / 2), dy)
    return room.layout.try_at(piece, x, y, placed.yaw + turned)
