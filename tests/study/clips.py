"""Small videos, a study made of them, and answers to it as the page would write them."""

import json
import pathlib
import subprocess

import imageio_ffmpeg

from wm.study.folder import Study, make_study, open_study
from wm.study.questions import read_questions
from wm.study.sessions import StudyPlan

METHODS = ("ours", "WonderWorld", "FlexWorld")
SCENES = ("hall_orbit", "kitchen_door")


def clip(path, *, pattern="testsrc", size="64x36", seconds=0.4, codec="libvpx-vp9", options=()):
    """A video of a test pattern, with a title that tells the method."""
    path.parent.mkdir(parents=True, exist_ok=True)
    source = f"{pattern}=size={size}:rate=10:duration={seconds}"
    told = ["-y", "-v", "error", "-f", "lavfi", "-i", source, "-c:v", codec, "-pix_fmt", "yuv420p", *options]
    title = ["-metadata", f"title=made by {path.parent.name}"]
    subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), *told, *title, str(path)], check=True, capture_output=True)
    return path


def clips(folder: pathlib.Path) -> dict[str, pathlib.Path]:
    """A folder of videos for each method, each video another picture."""
    for row, method in enumerate(METHODS):
        for column, scene in enumerate(SCENES):
            clip(folder / method / f"{scene}.mp4", pattern=("testsrc", "testsrc2", "smptebars")[row], seconds=0.4 + 0.1 * column)
    return {method: folder / method for method in METHODS}


def small_study(folder: pathlib.Path, questions="comparison", **plan) -> Study:
    """A study of those videos."""
    make_study(clips(folder / "videos"), folder / "study", read_questions(questions), StudyPlan(**{"participants": 6, **plan}))
    return open_study(folder / "study")


def answers(study: Study, slot: int, number: int, rate=lambda method, scene: 3, prefer=lambda left, right: "left"):
    """What a participant who passes all checks answers: `rate` and `prefer` are asked with methods."""
    given = []
    for trial in study.sessions[slot]:
        methods = [study.videos[name][0] for name in trial.videos]
        if trial.is_pair:
            given.append({"choice": trial.check or prefer(*methods)})
        else:
            value = trial.check or rate(methods[0], study.videos[trial.videos[0]][1])
            given.append({"ratings": {question.id: value for question in study.questions.ratings}})
    pages = [{**one, "seconds": 9.5, "plays": 1} for one in given]
    return {"version": 1, "study": study.id, "participant": f"{number:032x}", "slot": slot, "answers": pages}


def hand_in(study: Study, given, name=None):
    """Writes answers where the server would."""
    file = study.folder / "answers" / f"{name or given['participant']}.json"
    file.parent.mkdir(exist_ok=True)
    file.write_text(given if isinstance(given, str) else json.dumps(given))
    return file
