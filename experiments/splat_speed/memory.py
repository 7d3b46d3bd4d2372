"""Peak memory of a million gaussians at 1376 x 768: one whole step, and three steps of a fit; each in a process of its own.

This script stays small: a process counts what its parent held when it was started as its own.
"""

import resource
import subprocess
import sys
from collections.abc import Iterator

from records import Record, write

CASES = {"step": "1M, 1376 x 768, one step", "fit": "1M, 1376 x 768, three steps of a fit"}
MARGIN = 0.1


def records(tiny: bool) -> Iterator[Record]:
    for kind, case in CASES.items():
        command = [sys.executable, __file__, kind, *(["--tiny"] if tiny else [])]
        peak = float(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout)
        yield Record(figure="memory", case=case, key="peak", value=peak / 1e9, unit="GB", better="lower", wanted=6, margin=MARGIN)


def work(kind: str, tiny: bool) -> int:
    """Bytes that this process held at most, at the end of the work."""
    from wm.host import prepare_process

    prepare_process()
    n, width, height = (2000, 64, 48) if tiny else (1_000_000, 1376, 768)
    {"step": one_step, "fit": three_steps}[kind](n, width, height)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def one_step(n: int, width: int, height: int) -> None:
    import jax
    from bench_scene import bench_step

    from wm.schema import RasterSettings

    jax.block_until_ready(bench_step(n, width, height, settings=RasterSettings())())


def three_steps(n: int, width: int, height: int) -> None:
    """Toward a grey image, three metres away."""
    import jax
    import numpy as np
    from bench_scene import camera_of, scene

    from wm.schema import FitSettings
    from wm.splat import TrainingView, fit

    grey = {"rgb": np.full((height, width, 3), 128, np.uint8), "depth": np.full((height, width), 3, np.float32)}
    view = TrainingView(camera=camera_of(width, height), **grey, mask=np.ones((height, width), bool), room=0)
    result = fit(scene(n), [view], settings=FitSettings(steps=3, curve_points=0), key=jax.random.key(0))
    assert result.stopped is None, result.stopped


if __name__ == "__main__":
    tiny, kinds = "--tiny" in sys.argv, [kind for kind in CASES if kind in sys.argv]
    if kinds:
        print(work(kinds[0], tiny))
    else:
        write(records(tiny))
