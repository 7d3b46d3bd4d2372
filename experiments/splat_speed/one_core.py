"""Times of the rasterizer's parts on one core, beside one `jnp.exp` element; compile time apart."""

import functools
import os
import sys
from collections.abc import Iterator

os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # before JAX counts the cores

from bench_scene import EXPONENTIALS, bench_step, best, exponential, seconds  # noqa: E402
from records import Record, write  # noqa: E402

from wm.host import prepare_process  # noqa: E402
from wm.schema import RasterSettings  # noqa: E402

CASES = (
    ("100k of 0.46 the size, 688 x 384", 100_000, 688, 384, 0.46, True, None),
    ("100k of 0.6 the size, 688 x 384", 100_000, 688, 384, 0.6, True, None),
    ("100k, 688 x 384", 100_000, 688, 384, 1.0, True, 250),
    ("100k, 688 x 384, not slanted", 100_000, 688, 384, 1.0, False, 250),
    ("300k, 688 x 384", 300_000, 688, 384, 1.0, True, None),
    ("100k, 1376 x 768", 100_000, 1376, 768, 1.0, True, None),
    ("300k, 1376 x 768", 300_000, 1376, 768, 1.0, True, 900),
)
"""Gaussians, width, height, how many times the usual size they have (at 0.46 a view lists 12M pairs), whether depth is slanted,
which is two features more, and what is wanted of the step in milliseconds per nanosecond of an exponential."""

REPEATS = 15
MARGIN = 0.15
"""By how much a step may exceed the baseline before the gate fails: the best of 15 wanders by 5 % on a shared machine."""


def records(tiny: bool) -> Iterator[Record]:
    prepare_process()
    for name, n, width, height, size, slanted, wanted in CASES[2:4] if tiny else CASES:
        if tiny:
            n, width, height = 2000, 64, 48
        yield from measure(name, n, width, height, size, slanted, wanted, 2 if tiny else REPEATS)


def measure(name: str, n: int, width: int, height: int, size: float, slanted: bool, wanted: float | None, repeats: int):
    """One case: the best of `repeats` for every part, milliseconds of wall-clock."""
    record = functools.partial(Record, figure="one_core", case=name)
    step = bench_step(n, width, height, size=size, settings=RasterSettings(slanted=slanted))
    first = seconds(step)
    projected = step.project()
    plan = step.plan(projected)
    pairs = int(plan.count.sum()) * step.settings.tile**2
    ms = best(
        {
            "exp": exponential,
            "projection": step.project,
            "plan": lambda: step.plan(projected),
            "forward": functools.partial(step.forward, projected, plan),
            "both": functools.partial(step.both, projected, plan),
            "its derivative": functools.partial(step.vjp, step.both(projected, plan)),
        },
        repeats,
    )
    exp_ns = ms["exp"] * 1e6 / EXPONENTIALS
    whole = ms["projection"] + ms["plan"] + ms["both"] + ms["its derivative"]
    yield record(key="pairs", value=pairs / 1e6, unit="1e6")
    yield record(key="exp", value=exp_ns, unit="ns")
    for part, value, most in (("forward", ms["forward"], 3.2), ("backward", ms["both"] - ms["forward"], 8.0)):
        yield record(key=part, value=value, unit="ms", better="lower")
        yield record(key=f"{part} a pair", value=value * 1e6 / pairs / exp_ns, unit="exps", better="lower", wanted=most)
    for part in ("projection", "plan", "its derivative"):
        yield record(key=part, value=ms[part], unit="ms", better="lower")
    yield record(key="whole step", value=whole, unit="ms", better="lower")
    yield record(key="step", value=whole / exp_ns, unit="ms per ns of exp", better="lower", wanted=wanted, margin=MARGIN)
    yield record(key="compilation", value=first - whole / 1e3, unit="s", better="lower")


if __name__ == "__main__":
    write(records("--tiny" in sys.argv))
