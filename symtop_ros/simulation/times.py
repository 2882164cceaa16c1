"""The time of a run: what its stamps are, and how it follows a motion that is hard to compute.

A simulation has one of two. With `Time` stamps are times of the clock of its host. With
`RunTime` (parameter publish_clock) they are the elapsed time of the run, which is published on
/clock: it advances by the real-time factor, stands still in a pause and never goes back, so that
rates are derivatives by the stamps at every factor. Gazebo's /clock is of this kind.
"""

from typing import TYPE_CHECKING, Protocol

from symtop_ros.simulation.block import CATCH_UP
from symtop_ros.simulation.changes.outcomes import Step
from symtop_ros.simulation.changes.timeline import Change
from symtop_ros.simulation.segment import Segment
from symtop_ros.wire.layout import NANOSECONDS

if TYPE_CHECKING:
    from symtop_ros.simulation.simulation import Simulation

CALLS = 20  # of 1 ms for a request; the lock is held meanwhile
WHY_IT_ENDS = "too fast for doubles, or 1e15 turns from its start"
JUMP = 1.0  # s; a larger step of the clock is a jump, which the motion follows


class Clock(Protocol):
    """Source of the stamps."""

    @property
    def now(self) -> int:
        """Current time in ns."""

    @property
    def is_simulated(self) -> bool:
        """True if the time is set from outside (use_sim_time)."""


class Time:
    """The time of a run by a clock that is not its own."""

    can_jump = True  # the clock may be set while the run uses it

    def __init__(self, clock: Clock) -> None:
        self.clock = clock

    @property
    def catch_up(self) -> float:
        """Seconds of samples that are sent late; older ones are dropped."""
        return JUMP if self.clock.is_simulated else CATCH_UP

    def factor(self, segment: Segment) -> float:
        """Return the real-time factor that is kept when a motion runs."""
        return segment.factor

    def set_factor(self, factor: float) -> None:
        """Continue at another real-time factor, which segments have already."""

    def seconds_until(self, stamp: int) -> float | None:
        """Return the seconds of real time until a stamp; None if a change must wake the run."""
        wait = (stamp - self.clock.now) / NANOSECONDS
        return None if self.clock.is_simulated and wait > 0 else wait

    def hold(self, stamp: int) -> None:
        """Let the time wait for a stamp (ns) that is late; this clock does not wait."""

    def prepare(self, run: "Simulation", stamp: int) -> bool:
        """Work towards a stamp; return True if its state is ready."""
        ready = run.budget.prepare(run.segment, stamp)
        if run.budget.end is not None:
            warn_of_end(run, run.timeline.stop(run.stamp, run.budget.end))
        return ready

    def integrate_to(self, run: "Simulation", stamp: int) -> bool:
        """Work until the state at a stamp is ready; False if a nearer stamp became the next."""
        while not self.prepare(run, stamp):
            self.check_pace(run, stamp)
        return True

    def check_pace(self, run: "Simulation", stamp: int) -> None:
        """Slow the motion down if it cannot be followed."""
        if shortfall := run.budget.shortfall:
            run.host.warn(run.apply(run.timeline.slow_down(stamp, shortfall)))

    def pause(self, run: "Simulation", paused: bool) -> str:
        """Stop the motion, or continue it; return the verdict."""
        return run.apply(run.timeline.pause(run.stamp, paused))

    def step(self, run: "Simulation", duration: float) -> str:
        """Advance a paused motion by a duration in s; return the verdict."""
        return run.apply(run.timeline.step(run.stamp, duration))


def warn_of_end(run: "Simulation", change: Change) -> None:
    """Pause a motion that cannot continue."""
    run.host.warn(f"the motion has no state any further ({WHY_IT_ENDS}): {run.apply(change)}")


class RunClock:
    """Elapsed time of a run."""

    is_simulated = False

    def __init__(self, real: Clock, factor: float) -> None:
        self._real, self.is_running = real, True
        self._time, self._since = 0, real.now  # ns of the run, and the real time at which it was so
        self.factor = factor  # seconds of the run per second of real time

    @property
    def now(self) -> int:
        """Current time in ns."""
        passed = self._real.now - self._since if self.is_running else 0
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
        self.is_running = False

    def start(self) -> None:
        """Continue from where it stands."""
        self.set(self._time)
        self.is_running = True


