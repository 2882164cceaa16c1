"""Fields of run.json, read as `run_fields.json` describes them; the page reads them by it too."""

import json
from collections.abc import Callable, Mapping
from math import inf
from pathlib import Path
from typing import Any

from symtop_ros.base.refusals import choice, flag, number, refuse, vector

TABLE = json.loads(Path(__file__).with_name("run_fields.json").read_text(encoding="utf-8"))
Field = Mapping[str, Any]


def _read_record(name: str, value: Any, field: Field) -> dict[str, Any]:
    kinds = field["records"]
    kind = value.get("kind") if isinstance(value, dict) else None
    if not isinstance(kind, str) or kind not in kinds:
        raise refuse(name, f"a record of kind {', '.join(kinds)}", value)
    fields = {each: read_field(each, found, value) for each, found in kinds[kind].items()}
    return {"kind": kind, **fields}


def _read_text(name: str, value: Any, field: Field) -> str:
    if not isinstance(value, str) or len(value) > field["length"]:
        raise refuse(name, f"a text of at most {field['length']} characters", value)
    return value


# By what the description of a field has; others are numbers.
READERS: dict[str, Callable[[str, Any, Field], Any]] = {
    "size": lambda name, value, field: vector(
        name, value, field["size"], field["limit"], field["unit"]
    ),
    "records": _read_record,
    "flag": lambda name, value, _: flag(name, value),
    "words": lambda name, value, field: choice(name, value, tuple(field["words"])),
    "length": _read_text,
}


def read_field(name: str, field: Field, given: Mapping[str, Any]) -> Any:
    """Return a value that follows the description of its field."""
    if name not in given and "absent" in field:
        return field["absent"]
    value = given.get(name)
    for sign, read in READERS.items():
        if sign in field:
            return read(name, value, field)
    return number(name, value, field["unit"], field.get("low", -inf), field.get("high", inf))
