"""Turns: the lock of a run, and who waits for it."""

import threading
from collections import deque


class Turns:
    """A lock for `with`, which shows a thread that publishes late samples that a turn waits."""

    def __init__(self) -> None:
        self.lock = threading.RLock()  # to take it without being waited for
        self._waiting: deque[None] = deque()  # one for each turn that waits

    @property
    def is_awaited(self) -> bool:
        """True if a turn waits for the lock."""
        return bool(self._waiting)

    def __enter__(self) -> None:
        """Wait for the lock."""
        self._waiting.append(None)
        self.lock.acquire()
        self._waiting.pop()

    def __exit__(self, *_: object) -> None:
        """Give the lock to another."""
        self.lock.release()
