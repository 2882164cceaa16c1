"""Indexes of messages, which follow each chunk: what they say of a chunk that cannot be read."""

import struct
from collections.abc import Callable

from mcap.records import Chunk, ChunkIndex

from symtop_ros.base.counts import write_count

Entry = tuple[int, int]  # log time in ns, and offset in the chunk
INDEX_HEAD = struct.Struct("<HI")  # channel, and bytes of the entries
ENTRY = struct.Struct("<QQ")


class DamageError(Exception):
    """A record that contradicts itself."""


def read_entries(data: bytes) -> tuple[int, list[Entry]]:
    """Return the channel of an index and its entries; DamageError if it has fewer than it says."""
    channel, size = INDEX_HEAD.unpack_from(data)
    if size > len(data) - INDEX_HEAD.size:
        raise DamageError("the entries are more than the record has")
    entries = memoryview(data)[INDEX_HEAD.size : INDEX_HEAD.size + size]
    return channel, [*ENTRY.iter_unpack(entries)]


class DamagedChunk:
    """A chunk without readable messages: the indexes behind it, its head and that of the summary.

    Any of these may be damaged as well. The message states times if no two of the sources
    contradict each other, or if two agree. It states a number if the indexes are complete and have
    these times.
    """

    def __init__(
        self, chunk: Chunk | None, index: ChunkIndex | None, has_messages: bool = True
    ) -> None:
        self._index, self.has_messages = index, has_messages
        heads = [each for each in (chunk, index) if each]
        self._spans = [(each.message_start_time, each.message_end_time) for each in heads]
        self._times: list[int] = []  # of the first and the latest message in each index
        self._length = 0  # bytes of the indexes
        self.count = 0  # messages, as the indexes say
        self.is_certain = False  # True if the chunk is damaged; else its indexes decide
        self.is_cut = False  # True if some indexes cannot be read

    def add(self, data: bytes, length: int) -> None:
        """Add an index behind the chunk, and the length of its record in bytes."""
        try:
            times = [time for time, _ in read_entries(data)[1]]
        except (DamageError, struct.error):
            self.is_cut = True
            return
        self._times += [min(times), max(times)] if times else []
        self._length += length
        self.count += len(times)

    def find_span(self) -> tuple[int, int] | None:
        """Return the log times of the first and the latest message; None if they are not known."""
        spans = self._list_spans()
        agreed = [each for each in spans if spans.count(each) > 1 or len(spans) == 1]
        return agreed[0] if agreed and agreed[0][0] <= agreed[0][1] else None

    def describe(self, since_start: Callable[[int], float]) -> str:
        """Return what is lost, in a sentence; times are those since the start of the log."""
        if not self.has_messages:
            return "a chunk without messages is damaged"
        span = self.find_span()
        is_counted = self.count and self._is_complete() and span == self._list_spans()[0]
        times = f"of {since_start(span[0]):.3f} .. {since_start(span[1]):.3f} s" if span else ""
        if is_counted:
            are = "is" if self.count == 1 else "are"
            lost = write_count(self.count, "message")
            return f"a chunk is damaged: {lost} {times} {are} lost"
        return f"a chunk is damaged: its messages{f', {times},' if times else ''} are lost"

    def _list_spans(self) -> list[tuple[int, int]]:
        """Return the log times that the indexes, the head and the summary say, in this order."""
        own = [(min(self._times), max(self._times))] if self._times and self._is_complete() else []
        return own + self._spans

    def _is_complete(self) -> bool:
        length = self._index.message_index_length if self._index else self._length
        return not self.is_cut and self._length == length
