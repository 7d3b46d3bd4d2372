"""Labels and furniture kinds: which parametric template stands for a label, and the sizes that it is built in."""

import dataclasses
import functools

import numpy as np
from jaxtyping import Float

from wm.offline.arrangement.inventory import lamp_sorts, with_lamp
from wm.offline.furniture import KINDS, Piece, make_piece
from wm.offline.style.finish import Style
from wm.synth.lifting.vocabulary import sort_of

ANYTHING = "chest"
"""The template of a label that says nothing: a box with a lid."""

_BEYOND = 0.25
"""Share of its range by which a kind is built smaller or larger than usual."""


@dataclasses.dataclass(frozen=True, eq=False)
class Template:
    """A kind of furniture at its middle size, and the sizes that it is usually built in."""

    kind: str
    style: Style
    support: str  # floor | flat | wall | ceiling | object
    piece: Piece
    low: np.ndarray  # [3] metres
    high: np.ndarray  # [3]


def kind_of(label: str) -> str:
    """The furniture kind whose template stands for a label: a key of KINDS."""
    sort = sort_of(label)
    return sort if sort in KINDS else ANYTHING


def rebuilt(template: Template, size: Float[np.ndarray, "3"], rng: np.random.Generator | None = None) -> Piece:
    """A template's piece built anew for about this size, and not stretched to it: legs stay as thick, and cushions as round.

    Pieces are built to nominal sizes, which legs that splay and taps go beyond: size and nominal size lie at the same share of
    their ranges.
    """
    entry, span = KINDS[template.kind], template.high - template.low
    share = np.where(span > 1e-6, (size - template.low) / np.where(span > 1e-6, span, 1.0), 0.5)
    low, high = np.array(entry.low), np.array(entry.high)
    nominal = low + np.clip(share, -_BEYOND, 1 + _BEYOND) * (high - low)
    return make_piece(template.kind, template.style, rng or np.random.default_rng(0), size=_size(nominal))


@functools.lru_cache(maxsize=512)
def template_of(kind: str, style: Style) -> Template:
    """A kind's template in a style."""
    entry = KINDS[kind]
    low, high = np.array(entry.low), np.array(entry.high)
    pieces = [make_piece(kind, style, np.random.default_rng(0), size=_size(at)) for at in (low, (low + high) / 2, high)]
    sizes = np.stack([piece.size for piece in pieces])
    return Template(kind=kind, style=style, support=entry.support, piece=pieces[1], low=sizes.min(axis=0), high=sizes.max(axis=0))


@functools.lru_cache(maxsize=512)
def templates_of(kind: str, style: Style) -> tuple[Template, ...]:
    """A kind's templates in a style: one, but of lamps one for each shape that the sorts of lamp in the style's houses have."""
    by_shape: dict[bytes, Template] = {}
    for sort in lamp_sorts(style):
        template = template_of(kind, with_lamp(style, sort))
        by_shape.setdefault(template.piece.vertices.tobytes(), template)
    return tuple(by_shape.values())


def _size(size: np.ndarray) -> tuple[float, float, float]:
    w, d, h = size.tolist()
    return w, d, h
