"""Labels on a drawing: where each text stands so that no two overlap.

Greedy, in order of importance: a label tries the places it is given, in one line, in two, then turned, and takes the first where
its box is clear of all that were placed before; one that fits nowhere is left out. Widths are estimated from the number of
letters, since who draws the text knows the font and this program does not.
"""

import dataclasses
import itertools
from collections.abc import Iterable, Sequence

LETTER, LINE = 0.56, 1.15
"""Width of a letter and height of a line, as shares of the font's size: of a sans-serif, semibold face and on the large side."""
LONGEST = 28
"""Letters that a label has at most; the rest is cut off and an ellipsis says so."""


@dataclasses.dataclass(frozen=True)
class Box:
    """An axis-aligned rectangle, pixels."""

    x0: float
    y0: float
    x1: float
    y1: float

    def overlaps(self, other: "Box") -> bool:
        """Whether they share more than an edge."""
        return self.x0 < other.x1 and other.x0 < self.x1 and self.y0 < other.y1 and other.y0 < self.y1

    def within(self, other: "Box") -> bool:
        """Whether no part of it is outside the other, to a hundredth of a pixel."""
        return min(self.x0 - other.x0, self.y0 - other.y0, other.x1 - self.x1, other.y1 - self.y1) > -0.01


@dataclasses.dataclass(frozen=True)
class Label:
    """A text in its place."""

    lines: tuple[str, ...]
    x: float  # of its middle, pixels
    y: float
    turned: bool  # reads upwards
    box: Box


def place_label(
    text: str, places: Iterable[tuple[float, float]], *, size: float, taken: Sequence[Box], sheet: Box, turned: bool = False
) -> Label | None:
    """The label at the first of the places where it fits beside what is taken; None where it fits nowhere.

    Args:
        places: of its middle, pixels, best first; moved as little as keeps the label within the sheet.
        size: of the font, pixels.
        turned: upwards is tried before across, for what is longer that way.
    """
    layouts = [(lines, way) for way in (turned, not turned) for lines in _lines(text)]
    for (x, y), (lines, way) in itertools.product(places, layouts):
        box = _box(lines, x, y, size, way)
        dx = max(sheet.x0 - box.x0, 0.0) + min(sheet.x1 - box.x1, 0.0)
        dy = max(sheet.y0 - box.y0, 0.0) + min(sheet.y1 - box.y1, 0.0)
        box = Box(box.x0 + dx, box.y0 + dy, box.x1 + dx, box.y1 + dy)
        if box.within(sheet) and not any(box.overlaps(other) for other in taken):
            return Label(lines=lines, x=x + dx, y=y + dy, turned=way, box=box)
    return None


def _lines(text: str) -> list[tuple[str, ...]]:
    """The text in one line, and in the two of most equal length if it has a space."""
    text = " ".join(text.split())
    text = text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
    words = text.split(" ")
    halves = [(" ".join(words[:k]), " ".join(words[k:])) for k in range(1, len(words))]
    return [(text,), *([min(halves, key=lambda half: max(map(len, half)))] if halves else [])]


def _box(lines: tuple[str, ...], x: float, y: float, size: float, turned: bool) -> Box:
    width, height = LETTER * size * max(map(len, lines)), LINE * size * len(lines)
    if turned:
        width, height = height, width
    return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)
