"""Measure the machine by a bare loop that waits and works for some ms, again and again.

A test of real time runs it in the same seconds, and is skipped if the loop itself came too late.
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

# Each turn waits for 5 ms, or for the end of the input, and then works for about 1 ms.
LOOP = """
import select, sys, time
longest, before, ended = 0.0, time.monotonic(), []
print(flush=True)
while not ended:
    ended, *_ = select.select([sys.stdin], [], [], 0.005)
    sum(range(30_000))
    now = time.monotonic()
    longest, before = max(longest, now - before), now
print(longest)
"""


class MachineTime:
    """The longest turn of the loop in s; known after the block in which it runs."""

    def __init__(self) -> None:
        self.longest = 0.0

    def demand(self, most: float) -> None:
        """Skip the test if a turn took more than `most` seconds."""
        if self.longest > most:
            text = f"the machine let a bare loop wait for {self.longest:.3f} s, needed {most:g} s"
            pytest.skip(text)


@contextmanager
def measuring() -> Iterator[MachineTime]:
    """Run the loop during a block."""
    machine = MachineTime()
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, "-c", LOOP], **pipes) as process:
        process.stdout.readline()
        try:
            yield machine
        finally:
            machine.longest = float(process.communicate()[0])
