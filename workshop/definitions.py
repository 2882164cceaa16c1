"""Writes run/log/definitions.json from the message packages of the installed ROS 2 (Jazzy).

Run it when a topic with a new message type is added: python -m workshop.definitions

The hashes are those of rosbags. Its texts have no comments, which rosbag2 writes and a reader of a
log may need: a third of the characters is left.
"""

import json
import os
import re
import sys
from pathlib import Path

from rosbags.typesys import Stores, get_typestore

from symtop_ros.run.simulation.topics import TOPICS

TARGET = Path(__file__).parents[1] / "symtop_ros" / "run/log/definitions.json"
SEPARATOR = "=" * 80 + "\nMSG: {name}\n{text}"
# tf2_msgs is not on PyPI, where the rest of ROS 2 is.
TF_MESSAGE = "tf2_msgs/msg/TFMessage"
TF_TEXT = "geometry_msgs/TransformStamped[] transforms\n"
FIELD = re.compile(r"^\s*([A-Za-z]\w*(?:/\w+)*)(?:<=\d+)?(?:\[[^\]]*\])?\s+\w+", re.MULTILINE)
PRIMITIVES = {
    "bool",
    "byte",
    "char",
    "float32",
    "float64",
    "string",
    "wstring",
    *(f"{sign}int{size}" for sign in ("", "u") for size in (8, 16, 32, 64)),
}


def definitions() -> dict[str, dict[str, str]]:
    """Text with all dependencies, and RIHS01 hash, of each type that is logged."""
    types = sorted({topic.type for topic in TOPICS.values()})
    known = get_typestore(Stores.ROS2_JAZZY)
    return {name: {"text": full_text(name), "hash": known.hash_rihs01(name)} for name in types}


def full_text(name: str) -> str:
    """The text as rosbag2 writes it: dependencies follow after a line of 80 "=" each."""
    others = dict.fromkeys(dependencies(name))
    parts = [SEPARATOR.format(name=each.replace("/msg/", "/"), text=text(each)) for each in others]
    return "\n".join([text(name), *parts])


def dependencies(name: str) -> list[str]:
    """Types of the fields, and of theirs, depth first."""
    package = name.partition("/")[0]
    found: list[str] = []
    for field in FIELD.findall(text(name)):
        if field.split("<")[0] not in PRIMITIVES:
            owner, _, short = field.rpartition("/")
            nested = f"{owner.removesuffix('/msg') or package}/msg/{short}"
            found += [nested, *dependencies(nested)]
    return found


def text(name: str) -> str:
    """The text of a type alone."""
    return TF_TEXT if name == TF_MESSAGE else file(name).read_text(encoding="utf-8")


def file(name: str) -> Path:
    """The installed .msg of a type."""
    package, _, short = name.split("/")
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    paths = [Path(each, "share", package, "msg", f"{short}.msg") for each in prefixes if each]
    return next(path for path in paths if path.is_file())


if __name__ == "__main__":
    TARGET.write_text(json.dumps(definitions(), indent=1, sort_keys=True) + "\n", encoding="utf-8")
    print(f"wrote {TARGET}")
