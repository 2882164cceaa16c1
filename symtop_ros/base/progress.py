"""Progress of a program on a terminal."""

import sys
import time
from collections.abc import Callable

PATIENCE = 2.0  # s, after which progress is written


class Progress:
    """Progress on a terminal, once an action takes longer than `PATIENCE`."""

    def __init__(self, program: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._program = program
        self._clock, self._begin, self._wrote = clock, clock(), False

    def report(self, part: float, action: str) -> None:
        """Write what part of an action is done, and an estimate of the time that is left."""
        spent = self._clock() - self._begin
        if spent < PATIENCE or not 0 < part < 1 or not sys.stderr.isatty():
            return
        left = spent * (1 - part) / part
        print(
            f"\r{self._program}: {action}, {part:.0%}, at most {left:.0f} s more ",
            end="",
            file=sys.stderr,
        )
        self._wrote = True

    def end(self) -> None:
        """End the line, if one was written."""
        if self._wrote:
            print(file=sys.stderr)
