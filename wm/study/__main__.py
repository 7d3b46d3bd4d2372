"""The command line: python -m wm.study make, serve and analyse.

    python -m wm.study make ours=renders/ours WonderWorld=renders/wonderworld output=study questions=comparison seed=0
    python -m wm.study serve study
    python -m wm.study analyse study

docs/study.md says more.
"""

import pathlib
import sys
from collections.abc import Callable, Sequence

from wm import console
from wm.errors import InputError
from wm.study.analysis import analyse
from wm.study.answers import read_answers
from wm.study.folder import make_study, open_study
from wm.study.questions import read_questions
from wm.study.results import write_results
from wm.study.serve import server
from wm.study.sessions import StudyPlan
from wm.study.words import Words, sorted_words

BAD_INPUT = 2
_USAGE = """python -m wm.study make METHOD=VIDEO_OR_FOLDER ... output=FOLDER [questions=comparison|ablation|FILE]
                        [reference=METHOD] [seed=0] [participants=60] [ratings=N] [pairs=N]
python -m wm.study serve FOLDER [port=8765] [host=127.0.0.1]
python -m wm.study analyse FOLDER [ANSWERS ...] [output=FOLDER/results] [seed=0] [resamples=10000]
docs/study.md says more."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command. Returns 0, or 2 where it cannot be done; the reason is a line on stderr."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if not words or words[0] == "help" or {"-h", "--help"} & set(words):
        console.say(_USAGE)
        return 0 if words else BAD_INPUT
    try:
        if words[0] not in _COMMANDS:
            raise InputError(f"no command {words[0]}; there are {', '.join(_COMMANDS)}")
        keys, command = _COMMANDS[words[0]]
        command(sorted_words(words[1:], keys))
    except (InputError, OSError) as error:
        console.warn(f"wm.study: {error}")
        return BAD_INPUT
    return 0


def _make(words: Words) -> None:
    if words.paths:
        raise InputError(f"{words.paths[0]}: a video is given as METHOD=PATH")
    if not words.methods or not words.text("output", ""):
        raise InputError("make wants METHOD=VIDEO_OR_FOLDER at least once, and output=FOLDER")
    output = pathlib.Path(words.options["output"])
    plan = StudyPlan(
        participants=words.number("participants", StudyPlan.participants, least=1),
        ratings=words.number("ratings", 0) if "ratings" in words.options else None,
        pairs=words.number("pairs", 0) if "pairs" in words.options else None,
        reference=words.options.get("reference"),
        seed=words.number("seed", 0),
    )
    for line in make_study(words.methods, output, read_questions(words.text("questions", "comparison")), plan):
        console.warn(f"wm.study: {line}")
    study = open_study(output)
    console.say(f"{output / 'page'}: publish this folder; {len(study.sessions)} sessions of {len(study.sessions[0])} pages")
    console.say(f"{output / 'key.json'}: which video is of which method; keep it, and do not publish it")


def _serve(words: Words) -> None:
    folder = _one_folder(words)
    open_study(folder)
    port = words.number("port", 8765)
    with server(folder, words.text("host", "127.0.0.1"), port) as running:
        console.say(f"The study is at http://{words.text('host', '127.0.0.1')}:{running.server_address[1]}/ until Ctrl-C.")
        try:
            running.serve_forever()
        except KeyboardInterrupt:
            console.say(f"Answers are in {folder / 'answers'}.")


def _analyse(words: Words) -> None:
    if words.methods or not words.paths:
        raise InputError("analyse wants the folder of a study, and files or folders of answers if they are elsewhere")
    study = open_study(words.paths[0])
    places = words.paths[1:] or [study.folder / "answers"]
    read = read_answers(study, places)
    for line in read.refused:
        console.warn(f"wm.study: {line}")
    output = pathlib.Path(words.text("output", str(study.folder / "results")))
    found = analyse(study, read, seed=words.number("seed", 0), resamples=words.number("resamples", 10_000, least=100))
    write_results(study, found, output)
    figures = f"participants counted: {found.counted}, excluded: {len(found.excluded)}; files refused: {len(read.refused)}"
    console.say(f"{output / 'results.md'}: {figures}")


def _one_folder(words: Words) -> pathlib.Path:
    if len(words.paths) != 1 or words.methods:
        raise InputError("serve wants the folder of one study")
    return words.paths[0]


_COMMANDS: dict[str, tuple[tuple[str, ...], Callable[[Words], None]]] = {
    "make": (("output", "questions", "reference", "seed", "participants", "ratings", "pairs"), _make),
    "serve": (("port", "host"), _serve),
    "analyse": (("output", "seed", "resamples"), _analyse),
}

if __name__ == "__main__":
    console.end(main)
