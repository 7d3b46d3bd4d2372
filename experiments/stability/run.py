"""Errors of `render` and of the losses against float64 in stiff and extreme cases: a table, and result.csv."""

import csv
import pathlib

from tests.splat.stability import CASES

HERE = pathlib.Path(__file__).parent


def main() -> None:
    rows = []
    for name, case in CASES.items():
        errors = case.measure()
        rows.append({"case": name, "value": errors.value, "gradient": errors.gradient, "undecided": errors.undecided})
        print(
            f"| {name} | {errors.value:.0e} | {errors.gradient:.0e} | {100 * errors.undecided:.1f} % | "
            f"{case.value:.0e}, {case.gradient:.0e}: {case.promise} |",
            flush=True,
        )
    with open(HERE / "result.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
