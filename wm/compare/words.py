"""The words of the command line: METHOD=PATH, METHOD.option=value, and settings of the comparison."""

import collections
import dataclasses
import pathlib
from collections.abc import Iterable, Sequence

from wm.compare.adapters.registry import ADAPTERS, adapter_for
from wm.compare.axes import UP
from wm.compare.comparison import ComparisonRequest
from wm.compare.errors import CompareError
from wm.compare.records import Source
from wm.compare.store import check_method
from wm.compare.trajectories import DEFAULT, Picture, parse_names

_SETTINGS = ("trajectories", "output", "frames", "size", "fov", "fps", "quality")
_OPTIONS = ("up", "antialias", "cameras")
_MOST = 16384  # pixels along a side, as of cameras.width


def parse(words: Sequence[str]) -> ComparisonRequest:
    """The comparison that words ask for. Raises: CompareError, in one line that says what would be right."""
    pairs = [_pair(word) for word in words]
    _check_once(key for key, _ in pairs)
    settings = {key: value for key, value in pairs if key in _SETTINGS}
    options = [(key, value) for key, value in pairs if key not in _SETTINGS and "." in key and key.rpartition(".")[2] in _OPTIONS]
    methods = [pair for pair in pairs if pair[0] not in _SETTINGS and pair not in options]
    sources: dict[str, Source] = {}
    for key, value in methods:
        source = _source(key, value)
        if source.method in sources:
            raise CompareError(f"{source.method} is given twice; NAME:ADAPTER=PATH gives a system several rows")
        sources[source.method] = source
    if not sources:
        raise CompareError("no METHOD=PATH is given; ours=outputs/gothic/full/0 would be one")
    for key, value in options:
        method, _, option = key.rpartition(".")
        if method not in sources:
            raise CompareError(f"{key}: no method {method} is given; one of {', '.join(sources)} would be right")
        sources[method] = _with_option(sources[method], option, value)
    return ComparisonRequest(
        sources=tuple(sources.values()),
        trajectories=_trajectories(settings.get("trajectories")),
        output=pathlib.Path(settings.get("output") or "comparison"),
        picture=_picture(settings),
        quality=settings.get("quality"),
    )


def _check_once(keys: Iterable[str]) -> None:
    for key, count in collections.Counter(keys).items():
        if count > 1:
            raise CompareError(f"{key}= is given twice; NAME:ADAPTER=PATH gives a system several rows")


def _pair(word: str) -> tuple[str, str]:
    key, equals, value = word.partition("=")
    if not equals or not key or not value:
        raise CompareError(
            f"{word!r} is no METHOD=PATH and no setting; settings are {', '.join(f'{name}=' for name in _SETTINGS)}"
        )
    return key, value


def _source(key: str, value: str) -> Source:
    method, colon, adapter = key.partition(":")
    path = pathlib.Path(value)
    check_method(method)
    if colon and adapter not in ADAPTERS:
        raise CompareError(f"{key}: {adapter!r} is no adapter; one of {', '.join(ADAPTERS)} would be right")
    return Source(method=method, adapter=adapter if colon else adapter_for(method, path), path=path)


def _with_option(source: Source, option: str, value: str) -> Source:
    takes = ADAPTERS[source.adapter].SYSTEM.options
    if option not in takes:
        right = ", ".join(takes) or "none"
        raise CompareError(f"{source.method}.{option}: the files of {source.adapter} say so themselves; options of it: {right}")
    match option:
        case "up" if value in UP:
            return dataclasses.replace(source, up=value)
        case "antialias" if value in ("true", "false"):
            return dataclasses.replace(source, antialias=value == "true")
        case "cameras":
            return dataclasses.replace(source, cameras=pathlib.Path(value))
    right = ", ".join(UP) if option == "up" else "true or false"
    raise CompareError(f"{source.method}.{option}={value}: one of {right} would be right")


def _trajectories(value: str | None) -> tuple[str, ...]:
    if value is None:
        return DEFAULT
    if value.endswith(".json"):
        return (value,)
    return tuple(parse_names(words_in(value)))


def words_in(value: str) -> list[str]:
    """The words of a list such as [around,close], or the single word."""
    inner = value[1:-1] if value.startswith("[") and value.endswith("]") else value
    words = [word.strip() for word in inner.split(",")]
    if not all(words):
        raise CompareError(f"{value!r} is no list; [a,b] would be right")
    return words


def _picture(settings: dict[str, str]) -> Picture:
    width, height = _size(settings.get("size", "688x384"))
    return Picture(
        width=width,
        height=height,
        fov=_angle(settings.get("fov", "60")),
        frames=_whole(settings, "frames", 60, 2, 100_000),
        fps=_whole(settings, "fps", 24, 1, 240),
    )


def _size(text: str) -> tuple[int, int]:
    width, cross, height = text.partition("x")
    if not (cross and width.isdigit() and height.isdigit() and all(16 <= int(n) <= _MOST for n in (width, height))):
        raise CompareError(f"size={text}: WIDTHxHEIGHT in pixels from 16 on, such as 688x384, would be right")
    return int(width), int(height)


def _whole(settings: dict[str, str], name: str, default: int, low: int, high: int) -> int:
    text = settings.get(name, str(default))
    if not (text.isascii() and text.isdigit() and low <= int(text) <= high):
        raise CompareError(f"{name}={text}: a whole number from {low} to {high} would be right")
    return int(text)


def _angle(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 5 <= value <= 150:
        raise CompareError(f"fov={text}: degrees from 5 to 150 would be right")
    return value
