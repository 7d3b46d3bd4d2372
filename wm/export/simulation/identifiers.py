"""Names that every format takes: ASCII letters, digits and underscores, not beginning with a digit, each there once."""

import re
from collections.abc import Sequence


def identifiers(names: Sequence[str]) -> list[str]:
    """An identifier for each name, in order: "hall-sofa-1" becomes "hall_sofa_1", and a second one "hall_sofa_1_2".

    They are USD's prim names and the names of files; two that differ in case only are told apart, since some file systems do not.
    """
    taken: set[str] = set()
    return [_free(_plain(name), taken) for name in names]


def _plain(name: str) -> str:
    plain = re.sub(r"[^A-Za-z0-9_]", "_", name) or "_"
    return f"_{plain}" if plain[0].isdigit() else plain


def _free(name: str, taken: set[str]) -> str:
    free, number = name, 1
    while free.lower() in taken:
        number += 1
        free = f"{name}_{number}"
    taken.add(free.lower())
    return free
