"""What targets of an export share: their error, and what is measured of a file that was written."""

import dataclasses

from wm.errors import InputError


class ExportError(InputError):
    """What was asked for cannot be exported, or was read back as something else; the message names target, file and reason."""


@dataclasses.dataclass(frozen=True)
class Check:
    """One line of the table of python -m wm.check."""

    target: str  # "mjcf"
    what: str  # "objects that moved less than 2 cm"
    value: str  # "132 of 132"
    wanted: str  # "all"
    passed: bool
