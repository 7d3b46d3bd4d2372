"""Eight methods on five trajectories, with stand-ins for the outputs of other systems: figures, seconds, peak memory.

    python -m experiments.comparison.run RUN [count=300000] [frames=60] [size=688x384] [output=outputs/comparison]

Seven rows besides ours are written from the run itself (stand_ins.py says how each is degraded): they are our scene in the
formats of other systems, and not what those systems make.
"""

import pathlib
import sys
import time

from experiments.comparison.stand_ins import stand_ins
from wm.compare.comparison import compare
from wm.compare.words import parse
from wm.finished import open_finished


def main(words: list[str]) -> None:
    paths = [word for word in words if "=" not in word]
    told = dict(word.split("=", 1) for word in words if "=" in word)
    output = pathlib.Path(told.pop("output", "outputs/comparison"))
    count = int(told.pop("count", "300000"))
    run = open_finished(paths[0])
    theirs = stand_ins(run, output / "stand_ins", count=count)
    names = {"ours": run.folder} | {f"{method}_stand_in:{method}": path for method, path in theirs.items()}
    request = parse([*(f"{name}={path}" for name, path in names.items()), *(f"{key}={value}" for key, value in told.items()),
                     f"output={output}"])  # fmt: skip
    began = time.perf_counter()
    print(compare(request))
    print(f"{time.perf_counter() - began:.1f} s for {len(request.sources)} methods")


if __name__ == "__main__":
    main(sys.argv[1:])
