"""How many participants a study needs, and what its attention checks are worth, by simulated participants.

    python experiments/study/run.py      prints the tables and writes result.csv

Participants have levels of their own and answer around the paper's means; careless ones answer every page at random. Sessions,
checks, tallies and intervals are those of wm.study.
"""

import csv
import dataclasses
import pathlib
from collections import defaultdict

import numpy as np
from tabulate import tabulate

from wm.study.answers import Answer, Sheet
from wm.study.attention import failed_check
from wm.study.folder import Study
from wm.study.intervals import bootstrapped_mean, exact_share
from wm.study.paper_study import PAPER_RATINGS
from wm.study.questions import read_questions
from wm.study.sessions import StudyPlan, plan_sessions
from wm.study.tallies import ratings_of

LEVEL, NOISE = 0.5, 0.8
"""Standard deviations in points: between participants, and between answers of one. Assumed; the paper gives no spread."""
SCENES = 5
STUDIES = 400
QUESTIONS = read_questions("comparison")
MEANS = PAPER_RATINGS["comparison"]


def study(participants):
    """A study of the paper's seven methods on five scenes, without videos."""
    names = {method: {f"s{k}": f"{method}-{k}" for k in range(SCENES)} for method in ("ours", *(m for m in MEANS if m != "ours"))}
    sessions = plan_sessions(names, QUESTIONS, StudyPlan(participants=participants))
    videos = {name: (method, scene) for method, scenes in names.items() for scene, name in scenes.items()}
    return Study(pathlib.Path(), "simulated", QUESTIONS, tuple(names), "ours", videos, tuple(map(tuple, sessions)))


def attentive(made, slot, rng):
    level, answers = rng.normal(0, LEVEL), []
    first = {}
    for trial in made.sessions[slot]:
        method = made.videos[trial.videos[0]][0]
        if trial.is_pair:
            answers.append(Answer(None, str(trial.check or "left")))
        elif trial.check is not None:
            answers.append(Answer({question.id: int(trial.check) for question in QUESTIONS.ratings}, None))
        else:
            felt = first.setdefault(trial.videos, [mean + level for mean in MEANS[method]])
            values = np.clip(np.rint(rng.normal(felt, NOISE)), 1, 5).astype(int).tolist()
            answers.append(Answer({question.id: value for question, value in zip(QUESTIONS.ratings, values)}, None))
    return Sheet(f"{slot:032x}", "", slot, tuple(answers))


def careless(made, slot, rng):
    answers = [
        Answer(None, str(rng.choice(["left", "right"])))
        if trial.is_pair
        else Answer({question.id: int(rng.integers(1, 6)) for question in QUESTIONS.ratings}, None)
        for trial in made.sessions[slot]
    ]
    return Sheet(f"{slot:032x}", "", slot, tuple(answers))


def widths(participants, rng):
    """Half a mean's interval, how often it covers, and how often 2.61 (SpatialGen) is told from 2.27 (LayerPano3D)."""
    made, truth = study(participants), expected(rng)
    half, covered, told = [], [], []
    for _ in range(STUDIES):
        answers = defaultdict(list)
        for rating in ratings_of(made, [attentive(made, slot, rng) for slot in range(participants)]):
            if rating.question == "quality":
                answers[rating.method].append((rating.participant, float(rating.value)))
        found = {method: bootstrapped_mean(given, seed=0, resamples=500) for method, given in answers.items()}
        half += [(one.high - one.low) / 2 for one in found.values()]
        covered += [one.low <= truth[method] <= one.high for method, one in found.items()]
        told.append(difference(answers["spatialgen"], answers["layerpano3d"]).low > 0)
    return np.mean(half), np.mean(covered), np.mean(told)


def expected(rng):
    """The mean answers that the simulated participants give in the end."""
    felt = {method: means[0] + rng.normal(0, LEVEL, 200_000) for method, means in MEANS.items()}
    return {method: float(np.clip(np.rint(rng.normal(one, NOISE)), 1, 5).mean()) for method, one in felt.items()}


def difference(first, second):
    """The mean difference of two methods within participants."""
    each = defaultdict(lambda: ([], []))
    for side, answers in enumerate((first, second)):
        for who, value in answers:
            each[who][side].append(value)
    return bootstrapped_mean([(who, float(np.mean(a) - np.mean(b))) for who, (a, b) in each.items()], seed=0, resamples=500)


def caught(kind, rng, tolerance, number=2000):
    """Share of participants that a check excludes."""
    questions = dataclasses.replace(QUESTIONS, checks=dataclasses.replace(QUESTIONS.checks, tolerance=tolerance))
    made = dataclasses.replace(study(60), questions=questions)
    return np.mean([failed_check(made, kind(made, n % 60, rng)) is not None for n in range(number)])


def main():
    rng = np.random.default_rng(0)
    rows = []
    for participants in (8, 16, 31, 60):
        half, covered, told = widths(participants, rng)
        shares = [exact_share(round(share * participants), participants, participants) for share in (0.97, 0.6)]
        rows.append((participants, half, covered, told, *(bound for one in shares for bound in (one.low, one.high))))
    head = ("participants", "half width", "coverage", "0.34 apart told", "97 % low", "97 % high", "60 % low", "60 % high")
    print(tabulate(rows, head, tablefmt="github", floatfmt=".3f"))
    checks = [(at, caught(careless, rng, at), caught(attentive, rng, at)) for at in (1.0, 1.5, 2.0, 4.0)]
    print()
    print(tabulate(checks, ("tolerance", "careless excluded", "attentive excluded"), tablefmt="github"))
    with (pathlib.Path(__file__).parent / "result.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows([(row[0], *(f"{value:.4f}" for value in row[1:])) for row in rows])
        writer.writerow(("tolerance", "careless excluded", "attentive excluded"))
        writer.writerows([(at, f"{bad:.4f}", f"{good:.4f}") for at, bad, good in checks])


if __name__ == "__main__":
    main()
