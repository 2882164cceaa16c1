"""The run of one top out of a log: arrays of samples, and its events, whoever recorded it.

Topics are found by the end of their names and by type, so that namespaces and other topics in the
file do not matter; what is not there is simply missing in the batches.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from mcap.records import Message
from numpy.typing import NDArray

from symtop_ros.playback.mcap_file import McapFile
from symtop_ros.run.events import Event
from symtop_ros.wire.diagnostics import DIAGNOSTICS, statuses
from symtop_ros.wire.messages import KINDS, Unpacked, unpacked

ROWS = 4096  # samples of a topic in a batch: what Rerun's viewer likes best
PREFIX = "top: "  # of the names of our statuses
TF = "tf"


@dataclass(frozen=True, eq=False)
class Columns:
    """Samples of one topic.

    Attributes
    ----------
    stamps : ndarray (n,)
        In ns.
    numbers : ndarray (n, width)
        As in `run.samples`.
    places : ndarray (n,)
        Where they stand among the messages of the batch.
    """

    stamps: NDArray[np.int64]
    numbers: NDArray[np.float64]
    places: NDArray[np.int64]


@dataclass
class Batch:
    """Some messages in a row.

    Attributes
    ----------
    columns : dict
        By the names of `run.samples`.
    events : list of (int, Event)
        With their places among the messages of the batch.
    """

    columns: dict[str, Columns] = field(default_factory=dict)
    events: list[tuple[int, Event]] = field(default_factory=list)


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
        Names of the topics that were found, by the names of `run.samples` and "events".
    """

    def __init__(self, file: McapFile, node: str | None = None) -> None:
        self.file = file
        self.node = node
        self.topics: dict[str, str] = {}
        self._roles: dict[int, str] = {}  # channel: what it carries, "" for nothing of ours
        self._frame: str | None = None  # child frame of /tf
        self._unreadable: dict[str, str] = {}

    def batches(self) -> Iterator[Batch]:
        """Yield the run, front to back; `file.problems` and `problems` are complete afterwards."""
        for messages in self._runs():
            batch = Batch()
            places: dict[int, list[int]] = {}
            for place, message in enumerate(messages):
                places.setdefault(message.channel_id, []).append(place)
            for channel, where in places.items():
                role = self._role(channel)
                if role:
                    self._read(batch, role, messages, np.array(where))
            batch.events.sort(key=lambda each: each[0])
            yield batch

    @property
    def problems(self) -> list[str]:
        """What is missing for a top, and what could not be read."""
        missing = [name for name in ("events", *KINDS) if name not in {TF, *self.topics}]
        found = [f"no {name} in it" for name in missing]
        return found + [f"{topic}: {text}" for topic, text in self._unreadable.items()]

    def _runs(self) -> Iterator[list[Message]]:
        """Yield messages in runs that do not part the topics of a sample."""
        messages: list[Message] = []
        for chunk in self.file.chunks():
            messages += chunk
            if len(messages) > ROWS * len(KINDS):
                last = messages[-1].log_time
                cut = len(messages)
                while cut and messages[cut - 1].log_time == last:
                    cut -= 1
                cut = cut or len(messages)
                yield messages[:cut]
                messages = messages[cut:]
        yield messages

    def _role(self, channel: int) -> str:
        if channel not in self._roles:
            self._roles[channel] = self._find_role(channel)
        return self._roles[channel]

    def _find_role(self, number: int) -> str:
        channel = self.file.channels.get(number)
        schema = channel and self.file.schemas.get(channel.schema_id)
        if not channel or not schema or channel.message_encoding != "cdr":
            return ""
        node, _, name = channel.topic.rpartition("/")
        kind = DIAGNOSTICS if name == "events" else KINDS.get(name)
        if schema.name != kind:
            return ""
        if name != TF:
            self.node = node if self.node is None else self.node
            if node != self.node:
                return ""
        self.topics[name] = channel.topic
        return name

    def _read(
        self, batch: Batch, role: str, messages: list[Message], where: NDArray[np.int64]
    ) -> None:
        data = [messages[place].data for place in where]
        if role == "events":
            batch.events += self._events(data, where)
            return
        parts, refused = unpacked(KINDS[role], data)
        if role == TF:
            parts = self._of_the_top(parts)
        if refused:
            self._unreadable[self.topics[role]] = f"{len(refused)} messages: {refused[0]}"
        if parts:
            batch.columns[role] = _joined(parts, where)

    def _events(self, data: list[bytes], where: NDArray[np.int64]) -> list[tuple[int, Event]]:
        found = []
        for place, each in zip(where.tolist(), data, strict=True):
            try:
                for status in statuses(each):
                    name = status.name.removeprefix(PREFIX)
                    event = Event(status.stamp, name, status.message, status.values)
                    event.segment()
                    found.append((place, event))
            except ValueError as error:  # DecodeError is one
                self._unreadable[self.topics["events"]] = str(error)
        return found

    def _of_the_top(self, parts: list[Unpacked]) -> list[Unpacked]:
        """Transforms of one child frame: that of the top, or the first."""
        children = [part.names[-1] for part in parts]
        if self._frame is None and children:
            self._frame = "top" if "top" in children else children[0]
        return [part for part in parts if part.names[-1] == self._frame]


def _joined(parts: list[Unpacked], where: NDArray[np.int64]) -> Columns:
    which = np.concatenate([part.which for part in parts])
    order = np.argsort(which)
    return Columns(
        np.concatenate([part.stamps for part in parts])[order],
        np.concatenate([part.numbers for part in parts])[order],
        where[which[order]],
    )
