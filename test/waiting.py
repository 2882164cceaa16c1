"""Waiting for what other processes and threads do."""

import time
from collections.abc import Callable
from typing import Any

# s; ends a test that hangs. On one core that a run shares with busy programs, and on a page that is
# slowed down twenty times, a start of some seconds takes more than a minute.
TIMEOUT = 300.0


Act = Callable[[], Any]


def until(condition: Act, wait: Act = lambda: time.sleep(0.02), timeout: float = TIMEOUT) -> Any:
    """Wait until a condition holds, and return what it gives; `wait` is called in between."""
    deadline = time.monotonic() + timeout
    while not (found := condition()):
        assert time.monotonic() < deadline, "the condition did not come true in time"
        wait()
    return found
