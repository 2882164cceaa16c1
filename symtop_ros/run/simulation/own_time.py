"""A simulation in its own time (parameter publish_clock), as Gazebo's.

Its stamps are the elapsed time of the run, which is published on /clock: it advances by the
real-time factor, stands still in a pause and goes back only if a reset of the time is asked for, so
that rates are derivatives by the stamps at every factor. The factor of its segments is 1.
"""

from symtop_ros.run.simulation.budget import Shortfall
from symtop_ros.run.simulation.clocks import HostClock, RunClock
from symtop_ros.run.simulation.host import Clock, Host, Sink
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.simulation import Simulation
from symtop_ros.run.wire.layout import NANOSECONDS

CALLS = 20  # of 1 ms for a request; the lock is held meanwhile


def simulate(settings: Settings, clock: Clock, sink: Sink, host: Host) -> Simulation:
    """Return a simulation with the stamps of its host's clock, or in its own time."""
    if settings.publish_clock:
        own = RunClock(clock, settings.real_time_factor)
        return OwnTimeSimulation(settings, own, sink, host)
    return Simulation(settings, HostClock(clock), sink, host)


class OwnTimeSimulation(Simulation):
    """A top in the elapsed time of its run, which no other program sets.

    The time waits for a motion that is paused or cannot be followed.
    """

    _clock: RunClock

    def _stop_at(self, reached: float) -> None:
        """Bring a motion that cannot continue to its last time in s, and pause it there."""
        before = self.stamp
        self._bring_forward(reached)
        if self.stamp == before:
            self._stop()
            super()._stop_at(reached)

    def _stop(self) -> None:
        """Let the time stand still: changes from now on act 1 ns after the last sample."""
        self._clock.stop(max(self.last, self.segment.stamp - 1))
        self.restart_grid(self.now + 1)

    def _integrate_to(self, stamp: int) -> bool:
        """Work for some ms until the state at a stamp is ready; else a nearer stamp is the next."""
        for _ in range(CALLS):
            progress = self._prepare(stamp)
            if progress.ready:
                return True
        if progress.shortfall:
            self._slow_down(stamp, progress.shortfall)
        segment = self.segment
        self._bring_forward(segment.motion._reach(segment.time_at(stamp), 0))
        while not self._prepare(self.stamp).ready:  # 1 ns at most
            pass
        return False

    def _slow_down(self, stamp: int, shortfall: Shortfall) -> None:
        """Slow the time down; a sample shows what was reached."""
        self._bring_forward(shortfall.reached)
        # Less than 1 ns after the last sample, the next stamp is not reached, and may never be.
        if self.segment.stamp_at(shortfall.reached) >= self.stamp:
            self.host.warn(self._set_pace(shortfall.factor))

    def _bring_forward(self, reached: float) -> None:
        """Let the next stamp be that of a time (s of the motion) that is integrated."""
        segment = self.segment
        stamp = max(self.last + 1, segment.stamp, segment.stamp_at(reached))
        if stamp < self.stamp:
            self.restart_grid(stamp)
            if self.now > stamp:
                self._clock.wait_at(stamp)

    def pause(self, paused: bool) -> str:
        """Stop the motion and its time, or continue both."""
        if paused:
            self._stop()
        verdict = super().pause(paused)
        if not paused:
            self.restart_grid(self.now + round(NANOSECONDS / self.ticker.rate))
            self._clock.start()
        return verdict

    def begin_paused(self) -> None:
        """Pause a run right after its first sample: later ones would need a time that runs."""
        self._clock.stop(self.stamp)
        self.restart_grid(self.stamp)
        self.settle()
        self.publish()
        self.pause(True)

    def step(self, duration: float) -> str:
        """Advance a paused motion and its time, with one sample at the end."""
        now = self.now + round(duration * NANOSECONDS)
        if now == self.now:
            return self.do("step", {})
        verdict = self.do("step", {"to": now})
        self._clock.stop(now)
        self.restart_grid(now)
        self.settle()  # a torque may end meanwhile
        self.publish()
        self.pause(True)
        return verdict

    def reset_time(self, with_state: bool) -> None:
        """Set the time back to 0, where the motion continues, or starts as the parameters say.

        Call it in a turn. The sample at 0 is published, in a pause too.
        """
        moved = self.timeline.move(self.stamp, 0)
        # A start that is refused changes nothing.
        again = moved.restart(0, {}) if with_state else None
        self.last = -1
        self._clock.set(0)
        self.restart_grid(0)
        self.apply(moved)
        if again:
            self.apply(again)
        self.publish()
        if not self._clock.is_running:
            self._stop()
