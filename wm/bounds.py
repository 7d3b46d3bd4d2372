"""What a field of a settings record may hold, declared with the field: bounds of a number, options of a choice, help for all.

    steps: int = number(120, 0, 10_000_000, "Optimiser steps per room.")
    init: str = choice("flat", ("flat", "isotropic", "random"), "How the initial gaussians are shaped.")
    video: bool = setting(True, "Write the fly-through.")

The declarations are metadata of the dataclass field, under "bounds", "options", "unit" and "help"; further keywords are stored
beside them. `wm.validate` reads them for a configuration, `check_settings` for a function that is called from Python. Standard
library only.
"""

import dataclasses
import numbers
from collections.abc import Iterator, Mapping
from typing import Any


@dataclasses.dataclass(frozen=True, kw_only=True)
class Bounds:
    """The interval of a number: from `low` on, up to `high`, which belongs to it unless `below`."""

    low: int | float
    high: int | float
    below: bool = False
    """Whether `high` itself is excluded."""
    whole: bool = False
    """Whether only integers will do."""
    null: str = ""
    """What None means, where it may stand for a number."""

    def allow(self, value: Any) -> bool:
        """Whether a field may hold this value. NaN, infinities and booleans are never allowed."""
        if value is None:
            return bool(self.null)
        wanted: type = int if self.whole else numbers.Real  # such as float, int, and the floating-point numbers of NumPy
        if isinstance(value, bool) or not isinstance(value, wanted):
            return False
        return bool(self.low <= value < self.high if self.below else self.low <= value <= self.high)

    def kind(self, value: Any) -> str:
        """What a refused value should have been: "an integer" where it is not one and should be, else "a number"."""
        return "an integer" if self.whole and not isinstance(value, int) else "a number"

    @property
    def span(self) -> str:
        """The interval in words, such as: 0 to below 1."""
        return f"{self.low:g} to {'below ' * self.below}{self.high:g}" + (f", or null for {self.null}" if self.null else "")

    @property
    def interval(self) -> str:
        """The interval in brackets, such as: [0, 1)."""
        return f"[{self.low:g}, {self.high:g}{')' if self.below else ']'}" + (f" or None for {self.null}" if self.null else "")


def setting(default: Any, help: str, **metadata: Any) -> Any:
    """A dataclass field with a default, and what it is for in a sentence."""
    return dataclasses.field(default=default, metadata={"help": help, **metadata})


def number(
    default: int | float | None,
    low: int | float,
    high: int | float,
    help: str,
    *,
    unit: str = "",
    below: bool = False,
    null: str = "",
    **metadata: Any,
) -> Any:
    """A dataclass field that holds a number between bounds: an integer where the default (or, where that is None, `low`) is one.

    Args:
      default: its value where nothing else is said.
      low: the lowest value.
      high: the highest value; below it with `below`.
      help: what it is for, in a sentence.
      unit: what it is measured in, empty for counts, shares and factors.
      below: whether `high` itself is excluded.
      null: what None means; where this is empty, None is refused.
      metadata: further entries.
    """
    whole = isinstance(low if default is None else default, int)
    bounds = Bounds(low=low, high=high, below=below, whole=whole, null=null)
    return setting(default, help, bounds=bounds, unit=unit, **metadata)


def choice(default: str, options: tuple[str, ...], help: str, **metadata: Any) -> Any:
    """A dataclass field that holds one of `options`."""
    return setting(default, help, options=options, **metadata)


def outside(record: Any, prefix: str = "") -> Iterator[tuple[str, Mapping[str, Any], Any]]:
    """What a settings record, and the records that it holds, should not hold, in the order of the fields.

    Yields:
      The key of a field after `prefix`, dots between records; its metadata; and its value, which is outside "bounds" or not among
      "options" of these.
    """
    for field in dataclasses.fields(record):
        key, value, metadata = f"{prefix}{field.name}", getattr(record, field.name), field.metadata
        if dataclasses.is_dataclass(value):
            yield from outside(value, f"{key}.")
        elif ("bounds" in metadata and not metadata["bounds"].allow(value)) or value not in metadata.get("options", (value,)):
            yield key, metadata, value


def check_settings(name: str, record: Any) -> None:
    """Raises ValueError for the first value of a settings record, called `name`, that its field does not allow."""
    for key, metadata, value in outside(record, f"{name}."):
        if "options" in metadata:
            raise ValueError(f"{key} {value!r} is unknown; one of {', '.join(metadata['options'])} would be right")
        bounds = metadata["bounds"]
        raise ValueError(f"{key} is {value!r}; {bounds.kind(value)} in {bounds.interval} would be right")
