"""Samples of some stamps in a row: in arrays they cost a fraction of what each costs alone."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from symtop_ros.physics import State
from symtop_ros.run.samples import SAMPLES
from symtop_ros.run.segment import Segment


class Block:
    """The samples of a segment at some stamps.

    A topic is computed when it is first asked for, and in all blocks that follow: then it is at
    hand when its time comes.

    Parameters
    ----------
    segment : Segment
    stamps : sequence of int
        In ns.

    Attributes
    ----------
    last, length : int
        The last of the stamps, and how many there are.
    """

    def __init__(self, segment: Segment, stamps: Sequence[int]) -> None:
        self.segment = segment
        self._stamps = np.array(stamps, dtype=np.int64)
        self.last, self.length = stamps[-1] if stamps else 0, len(stamps)
        self._row = {stamp: row for row, stamp in enumerate(stamps)}
        self._numbers: dict[str, list[list[float]]] = {}
        self._asked: set[str] = set()

    def following(self, segment: Segment, stamps: Sequence[int]) -> Block:
        """Return another block, with the topics at hand that were asked for in this one."""
        block = Block(segment, stamps)
        for name in self._asked:
            block._compute(name)
        return block

    def holds(self, segment: Segment, stamp: int) -> bool:
        """Whether the sample of a segment at a stamp is in the block."""
        return segment is self.segment and stamp in self._row

    def numbers(self, name: str, stamp: int) -> list[float]:
        """Return the numbers of a topic, as in `run.samples`, at a stamp."""
        self._asked.add(name)
        if name not in self._numbers:
            self._compute(name)
        return self._numbers[name][self._row[stamp]]

    def _compute(self, name: str) -> None:
        computed = SAMPLES[name](self.segment.path, self._states)
        shape = len(self._stamps), computed.shape[-1]
        self._numbers[name] = np.broadcast_to(computed, shape).tolist()

    @cached_property
    def _states(self) -> State:
        """The states; only one where the motion rests."""
        return self.segment.state_at(self._stamps)
