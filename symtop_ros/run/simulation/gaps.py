"""Samples that were missed, and when and how the user is warned of them."""

from symtop_ros.run.simulation.block import GAP, Ticker
from symtop_ros.run.simulation.clocks import HostClock, RunClock
from symtop_ros.run.wire.layout import NANOSECONDS

PERIOD = 60 * NANOSECONDS  # between two warnings


class Gaps:
    """Missed samples, of which the user is warned when they amount to something."""

    def __init__(self, clock: HostClock | RunClock) -> None:
        self._clock = clock
        self._warned: int | None = None  # time of the last warning in ns
        self._missed = 0  # samples since then
        self.note_sent()

    def note_sent(self) -> None:
        """Note that all samples that are due were sent."""
        self._sent = self._clock.now, self._clock.steady  # ns

    def add(self, missed: int) -> None:
        """Add samples that were missed."""
        self._missed += missed

    def explain(self, ticker: Ticker) -> str | None:
        """Return a warning of what was missed since the last one; None if it is too early."""
        seconds, now = self._missed / ticker.rate, self._clock.now
        last = self._warned
        if seconds < GAP or (last is not None and abs(now - last) < PERIOD):
            return None
        since = "" if last is None else " since the last warning of this kind"
        text = (
            f"no samples for {seconds:.3g} s ({self._missed} missed){since}: "
            f"{self._find_reason()}; the motion follows the clock ({ticker.missed} missed in all)"
        )
        self._warned, self._missed = now, 0
        return text

    def _find_reason(self) -> str:
        """Return why samples are missing: the clock was set forward, or the process is late."""
        before, steady = self._sent
        step = (self._clock.now - before - (self._clock.steady - steady)) / NANOSECONDS
        if step > GAP and not self._clock.is_simulated:
            return f"the clock of the system was set forward by {step:.3g} s"
        return "the process was stopped, lacked CPU time or waited for its middleware"
