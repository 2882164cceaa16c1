"""Work counted in calls, which is the same on every machine; its time is not."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager


class Work:
    """Work of a block of a test."""

    def __init__(self) -> None:
        self.calls = 0  # of functions, those of Python and those in C

    def note(self, _frame: object, event: str, _argument: object) -> None:
        """Count an event of Python's profiler."""
        self.calls += event in ("call", "c_call")


@contextmanager
def counting() -> Iterator[Work]:
    """Count the work of a block in this thread."""
    work = Work()
    before = sys.getprofile()
    sys.setprofile(work.note)
    try:
        yield work
    finally:
        sys.setprofile(before)
