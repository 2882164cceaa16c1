"""The grid of stamps: tick k is at start + k/rate, whenever it is published."""

from symtop_ros.wire.layout import NANOSECONDS

CATCH_UP = 0.1  # s; ticks that are later are dropped, so that a stopped process sends no burst


class Ticker:
    """Stamps of a steady grid, and counts of the late and the dropped ones.

    A stamp is the nearest integer number of nanoseconds, computed in integers: the rate is taken as
    the exact value of its double, so the grid does not drift however long it runs.
    """

    def __init__(self, rate: float, now: int) -> None:
        self.late = 0  # ticks that were published more than a period after their stamp
        self.missed = 0  # ticks that were dropped
        self.rate = rate  # ticks per second
        self._start, self._next = now, 0  # ns, and number of the next tick
        self._ticks, self._nanoseconds = _ratio(rate)

    def restart(self, rate: float, start: int) -> None:
        """Begin a new grid with its first tick at `start` (ns)."""
        self.rate, self._start, self._next = rate, start, 0
        self._ticks, self._nanoseconds = _ratio(rate)

    @property
    def next_stamp(self) -> int:
        """Stamp in ns of the next tick."""
        return self._stamp(self._next)

    def due(self, now: int, catch_up: float, until: int, count_late: bool = True) -> list[int]:
        """Return the stamps that are due, in order, and count late and dropped ones."""
        last = (now - self._start) * self._ticks // self._nanoseconds
        oldest = last - int(catch_up * self.rate)
        if oldest > self._next:
            self.missed += oldest - self._next
            self._next = oldest
        # A stamp is rounded, so the one of tick `last` may be half a nanosecond after `now`.
        stamps = [
            self._stamp(k) for k in range(self._next, last + 1) if self._stamp(k) <= min(now, until)
        ]
        self._next += len(stamps)
        if count_late:
            self.late += sum((now - stamp) * self._ticks > self._nanoseconds for stamp in stamps)
        return stamps

    def grid(self, stamp: int, count: int) -> list[int]:
        """Return `count` consecutive stamps of the grid from `stamp` (one of them) on."""
        first = _divide((stamp - self._start) * self._ticks, self._nanoseconds)
        return [self._stamp(k) for k in range(first, first + count)]

    def _stamp(self, k: int) -> int:
        return self._start + _divide(k * self._nanoseconds, self._ticks)


def _ratio(rate: float) -> tuple[int, int]:
    """Return ticks and nanoseconds, whose quotient is the rate."""
    ticks, seconds = rate.as_integer_ratio()
    return ticks, seconds * NANOSECONDS


def _divide(numerator: int, denominator: int) -> int:
    """Return the nearest integer to a quotient; halves are rounded up."""
    return (2 * numerator + denominator) // (2 * denominator)
