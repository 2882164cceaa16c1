"""The torque of a button that a page holds down, repeated for the node.

The node lets go of an applied torque 0.1 s after the last message. A page that draws slowly sends
less often, so that one hold would become several pushes. The bridge repeats the torque until the
page ends it, or until nothing was heard of the page for some seconds.
"""

import threading
import time
from collections.abc import Callable, Sequence

PERIOD = 0.05  # s between two messages to the node, half of its default time-out
SILENCE = 3.0  # s after which a page counts as gone: six of the messages by which it holds on


class HeldTorque:
    """A torque (N m) that is held. Methods may be called from any thread."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._torque: tuple[float, ...] = ()  # empty if none is held
        self._heard = self._sent = 0.0  # s of the clock

    def take(self, torque: Sequence[float]) -> None:
        """Hold a torque that was just published; zero holds none."""
        with self._lock:
            self._torque = tuple(torque) if any(torque) else ()
            self._heard = self._sent = self._clock()

    def renew(self) -> None:
        """Hold on: the page is still there."""
        with self._lock:
            self._heard = self._clock()

    def find_due(self) -> tuple[float, ...]:
        """Return the torque if it is to be published now; empty if not."""
        with self._lock:
            now = self._clock()
            if now > self._heard + SILENCE:
                self._torque = ()
            if not self._torque or now < self._sent + PERIOD:
                return ()
            self._sent = now
            return self._torque
