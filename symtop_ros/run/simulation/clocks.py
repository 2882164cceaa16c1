"""The clocks of a run: that of its host, or its own time (parameter publish_clock).

A `Simulation` asks its clock how far behind samples may be sent, how long a stamp is away, and
whether the time was set; what differs between the two clocks is here.
"""

from symtop_ros.run.simulation.block import CATCH_UP, GAP
from symtop_ros.run.simulation.host import Clock
from symtop_ros.run.simulation.topics import DEPTH
from symtop_ros.run.wire.layout import NANOSECONDS

JUMP = 1.0  # s; a larger step of the clock is a jump, which the motion follows


class HostClock:
    """The clock of the host, which other programs may set.

    The motion passes at the real-time factor of its segment.
    """

    pace = 1.0  # seconds of the stamps per second of real time

    def __init__(self, source: Clock) -> None:
        self._source = source
        self._jumped_to: int | None = None  # ns

    @property
    def now(self) -> int:
        """Current time in ns."""
        return self._source.now

    @property
    def steady(self) -> int:
        """Time in ns of a clock that cannot be set."""
        return self._source.steady

    @property
    def is_simulated(self) -> bool:
        """True if the time is set from outside (use_sim_time)."""
        return self._source.is_simulated

    def catch_up(self, rate: float) -> float:
        """Return the seconds of samples that are sent late: no more than publishers keep."""
        return JUMP if self.is_simulated else min(CATCH_UP, DEPTH / rate)

    def wait_for(self, stamp: int) -> float | None:
        """Return the seconds of real time until a stamp; None if a change must wake the run."""
        wait = (stamp - self.now) / NANOSECONDS
        return None if self.is_simulated and wait > 0 else wait

    def hold_back(self, stamp: int) -> None:
        """Do nothing: this time does not wait for the sample of a stamp."""

    def take_waits(self) -> tuple[int, int]:
        """Return (0, 0): this time does not wait."""
        return 0, 0

    def set_factor(self, factor: float) -> None:
        """Do nothing: the segments have the factor."""

    def note_jump(self) -> None:
        """Note that the clock was set to its current time."""
        self._jumped_to = self.now

    def take_jump(self, stamp: int, rate: float) -> int | None:
        """Return the time (ns) to which the clock was set since it was last asked, or None.

        `stamp` is the next one, at a rate in Hz.
        """
        now, self._jumped_to = self._jumped_to, None
        # The system clock can be set back without any notification.
        is_behind = self.now < stamp - (JUMP + 1 / rate) * NANOSECONDS
        return self.now if is_behind else now


class RunClock:
    """Elapsed time of a run, which no other program sets.

    It advances by the real-time factor, stands still in a pause, and waits for late samples.
    """

    is_simulated = False

    def __init__(self, real: Clock, factor: float) -> None:
        self._real = real
        self.is_running = True
        self._time = 0  # ns of the run
        self._since = real.now  # the real time at which it was so
        self._waited, self._ran = 0, 0  # ns of real time, up to then; see `take_waits`
        self._taken = 0, 0  # the same at the last call of `take_waits`
        self.pace = factor  # seconds of the run per second of real time

    @property
    def now(self) -> int:
        """Current time in ns."""
        return self._time + int(self._passed * self.pace)

    @property
    def _passed(self) -> int:
        """Real time (ns) for which it has run since it was set."""
        return self._real.now - self._since if self.is_running else 0

    @property
    def steady(self) -> int:
        """The same time: no other program sets it."""
        return self.now

    def catch_up(self, rate: float) -> float:
        """Return more than the time waits: no sample is dropped."""
        return JUMP * self.pace

    def wait_for(self, stamp: int) -> float | None:
        """Return the seconds of real time until a stamp; None in a pause."""
        wait = (stamp - self.now) / NANOSECONDS / self.pace
        return wait if self.is_running else None

    def hold_back(self, stamp: int) -> None:
        """Wait for the sample of a stamp: the process may have been stopped."""
        latest = stamp + round(GAP * self.pace * NANOSECONDS)
        if self.now > latest:
            self.wait_at(latest)

    def wait_at(self, time: int) -> None:
        """Continue from a time (ns) that has passed, before which the samples are late."""
        self._waited += round((self.now - time) / self.pace)
        self.set(time)

    def take_waits(self) -> tuple[int, int]:
        """Return how long this time waited since the last call, and how long it waited or ran.

        Both are in ns of real time. This time has advanced by the difference times its pace.
        """
        (waited, ran), self._taken = self._taken, (self._waited, self._ran + self._passed)
        return self._taken[0] - waited, self._taken[1] - ran

    def set_factor(self, factor: float) -> None:
        """Continue at another pace."""
        self.set(self.now)
        self.pace = factor

    def note_jump(self) -> None:
        """Do nothing: this clock does not follow the host's."""

    def take_jump(self, stamp: int, rate: float) -> None:
        """Return None: this clock does not jump."""

    def set(self, time: int) -> None:
        """Continue from a time (ns); one that precedes the last stamp is a jump back."""
        self._ran += self._passed
        self._time = time
        self._since = self._real.now

    def stop(self, time: int) -> None:
        """Stand still at a time (ns)."""
        self.set(time)
        self.is_running = False

    def start(self) -> None:
        """Continue from where it stands."""
        self.set(self._time)
        self.is_running = True
