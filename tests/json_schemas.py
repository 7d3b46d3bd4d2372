"""The part of JSON Schema that our schemas use: whether a value conforms, and values that do."""

import re
from typing import Any

from hypothesis import strategies as st

_TYPES = {"object": dict, "array": list, "string": str, "number": (int, float)}


def faults(schema: dict[str, Any], value: Any, where: str = "$") -> list[str]:
    """Where and how a value does not conform to a schema; an unknown keyword raises KeyError."""
    if "anyOf" in schema:
        options = [faults(option, value, where) for option in schema["anyOf"]]
        return [] if [] in options else min(options, key=len)
    found = [f"{where}: {key}" for key in schema if not _HOLDS[key](schema, value)]
    if not found and isinstance(value, dict):
        return [fault for key, part in value.items() for fault in faults(schema["properties"][key], part, f"{where}.{key}")]
    if not found and isinstance(value, list):
        return [fault for k, part in enumerate(value) for fault in faults(schema["items"], part, f"{where}[{k}]")]
    return found


_HOLDS = {
    "type": lambda schema, value: isinstance(value, _TYPES[schema["type"]]) and not isinstance(value, bool),
    "enum": lambda schema, value: value in schema["enum"],
    "pattern": lambda schema, value: not isinstance(value, str) or re.search(schema["pattern"], value) is not None,
    "minLength": lambda schema, value: not isinstance(value, str) or len(value) >= schema["minLength"],
    "maxLength": lambda schema, value: not isinstance(value, str) or len(value) <= schema["maxLength"],
    "minimum": lambda schema, value: not isinstance(value, (int, float)) or value >= schema["minimum"],
    "maximum": lambda schema, value: not isinstance(value, (int, float)) or value <= schema["maximum"],
    "minItems": lambda schema, value: not isinstance(value, list) or len(value) >= schema["minItems"],
    "maxItems": lambda schema, value: not isinstance(value, list) or len(value) <= schema["maxItems"],
    "required": lambda schema, value: not isinstance(value, dict) or set(schema["required"]) <= set(value),
    "additionalProperties": lambda schema, value: not isinstance(value, dict) or set(value) <= set(schema["properties"]),
    "properties": lambda schema, value: True,
    "items": lambda schema, value: True,
    "description": lambda schema, value: True,
}


def conforming(schema: dict[str, Any]) -> st.SearchStrategy[Any]:
    """Values that conform to a schema; texts without a pattern are printable."""
    if "anyOf" in schema:
        return st.one_of([conforming(option) for option in schema["anyOf"]])
    if "enum" in schema:
        return st.sampled_from(schema["enum"])
    if schema["type"] == "object":
        return st.fixed_dictionaries({name: conforming(part) for name, part in schema["properties"].items()})
    if schema["type"] == "array":
        return st.lists(
            conforming(schema["items"]), min_size=schema["minItems"], max_size=schema.get("maxItems", schema["minItems"] + 2)
        )
    if schema["type"] == "number":
        return st.floats(schema["minimum"], schema["maximum"], allow_nan=False)
    if "pattern" in schema:
        return st.from_regex(schema["pattern"].replace("$", r"\Z"), fullmatch=True)
    letters = st.characters(codec="utf-8", categories=("L", "N", "P", "S"))
    return st.text(letters, min_size=schema["minLength"], max_size=min(schema["maxLength"], 20))
