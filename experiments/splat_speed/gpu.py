"""Times of a whole step on a GPU: by the kernels, and by the loops of XLA, which any device runs; a fit; memory.

`run.py` measures this only where it is named, since it needs a JAX that sees an NVIDIA GPU.
"""

import functools
import sys
import time
from collections.abc import Iterator

import jax
import numpy as np
from bench_scene import Step, bench_step, best, seconds
from records import Record, write
from whole_fit import FULL, TINY, seen, views_in

from wm.schema import RasterSettings
from wm.splat import fit, initial_gaussians, render

CASES = (
    ("100k, 688 x 384", 100_000, 688, 384),
    ("1M, 1376 x 768", 1_000_000, 1376, 768),
)
COMPOSITORS = (("kernels", {}), ("loops", {}), ("loops, all tiles in a block", {"block": 1 << 20}))
REPEATS = {"kernels": 20, "loops": 2}
STARTED = 3
"""Steps of the fit after which all is compiled."""


def records(tiny: bool) -> Iterator[Record]:
    if jax.default_backend() != "gpu":
        sys.exit(f"JAX sees no GPU here, only {jax.devices()}")
    for name, n, width, height in CASES[:1] if tiny else CASES:
        images = {}
        for variant, settings in COMPOSITORS:
            compositor = variant.split(",")[0]
            step = bench_step(n, width, height, settings=RasterSettings(compositor=compositor, **settings))
            yield from measure(f"{name}, {variant}", step, REPEATS[compositor])
            images[variant] = derivative_of(step)
        for variant, derivative in images.items():
            error = np.linalg.norm(derivative - images["loops"]) / np.linalg.norm(images["loops"])
            yield Record(figure="gpu", case=f"{name}, {variant}", key="derivative against loops", value=float(error), unit="")
    yield from whole_fit(tiny)


def measure(case: str, step: Step, repeats: int) -> Iterator[Record]:
    """One case: the best of `repeats` for every part, milliseconds of wall-clock."""
    record = functools.partial(Record, figure="gpu", case=case, unit="ms", better="lower")
    first = seconds(step)
    projected = step.project()
    plan = step.plan(projected)
    ms = best(
        {
            "projection": step.project,
            "plan": lambda: step.plan(projected),
            "forward": functools.partial(step.forward, projected, plan),
            "both": functools.partial(step.both, projected, plan),
            "its derivative": functools.partial(step.vjp, step.both(projected, plan)),
            "whole step": step,
        },
        repeats,
    )
    yield record(key="pairs", value=int(plan.count.sum()) * step.settings.tile**2 / 1e6, unit="1e6", better="")
    yield record(key="backward", value=ms.pop("both") - ms["forward"])
    for key, value in ms.items():
        yield record(key=key, value=value)
    if step.settings.compositor == "kernels":
        loss = jax.jit(jax.grad(lambda g: render(g, step.camera, settings=step.settings).rgb.mean()))
        yield record(key="grad of render under jit", value=best({"": lambda: loss(step.gaussians)}, repeats)[""])
    yield record(key="compilation", value=first - ms["whole step"] / 1e3, unit="s")
    peak = jax.devices()[0].memory_stats()["peak_bytes_in_use"]
    yield record(key="memory so far", value=peak / 2**30, unit="GiB")


def derivative_of(step: Step) -> np.ndarray:
    """With respect to the means of all gaussians, in the order of the scene."""
    return np.asarray(step().means)


def whole_fit(tiny: bool) -> Iterator[Record]:
    """Steps a second of a fit of one room, from the moment everything is compiled."""
    size, settings = ((64, 48), TINY) if tiny else ((688, 384), FULL)
    views = functools.partial(views_in, *size)
    start = initial_gaussians(views(0), settings=settings, rng=np.random.default_rng(0))
    record = functools.partial(Record, figure="gpu", case="fit of a room, 688 x 384")
    yield record(key="gaussians", value=len(start.means) / 1e3, unit="1e3")
    yield record(key="visible", value=seen(start, views(0))[0] / 1e3, unit="1e3")
    stamps = []
    fit(start, views(0), settings=settings, key=jax.random.key(0), progress=lambda *_: stamps.append(time.perf_counter()))
    rate = (len(stamps) - STARTED) / (stamps[-1] - stamps[STARTED - 1])
    yield record(key="rate", value=rate, unit="views/s", better="higher")


if __name__ == "__main__":
    write(records("--tiny" in sys.argv))
