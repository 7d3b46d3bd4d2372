"""The paper's ablation: scenes x eight variants x seeds in one sweep of wm.run, and its table. See README.md.

    python experiments/ablation/run.py                                   five scenes, three seeds, standard size
    python experiments/ablation/run.py --draft --scenes gothic --seeds 0 1
    python experiments/ablation/run.py --image like_distilled --out distilled

Further words, such as fit.steps=60, go to wm.run. Runs are kept below --root; a second call with the same arguments runs nothing
and writes the same tables.
"""

import argparse
import csv
import pathlib
import subprocess
import sys

from table import markdown, order, records

from wm.metric_table import read_metrics
from wm.report.paper import PAPER_ROWS
from wm.report.sweep import read_runs

HERE = pathlib.Path(__file__).parent
SCENES = ("beach_house", "clockwork_garden", "gothic", "roman_estate", "scandinavian")
VARIANTS = ("full", *(variant for variant in PAPER_ROWS if variant != "full"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", default=list(SCENES))
    parser.add_argument("--seeds", nargs="+", type=int, default=[0, 1, 2])
    parser.add_argument("--variants", nargs="+", default=list(VARIANTS), choices=VARIANTS)
    parser.add_argument("--draft", action="store_true", help="preset=draft: minutes a scene instead of an hour")
    parser.add_argument("--image", default="procedural", help="the image model, such as like_distilled")
    parser.add_argument("--quality", help="folder with the weights of CLIP-IQA+ and the aesthetic score (docs/evaluation.md)")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path("outputs/ablation"), help="where the runs are kept")
    parser.add_argument("--out", default="result", help="name of the tables beside this file")
    further = [word for word in sys.argv[1:] if "=" in word and not word.startswith("-")]
    arguments = parser.parse_args([word for word in sys.argv[1:] if word not in further])
    folders = sweep(arguments, further)
    runs = read_runs(folders)
    shown = [variant for variant in VARIANTS if variant in arguments.variants]
    text = "\n\n".join([markdown(runs, shown), order(runs, shown)])
    (HERE / f"{arguments.out}.md").write_text(text + "\n", encoding="utf-8")
    with (HERE / f"{arguments.out}.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, records(runs)[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(records(runs))
    print(text)


def sweep(arguments: argparse.Namespace, further: list[str]) -> list[pathlib.Path]:
    """The folders of all runs, after one sweep of wm.run where some of them are not finished."""
    preset = "draft" if arguments.draft else "standard"
    root = arguments.root.resolve() / f"{preset}_{arguments.image}"
    grid = [(scene, variant, seed) for scene in arguments.scenes for variant in arguments.variants for seed in arguments.seeds]
    folders = [root / scene / variant / str(seed) for scene, variant, seed in grid]
    if not all(finished(folder, arguments.quality) for folder in folders):
        words = [
            f"+scene={','.join(arguments.scenes)}",
            f"seed={','.join(map(str, arguments.seeds))}",
            f"variant={','.join(arguments.variants)}",
            f"preset={preset}",
            f"image={arguments.image}",
            f"hydra.sweep.dir={root}",
            "report.enabled=false",
            *([f"evaluate.quality={pathlib.Path(arguments.quality).resolve()}"] if arguments.quality else []),
        ]
        subprocess.run([sys.executable, "-m", "wm.run", "-m", *words, *further], check=True)
    return folders


def finished(folder: pathlib.Path, quality: str | None) -> bool:
    """Whether a run has left its metrics, and scores of its pictures where they are wanted."""
    metrics = read_metrics(folder / "metrics.json")
    return metrics is not None and (quality is None or any(metrics.get(key) is not None for key in ("clip_iqa", "aesthetic")))


if __name__ == "__main__":
    main()
