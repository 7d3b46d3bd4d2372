"""The floor plan in a language model's answer, whatever the model wraps around it.

Models are asked for JSON and answer with code fences, sentences before and after it, single quotes, comments, commas before a
closing bracket, Python's True and None, numbers in quotes and points as {"x": 1, "y": 2}. All of that is read here. Files of a
user's own stay strict JSON (`wm.geometry.load_plan`), so that nothing in them is guessed. A proposal that is misread breaks a
rule, and the model is asked again.
"""

import json
import re
from collections.abc import Iterator
from typing import Any

from wm.geometry.plan.layout_json import MAX_BYTES, decode
from wm.geometry.plan.records import PlanError, Violation

_TOKEN = re.compile(
    r"""(?P<double>"(?:[^"\\]|\\.)*")
      | (?P<single>'(?:[^'\\]|\\.)*')
      | (?P<comment>//[^\n]*|/\*.*?\*/|\#[^\n]*)
      | (?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)
      | (?P<word>[A-Za-z_][A-Za-z0-9_]*)
      | (?P<mark>[][{}:,])
      | (?P<space>\s+)
      | (?P<other>.)""",
    re.VERBOSE | re.DOTALL,
)
_WORDS = {"True": "true", "False": "false", "None": "null", "undefined": "null", "true": "true", "false": "false", "null": "null"}
_CLOSES = {"{": "}", "[": "]"}
_MOST_STARTS = 32
"""Opening brackets of an answer that are tried."""
_NUMBERS = frozenset(("position", "width", "height", "sill_height", "ceiling_height", "wall_thickness", "default_ceiling_height"))
_POINTS = frozenset(("floor_polygon", "wall_segment"))
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?:m|meters?|metres?)?\s*")


def plan_document(text: str) -> Any:
    """The plan that an answer holds, as decoded JSON: an object with `rooms`.

    Raises:
      PlanError: one violation, rule "json", that tells the model what is wrong with its answer.
    """
    if len(text) > MAX_BYTES:
        raise _fault(f"the answer is {len(text)} characters long; at most {MAX_BYTES} are read")
    try:
        return _usual(_unwrapped(decode(text, "proposal")))
    except PlanError as error:
        fault = error.violations[0].message
    for found in _candidates(text):
        if found is None:
            fault = "the JSON breaks off before its brackets are closed; answer with the whole plan"
            continue
        try:
            document = _unwrapped(decode(found, "proposal"))
        except PlanError as error:
            fault = error.violations[0].message
            continue
        if isinstance(document, dict) and "rooms" in document:
            return _usual(document)
    if "{" not in text:
        fault = "the answer holds no JSON object; answer with the floor plan as one JSON object and nothing else"
    raise _fault(fault)


def _candidates(text: str) -> Iterator[str | None]:
    """Strict JSON of what begins at each opening bracket and is balanced; None for a bracket that nothing closes.

    What lies within a value is no candidate of its own, unless the brackets around it are not those of JSON.
    """
    starts = [match.start() for match in re.finditer(r"[{\[]", text)][:_MOST_STARTS]
    behind = 0
    for start in starts:
        if start < behind:
            continue
        strict, end = _strict(text, start)
        if strict is not None and '"rooms"' in strict:
            behind = end
        if strict is not None or '"rooms"' in text[start:] or "'rooms'" in text[start:]:
            yield strict


def _strict(text: str, start: int) -> tuple[str | None, int]:
    """The balanced value that begins at a bracket, as strict JSON, and where it ends; (None, end) where it is not balanced."""
    out: list[str] = []
    open_brackets: list[str] = []
    for match in _TOKEN.finditer(text, start):
        kind, token = match.lastgroup, match.group()
        if kind in ("comment", "space"):
            continue
        if token in _CLOSES:
            open_brackets.append(_CLOSES[token])
        elif token in ("}", "]"):
            if open_brackets.pop() != token:
                return None, match.end()
            if out[-1] == ",":
                out.pop()
        out.append(_written(kind, token))
        if not open_brackets:
            return "".join(out), match.end()
    return None, len(text)


def _written(kind: str | None, token: str) -> str:
    """A token as strict JSON writes it."""
    if kind == "single":
        return json.dumps(re.sub(r"\\(['\"])", r"\1", token[1:-1]))
    if kind == "word":
        return _WORDS.get(token, json.dumps(token))
    if kind == "number":
        whole = token.lstrip("+")
        return whole if re.fullmatch(r"-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?", whole) else repr(float(whole))
    return token


def _unwrapped(document: Any) -> Any:
    """A plan out of {"plan": {...}}, or a bare list of rooms made one."""
    if isinstance(document, list) and document and all(isinstance(room, dict) and "floor_polygon" in room for room in document):
        return {"rooms": document}
    if isinstance(document, dict) and "rooms" not in document:
        inner = [value for value in document.values() if isinstance(value, dict) and "rooms" in value]
        return inner[0] if len(inner) == 1 else document
    return document


def _usual(value: Any, key: str = "") -> Any:
    """The document with lengths as numbers and points as lists, where a model has written them otherwise."""
    if isinstance(value, dict):
        if key in _POINTS and {name.lower() for name in value} == {"x", "y"}:
            return [_length(part) for _, part in sorted(value.items(), key=lambda item: item[0].lower())]
        return {name: _usual(part, name) for name, part in value.items()}
    if isinstance(value, list):
        return [_usual(part, key if key in _POINTS else "") for part in value]
    return _length(value) if key in _NUMBERS | _POINTS else value


def _length(value: Any) -> Any:
    match = _LENGTH.fullmatch(value) if isinstance(value, str) else None
    return value if match is None else float(match.group(1))


def _fault(message: str) -> PlanError:
    return PlanError((Violation(None, "json", message),), "proposal")
