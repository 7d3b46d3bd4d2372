"""The folder of a study. Only its `page` is for participants; the key that names the methods stays beside it.

    page/        to be published: index.html, study.css, study.js, plan.js, videos/<digest>.mp4
    key.json     which video is of which method. NOT to be published
    serve.py     the server, for `python serve.py`: shows page/, stores answers/
    answers/     one file a participant
    README.txt   this, for whoever finds the folder

The same arguments give the same bytes.
"""

import hashlib
import importlib.resources
import json
import os
import pathlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from wm.artifacts.atomic import write_atomically
from wm.errors import InputError
from wm.stages.progress import progress
from wm.study.questions import QuestionSet, questions_from
from wm.study.sessions import StudyPlan, Trial, plan_sessions, reference_of
from wm.study.videos import StudyVideo, copied, matched, telling_differences, without_twins

VERSION = 1
PAGE_FILES = ("index.html", "study.css", "study.js")
_DATE = 946684800  # 2000-01-01
_ABOUT = """A study of videos, made by `python -m wm.study make`.

page/       what participants see. Publish this folder, and nothing else here.
key.json    says which video is of which method. Keep it: participants must not see it, and without it nothing can be analysed.
serve.py    `python serve.py` shows page/ and stores what participants answer in answers/ (Python's standard library only).
answers/    one JSON file a participant; files that participants have sent go here too.

Analyse with `python -m wm.study analyse THIS_FOLDER`.
"""


@dataclass(frozen=True)
class Study:
    """A study as its key has it."""

    folder: pathlib.Path
    id: str
    questions: QuestionSet
    methods: tuple[str, ...]
    reference: str
    videos: Mapping[str, tuple[str, str]]  # method and scene, by the name of the video
    sessions: tuple[tuple[Trial, ...], ...]


def make_study(methods: Mapping[str, pathlib.Path], output: pathlib.Path, questions: QuestionSet, plan: StudyPlan) -> list[str]:
    """Writes the folder of a study; the same arguments give the same bytes.

    Args:
      methods: for each method a video, or a folder of videos named by scene.
      output: the folder; one that is already a study's with answers is refused.

    Returns:
      Lines for the user: scenes left out, and what tells methods apart.

    Raises:
      InputError: see `matched`, `copied` and `plan_sessions`.
    """
    if any((output / "answers").glob("*.json")):
        raise InputError(f"output={output}: people have answered this study already; give another folder")
    sources, others = matched(methods)
    reference = reference_of(list(methods), plan)
    with progress("videos", len(sources)) as bar:
        videos = []
        for source in sources:
            videos.append(copied(source, output / "page" / "videos"))
            bar.update()
    without_twins(videos)
    _only(videos, output / "page" / "videos")
    names = {method: {video.scene: video.name for video in videos if video.method == method} for method in methods}
    sessions = plan_sessions(names, questions, plan)
    _write(output, videos, questions, reference, plan, sessions)
    lines = [f"left out, since not every method has them: {', '.join(others)}"] if others else []
    anew = [f"{video.method} {video.scene}" for video in videos if video.encoded]
    lines += [f"encoded anew as H.264, since browsers do not play the original: {', '.join(anew)}"] if anew else []
    return lines + telling_differences(videos)


def _only(videos: list[StudyVideo], folder: pathlib.Path) -> None:
    """Removes videos of an earlier call, and gives all one date: they were written method by method."""
    names = {f"{video.name}.mp4" for video in videos}
    for file in folder.glob("*.mp4"):
        if file.name in names:
            os.utime(file, (_DATE, _DATE))
        else:
            file.unlink()


def _write(
    output: pathlib.Path,
    videos: list[StudyVideo],
    questions: QuestionSet,
    reference: str,
    plan: StudyPlan,
    sessions: list[list[Trial]],
) -> None:
    page = _for_participants(videos, questions, sessions)
    key = {
        "version": VERSION,
        "study": page["study"],
        "questions": questions.as_json(),
        "reference": reference,
        "plan": asdict(plan),
        "methods": list(dict.fromkeys(video.method for video in videos)),
        "videos": {video.name: {"method": video.method, "scene": video.scene, "source": video.source} for video in videos},
        "sessions": page["sessions"],
    }
    own = importlib.resources.files("wm.study")
    for name in PAGE_FILES:
        write_atomically(output / "page" / name, (own / "page" / name).read_bytes())
    write_atomically(output / "page" / "plan.js", f"window.STUDY = {json.dumps(page, sort_keys=True)};\n")
    write_atomically(output / "serve.py", (own / "serve.py").read_bytes())
    write_atomically(output / "README.txt", _ABOUT)
    write_atomically(output / "key.json", json.dumps(key, indent=1) + "\n")
    (output / "answers").mkdir(exist_ok=True)


def _for_participants(videos: list[StudyVideo], questions: QuestionSet, sessions: list[list[Trial]]) -> dict[str, Any]:
    """What the page knows: texts, sizes of videos in the order of their names, and sessions; nothing of methods."""
    shown = {key: value for key, value in questions.as_json().items() if key not in ("paper", "pairs", "checks")}
    sizes = {video.name: [video.width, video.height] for video in sorted(videos, key=lambda video: video.name)}
    page = {"version": VERSION, **shown, "videos": sizes, "sessions": [[trial.as_json() for trial in one] for one in sessions]}
    return page | {"study": hashlib.sha256(json.dumps(page, sort_keys=True).encode()).hexdigest()[:12]}


def open_study(folder: pathlib.Path) -> Study:
    """A study read back from its key.

    Raises:
      InputError: there is no key, or it is damaged.
    """
    path = folder / "key.json"
    try:
        key = json.loads(path.read_text(encoding="utf-8"))
        videos = {name: (str(video["method"]), str(video["scene"])) for name, video in key["videos"].items()}
        sessions = tuple(tuple(_trial(trial) for trial in session) for session in key["sessions"])
        if key["version"] != VERSION or not all(name in videos for one in sessions for trial in one for name in trial.videos):
            raise ValueError("another version, or videos without a method")
        questions = questions_from(key["questions"], place=str(path))
        return Study(folder, key["study"], questions, tuple(key["methods"]), key["reference"], videos, sessions)
    except FileNotFoundError as error:
        raise InputError(f"{folder}: no study is there (no key.json); make one with `python -m wm.study make`") from error
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path}: the key is damaged ({error})") from error


def _trial(values: dict[str, Any]) -> Trial:
    return Trial(tuple(values["videos"]), values.get("check"), values.get("repeat", False))
