"""Which samples are due: tick k is at start + k/rate, whenever one gets round to it."""

from __future__ import annotations

NANOSECONDS = 1_000_000_000
CATCH_UP = 0.1  # s; no avalanche of samples after the process was stopped


class Ticker:
    """Hands out the stamps of a steady grid.

    Attributes
    ----------
    rate : float
        In Hz.
    late : int
        Ticks handed out more than a period after their stamp.
    missed : int
        Ticks that were never handed out.
    """

    def __init__(self, rate: float, now: int) -> None:
        self.late = 0
        self.missed = 0
        self.restart(rate, now)

    def restart(self, rate: float, start: int) -> None:
        """Begin another grid; its first tick is at `start`, in ns."""
        self.rate = rate
        self._start = start
        self._next = 0

    @property
    def next_stamp(self) -> int:
        """Stamp in ns of the first tick that is not handed out yet."""
        return self._stamp(self._next)

    def due(self, now: int, catch_up: float, until: int) -> list[int]:
        """Return the stamps that are due, in order, and count what is late or missed.

        Parameters
        ----------
        now : int
            In ns.
        catch_up : float
            Ticks later than this, in s, are missed.
        until : int
            None after this is handed out, in ns.
        """
        last = int((now - self._start) * self.rate / NANOSECONDS)
        oldest = last - int(catch_up * self.rate)
        if oldest > self._next:
            self.missed += oldest - self._next
            self._next = oldest
        stamps = [
            self._stamp(k) for k in range(self._next, last + 1) if self._stamp(k) <= min(now, until)
        ]
        self._next += len(stamps)
        self.late += sum(now - stamp > NANOSECONDS / self.rate for stamp in stamps)
        return stamps

    def grid(self, stamp: int, count: int) -> list[int]:
        """Return some stamps of the grid in a row, from one of them on."""
        first = round((stamp - self._start) * self.rate / NANOSECONDS)
        return [self._stamp(k) for k in range(first, first + count)]

    def _stamp(self, k: int) -> int:
        return self._start + round(k * NANOSECONDS / self.rate)
