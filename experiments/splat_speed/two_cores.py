"""Two views at once on two cores against one on one: in two processes held to a core each, and in threads of one process.

The workers take turns: one alone, the other alone, both, and again. What counts is the whole step on the bench scene, over the
time in which all that work are at it. In threads each worker has a JAX device of its own.
"""

import functools
import multiprocessing
import os
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor

import jax
from bench_scene import bench_step
from records import Record, write

from wm.host import prepare_process
from wm.schema import RasterSettings

PHASES = ((0,), (1,), (0, 1))
"""Which workers work in each."""

MARGIN = 0.1
Stamps = list[list[float]]
"""For each phase the seconds at which a worker began it and ended each of its steps; nothing where it slept."""


def records(tiny: bool) -> Iterator[Record]:
    size, rounds, length = ((2000, 64, 48), 2, 0.2) if tiny else ((100_000, 688, 384), 3, 4.0)
    cores = sorted(os.sched_getaffinity(0))[:2]
    if len(cores) < 2:
        sys.exit("two views at once need two cores")
    single = None
    for how, measure in (("processes", in_processes), ("threads", in_threads)):
        stamps = measure(cores, size, rounds, length)
        rate = [max(views_per_s([stamps[k][turn] for k in phase]) for turn in turns_of(phase, rounds)) for phase in PHASES]
        single = single or (rate[0] + rate[1]) / 2
        record = functools.partial(Record, figure="two_cores", case=f"100k, 688 x 384, {how}", better="higher")
        yield record(key="one alone", value=rate[0], unit="views/s")
        yield record(key="the other alone", value=rate[1], unit="views/s")
        yield record(key="together", value=rate[2], unit="views/s")
        gated = {"wanted": 1.8, "margin": MARGIN} if how == "processes" else {}
        yield record(key="against one process alone", value=rate[2] / single, unit="", **gated)


def turns_of(phase: tuple[int, ...], rounds: int) -> range:
    """Where in the stamps a phase is."""
    return range(PHASES.index(phase), rounds * len(PHASES), len(PHASES))


def views_per_s(stamps: Sequence[Sequence[float]]) -> float:
    """Rates of workers, added up over the steps that lie within the time in which all of them work."""
    begin, end = max(times[0] for times in stamps), min(times[-1] for times in stamps)
    inside = [[at for at in times if begin <= at <= end] for times in stamps]
    return sum((len(times) - 1) / (times[-1] - times[0]) for times in inside)


def in_processes(cores: Sequence[int], size: tuple[int, int, int], rounds: int, length: float) -> list[Stamps]:
    context = multiprocessing.get_context("spawn")
    barrier, results = context.Barrier(2), context.SimpleQueue()
    workers = [context.Process(target=pinned, args=(k, cores[k], size, rounds, length, barrier, results)) for k in (0, 1)]
    for worker in workers:
        worker.start()
    found = dict(results.get() for _ in workers)
    for worker in workers:
        worker.join()
    return [found[0], found[1]]


def pinned(me: int, core: int, size: tuple[int, int, int], rounds: int, length: float, barrier, results) -> None:
    """The work of a process: held to its core before JAX counts the cores."""
    os.sched_setaffinity(0, {core})
    prepare_process()
    results.put((me, turns(me, None, size, rounds, length, barrier)))


def in_threads(cores: Sequence[int], size: tuple[int, int, int], rounds: int, length: float) -> list[Stamps]:
    os.sched_setaffinity(0, cores)
    jax.config.update("jax_num_cpu_devices", 2)
    prepare_process()
    barrier = threading.Barrier(2)
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(lambda me: turns(me, jax.devices()[me], size, rounds, length, barrier), (0, 1)))


def turns(me: int, device, size: tuple[int, int, int], rounds: int, length: float, barrier) -> Stamps:
    """The stamps of one worker."""
    step = bench_step(*size, settings=RasterSettings(), device=device)
    jax.block_until_ready(step())
    stamps = []
    for phase in PHASES * rounds:
        barrier.wait()
        times = [time.perf_counter()] if me in phase else []
        while times and times[-1] < times[0] + length:
            jax.block_until_ready(step())
            times.append(time.perf_counter())
        stamps.append(times)
    return stamps


if __name__ == "__main__":
    write(records("--tiny" in sys.argv))