class RunTime(Time):
    """The elapsed time of a run. The factor of its segments is 1."""

    clock: RunClock
    can_jump = False  # no other program sets this clock

    def __init__(self, real: Clock, factor: float) -> None:
        super().__init__(RunClock(real, factor))

    @property
    def catch_up(self) -> float:
        """Return more than the time waits: no sample is dropped."""
        return JUMP * self.clock.factor

    def factor(self, segment: Segment) -> float:
        """Return the factor of the clock."""
        return self.clock.factor

    def set_factor(self, factor: float) -> None:
        """Continue at another pace."""
        if factor != self.clock.factor:
            self.clock.set_factor(factor)

    def seconds_until(self, stamp: int) -> float | None:
        """Return the seconds of real time until a stamp; None in a pause."""
        wait = (stamp - self.clock.now) / NANOSECONDS / self.clock.factor
        return wait if self.clock.is_running else None

    def hold(self, stamp: int) -> None:
        """Wait for a process that was stopped, so that no sample is missed."""
        late = self.clock.now - stamp - round(CATCH_UP * self.clock.factor * NANOSECONDS)
        if late > 0:
            self.clock.set(self.clock.now - late)

    def prepare(self, run: "Simulation", stamp: int) -> bool:
        """Work towards a stamp; return True if its state is ready."""
        ready = run.budget.prepare(run.segment, stamp, self.clock.factor)
        if run.budget.end is not None:
            self._end(run, run.budget.end)
        return ready

    def _end(self, run: "Simulation", reached: float) -> None:
        """Bring a motion that cannot continue to its last time in s, and pause it there."""
        before = run.stamp
        self._bring_forward(run, reached)
        if run.stamp == before:
            self._stop(run)
            warn_of_end(run, run.timeline.stop(run.stamp, reached))

    def _stop(self, run: "Simulation") -> None:
        """Let the time stand still: what is changed from now on acts 1 ns after the last sample."""
        self.clock.stop(max(run.last, run.segment.stamp - 1))
        run.restart_grid(self.clock.now + 1)

    def integrate_to(self, run: "Simulation", stamp: int) -> bool:
        """Work for some ms until the state at a stamp is ready; else a nearer stamp is the next."""
        for _ in range(CALLS):
            if self.prepare(run, stamp):
                return True
        self.check_pace(run, stamp)
        segment = run.segment
        self._bring_forward(run, segment.motion.reach(segment.time_at(stamp), 0))
        while not self.prepare(run, run.stamp):  # 1 ns at most
            pass
        return False

    def check_pace(self, run: "Simulation", stamp: int) -> None:
        """Slow the time down if the motion cannot be followed; a sample shows what was reached."""
        if shortfall := run.budget.shortfall:
            self._bring_forward(run, shortfall.reached)
            change = run.timeline.set_pace(run.stamp, self.clock.factor, shortfall.factor)
            run.host.warn(run.apply(change))
            self.clock.set_factor(shortfall.factor)

    def _bring_forward(self, run: "Simulation", reached: float) -> None:
        """Let the next stamp be that of a time (s of the motion) that is integrated."""
        segment = run.segment
        stamp = max(run.last + 1, segment.stamp, segment.stamp_at(reached))
        if stamp < run.stamp:
            run.restart_grid(stamp)
            if self.clock.now > stamp:
                self.clock.set(stamp)

    def pause(self, run: "Simulation", paused: bool) -> str:
        """Stop the motion and its time, or continue both."""
        if paused:
            self._stop(run)
        verdict = run.apply(run.timeline.pause(run.stamp, paused))
        if not paused:
            run.restart_grid(self.clock.now + round(NANOSECONDS / run.ticker.rate))
            self.clock.start()
        return verdict

    def step(self, run: "Simulation", duration: float) -> str:
        """Advance a paused motion and its time, with one sample at the end."""
        now = self.clock.now + round(duration * NANOSECONDS)
        if now == self.clock.now:
            return run.report("step", Step("none"))
        verdict = run.apply(run.timeline.step_clock(run.stamp, now))
        self.clock.stop(now)
        run.restart_grid(now)
        run.settle()  # a torque may end meanwhile
        run.publish()
        self.pause(run, True)
        return verdict
