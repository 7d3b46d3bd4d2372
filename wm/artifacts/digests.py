"""Digests of values and files, and the one way in which values are written as JSON."""

import dataclasses
import hashlib
import json
import pathlib
from typing import Any

import numpy as np


def digest(*parts: Any) -> str:
    """A stable key of JSON-like values, dataclasses, bytes and arrays (20 hex digits of a SHA-256)."""
    sha = hashlib.sha256()
    for part in parts:
        if isinstance(part, np.ndarray):
            sha.update(f"{part.dtype.str}{part.shape}".encode())
            sha.update(np.ascontiguousarray(part).tobytes())
        elif isinstance(part, bytes):
            sha.update(part)
        else:
            sha.update(json.dumps(identity(part), sort_keys=True, allow_nan=False).encode())
        sha.update(b"\x00")
    return sha.hexdigest()[:20]


def identity(value: Any) -> Any:
    """A settings record as JSON-like values, without the fields that change no result (`wm.schema.BESIDE`)."""
    if not dataclasses.is_dataclass(value) or isinstance(value, type):
        return value
    kept = (field.name for field in dataclasses.fields(value) if field.metadata.get("identity", True))
    return {name: identity(getattr(value, name)) for name in kept}


def file_digest(path: pathlib.Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()[:20]


def content_digest(content: bytes) -> str:
    """`file_digest` of a file that holds this."""
    return hashlib.sha256(content).hexdigest()[:20]


def json_text(value: Any) -> str:
    """JSON with sorted keys, one way only; NaN is refused."""
    return json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n"
