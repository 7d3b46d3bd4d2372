"""Which participants were attentive.

Three kinds of checks are among the pages, and a participant who fails one is excluded from every figure:

- a page to rate that says which number to choose: failed unless every question has that number;
- a pair that says which video to choose: failed by the other one;
- a video that is rated a second time, near the end: failed where the two ratings differ by more than the tolerance of the
  question set, on average over the questions. experiments/study says how many of whom this excludes.

A check whose video could not be played is not judged. No check counts as a rating or a preference.
"""

from wm.study.answers import Answer, Sheet
from wm.study.folder import Study
from wm.study.sessions import Trial


def failed_check(study: Study, sheet: Sheet) -> str | None:
    """Why a participant is excluded, or None."""
    pages = sheet.with_trials(study)
    first = {trial.videos: answer for trial, answer in pages if not (trial.is_pair or trial.repeat or trial.check is not None)}
    for number, (trial, answer) in enumerate(pages, 1):
        if reason := _told(trial, answer) or _repeated(trial, answer, first, study.questions.checks.tolerance):
            return f"page {number}: {reason}"
    return None


def _told(trial: Trial, answer: Answer) -> str | None:
    if trial.check is None:
        return None
    if answer.choice is not None and answer.choice != trial.check:
        return f"it asked for the {trial.check} video, the answer is {answer.choice}"
    if answer.ratings is not None and set(answer.ratings.values()) != {trial.check}:
        return f"it asked for {trial.check} everywhere, the answers are {', '.join(map(str, answer.ratings.values()))}"
    return None


def _repeated(trial: Trial, answer: Answer, first: dict[tuple[str, ...], Answer], tolerance: float) -> str | None:
    before = first[trial.videos].ratings if trial.repeat and trial.videos in first else None
    if before is None or answer.ratings is None:
        return None
    apart = sum(abs(value - before[question]) for question, value in answer.ratings.items()) / len(before)
    return f"the video was rated before, and now {apart:.1f} points apart on average" if apart > tolerance else None
