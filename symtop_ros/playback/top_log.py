"""The run of one top out of a log, whoever recorded it.

Topics are found by the end of their names and by type, so that namespaces and other topics in the
file do not matter; what is not there is simply missing in the batches.
"""

from __future__ import annotations

from collections.abc import Iterator

from mcap.records import Message

from symtop_ros.playback.batch import EVENTS, TF, Batch, BatchReader
from symtop_ros.playback.mcap_file import LogError, McapFile
from symtop_ros.wire.diagnostics import DIAGNOSTICS
from symtop_ros.wire.messages import KINDS

ROWS = 4096  # samples of a topic in a batch: what Rerun's viewer likes best
TYPES = {EVENTS: DIAGNOSTICS, **KINDS}


class TopLog:
    """The run of one top.

    Parameters
    ----------
    file : McapFile
    node : str or None
        Full name of the node, where there are more than one; None for the first.

    Attributes
    ----------
    topics : dict
        Topics that were found, by their short names.
    others : set of str
        Nodes that were found beside that one.
    """

    def __init__(self, file: McapFile, node: str | None = None) -> None:
        self.file, self.node = file, node
        self.topics: dict[str, str] = {}
        self.others: set[str] = set()
        self._names: dict[int, str] = {}  # short name by channel, "" for what is not of the top
        self._reader = BatchReader()

    def batches(self) -> Iterator[Batch]:
        """Yield the run, front to back.

        Raises
        ------
        LogError
            At the end, where there was nothing of a top.
        """
        for messages in self._runs():
            named = [(self._name(message.channel_id), message.data) for message in messages]
            yield self._reader.read([each for each in named if each[0]])
        if not set(self.topics) - {TF}:
            known = sorted(channel.topic for channel in self.file.channels.values())
            msg = (
                f"{self.file.path} holds no top{f' {self.node}' if self.node else ''}; its topics: "
            )
            raise LogError(msg + (", ".join(known[:20]) or "none"))

    @property
    def problems(self) -> list[str]:
        """What is missing, and what could not be read; complete after the last batch."""
        unreadable = [f"{name}: {text}" for name, text in self._reader.unreadable.items()]
        missing = [name for name in TYPES if name not in self.topics]
        found = [f"there is no {', no '.join(missing)} in it"] if missing else []
        if self.others:
            others = ", ".join(sorted(self.others))
            found.append(f"this is {self.node}; --node chooses another: {others}")
        return self.file.problems + unreadable + found

    def _runs(self) -> Iterator[list[Message]]:
        """Yield messages in runs that do not part the topics of a sample."""
        messages: list[Message] = []
        for chunk in self.file.chunks():
            messages += chunk
            while len(messages) > (most := ROWS * max(1, len(self.topics))):
                cut = _boundary(messages, most)
                yield messages[:cut]
                messages = messages[cut:]
        yield messages

    def _name(self, channel: int) -> str:
        if channel not in self._names:
            self._names[channel] = self._find_name(channel)
        return self._names[channel]

    def _find_name(self, number: int) -> str:
        channel = self.file.channels.get(number)
        schema = channel and self.file.schemas.get(channel.schema_id)
        if not channel or not schema or channel.message_encoding != "cdr":
            return ""
        node, _, name = channel.topic.rpartition("/")
        if schema.name != TYPES.get(name):
            return ""
        if name != TF:
            self.node = node if self.node is None else self.node
            if node != self.node:
                self.others.add(node)
                return ""
        self.topics[name] = channel.topic
        return name


def _boundary(messages: list[Message], most: int) -> int:
    """Return where a sample begins, `most` at the latest; that itself where there is but one."""
    cut = most
    while cut and messages[cut - 1].log_time == messages[cut].log_time:
        cut -= 1
    return cut or most
