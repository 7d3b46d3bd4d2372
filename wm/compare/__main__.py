"""The command line: python -m wm.compare METHOD=PATH ... and python -m wm.compare inputs RUN."""

import sys
from collections.abc import Sequence

from wm import console
from wm.compare.comparison import TABLE, compare
from wm.compare.inputs.writing import write_inputs
from wm.compare.words import parse
from wm.errors import InputError

HELP = """python -m wm.compare METHOD=PATH ... [trajectories=[around1,close1,along1,door1]] [output=comparison]

METHOD is a system (ours, wonderworld, flexworld, layerpano3d, worldexplorer, spatialgen, dreamscene360), or any name where PATH
tells what it is: a run folder, a .ply, .splat, .glb, .obj. NAME:ADAPTER=PATH gives a system several rows.

METHOD.up=z  METHOD.antialias=true  METHOD.cameras=transforms.json    for files that do not say
trajectories=FILE.json     one path of cameras (transforms.json) for all methods, in their own axes with z turned up
frames=60 size=688x384 fov=60 fps=24
quality=FOLDER             weights of CLIP-IQA+ and the aesthetic score (docs/evaluation.md); without them those columns are empty

python -m wm.compare inputs RUN [to=[spatialgen,panorama,image]] [output=RUN/export/inputs]    what other systems start from
"""
BAD_INPUT = 2


def main(words: Sequence[str]) -> int:
    """Does what the words ask for; returns the exit code."""
    if not words or {"-h", "--help"} & set(words):
        console.say(HELP)
        return 0 if words else BAD_INPUT
    try:
        if words[0] == "inputs":
            for folder in write_inputs(words[1:]):
                console.say(str(folder))
            return 0
        request = parse(words)
        console.say(compare(request))
        console.say(f"{request.output / TABLE}, videos in {request.output / 'videos'}")
    except (InputError, OSError) as error:
        console.warn(f"wm: {error}")
        return BAD_INPUT
    return 0


if __name__ == "__main__":
    console.end(lambda: main(sys.argv[1:]))
