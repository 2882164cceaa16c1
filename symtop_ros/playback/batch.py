"""Messages of a top, from a log or from a running node, as arrays and events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from symtop_ros.run.events import PREFIX, Event
from symtop_ros.wire.diagnostics import statuses
from symtop_ros.wire.messages import KINDS, Unpacked, unpacked
from symtop_ros.wire.text import one_line

EVENTS, TF = "events", "tf"


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

    def where(self, chosen: NDArray[np.bool_]) -> Columns:
        """Return some of the samples."""
        return Columns(self.stamps[chosen], self.numbers[chosen], self.places[chosen])


@dataclass(frozen=True)
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

    def stretches(self) -> Iterator[tuple[Event | None, dict[str, Columns]]]:
        """Yield the samples after each event, those before all of them first, with None."""
        events = [None, *(event for _, event in self.events)]
        owners = {name: self._owners(columns) for name, columns in self.columns.items()}
        for number, event in enumerate(events):
            yield (
                event,
                {
                    name: columns.where(owners[name] == number)
                    for name, columns in self.columns.items()
                    if (owners[name] == number).any()
                },
            )

    def _owners(self, columns: Columns) -> NDArray[np.intp]:
        """Return which event each sample comes after; 0 for what was before all of them.

        The node logs an event before the samples it governs. Others write in the order of arrival:
        there the stamps decide, unless the clock has jumped.
        """
        places = [place for place, _ in self.events]
        owners = np.searchsorted(places, columns.places, side="right")
        for number, (_, event) in enumerate(self.events, start=1):
            if event.name != "clock":
                later = columns.stamps >= event.stamp
                owners[(owners == number - 1) & later] = number
                owners[(owners == number) & ~later] = number - 1
        return owners


class BatchReader:
    """Turns bytes into batches.

    Attributes
    ----------
    unreadable : dict
        What was wrong with the messages of a topic, by its short name.
    """

    def __init__(self) -> None:
        self.unreadable: dict[str, str] = {}
        self._frame: str | None = None  # child frame of /tf

    def read(self, messages: Sequence[tuple[str, bytes]]) -> Batch:
        """Return a batch of messages, given with the short names of their topics."""
        places: dict[str, list[int]] = {}
        for place, (name, _) in enumerate(messages):
            places.setdefault(name, []).append(place)
        batch = Batch()
        for name, where in places.items():
            data = [messages[place][1] for place in where]
            if name == EVENTS:
                batch.events.extend(self._events(data, where))
            else:
                self._samples(batch, name, data, where)
        return batch

    def _samples(self, batch: Batch, name: str, data: list[bytes], where: list[int]) -> None:
        parts, refused = unpacked(KINDS[name], data)
        if refused:
            self.unreadable[name] = f"{len(refused)} messages: {refused[0]}"
        if name == TF:
            parts = self._of_the_top(parts)
        if parts:
            batch.columns[name] = _joined(parts, np.array(where))

    def _events(self, data: list[bytes], where: list[int]) -> list[tuple[int, Event]]:
        found = []
        for place, each in zip(where, data, strict=True):
            try:
                for status in statuses(each):
                    name = status.name.removeprefix(PREFIX)
                    event = Event(status.stamp, name, status.message, status.values)
                    event.segment()
                    event.state()
                    found.append((place, event))
            except ValueError as error:
                self.unreadable[EVENTS] = one_line(error)
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
