"""The run of one top in a log, recorded by symtop_ros or by another program, in files of any kind.

Topics that are missing are missing in the batches.
"""

import json
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

from symtop_ros.base.refusals import one_line
from symtop_ros.run.log.batch import Batch, BatchReader
from symtop_ros.run.log.catalog import Catalog, read_catalog
from symtop_ros.run.log.contents import DECODED, Chosen, select
from symtop_ros.run.log.names import Names
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.log.source import MessageSource
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.points import Points, read_points
from symtop_ros.run.simulation.topics import POINTS
from symtop_ros.run.wire.layout import Reader

ROWS = 4096  # samples of a topic in a batch: Rerun's viewer is fastest with columns of this length


class TopLog:
    """The run of one top."""

    def __init__(self, file: MessageSource, node: str | None = None) -> None:
        self.file, self._asked = file, node
        self._names = Names(file, node)

    @cached_property
    def catalog(self) -> Catalog:
        """All that is known of the log; LogError if it has no run of a top."""
        found = read_catalog(self.file, self._names)
        if not found.has_top:
            topics = sorted(channel.topic for channel in self.file.channels.values())
            known = ", ".join(topics[:20]) or "none"
            asked = f" {self._names.node}" if self._asked else ""
            damage = "".join(f"; {text}" for text in found.problems[:1])
            raise LogError(f"no run of a top{asked} in {self.file.path}: topics {known}{damage}")
        return found

    def batches(self) -> Iterator[Batch]:
        """Yield the run from its start to its end, with the events of the catalog: each once."""
        reader = BatchReader()
        reader.frame = self.catalog.frame
        ordered = self.catalog.ordered
        own = {*map(_key, ordered.places, ordered.events)}
        for run in self.list_messages():
            chosen = [each for each in run if each[1] in DECODED]
            batch = reader.read(
                [(name, each.data) for _, name, each in chosen], [place for place, *_ in chosen]
            )
            yield replace(batch, events=[each for each in batch.events if _key(*each) in own])

    def read_points(self) -> Points | None:
        """Return the measured points of a run that the log keeps; None without them.

        Raises
        ------
        LogError
            If they are damaged.
        """
        topic = self.catalog.topics.get(POINTS.name)
        if topic is None or not topic.count:
            return None
        chunks = (select(self._names, chunk, 0) for chunk in self.file.chunks())
        found = (each.data for run in chunks for _, name, each in run if name == POINTS.name)
        try:
            return read_points(json.loads(Reader(next(found)).string()))
        except (ValueError, RecursionError) as error:
            raise LogError(f"the measured points cannot be read: {one_line(error)}") from None

    def list_messages(self) -> Iterator[list[Chosen]]:
        """Yield the messages of the top in runs that keep the topics of each sample together."""
        messages: list[Chosen] = []
        topics = sum(
            each.count > 0 for name, each in self.catalog.topics.items() if name in DECODED
        )
        most = ROWS * max(1, topics)
        place = 0
        for chunk in self.file.chunks():
            messages += select(self._names, chunk, place)
            place += len(chunk)
            while len(messages) > most:
                # the last place up to `most` at which a sample begins
                begins = (
                    k
                    for k in range(most, 0, -1)
                    if messages[k - 1][2].log_time != messages[k][2].log_time
                )
                cut = next(begins, most)
                yield messages[:cut]
                messages = messages[cut:]
        yield messages


def _key(place: int, event: Event) -> tuple[int, int]:
    """Return what an event is known by; those of one message have different numbers."""
    return place, event.number
