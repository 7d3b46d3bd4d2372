"""Figures as typed records: written, read, tabulated, and held against those of an earlier day."""

import csv
import dataclasses
import sys
from collections.abc import Iterable, Sequence
from typing import Literal, TextIO

from tabulate import tabulate


@dataclasses.dataclass(frozen=True, kw_only=True)
class Record:
    """One measured number."""

    figure: str  # what is asked: the script that measured it
    case: str  # of what
    key: str
    value: float
    unit: str
    better: Literal["lower", "higher", ""] = ""  # "" where neither is
    wanted: float | None = None  # at most, or at least
    margin: float | None = None  # share by which it may be worse than the baseline; None: the gate leaves it alone

    @property
    def place(self) -> tuple[str, str, str]:
        return self.figure, self.case, self.key

    @property
    def reached(self) -> bool:
        """Whether it is what is wanted."""
        return self.wanted is None or (self.value <= self.wanted if self.better == "lower" else self.value >= self.wanted)


NAMES = [field.name for field in dataclasses.fields(Record)]


def write(records: Iterable[Record], file: TextIO = sys.stdout) -> None:
    """A line of CSV for each record, as soon as it is there, under a line of names."""
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(NAMES)
    for record in records:
        writer.writerow(f"{x:.4g}" if isinstance(x, float) else x for x in dataclasses.astuple(record))  # None is empty
        file.flush()


def read(lines: Iterable[str]) -> list[Record]:
    """What `write` wrote."""
    rows = []
    for row in csv.DictReader(lines):
        numbers = {name: float(row[name]) if row[name] else None for name in ("value", "wanted", "margin")}
        rows.append(Record(**{**row, **numbers}))
    return rows


def worse(found: Sequence[Record], baseline: Sequence[Record]) -> list[str]:
    """One line for each record that is worse than its baseline by more than its margin, or has none."""
    before = {record.place: record.value for record in baseline}
    lines = []
    for record in (record for record in found if record.margin is not None):
        name = f"{record.figure}, {record.case}: {record.key}"
        if record.place not in before:
            lines.append(f"{name} has no baseline in result.csv")
            continue
        share = 1 + record.margin if record.better == "lower" else 1 - record.margin
        limit = before[record.place] * share
        if not (record.value <= limit if record.better == "lower" else record.value >= limit):
            bound = "at most" if record.better == "lower" else "at least"
            lines.append(
                f"{name} is {record.value:.4g} {record.unit}, {bound} {limit:.4g} is allowed: "
                f"the baseline {before[record.place]:.4g} and {record.margin:.0%}"
            )
    return lines


def table(records: Sequence[Record]) -> str:
    """Markdown: a table for each figure, a row for each case, what is wanted in brackets and bold where it is missed."""
    tables = []
    for figure in dict.fromkeys(record.figure for record in records):
        mine = {(record.case, record.key): record for record in records if record.figure == figure}
        units = {record.key: record.unit for record in mine.values()}
        headings = ["", *(f"{key}, {unit}" if unit else key for key, unit in units.items())]
        rows = [[case, *(_cell(mine.get((case, key))) for key in units)] for case in dict.fromkeys(case for case, _ in mine)]
        tables.append(f"`{figure}`\n\n{tabulate(rows, headings, tablefmt='github', disable_numparse=True)}\n")
    return "\n".join(tables)


def _cell(record: Record | None) -> str:
    if record is None:
        return ""
    value = f"{record.value:.0f}" if record.value >= 1000 else f"{record.value:.3g}"
    if record.wanted is None:
        return value
    return f"{value if record.reached else f'**{value}**'} ({record.wanted:g})"
