"""The grid of stamps, and the samples of the next ones.

Tick k is at start + k/rate, whenever it is published. The samples of several ticks are computed
together, as arrays.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.physics import State
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, Samples
from symtop_ros.run.wire.layout import NANOSECONDS

# encodes the messages of a topic, by its stamps (n,) in ns and its doubles (n, width)
Encode = Callable[[str, Stamps, Real], list[bytes]]
# s; ticks that are later are dropped, so that a stopped process sends no long burst. Fast DDS may
# hold a publisher for 0.33 s when a subscriber comes (docs/ros_reference.md, Discovery).
CATCH_UP = 0.5
AHEAD = 0.05  # s of samples that are computed together; a kick makes them useless
# Samples in a block at most. Requests wait while a block is computed, so blocks are short; those of
# driven motions are shorter, because it takes a block to find that one is too fast.
MAX_BLOCK, MAX_DRIVEN_BLOCK = 16, 4
GAP = 0.1  # s without samples that are reported; in a longer gap the own time of a run waits


class Block:
    """The samples of a segment at some stamps, as numbers and as encoded messages.

    A topic is computed when it is first asked for. Those that are due, because the block before was
    asked for them, can be computed earlier, piece by piece, so that no tick computes all of them.
    """

    def __init__(
        self, segment: Segment, stamps: Sequence[int], encode: Encode, due: Iterable[str] = ()
    ) -> None:
        self.segment, self._encode = segment, encode
        self._stamps = np.array(stamps, dtype=np.int64)
        self.last = stamps[-1] if stamps else 0
        self.length = len(stamps)
        self._row = {stamp: row for row, stamp in enumerate(stamps)}
        self._numbers: dict[str, Real] = {}  # by topic, (n, width)
        self._messages: dict[str, list[bytes]] = {}
        self.requested: dict[str, None] = {}  # topics that were asked for, in their order
        self._due = dict.fromkeys(due if stamps else ())
        self._samples: Samples | None = None  # once their states are computed

    def work(self) -> bool:
        """Compute a piece of what is due, the states or a topic; return False if nothing is."""
        if not self._due:
            return False
        if self._samples is None:
            self._compute_states()
        else:
            self._compute(next(iter(self._due)))
        return True

    def finish(self) -> None:
        """Compute all that is due."""
        while self.work():
            pass

    def covers(self, segment: Segment, stamp: int) -> bool:
        """Return True if the block has the sample of a segment at a stamp."""
        return segment is self.segment and stamp in self._row

    def message(self, topic: str, stamp: int) -> bytes:
        """Return the message of a topic (named as in `SAMPLE_TOPICS`) at a stamp."""
        self.requested[topic] = None
        if topic not in self._messages:
            self._compute(topic)
        return self._messages[topic][self._row[stamp]]

    def numbers(self, topic: str, stamp: int) -> list[float]:
        """Return the doubles of a topic at a stamp."""
        if topic not in self._numbers:
            self._compute(topic)
        found: list[float] = self._numbers[topic][self._row[stamp]].tolist()
        return found

    def find_state(self, stamp: int) -> State | None:
        """Return the state at a stamp of the block; None if the states are not computed yet."""
        if self._samples is None:
            return None
        state = self._samples.state  # one for all stamps while paused
        return state if state.orientation.ndim == 1 else state[self._row[stamp]]

    def _compute(self, topic: str) -> None:
        self._due.pop(topic, None)
        computed = SAMPLE_TOPICS[topic].compute(self._samples or self._compute_states())
        # A paused motion has one state for all stamps, and so has a block of one stamp.
        numbers = np.empty((len(self._stamps), computed.shape[-1]))
        numbers[:] = computed
        self._numbers[topic] = numbers
        self._messages[topic] = self._encode(topic, self._stamps, numbers)

    def _compute_states(self) -> Samples:
        # One state as such takes a fifth of the time of an array of one; its bits are the same.
        stamps = self._stamps if self.length > 1 else self.last
        self._samples = Samples.at(self.segment, stamps)
        return self._samples


class Blocks:
    """The block of the next stamps, and the computed part of the one that follows."""

    def __init__(self, segment: Segment, encode: Encode) -> None:
        self._encode = encode
        self.restart(segment)

    def restart(self, segment: Segment) -> None:
        """Begin with an empty block."""
        self.current = Block(segment, [], self._encode)
        self._later: Block | None = None

    def cover(self, segment: Segment, stamp: int) -> bool:
        """Go to the block with the sample of a segment at a stamp; return False if none has it."""
        if self._later and self._later.covers(segment, stamp):
            self.current, self._later = self._later, None
        return self.current.covers(segment, stamp)

    def state_at(self, segment: Segment, stamp: int) -> State:
        """Return the state of a segment at a stamp, with the same bits whether a block has it."""
        blocks = (self.current, self._later)
        found = (each.find_state(stamp) for each in blocks if each and each.covers(segment, stamp))
        return next(filter(None, found), None) or segment.state_at(stamp)

    def begin(self, segment: Segment, stamps: Sequence[int]) -> None:
        """Go to a new block; the topics that were asked for in the last block are due in it."""
        self.current = Block(segment, stamps, self._encode, self.current.requested)
        self._later = None

    def begin_later(self, segment: Segment, stamps: Sequence[int]) -> None:
        """Begin the block that follows."""
        self._later = Block(segment, stamps, self._encode, self.current.requested)

    def work_on_later(self) -> bool:
        """Compute a piece of the block that follows; return False if it is not begun."""
        if self._later is not None:
            self._later.work()
        return self._later is not None

    def find_next_length(self, segment: Segment, rate: float) -> int:
        """Return 1 for the first block of a motion, so that its first sample comes soon."""
        longest = MAX_DRIVEN_BLOCK if segment.motion.is_driven else MAX_BLOCK
        grown = 4 * self.current.length if self.current.segment is segment else 1
        return max(1, min(longest, grown, int(AHEAD * rate)))


class Ticker:
    """Stamps of a steady grid, and counts of the late and the dropped ones.

    A stamp is the nearest integer number of nanoseconds, computed in integers: the rate is taken as
    the exact value of its double, so the grid does not drift however long it runs.
    """

    def __init__(self, rate: float, now: int) -> None:
        self.late = 0  # ticks that were published more than a period after their stamp
        self.missed = 0  # ticks that were dropped
        self.restart(rate, now)

    def restart(self, rate: float, start: int) -> None:
        """Begin a new grid with its first tick at `start` (ns)."""
        self.rate, self._start = rate, start  # ticks per second, and ns
        self._ticks, seconds = rate.as_integer_ratio()
        self._nanoseconds = seconds * NANOSECONDS  # the rate is the quotient of both
        self._go_to(0)

    def _go_to(self, number: int) -> None:
        self._next = number  # of the next tick
        self.next_stamp = self._stamp(number)  # its stamp in ns

    def due(self, now: int, catch_up: float, until: int, count_late: bool = True) -> Iterator[int]:
        """Yield the stamps that are due, in order, and count late and dropped ones.

        A stamp is taken when it is yielded: those that are not asked for stay due.
        """
        # The last tick whose stamp is not after `now`: a stamp may be half a nanosecond before or
        # after its tick.
        last = ((2 * (now - self._start) + 1) * self._ticks - 1) // (2 * self._nanoseconds)
        oldest = last - int(catch_up * self.rate)
        if oldest > self._next:
            self.missed += oldest - self._next
            self._go_to(oldest)
        while self._next <= last and self.next_stamp <= until:
            stamp = self.next_stamp
            self._go_to(self._next + 1)
            self.late += count_late and (now - stamp) * self._ticks > self._nanoseconds
            yield stamp

    def grid(self, stamp: int, count: int) -> list[int]:
        """Return `count` consecutive stamps of the grid from `stamp` (one of them) on."""
        # A stamp that was rounded down is just before its tick.
        first = (stamp - self._start) * self._ticks // self._nanoseconds
        first += self._stamp(first) != stamp
        return [self._stamp(k) for k in range(first, first + count)]

    def _stamp(self, k: int) -> int:
        """Return the nearest integer to the time of a tick; halves are rounded up."""
        nanoseconds = (2 * k * self._nanoseconds + self._ticks) // (2 * self._ticks)
        return self._start + nanoseconds
