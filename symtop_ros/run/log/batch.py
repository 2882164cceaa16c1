"""Messages of a top, from a log or a running node, decoded into arrays and events."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from symtop_ros.base.arrays import Mask
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import one_line
from symtop_ros.run.simulation.events import Event, decode_events
from symtop_ros.run.simulation.topics import EVENTS, SAMPLE_TOPICS
from symtop_ros.run.wire.messages import Decoded, decode_messages

TF = "tf"


@dataclass(frozen=True, eq=False)
class Columns:
    """Samples of one topic."""

    stamps: NDArray[np.int64]  # in ns
    numbers: NDArray[np.float64]  # the doubles of the messages, as in `simulation.topics`
    places: NDArray[np.int64]  # their places in the log, or among the messages of the batch

    def select(self, chosen: Mask) -> "Columns":
        """Return the samples for which `chosen` (n,) is True."""
        return Columns(self.stamps[chosen], self.numbers[chosen], self.places[chosen])


@dataclass(frozen=True)
class Batch:
    """Consecutive messages."""

    columns: dict[str, Columns] = field(default_factory=dict)  # by the names of the topics
    # with their places, as in the columns
    events: list[tuple[int, Event]] = field(default_factory=list)

    def intervals(self) -> Iterator[tuple[Event | None, dict[str, Columns]]]:
        """Yield each event with the samples that follow it; first None with those before all."""
        owners = {name: self._owners(columns) for name, columns in self.columns.items()}
        for number, event in enumerate([None, *(event for _, event in self.events)]):
            yield event, choose(self.columns, {n: own == number for n, own in owners.items()})

    def _owners(self, columns: Columns) -> NDArray[np.intp]:
        """Return the number of the event that each sample belongs to; 0: before all of them.

        The node logs an event before its samples. Other recorders write in the order of arrival;
        there the stamps decide. Those that a clock repeats after a jump back leave it open, and the
        place decides.
        """
        owners = np.searchsorted([place for place, _ in self.events], columns.places, side="right")
        bounds = [sorted((event.stamp, event.previous_end)) for _, event in self.events]
        for number, (_, after) in enumerate(bounds, start=1):
            owners[(owners == number - 1) & (columns.stamps >= after)] = number
        for number, (before, _) in reversed(list(enumerate(bounds, start=1))):
            owners[(owners == number) & (columns.stamps < before)] = number - 1
        return owners


def choose(columns: Mapping[str, Columns], masks: Mapping[str, Mask]) -> dict[str, Columns]:
    """Return the samples of each topic that a mask (n,) chooses, without topics that have none."""
    return {name: each.select(masks[name]) for name, each in columns.items() if masks[name].any()}


class BatchReader:
    """Decodes messages into batches."""

    def __init__(self) -> None:
        # reason why messages of a topic could not be decoded, by the name of the topic
        self.unreadable: dict[str, str] = {}
        # Their numbers and what is said of them, by topics and verbs.
        self._counts: Counter[tuple[str, str]] = Counter()
        self._texts: dict[tuple[str, str], str] = {}
        self.lost_events: list[int] = []  # places of messages whose events could not be decoded
        self.frame: str | None = None  # child frame of the top on /tf, if it is known
        self._names: dict[str, tuple[str, ...]] = {}  # frames or joints of each topic

    def read(
        self, messages: Sequence[tuple[str, bytes]], places: Sequence[int] | None = None
    ) -> Batch:
        """Decode messages, given with the names of their topics, and with their places in a log."""
        found: dict[str, list[int]] = {}
        for number, (name, _) in enumerate(messages):
            found.setdefault(name, []).append(number)
        batch = Batch()
        # Events come first: they say which frame on /tf belongs to the top.
        for name in sorted(found, key=lambda name: name != EVENTS.name):
            data = [messages[number][1] for number in found[name]]
            where = found[name] if places is None else [places[number] for number in found[name]]
            if name == EVENTS.name:
                batch.events.extend(self._events(data, where))
            else:
                self._samples(batch, name, data, where)
        return batch

    def _samples(self, batch: Batch, name: str, data: list[bytes], where: list[int]) -> None:
        parts, refused = decode_messages(SAMPLE_TOPICS[name].format, data)
        if refused:
            self._note(name, "", len(refused), f": {refused[0]}")
        if name == TF:
            parts = self._select_frame(parts)
        self._check_names(name, parts)
        if parts:
            batch.columns[name] = _join(parts, np.array(where))

    def _check_names(self, topic: str, parts: list[Decoded]) -> None:
        """Report messages whose frames or joints are not those of the first message of a topic."""
        for part in parts:
            expected = self._names.setdefault(topic, part.names)
            if part.names != expected:
                got, wanted = (one_line(", ".join(names), 100) for names in (part.names, expected))
                said = f" not name {wanted}; the first has {got}"
                self._note(topic, "do", len(part.indices), said)

    def _note(self, topic: str, verb: str, count: int, text: str) -> None:
        """Count messages of a topic with one kind of fault, whose first text is said."""
        self._counts[topic, verb] += count
        self._texts.setdefault((topic, verb), text)
        self.unreadable[topic] = "; ".join(
            f"{write_count(number, 'message', key[1])}{self._texts[key]}"
            for key, number in self._counts.items()
            if key[0] == topic
        )

    def _events(self, data: list[bytes], where: list[int]) -> list[tuple[int, Event]]:
        found = []
        for place, each in zip(where, data, strict=True):
            try:
                found += [(place, event) for event in decode_events(each)]
                self.frame = found[-1][1].values.get("top_frame", self.frame)
            except ValueError as error:
                self.unreadable[EVENTS.name] = one_line(error)
                self.lost_events.append(place)
        return found

    def _select_frame(self, parts: list[Decoded]) -> list[Decoded]:
        """Return the transforms of the top: of the frame in its events, else "top" or the first."""
        children = [part.names[-1] for part in parts]
        if self.frame is None and children:
            self.frame = "top" if "top" in children else children[0]
        return [part for part in parts if part.names[-1] == self.frame]


def _join(parts: list[Decoded], where: NDArray[np.int64]) -> Columns:
    indices = np.concatenate([part.indices for part in parts])
    order = np.argsort(indices)
    return Columns(
        np.concatenate([part.stamps for part in parts])[order],
        np.concatenate([part.numbers for part in parts])[order],
        where[indices[order]],
    )
