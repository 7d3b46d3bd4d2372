"""Errors of `render` and of the losses against float64 in stiff and extreme cases: a table, and result.csv."""

import csv
import pathlib

from tabulate import tabulate

from tests.splat.stability import CASES

HERE = pathlib.Path(__file__).parent


def main() -> None:
    rows, shown = [], []
    for name, case in CASES.items():
        errors = case.measure()
        rows.append({"case": name, "value": errors.value, "gradient": errors.gradient, "undecided": errors.undecided})
        found = (f"{errors.value:.0e}", f"{errors.gradient:.0e}", f"{100 * errors.undecided:.1f} %")
        shown.append((name, *found, f"{case.value:.0e}, {case.gradient:.0e}: {case.promise}"))
    headings = ("case", "value", "gradient", "undecided", "promised: value, gradient")
    print(tabulate(shown, headings, tablefmt="github", disable_numparse=True))
    with open(HERE / "result.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
