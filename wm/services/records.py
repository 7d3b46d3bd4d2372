"""A request to a model, its answer, and what a request is expected to cost."""

import dataclasses
from collections.abc import Mapping
from typing import Any

from wm.artifacts.digests import digest


@dataclasses.dataclass(frozen=True, eq=False)
class ServiceRequest:
    """What a model is asked. Two requests with the same key are the same request, and get the same answer."""

    backend: str  # dotted path of the module that asks
    model: str  # as the service or the hub names it, with its revision where there is one
    content: Mapping[str, Any]
    """Everything that the answer depends on, by name: JSON values, bytes, arrays. Never a secret, an address or a time limit."""
    paid: bool = True
    """Whether it costs money. A local model costs time only, and no budget counts it."""
    expected: Mapping[str, int | float] = dataclasses.field(default_factory=dict)
    """Expected usage, in the units of `ServiceAnswer.usage`, from which the budget reserves. The price table fills in what is
    not said."""

    @property
    def key(self) -> str:
        """20 hex digits, from model and content."""
        return digest("request", self.model, *(part for name in sorted(self.content) for part in (name, self.content[name])))


@dataclasses.dataclass(frozen=True, eq=False)
class ServiceAnswer:
    """What a model answered, as it came: nothing is decoded, resampled or repaired, so that an upgrade can read it again."""

    files: Mapping[str, bytes] = dataclasses.field(default_factory=dict)
    """By name, such as "image.png", "text.txt" or "depth.npy". Empty for a refusal."""
    refusal: str = ""
    """Why there is no usable content: a safety block, an empty candidate, a text in place of an image. Empty for none."""
    model_version: str = ""  # as the service reports it
    response_id: str = ""
    finish_reason: str = ""
    usage: Mapping[str, int | float] = dataclasses.field(default_factory=dict)
    """What was used: "input_tokens", "output_tokens", "image_tokens" (tokens of images put out), "images", "requests"."""

    @property
    def record(self) -> dict[str, Any]:
        """All but the files, as JSON values."""
        told = {field.name: getattr(self, field.name) for field in dataclasses.fields(self) if field.name != "files"}
        return told | {"usage": dict(self.usage)}


@dataclasses.dataclass(frozen=True)
class Quote:
    """What one request to a backend is expected to cost."""

    model: str
    usd: float | None  # 0 for a local model; None if the table has no price
    seconds: float | None  # of waiting; None where nobody knows
    at_once: int = 1  # requests that are under way at the same time
