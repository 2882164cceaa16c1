"""Definitions of the logged message types: text with dependencies, and RIHS01 hash.

They are shipped in definitions.json, so that a log can be written without ROS. A test compares them
with those of the installed ROS 2.
"""

import json
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from symtop_ros.simulation.topics import Topic


class Channel(NamedTuple):
    """A topic of a log."""

    name: str  # full name of the topic
    topic: Topic  # its type and quality of service


class Definition(NamedTuple):
    """Definition of a message type."""

    type: str  # name, such as "std_msgs/msg/String"
    text: str  # the .msg text, followed by those of all dependencies in the form of rosbag2
    type_hash: str  # hash of the type description (REP-2016), "RIHS01_..."


def load_definition(name: str) -> Definition:
    """Return the definition of a logged type."""
    entry = _load()[name]
    return Definition(name, entry["text"], entry["hash"])


@cache
def _load() -> dict[str, dict[str, str]]:
    text = files("symtop_ros.log").joinpath("definitions.json").read_text(encoding="utf-8")
    return dict(json.loads(text))
