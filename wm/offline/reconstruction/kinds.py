"""The parametric templates that a label selects, and the sizes in which they are built."""

import dataclasses
import functools

import numpy as np
from jaxtyping import Float

from wm.offline.arrangement.inventory import lamp_sorts, with_lamp
from wm.offline.furniture import KINDS, Piece, make_piece
from wm.offline.style.finish import Style
from wm.synth.lifting.vocabulary import sort_of

ANYTHING = "chest"
"""The kind for a label that names no known kind: a box with a lid."""

_BEYOND = 0.25
"""How far beyond its usual range of sizes a kind may be built, as a share of that range."""


@dataclasses.dataclass(frozen=True, eq=False)
class Template:
    """A kind of furniture built at the middle of its range of sizes, and that range."""

    kind: str
    style: Style
    support: str  # floor | flat | wall | ceiling | object
    piece: Piece
    low: np.ndarray  # [3] metres
    high: np.ndarray  # [3]


def kind_of(label: str) -> str:
    """The kind of furniture (a key of KINDS) that a label selects."""
    sort = sort_of(label)
    return sort if sort in KINDS else ANYTHING


def rebuilt(template: Template, size: Float[np.ndarray, "3"], rng: np.random.Generator | None = None) -> Piece:
    """A new piece of the template's kind, built for about this size. It is not stretched, so that legs keep their thickness.

    Pieces are built for nominal sizes, and parts such as splayed legs and taps reach beyond these. The nominal size is chosen at
    the same share of its range as `size` has in the range of the template.
    """
    entry, span = KINDS[template.kind], template.high - template.low
    share = np.where(span > 1e-6, (size - template.low) / np.where(span > 1e-6, span, 1.0), 0.5)
    low, high = np.array(entry.low), np.array(entry.high)
    nominal = low + np.clip(share, -_BEYOND, 1 + _BEYOND) * (high - low)
    return make_piece(template.kind, template.style, rng or np.random.default_rng(0), size=_size(nominal))


@functools.lru_cache(maxsize=512)
def template_of(kind: str, style: Style) -> Template:
    """The template of a kind in a style."""
    entry = KINDS[kind]
    low, high = np.array(entry.low), np.array(entry.high)
    pieces = [make_piece(kind, style, np.random.default_rng(0), size=_size(at)) for at in (low, (low + high) / 2, high)]
    sizes = np.stack([piece.size for piece in pieces])
    return Template(kind=kind, style=style, support=entry.support, piece=pieces[1], low=sizes.min(axis=0), high=sizes.max(axis=0))


@functools.lru_cache(maxsize=512)
def templates_of(kind: str, style: Style) -> tuple[Template, ...]:
    """The templates of a kind in a style: one per shape that its lamps may have for lamps, and one for all other kinds."""
    by_shape: dict[bytes, Template] = {}
    for sort in lamp_sorts(style):
        template = template_of(kind, with_lamp(style, sort))
        by_shape.setdefault(template.piece.vertices.tobytes(), template)
    return tuple(by_shape.values())


def _size(size: np.ndarray) -> tuple[float, float, float]:
    w, d, h = size.tolist()
    return w, d, h
