"""What a log says of a message type: its text and those of all it is made of, and its hash.

Both come from the installed ROS 2 (from PyPI it is in the prefix of Python, and sets no
AMENT_PREFIX_PATH); tf2_msgs is not on PyPI, and its one message is told here.
"""

from __future__ import annotations

import json
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path

# rosbag2's form: the text, then after a line of 80 "=" each dependency under its name
SEPARATOR = "=" * 80 + "\nMSG: {kind}\n{text}"
TF_MESSAGE = "tf2_msgs/msg/TFMessage"
TF_TEXT = "geometry_msgs/TransformStamped[] transforms\n"
TF_HASH = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"
FIELD = re.compile(r"^\s*([A-Za-z]\w*(?:/\w+)*)(?:<=\d+)?(?:\[[^\]]*\])?\s+\w+", re.MULTILINE)
PLAIN = {
    *("bool", "byte", "char", "float32", "float64", "string", "wstring"),
    *(f"{sign}int{size}" for sign in ("", "u") for size in (8, 16, 32, 64)),
}


@dataclass(frozen=True, slots=True)
class Definition:
    """A message type, its text with all dependencies, and its RIHS01 hash."""

    kind: str
    text: str
    type_hash: str


def definition(kind: str) -> Definition:
    """Return the definition of `package/msg/Name`."""
    others = dict.fromkeys(_dependencies(kind))
    parts = [SEPARATOR.format(kind=_short(each), text=_text(each)) for each in others]
    return Definition(kind, "\n".join([_text(kind), *parts]), _hash(kind))


def _dependencies(kind: str) -> list[str]:
    """Types of the fields of a message, and of theirs, depth first."""
    package = kind.partition("/")[0]
    found: list[str] = []
    for name in FIELD.findall(_text(kind)):
        if name.split("<")[0] not in PLAIN:
            owner, _, short = name.rpartition("/")
            nested = f"{owner.removesuffix('/msg') or package}/msg/{short}"
            found += [nested, *_dependencies(nested)]
    return found


def _short(kind: str) -> str:
    return kind.replace("/msg/", "/")


def _text(kind: str) -> str:
    return TF_TEXT if kind == TF_MESSAGE else _file(kind, "msg").read_text(encoding="utf-8")


def _hash(kind: str) -> str:
    if kind == TF_MESSAGE:
        return TF_HASH
    try:
        hashes = json.loads(_file(kind, "json").read_text(encoding="utf-8"))["type_hashes"]
    except OSError:  # before Iron there were none
        return ""
    return next(str(each["hash_string"]) for each in hashes if each["type_name"] == kind)


def _file(kind: str, suffix: str) -> Path:
    package, _, name = kind.split("/")
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    paths = [Path(each, "share", package, "msg", f"{name}.{suffix}") for each in prefixes if each]
    found = next((path for path in paths if path.is_file()), None)
    if not found:
        msg = f"no definition of {kind} ({name}.{suffix}) in AMENT_PREFIX_PATH or {sys.prefix}"
        raise FileNotFoundError(msg)
    return found
