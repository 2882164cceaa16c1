"""Samples of consecutive stamps, computed together: in arrays each costs a fraction."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.topics import SAMPLE_TOPICS, Samples


class Block:
    """The samples of a segment at some stamps.

    A topic is computed when it is first asked for. In the blocks made by `continue_with` it is then
    computed at once, so that its numbers are ready when their tick is due.
    """

    def __init__(self, segment: Segment, stamps: Sequence[int]) -> None:
        self.segment = segment
        self._stamps = np.array(stamps, dtype=np.int64)
        self.last, self.length = stamps[-1] if stamps else 0, len(stamps)
        self._row = {stamp: row for row, stamp in enumerate(stamps)}
        self._numbers: dict[str, list[list[float]]] = {}
        self._requested: set[str] = set()

    def continue_with(self, segment: Segment, stamps: Sequence[int]) -> "Block":
        """Return the next block, with the topics computed that were requested from this one."""
        block = Block(segment, stamps)
        for name in self._requested:
            block._compute(name)
        return block

    def covers(self, segment: Segment, stamp: int) -> bool:
        """Return True if the block has the sample of a segment at a stamp."""
        return segment is self.segment and stamp in self._row

    def numbers(self, topic: str, stamp: int) -> list[float]:
        """Return the doubles of a topic (named as in `SAMPLE_TOPICS`) at a stamp."""
        self._requested.add(topic)
        if topic not in self._numbers:
            self._compute(topic)
        return self._numbers[topic][self._row[stamp]]

    def _compute(self, topic: str) -> None:
        computed = SAMPLE_TOPICS[topic].compute(self._samples)
        # A paused motion has one state for all stamps, and so has a block of one stamp.
        shape = len(self._stamps), computed.shape[-1]
        self._numbers[topic] = np.broadcast_to(computed, shape).tolist()

    @cached_property
    def _samples(self) -> Samples:
        # One state as such takes a fifth of the time of an array of one; its bits are the same.
        return Samples.at(self.segment, self._stamps if self.length > 1 else self.last)
