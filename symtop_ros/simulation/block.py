"""Samples of consecutive stamps, computed together: in arrays each costs a fraction."""

from collections.abc import Callable, Sequence

import numpy as np

from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.topics import SAMPLE_TOPICS, Samples


class Block:
    """The samples of a segment at some stamps.

    A topic is computed when it is first asked for, if it is not computed before. `work_ahead`
    computes the next block piece by piece, so that no tick has to compute it as a whole.
    """

    def __init__(self, segment: Segment, stamps: Sequence[int]) -> None:
        self.segment = segment
        self._stamps = np.array(stamps, dtype=np.int64)
        self.last, self.length = stamps[-1] if stamps else 0, len(stamps)
        self._row = {stamp: row for row, stamp in enumerate(stamps)}
        self._numbers: dict[str, list[list[float]]] = {}
        self._requested: dict[str, None] = {}  # topics in their order
        self._due: list[str] = []  # topics that will be asked for
        self._samples: Samples | None = None  # once their states are computed
        self.next: Block | None = None

    def continue_with(self, segment: Segment, stamps: Sequence[int]) -> "Block":
        """Return the next block; the topics that were requested from this one are due in it."""
        block = Block(segment, stamps)
        block._due = list(self._requested)
        return block

    def compute(self) -> "Block":
        """Compute all topics that are due; return the block."""
        while self._due:
            self._compute(self._due.pop())
        return self

    def work_ahead(self, stamps: Callable[[], Sequence[int]]) -> None:
        """Compute a topic of the next block, which has these stamps; first of all its states."""
        if self.next is None:
            self.next = self.continue_with(self.segment, stamps())
        elif not (self.next._due and self.next.length):
            return
        elif self.next._samples is None:
            self.next._compute_states()
        else:
            self.next._compute(self.next._due.pop())

    def covers(self, segment: Segment, stamp: int) -> bool:
        """Return True if the block has the sample of a segment at a stamp."""
        return segment is self.segment and stamp in self._row

    def numbers(self, topic: str, stamp: int) -> list[float]:
        """Return the doubles of a topic (named as in `SAMPLE_TOPICS`) at a stamp."""
        self._requested[topic] = None
        if topic not in self._numbers:
            self._compute(topic)
        return self._numbers[topic][self._row[stamp]]

    def _compute(self, topic: str) -> None:
        computed = SAMPLE_TOPICS[topic].compute(self._samples or self._compute_states())
        # A paused motion has one state for all stamps, and so has a block of one stamp.
        shape = len(self._stamps), computed.shape[-1]
        self._numbers[topic] = np.broadcast_to(computed, shape).tolist()

    def _compute_states(self) -> Samples:
        # One state as such takes a fifth of the time of an array of one; its bits are the same.
        stamps = self._stamps if self.length > 1 else self.last
        self._samples = Samples.at(self.segment, stamps)
        return self._samples
