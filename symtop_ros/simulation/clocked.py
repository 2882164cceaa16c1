"""A simulation that publishes the time of its motion on /clock, and whose stamps are that time.

The time advances by the real-time factor, stands still in a pause and never goes back, so that
rates are derivatives by the stamps at every factor. Gazebo's /clock is of this kind.
"""

from symtop_ros.simulation.changes.outcomes import Step
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.simulation import JUMP, Clock, Host, Simulation, Sink
from symtop_ros.simulation.ticker import CATCH_UP
from symtop_ros.wire.layout import NANOSECONDS

CALLS = 20  # of 1 ms for a request; the lock is held meanwhile


class RunClock:
    """Elapsed time of a run."""

    is_simulated = False

    def __init__(self, real: Clock, factor: float) -> None:
        self._real, self._running = real, True
        self._time, self._since = 0, real.now  # ns of the run, and the real time at which it was so
        self.factor = factor  # seconds of the run per second of real time

    @property
    def now(self) -> int:
        """Current time in ns."""
        passed = self._real.now - self._since if self._running else 0
        return self._time + int(passed * self.factor)

    def set_factor(self, factor: float) -> None:
        """Continue at another pace."""
        self.set(self.now)
        self.factor = factor

    def set(self, time: int) -> None:
        """Continue from a time (ns), which must not precede the last stamp."""
        self._time, self._since = time, self._real.now

    def stop(self, time: int) -> None:
        """Stand still at a time (ns)."""
        self.set(time)
        self._running = False

    def start(self) -> None:
        """Continue from where it stands."""
        self.set(self._time)
        self._running = True

    def seconds_until(self, stamp: int) -> float | None:
        """Return the seconds of real time until a stamp (ns); None while it stands still."""
        return (stamp - self.now) / NANOSECONDS / self.factor if self._running else None


class ClockedSimulation(Simulation):
    """A simulation with publish_clock; the factor of its segments is 1."""

    def __init__(self, settings: Settings, clock: Clock, sink: Sink, host: Host) -> None:
        self._run_clock = RunClock(clock, settings.real_time_factor)
        super().__init__(settings, self._run_clock, sink, host)

    @property
    def factor(self) -> float:
        """The real-time factor that is kept when the motion runs."""
        return self._run_clock.factor

    def pause(self, paused: bool) -> str:
        """Stop the motion and its time, or continue both."""
        if paused:
            # No sample has a later stamp: what is changed in the pause acts 1 ns after it.
            self._run_clock.stop(max(self._last, self.segment.stamp - 1))
            self._restart_grid(self.now + 1)
        verdict = super().pause(paused)
        if not paused:
            self._restart_grid(self.now + round(NANOSECONDS / self.ticker.rate))
            self._run_clock.start()
        return verdict

    def step(self, duration: float) -> str:
        """Advance a paused motion and its time, with one sample at the end."""
        now = self.now + round(duration * NANOSECONDS)
        if now == self.now:
            return self.report("step", Step("none"))
        verdict = self.apply(self.timeline.step_clock(self.stamp, now))
        self._run_clock.stop(now)
        self._restart_grid(now)
        self._settle()  # a torque may end meanwhile
        self._publish()
        self.pause(True)
        return verdict

    def apply_settings(self, settings: Settings) -> None:
        """Continue from the current state with other settings."""
        old = self.settings.real_time_factor
        super().apply_settings(settings)
        if settings.real_time_factor != old:
            self._run_clock.set_factor(settings.real_time_factor)

    def _publish(self) -> bool:
        # The time waits for a process that was stopped, so that no sample is missed.
        late = self.now - self.stamp - round(CATCH_UP * self.factor * NANOSECONDS)
        if late > 0:
            self._run_clock.set(self.now - late)
        return super()._publish()

    def _find_wait(self) -> float | None:
        return self._run_clock.seconds_until(self.stamp)

    def _follow_jump(self) -> None:
        """Do nothing: no other program sets this clock."""

    def _integrate_to(self, stamp: int) -> bool:
        """Work for some ms until the state at a stamp is ready; else a nearer stamp is the next."""
        for _ in range(CALLS):
            if self._prepare(stamp):
                return True
        self._check_pace(stamp)
        self._bring_forward(self.segment.motion.reach(self.segment.time_at(stamp), 0))
        while not self._prepare(self.stamp):  # 1 ns at most
            pass
        return False

    def _bring_forward(self, reached: float) -> None:
        """Let the next stamp be that of a time (s of the motion) that is integrated."""
        stamp = max(self._last + 1, self.segment.stamp, self.segment.stamp_at(reached))
        if stamp < self.stamp:
            self._restart_grid(stamp)
            if self.now > stamp:
                self._run_clock.set(stamp)

    def _prepare(self, stamp: int) -> bool:
        return self._budget.prepare(self.segment, stamp, self.factor)

    @property
    def _catch_up(self) -> float:
        """Return more than the time waits: no sample is dropped."""
        return JUMP * self.factor

    def _check_pace(self, stamp: int) -> None:
        """Slow the time down if the motion cannot be followed; a sample shows what was reached."""
        shortfall = self._budget.shortfall
        if shortfall:
            self._bring_forward(shortfall.reached)
            self._host.warn(self._set_pace(shortfall.factor))

    def _set_pace(self, factor: float) -> str:
        verdict = super()._set_pace(factor)
        self._run_clock.set_factor(factor)
        return verdict
