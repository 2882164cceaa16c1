"""The topics of a top in a log: which channel each of them is.

A log of the node has the full names of its topics, which may be remapped, in its metadata. In logs
of other recorders, and of earlier versions, topics are recognised by the last part of their names
and by their types, so that namespaces and other topics do not matter.
"""

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache

from symtop_ros.run.log.batch import TF
from symtop_ros.run.log.source import MessageSource
from symtop_ros.run.log.writer import METADATA, NODE_ENTRY, TOPICS_ENTRY
from symtop_ros.run.simulation.topics import (
    APPLIED_TORQUE,
    DESCRIPTION,
    EVENTS,
    POINTS,
    SAMPLE_TOPICS,
    TOPICS,
    Topic,
)
from symtop_ros.run.wire.names import full_name

KNOWN: dict[str, Topic] = {
    **TOPICS,
    APPLIED_TORQUE.name: APPLIED_TORQUE,
    POINTS.name: POINTS,
}
# The URDF where rviz looks for it: remapped by the launch file, or of a node of version 0.6.
REMAPPED = replace(DESCRIPTION, ros_name=DESCRIPTION.name)
# Topics by whose names a top is found. /tf is that of all nodes.
TELLING = {name: KNOWN[name].type for name in (EVENTS.name, *SAMPLE_TOPICS) if name != TF}


@dataclass(frozen=True, slots=True)
class GivenNames:
    """The names in the metadata of a log."""

    node: str  # full name
    topics: Mapping[str, str]  # our names by the full ones


def read_names(metadata: Mapping[str, str]) -> GivenNames | None:
    """Return the names of topics in the metadata of the node; None without them."""
    with suppress(KeyError, ValueError, RecursionError):
        found = json.loads(metadata[TOPICS_ENTRY])
        if isinstance(found, dict) and all(type(each) is str for each in found.values()):
            topics = {full: name for name, full in found.items() if name in KNOWN}
            default = found.get(EVENTS.name, "").rpartition("/")[0]
            return GivenNames(metadata.get(NODE_ENTRY, default), topics)
    return None


class Names:
    """The names of the topics of one top in a log."""

    def __init__(self, file: MessageSource, node: str | None = None) -> None:
        self._file = file
        self.others: set[str] = set()  # full names of other nodes with tops in the log
        self.full: dict[str, str] = {}  # full names that were found, by ours
        self.is_guessed = False  # True if the log does not name a topic that was found
        self._read_given = cache(lambda file: read_names(file.metadata.get(METADATA, {})))
        self.find = cache(self._find)  # returns our name of a channel's topic; "" for others
        next(file.chunks(), [])  # metadata, and channels of a file without an index
        self.node = full_name(node) if node else None  # full name of the node
        if self.node is None:
            self.node = self._find_node()

    def find_given(self, name: str) -> str:
        """Return the full name of a topic that the metadata of the log has; "" without it."""
        found = filter(None, map(self._read_given, self._file.files))
        of_node = (each.topics for each in found if each.node == self.node)
        return next((full for each in of_node for full, ours in each.items() if ours == name), "")

    def _find(self, channel: int) -> str:
        node, name = self._look_up(channel)
        if node not in (None, self.node):
            self.others.add(node)
            return ""
        if name:
            self.full[name] = self._file.channels[channel].topic
            self.is_guessed |= self._read_given(self._file.find_file(channel)) is None
        return name

    def _look_up(self, number: int) -> tuple[str | None, str]:
        """Return the node of a channel, None if it is of all, and our name; "" for another."""
        channel = self._file.channels.get(number)
        schema = channel and self._file.schemas.get(channel.schema_id)
        if not channel or not schema or channel.message_encoding != "cdr":
            return None, ""
        given = self._read_given(self._file.find_file(number))
        if given is None:
            return self._guess(channel.topic, schema.name)
        name = given.topics.get(channel.topic, "")
        return (given.node, name) if name and schema.name == KNOWN[name].type else (None, "")

    def _guess(self, full: str, kind: str) -> tuple[str | None, str]:
        node, _, name = full.rpartition("/")
        if TELLING.get(name) == kind:
            return node, name
        if name == TF:
            return None, TF if kind == KNOWN[TF].type else ""
        shared = REMAPPED, *KNOWN.values()
        names = (
            each.name
            for each in shared
            if each.type == kind and each.resolve(self.node or "") == full
        )
        return None, next(names, "")

    def _find_node(self) -> str | None:
        """Return the node whose run is read by default, whatever the order of the files is."""
        tops = {self._look_up(number) for number in self._file.channels}
        nodes = {node for node, name in tops if node is not None and name in TELLING}
        return min(nodes, key=lambda node: (node != "/top", node), default=None)
