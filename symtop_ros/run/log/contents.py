"""The contents of a log that its catalog is made of, gathered while every message is read once."""

from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from mcap.records import Message

from symtop_ros.run.log.batch import BatchReader
from symtop_ros.run.log.event_order import Placed
from symtop_ros.run.log.intervals import Mark
from symtop_ros.run.log.names import Names
from symtop_ros.run.log.source import MessageSource
from symtop_ros.run.log.stamps import StampRows
from symtop_ros.run.simulation.events import WHOLE
from symtop_ros.run.simulation.topics import DIAGNOSTICS, EVENTS, SAMPLE_TOPICS
from symtop_ros.run.wire.diagnostics import Status, decode_statuses
from symtop_ros.run.wire.layout import DecodeError

MOTION, PACE = "motion", "pace"  # statuses of the diagnostics
LATEST, MISSED = "event", "missed"  # the number of the latest event, and samples that were missed
DECODED = (EVENTS.name, *SAMPLE_TOPICS)
Chosen = tuple[int, str, Message]  # a message of the top, with its place and our name of its topic


@dataclass(frozen=True)
class Contents:
    """The contents of all messages of a log, with their places in it."""

    counts: Counter[str] = field(default_factory=Counter)  # messages by our names of topics
    channels: Counter[int] = field(default_factory=Counter)  # messages by channels, of all topics
    rows: dict[str, StampRows] = field(default_factory=dict)  # stamps of samples
    events: list[Placed] = field(default_factory=list)
    lost_events: list[int] = field(default_factory=list)  # places of those that cannot be read
    marks: list[Mark] = field(default_factory=list)  # with the number of the latest event
    missed: list[tuple[int, int]] = field(default_factory=list)  # samples, as the node counts
    unreadable: dict[str, str] = field(default_factory=dict)  # reasons, by our names of topics


def read_contents(file: MessageSource, names: Names) -> Contents:
    """Return the contents of a log."""
    reader = BatchReader()
    reader.frame = _find_frame(file, names)
    found = Contents(unreadable=reader.unreadable, lost_events=reader.lost_events)
    place = 0
    owner = (names.node or "").lstrip("/")
    for messages in file.chunks():
        chosen = select(names, messages, place)
        place += len(messages)
        found.counts.update(name for _, name, _ in chosen)
        found.channels.update(each.channel_id for each in messages)
        for number, name, message in chosen:
            if name == DIAGNOSTICS.name:
                _add_diagnostics(found, owner, number, message)
        _add_samples(found, reader, [each for each in chosen if each[1] in DECODED])
    return found


def select(names: Names, messages: Sequence[Message], begin: int) -> list[Chosen]:
    """Return the messages of the top; the first of all has the place `begin` in the log."""
    named = ((k, names.find(each.channel_id), each) for k, each in enumerate(messages, begin))
    return [each for each in named if each[1]]


def _find_frame(file: MessageSource, names: Names) -> str | None:
    """Return the frame that the first event names: samples on /tf may precede that event."""
    reader = BatchReader()
    for messages in file.chunks():
        chosen = [each for each in select(names, messages, 0) if each[1] == EVENTS.name]
        if reader.read([(name, each.data) for _, name, each in chosen]).events:
            return reader.frame
    return None


def _add_samples(found: Contents, reader: BatchReader, chosen: Sequence[Chosen]) -> None:
    data = [(name, each.data) for _, name, each in chosen]
    batch = reader.read(data, [place for place, *_ in chosen])
    before = len(found.events)
    places = [place for place, _ in batch.events]
    found.events.extend(batch.events)
    for name, columns in batch.columns.items():
        events = before + np.searchsorted(places, columns.places)
        found.rows.setdefault(name, StampRows()).add(columns.stamps, columns.places, events)


def _add_diagnostics(found: Contents, owner: str, place: int, message: Message) -> None:
    statuses: list[Status] = []
    with suppress(DecodeError):  # found by the check of texts
        statuses = decode_statuses(message.data)
    for status in statuses:
        if status.name == f"{owner}: {MOTION}" and (number := _read(status, LATEST)):
            found.marks.append(Mark(place, status.stamp, number))
        if status.name == f"{owner}: {PACE}" and (number := _read(status, MISSED)) is not None:
            found.missed.append((place, number))


def _read(status: Status, name: str) -> int | None:
    text = status.values.get(name, "")
    return int(text) if WHOLE.fullmatch(text) else None
