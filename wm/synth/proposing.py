"""Propose - validate - correct: asks a language backend for a floor plan until a plan breaks no rule.

One iteration is one answer of the backend. The paper needs 1.3 to 3.2 iterations and 79 to 252 s (table "Floor-plan layout-LLM
backends").
"""

import dataclasses
import time
from collections import Counter
from collections.abc import Mapping
from typing import Any

from wm.geometry.plan.loading import FloorPlan, PlanError, read_plan
from wm.schema import LONGEST_ROOM_NAME
from wm.services.faults import RefusedError
from wm.synth.backends import LanguageBackend, LanguageResult
from wm.synth.plan_text import plan_document
from wm.synth.room_names import CONNECTING, room_sort

_SHOWN = 12  # violations in an error message


@dataclasses.dataclass(frozen=True)
class Attempt:
    """One answer of the backend and the rules that it broke (none if the plan is valid)."""

    text: str
    violations: tuple[str, ...]
    seconds: float
    record: Mapping[str, Any] = dataclasses.field(default_factory=dict)  # what wrote it (LanguageResult)


@dataclasses.dataclass(frozen=True, eq=False)
class Proposal:
    """A valid floor plan and the answers that led to it."""

    plan: FloorPlan
    iterations: int
    seconds: float  # of backend and validation together
    transcript: tuple[Attempt, ...]


class ProposalError(RuntimeError):
    """The backend gave no valid floor plan within the limit of iterations."""

    def __init__(self, transcript: tuple[Attempt, ...]):
        self.transcript = transcript
        last = transcript[-1].violations
        more = f" (and {len(last) - _SHOWN} more)" if len(last) > _SHOWN else ""
        tries = "1 proposal" if len(transcript) == 1 else f"{len(transcript)} proposals"
        super().__init__(f"no valid floor plan after {tries}; the last one had: {'; '.join(last[:_SHOWN])}{more}")


def propose_plan(backend: LanguageBackend, theme: str, rooms: list[str], *, seed: int, max_iterations: int) -> Proposal:
    """Asks `backend` for a floor plan of these rooms until one is valid.

    Args:
      backend: the language backend; after an invalid answer it is given that answer and its violations.
      theme: the scene in words.
      rooms: the names of the wanted rooms. A valid plan has all of them and no others, except rooms of the sorts CONNECTING.
      seed: seed of the scene.
      max_iterations: largest number of answers; at least one is asked for.

    Raises:
      ValueError: `rooms` is empty, or an entry is not a valid name.
      ProposalError: no answer was valid; the message lists the violations of the last one.
    """
    if not rooms:
        raise ValueError("the room programme is empty; name at least one room")
    for room in rooms:
        if not room.strip() or not room.isprintable() or len(room) > LONGEST_ROOM_NAME:
            raise ValueError(f"the room programme names {room!r}; a name has 1 to {LONGEST_ROOM_NAME} printable characters")
    transcript: list[Attempt] = []
    previous, violations, refused = None, [], 0
    for _ in range(max(max_iterations, 1)):
        start = time.perf_counter()
        try:
            result = backend.propose(theme, rooms, seed=(seed + refused) % 2**63, violations=list(violations), previous=previous)
        except RefusedError as refusal:
            transcript.append(Attempt("", (f"plan: answer: {refusal}",), time.perf_counter() - start))
            refused += 1  # another seed is another request: the same one would be answered by the kept refusal
            continue
        previous = _text(result)
        plan, violations = _validated(previous, rooms)
        transcript.append(Attempt(previous, tuple(violations), time.perf_counter() - start, result.record))
        if plan is not None:
            seconds = sum(attempt.seconds for attempt in transcript)
            return Proposal(plan=plan, iterations=len(transcript), seconds=seconds, transcript=tuple(transcript))
    raise ProposalError(tuple(transcript))


def _text(result: LanguageResult) -> str:
    if not isinstance(result, LanguageResult):
        told = f"{type(result).__module__}.{type(result).__name__}"
        raise ValueError(f"the language backend returned a {told}, not a LanguageResult (wm.synth.backends)")
    return result.text


def _validated(text: str, rooms: list[str]) -> tuple[FloorPlan | None, list[str]]:
    try:
        plan = read_plan(plan_document(text), "proposal", unreachable="refuse").plan
    except PlanError as error:
        return None, [str(violation) for violation in error.violations]
    violations = _programme_violations(plan, rooms)
    return (None if violations else plan), violations


def _programme_violations(plan: FloorPlan, rooms: list[str]) -> list[str]:
    """Violations for rooms of the programme that the plan lacks, and for rooms of the plan that are not in the programme."""
    wanted = Counter(" ".join(room.split()).lower() for room in rooms)
    there = Counter(" ".join(room.name.split()).lower() for room in plan.rooms)
    missing = [f"plan: programme: no room is named {name!r}, {count} wanted" for name, count in (wanted - there).items()]
    extra = [
        f"plan: programme: room {name!r} was not asked for; only halls and corridors may be added"
        for name in there - wanted
        if room_sort(name) not in CONNECTING
    ]
    return missing + extra
