"""Size of a run's gaussians in each format, and the PSNR of their renders against those of splats.ply.

    python experiments/splat_formats/run.py RUN [SPLAT_TRANSFORM]

SPLAT_TRANSFORM is the program of npm's @playcanvas/splat-transform; where it is given, it converts each file to PLY, and what it
has read is rendered too. Writes result.csv beside this file.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from wm.export.targets import TARGETS
from wm.finished import FinishedRun, open_finished
from wm.splat import SceneRenderer, load_ply, psnr
from wm.splat.formats import load_splats, to_z_up
from wm.splat.formats.turning import turned
from wm.types import Gaussians

FORMATS = ("compressed_ply", "gltf_splats", "labelled_ply", "sog", "splat", "spz")
Z_UP = ("labelled_ply",)
HALF_TURN = np.diag([1.0, -1, -1])
"""splat-transform 2.7.1, which npm installs on Node 20, turns SPZ half about x when it reads; 3.7 does not."""
READ_BY_PEER = ("compressed_ply", "labelled_ply", "sog", "splat", "spz")


def images(run: FinishedRun, gaussians: Gaussians) -> list[np.ndarray]:
    """Of all gaussians from every second held-out view."""
    renderer = SceneRenderer([gaussians], run.raster)
    return [np.clip(np.asarray(renderer.render(view.camera, [0]).rgb), 0, 1) for view in run.heldout[::2]]


def quality(run: FinishedRun, gaussians: Gaussians, wanted: list[np.ndarray]) -> float:
    return float(np.mean([psnr(a, b) for a, b in zip(images(run, gaussians), wanted)]))


def by_peer(program: str, path: pathlib.Path) -> Gaussians:
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.ply"
        subprocess.run([program, "--quiet", str(path), str(out)], check=True)
        found = load_ply(out)
    return turned(found, HALF_TURN) if path.suffix == ".spz" else found


def main(folder: str, program: str = "") -> None:
    run = open_finished(folder)
    wanted, whole = images(run, load_ply(run.splats_file)), run.splats_file.stat().st_size
    rows = []
    with tempfile.TemporaryDirectory() as made:
        for name in FORMATS:
            path = TARGETS[name].load().write(run, pathlib.Path(made))[0]
            up = (lambda g: g) if name in Z_UP else to_z_up
            size = path.stat().st_size - (run.scaffold_file.stat().st_size if name == "gltf_splats" else 0)
            row = {
                "format": name,
                "bytes": size,
                "share": round(size / whole, 3),
                "psnr": round(quality(run, up(load_splats(path)), wanted), 1),
            }
            if program and name in READ_BY_PEER:
                row["psnr_splat_transform"] = round(quality(run, up(by_peer(program, path)), wanted), 1)
            rows.append(row)
            print(row, flush=True)
    with (pathlib.Path(__file__).parent / "result.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, ["format", "bytes", "share", "psnr", "psnr_splat_transform"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main(*sys.argv[1:])
