"""How fits end that are given too much: a row for each stiff case on a small analytic room, printed and written to result.csv.

    PYTHONPATH=. python experiments/stiff_fits/run.py

The room is that of tests/splat/rooms.py: a box with smooth colours, eight views of 48 x 32, held-out views between them.
"""

import csv
import dataclasses
import pathlib
from collections.abc import Iterator

import jax
import numpy as np

from tests.splat.rooms import views_of
from wm.schema import FitSettings, RasterSettings
from wm.splat import fit, initial_gaussians

SIZE = {"width": 48, "height": 32}
VIEWS, HELDOUT = views_of(count=8, **SIZE), views_of(count=4, turn=0.4, **SIZE)
PLAIN = FitSettings(spacing=0.15, detail_spacing=0.15, steps=96, curve_points=2)
RATES = [
    f.name for f in dataclasses.fields(FitSettings) if f.name.startswith("lr_") and f.name not in ("lr_final", "lr_exposure")
]


def cases() -> Iterator[tuple[str, list, FitSettings]]:
    """Name, views and settings of each case."""
    yield "plain", VIEWS, PLAIN
    yield "depth weight 100", VIEWS, dataclasses.replace(PLAIN, depth_weight=100.0)
    for factor in (10, 100, 1000):
        yield f"learning rates x{factor}", VIEWS, dataclasses.replace(PLAIN, **{k: factor * getattr(PLAIN, k) for k in RATES})
    yield "rates that grow, to x1000", VIEWS, dataclasses.replace(PLAIN, lr_final=1000.0)
    yield "all views identical", [VIEWS[0]] * 8, PLAIN
    yield "one view", VIEWS[:1], PLAIN
    jumps = [with_tone(view, gain) for view, gain in zip(VIEWS, np.linspace(0.6, 1.4, 8))]
    yield "exposure jumps of 40 %", jumps, PLAIN
    yield "the same, compensated", jumps, dataclasses.replace(PLAIN, exposure=True)
    yield "contradictory depth", [*VIEWS, dataclasses.replace(VIEWS[0], depth=1.5 * VIEWS[0].depth)], PLAIN
    yield "an empty mask", [dataclasses.replace(VIEWS[0], mask=np.zeros_like(VIEWS[0].mask)), *VIEWS[1:]], PLAIN
    depth = VIEWS[2].depth.copy()
    depth[3, 4:7] = np.nan
    yield "NaN in a depth", [*VIEWS[:2], dataclasses.replace(VIEWS[2], depth=depth), *VIEWS[3:]], PLAIN


def with_tone(view, gain: float):
    return dataclasses.replace(view, rgb=np.clip(view.rgb * gain, 0, 255).astype(np.uint8))


def measure(name: str, views: list, settings: FitSettings) -> dict:
    """Held-out PSNR before and after, the loss of the first and of the last eighth of the steps, and how it ended."""
    losses = []
    start = initial_gaussians(VIEWS, settings=PLAIN, rng=np.random.default_rng(0))
    result = fit(
        start,
        views,
        settings=settings,
        raster=RasterSettings(chunk=1, block=16),
        key=jax.random.key(0),
        heldout=HELDOUT,
        progress=lambda done, total, info: losses.append(info["loss"]),
    )
    final = fit(
        result.gaussians,
        VIEWS,
        settings=dataclasses.replace(PLAIN, steps=0, curve_points=1),
        raster=RasterSettings(chunk=1, block=16),
        key=jax.random.key(0),
        heldout=HELDOUT,
    ).history[-1]
    finite = all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(result.gaussians))
    part = max(len(losses) // 8, 1)
    return {
        "case": name,
        "psnr_before": round(result.history[0].psnr, 2),
        "psnr_kept": round(final.psnr, 2),
        "m_mae_kept": round(final.m_mae, 4),
        "loss_first": round(float(np.mean(losses[:part])), 4) if losses else "",
        "loss_last": round(float(np.mean(losses[-part:])), 4) if losses else "",
        "finite": finite,
        "stopped": result.stopped or "",
    }


def main() -> None:
    rows = []
    for case in cases():
        rows.append(measure(*case))
        print(" | ".join(str(value) for value in rows[-1].values()), flush=True)
    with pathlib.Path(__file__).with_name("result.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
