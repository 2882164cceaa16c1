"""Samples that were missed, or for which the time waited; when and how the user is warned."""

from dataclasses import dataclass

from symtop_ros.base.counts import write_count
from symtop_ros.run.simulation.block import GAP
from symtop_ros.run.simulation.clocks import HostClock, RunClock
from symtop_ros.run.wire.layout import NANOSECONDS

PERIOD = 60 * NANOSECONDS  # between two warnings
WHY_LATE = "the process was stopped, lacked CPU time or waited for its middleware"


@dataclass
class Missed:
    """Samples that were missed, and the gaps that they make among those that were sent."""

    samples: int = 0
    gaps: int = 0
    longest: float = 0.0  # s of stamps without a sample
    _last: int | None = None  # stamp of the sample before the last gap, in ns
    _length: float = 0.0  # of the last gap in s

    def add(self, count: int, rate: float, last: int) -> None:
        """Add samples at a rate in Hz that were missed after the sample with the stamp `last`."""
        if last != self._last:
            self.gaps += 1
            self._last, self._length = last, 0.0
        self._length += count / rate
        self.samples += count
        self.longest = max(self.longest, self._length)

    def __str__(self) -> str:
        """Return the number of samples and of gaps, and the longest gap."""
        if self.gaps == 1:
            return f"{write_count(self.samples, 'sample')} missed in a gap of {self.longest:.3g} s"
        missed = f"{self.samples} samples missed in {self.gaps} gaps"
        return f"{missed}, the longest {self.longest:.3g} s"


class Gaps:
    """Missed samples, of which the user is warned when they amount to something."""

    def __init__(self, clock: HostClock | RunClock) -> None:
        self._clock = clock
        self._warned: int | None = None  # time of the last warning in ns
        self.whole = Missed()  # since the start of the run
        self._recent = Missed()  # since the last warning
        self.note_sent()

    def note_sent(self) -> None:
        """Note that all samples that are due were sent."""
        self._sent = self._clock.now, self._clock.steady  # ns

    def add(self, count: int, rate: float, last: int) -> None:
        """Add samples that were missed after the sample with the stamp `last` (ns)."""
        for each in (self.whole, self._recent):
            each.add(count, rate, last)

    def explain(self, rate: float) -> str | None:
        """Return a warning of what was missed since the last one; None if it is too early."""
        now, last = self._clock.now, self._warned
        is_early = last is not None and abs(now - last) < PERIOD
        if is_early or self._recent.samples < GAP * rate:
            return None
        since = "" if last is None else " since the last warning of this kind"
        text = (
            f"{self._recent}{since}: {self._find_reason()}; the motion follows the clock "
            f"({self.whole.samples} missed in all)"
        )
        self._warned, self._recent = now, Missed()
        return text

    def _find_reason(self) -> str:
        """Return why samples are missing: the clock was set forward, or the process is late."""
        before, steady = self._sent
        step = (self._clock.now - before - (self._clock.steady - steady)) / NANOSECONDS
        if step > GAP and not self._clock.is_simulated:
            return f"the clock of the system was set forward by {step:.3g} s"
        return WHY_LATE


class Waits:
    """Waits of the time of a run for late samples: it is then slower than it was asked to be."""

    def __init__(self, clock: HostClock | RunClock) -> None:
        self._clock = clock
        self.total = self.latest = 0.0  # s of real time: in all, and before the last measurement
        self.share = 0.0  # of the real time between the last two measurements
        self._quiet = 0  # ns without another warning
        self._begin_count()

    def _begin_count(self) -> None:
        """Begin to count what the next warning says: from the next wait on."""
        self._waited = self._ran = 0  # ns of real time
        self._advance = 0.0  # ns of the run

    def measure(self, kept: float, asked: float) -> str | None:
        """Measure the waits since the last call; return a warning if they are long.

        `kept` is the real-time factor without the waits, `asked` that of the settings. The result
        is None if the waits are shorter than `GAP`, or if the last warning is too recent.
        """
        waited, ran = self._clock.take_waits()
        self.latest = waited / NANOSECONDS
        self.total += self.latest
        self.share = min(1.0, waited / ran) if waited else 0.0
        self._quiet -= ran
        if waited or self._waited:
            self._waited += waited
            self._ran += ran
            self._advance += kept * max(0, ran - waited)
        return None if self._quiet > 0 else self._explain(asked)

    def _explain(self, asked: float) -> str | None:
        if self._waited < GAP * NANOSECONDS:
            return None
        seconds, whole = self._waited / NANOSECONDS, self._ran / NANOSECONDS
        text = (
            f"/clock waited for late samples for {seconds:.3g} of the last {whole:.3g} s: "
            f"{WHY_LATE}; real-time factor {self._advance / self._ran:.3g} instead of {asked:.3g}"
        )
        self._quiet = PERIOD
        self._begin_count()
        return text
