"""The run of one top in a log, recorded by symtop_ros or by another program.

Topics are recognised by the last part of their names and by their types, so that namespaces and
other topics in the file do not matter. Topics that are missing are missing in the batches.
"""

from collections.abc import Iterator
from functools import cache

from mcap.records import Message

from symtop_ros.log.bag import MessageSource
from symtop_ros.log.batch import TF, Batch, BatchReader
from symtop_ros.log.reader import LogError
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.topics import EVENTS, SAMPLE_TOPICS, SENSOR_TOPICS
from symtop_ros.simulation.validation import full_name

DEFAULT_NODE = "/top"
ROWS = 4096  # samples of a topic in a batch: Rerun's viewer is fastest with columns of this length
TYPES = {topic.name: topic.type for topic in (EVENTS, *SAMPLE_TOPICS.values())}


class TopLog:
    """The run of one top."""

    def __init__(self, file: MessageSource, node: str | None = None) -> None:
        self.file, self.node = file, full_name(node) if node else None
        self._asked = f" {self.node}" if node else ""
        # full names of the topics that were found, by their names in `simulation.topics`
        self.topics: dict[str, str] = {}
        self.others: set[str] = set()  # full names of other nodes with tops in the file
        self._name = cache(self._find_name)  # by channel
        self._reader = BatchReader()

    def batches(self) -> Iterator[Batch]:
        """Yield the run from its start to its end."""
        # /tf is shared, and samples may precede the event that says which frame is the top's.
        first = next(self.events(), None)
        if first:
            self._reader.frame = first.values.get("top_frame")
        for messages in self._runs():
            yield self._reader.read(self._select(messages))
        if not set(self.topics) - {TF}:
            known = sorted(channel.topic for channel in self.file.channels.values())
            msg = f"no run of a top{self._asked} in {self.file.path}: topics "
            raise LogError(msg + (", ".join(known[:20]) or "none"))

    def events(self) -> Iterator[Event]:
        """Yield the events of the run in the order of the log."""
        if self.node is None:
            self.node = self._find_node()
        for messages in self.file.chunks():
            chosen = [each for each in self._select(messages) if each[0] == EVENTS.name]
            yield from (event for _, event in self._reader.read(chosen).events)

    @property
    def has_readable_events(self) -> bool:
        """True if no event was found to be unreadable so far."""
        return EVENTS.name not in self._reader.unreadable

    @property
    def problems(self) -> list[str]:
        """Everything that is missing or unreadable; complete after the last batch."""
        missing = [name for name in TYPES if name not in (*self.topics, *SENSOR_TOPICS)]
        found = [f"the log has no {', no '.join(missing)}"] if missing else []
        if self.others:
            others = ", ".join(sorted(self.others))
            found.append(f"the node is {self.node}; others can be chosen by --node: {others}")
        return self.damage + found

    @property
    def damage(self) -> list[str]:
        """Everything that is damaged, lost or unreadable; complete after the last batch."""
        unreadable = [f"{name}: {text}" for name, text in self._reader.unreadable.items()]
        return self.file.problems + unreadable

    def _runs(self) -> Iterator[list[Message]]:
        """Yield messages in runs that keep the topics of each sample together."""
        messages: list[Message] = []
        for chunk in self.file.chunks():
            messages += chunk
            while len(messages) > (most := ROWS * max(1, len(self.topics))):
                cut = _boundary(messages, most)
                yield messages[:cut]
                messages = messages[cut:]
        yield messages

    def _select(self, messages: list[Message]) -> list[tuple[str, bytes]]:
        """Return the messages of the top, with the names of their topics."""
        named = ((self._name(message.channel_id), message.data) for message in messages)
        return [each for each in named if each[0]]

    def _find_name(self, number: int) -> str:
        """Return the name of the topic of a channel; "" for those of others."""
        node, name = self._node_and_name(number)
        if name and name != TF and node != self.node:
            self.others.add(node)
            return ""
        if name:
            self.topics[name] = self.file.channels[number].topic
        return name

    def _node_and_name(self, number: int) -> tuple[str, str]:
        """Return the node and the name of the topic of a channel; "" if it is not of a top."""
        channel = self.file.channels.get(number)
        schema = channel and self.file.schemas.get(channel.schema_id)
        if not channel or not schema or channel.message_encoding != "cdr":
            return "", ""
        node, _, name = channel.topic.rpartition("/")
        return (node, name) if schema.name == TYPES.get(name) else ("", "")

    def _find_node(self) -> str | None:
        """Return the node whose run is read by default, whatever the order of the files is."""
        if not self.file.channels:  # a file without an index: they are described in its chunks
            next(self.file.chunks(), [])
        tops = {self._node_and_name(number) for number in self.file.channels}
        nodes = {node for node, name in tops if name and name != TF}
        return min(nodes, key=lambda node: (node != DEFAULT_NODE, node), default=None)


def _boundary(messages: list[Message], most: int) -> int:
    """Return the last index up to `most` at which a sample begins, `most` by default."""
    cut = most
    while cut and messages[cut - 1].log_time == messages[cut].log_time:
        cut -= 1
    return cut or most
