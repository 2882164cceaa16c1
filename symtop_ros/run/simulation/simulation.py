"""The simulation: a sample at every stamp of a grid, and an event for every change.

A change takes effect at the next stamp that is not published yet: samples before it belong to the
old motion, samples from it on to the new one. The `timeline` defines each change; this module
decides when it takes effect, and what is published.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import TypeVar

from symtop_ros.base.refusals import attempt, one_line
from symtop_ros.physics import State
from symtop_ros.run.simulation.block import Blocks, Ticker
from symtop_ros.run.simulation.budget import SHARE, ComputeBudget, Lack, Progress, Shortfall
from symtop_ros.run.simulation.changes.follow import Act, Request
from symtop_ros.run.simulation.changes.outcomes import Failure, Outcome
from symtop_ros.run.simulation.changes.timeline import Timeline
from symtop_ros.run.simulation.clocks import HostClock, RunClock
from symtop_ros.run.simulation.events import Event, do_nothing
from symtop_ros.run.simulation.gaps import Gaps, Waits
from symtop_ros.run.simulation.host import Host, Sink
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.turns import Turns

AT_ONCE = 0.0  # s until the next tick, if this one has left work to do
LONGEST_HOLD = 60  # s until a faster pace is tried on a busy machine
HOW_TO_CONTINUE = "the top has stopped: start the node again"
WHY_IT_ENDS = "too fast for doubles, or 1e15 turns from its start"
T = TypeVar("T")


class Simulation:
    """A top that moves with a clock.

    All public methods may be called from any thread: each takes a lock.
    """

    def __init__(
        self, settings: Settings, clock: HostClock | RunClock, sink: Sink, host: Host
    ) -> None:
        self._sink, self.host, self._clock = sink, host, clock
        self.turns = Turns()
        self._failures: dict[str, Failure] = {}  # by the name of the turn
        self.failure: Failure | None = None  # has ended the run: no samples, all is refused
        self.event_number = 0  # of the latest event
        self.ticker = Ticker(settings.publish_rate, self.now)
        self.last = self.now  # stamp of the last sample
        self.timeline = Timeline.begin(settings, self.stamp)
        self.budget = ComputeBudget()
        self._spent = 0.0
        self.lack: Lack | None = None  # why the motion is slowed down, if it is not too fast
        self._hold = self._longest_hold = 0  # s until a faster pace is tried
        self._kept = 0  # s for which the asked pace was kept
        self.gaps = Gaps(clock)
        self.waits = Waits(clock)
        self._blocks = Blocks(self.segment, sink.encode)
        self._is_announcing = False  # True while an event is written: no other may precede it
        sink.send_description(self.stamp, settings)

    @property
    def now(self) -> int:
        """Current time of the clock in ns."""
        return self._clock.now

    @property
    def stamp(self) -> int:
        """Next stamp in ns."""
        return self.ticker.next_stamp

    @property
    def segment(self) -> Segment:
        """The motion of the next stamp."""
        return self.timeline.segment

    @property
    def settings(self) -> Settings:
        """The current settings."""
        return self.timeline.settings

    @property
    def factor(self) -> float:
        """The real-time factor that is kept when the motion runs, and its time does not wait."""
        return self.segment.factor * self._clock.pace

    @property
    def achieved(self) -> float:
        """The real-time factor of the motion as last measured; 0 in a pause."""
        return self.factor * (1 - self.waits.share) if self.segment.running else 0.0

    @property
    def state(self) -> State:
        """State at the next stamp."""
        return self._blocks.state_at(self.segment, self.stamp)

    # Turns. Ticks, requests and timers run in different threads; each takes a turn.

    def take_turn(self, name: str, act: Callable[[], T]) -> T | Failure:
        """Take the lock, bring the run up to date, and return what an action returns.

        An unexpected exception becomes a failure, which is reported as an error and as an event,
        once until the action `name` succeeds again; the motion keeps running. A request that may
        be refused is an action of `attempt`. An exception outside the action ends the run, with a
        last event.
        """
        with self.turns:
            return self._protect(name, partial(self._act, name, act))

    def _protect(self, name: str, act: Callable[[], T]) -> T | Failure:
        """Return what an action returns. An exception ends the run, not the program around it."""
        if self.failure:
            return self.failure
        try:
            return act()
        except Exception as error:
            text = f"{one_line(error)} ({HOW_TO_CONTINUE})"
            self.failure = Failure(name, type(error).__name__, text)
            self.host.fail(self.failure)
            self._announce_end(self.failure)
            return self.failure

    def _announce_end(self, failure: Failure) -> None:
        """Announce a failure that has ended the run; what failed may be what an event needs."""
        if self.host.is_open:  # else ROS is shutting down
            with suppress(Exception):
                self.apply(self.timeline.end(self.stamp, failure))

    def _act(self, name: str, act: Callable[[], T]) -> T | Failure:
        self._follow_jump()
        self.settle()
        stamp, before = self.stamp, self.timeline
        try:
            result = act()
        except Exception as error:
            if not self.host.is_open:
                raise
            failure = Failure(name, type(error).__name__, one_line(error))
            self._report_failure(failure, stamp, before)
            return failure
        self._failures.pop(name, None)
        return result

    def _report_failure(self, failure: Failure, stamp: int, before: Timeline) -> None:
        name = failure.action
        if self._failures.get(name) != failure or self.segment is not before.segment:
            self._failures[name] = failure
            self.host.report_error(str(failure))
            self.apply(self.timeline.fail(stamp, failure, before.segment))

    def answer(self, name: str, act: Callable[[], str]) -> tuple[bool, str]:
        """Carry out a request in a turn; return success and the answer.

        `act` returns the answer or raises RefusedError.
        """
        with self.turns:
            found = self.take_turn(f"~/{name}", partial(attempt, act))
            # The first sample of the new motion need not wait for the next tick.
            self._protect("a sample", self.publish)
        return (False, str(found)) if isinstance(found, Failure) else found

    def tick(self) -> float | None:
        """Publish all samples that are due; return the seconds until the next call.

        None: only a change of a simulated clock can make a sample due, or nothing after a failure.
        """
        with self.turns.lock:
            wait = self._protect("a tick", self._tick)
        return None if isinstance(wait, Failure) else wait

    def _tick(self) -> float | None:
        self._follow_jump()
        self._release_torque()
        if not (self.publish() and self._work_on_block()):
            return AT_ONCE
        # The rest of the block is computed now, so that it is ready in time. In the first sample
        # after a change, each topic is computed when it is sent.
        self._blocks.current.finish()
        self._work_ahead()
        return self._clock.wait_for(self.stamp)

    # Samples

    def publish(self) -> bool:
        """Publish what is due, one sample if a turn waits; False if the motion is not so far."""
        self._clock.hold_back(self.stamp)
        ready = self._work_on_block()
        if ready:
            self._send_due()
        return ready

    def _send_due(self) -> None:
        ticker, clock = self.ticker, self._clock
        missed, last = ticker.missed, self.last
        catch_up = clock.catch_up(ticker.rate)
        until = self._blocks.current.last
        for stamp in ticker.due(self.now, catch_up, until, not clock.is_simulated):
            self._sink.send_sample(stamp, self._blocks.current)
            self.last = stamp
            if self.turns.is_awaited:
                break
        if ticker.missed > missed:
            self.gaps.add(ticker.missed - missed, ticker.rate, last)
            if warning := self.gaps.explain(ticker.rate):
                self.host.warn(warning)
        self.gaps.note_sent()

    def _work_on_block(self) -> bool:
        """Work towards the states of the next stamps; return True when they are reached."""
        segment, stamp = self.timeline.segment, self.ticker.next_stamp
        if self._blocks.cover(segment, stamp):
            return True
        stamps = self._list_stamps(stamp)
        if not stamps:  # the torque ends with the next turn
            return False
        progress = self._prepare(stamps[-1])
        if progress.ready:
            self._blocks.begin(segment, stamps)
        elif progress.shortfall and not self._is_announcing:
            self._slow_down(stamps[0], progress.shortfall)
        return progress.ready

    def _work_ahead(self) -> None:
        """Compute a piece of the next block; the first sample of this one says what is due."""
        blocks = self._blocks
        # A block of a driven motion takes some steps of integration.
        if self.segment.motion.is_driven or not blocks.current.requested:
            return
        if not blocks.work_on_later():
            _, first = self.ticker.grid(blocks.current.last, 2)
            blocks.begin_later(self.segment, self._list_stamps(first))

    def _list_stamps(self, first: int) -> list[int]:
        """Return the stamps of a block; none if the held torque ends before the first."""
        count = self._blocks.find_next_length(self.segment, self.ticker.rate)
        stamps = self.ticker.grid(first, count)
        if any(self.timeline.held_torque):
            stamps = [each for each in stamps if each < self.timeline.torque_end]
        return stamps

    # The compute budget of driven motions

    def settle(self) -> None:
        """Bring the run up to date: the state at the next stamp is ready afterwards."""
        self._release_torque()
        self._integrate_to(self.stamp)

    def _prepare(self, stamp: int) -> Progress:
        """Work towards the state at a stamp; a motion that cannot continue is paused."""
        clock = self._clock
        progress = self.budget.prepare(self.segment, stamp, clock.pace, not clock.is_simulated)
        if progress.end is not None and not self._is_announcing:
            self._stop_at(progress.end)
        return progress

    def _stop_at(self, reached: float) -> None:
        """Pause a motion that cannot continue at the time (s) that it has reached."""
        verdict = self.do("pause", {"reached": reached})
        self.host.warn(f"the motion cannot be computed any further ({WHY_IT_ENDS}): {verdict}")

    def _integrate_to(self, stamp: int) -> bool:
        """Work until the state at a stamp is ready; False if a nearer stamp became the next."""
        while not (progress := self._prepare(stamp)).ready:
            if progress.shortfall:
                self._slow_down(stamp, progress.shortfall)
        return True

    def _slow_down(self, stamp: int, shortfall: Shortfall) -> None:
        """Slow down a motion that cannot be followed.

        How much of the processor a thread could get shows only when it asks for it. So a faster
        pace is tried after a second, and after twice as many whenever that was too fast, until it
        was kept for a minute.
        """
        self.lack = shortfall.lack
        self._kept = 0
        if self.lack:
            self._hold = self._longest_hold = min(LONGEST_HOLD, max(1, 2 * self._longest_hold))
        self.host.warn(self.apply(self.timeline.slow_down(stamp, shortfall)))

    def speed_up(self) -> None:
        """Return towards the real-time factor of the settings if the budget allows it.

        It is called once a second.
        """
        work, self._spent = self.budget.spent - self._spent, self.budget.spent
        current = self.factor
        factor = self.settings.real_time_factor
        self._hold = max(0, self._hold - 1)
        if current >= factor:
            self.lack = None
            self._kept += 1
            if self._kept == LONGEST_HOLD:
                self._longest_hold = 0
        elif self._hold == 0 and self._may_hurry(work) and self._prepare(self.stamp).ready:
            if self.segment.motion.is_driven:
                factor = min(factor, 2 * current)
            self._set_pace(factor)

    def _may_hurry(self, work: float) -> bool:
        """Return True if a motion that takes `work`, in s of CPU time per second, may be faster.

        One that lacked CPU time, but is not too fast, may take again what it needs.
        """
        return self.lack is not None or work < SHARE / 2

    def measure_pace(self) -> None:
        """Measure how fast the time was since the last call; warn if it waited for samples."""
        self._clock.hold_back(self.stamp)
        if warning := self.waits.measure(self.factor, self.settings.real_time_factor):
            self.host.warn(warning)

    def _set_pace(self, factor: float) -> str:
        """Continue at another real-time factor; return the verdict."""
        verdict = self.apply(self.timeline.set_pace(self.stamp, self.factor, factor))
        self._clock.set_factor(factor)
        return verdict

    # Changes

    def apply(self, timeline: Timeline) -> str:
        """Continue with a timeline and announce its change; return the verdict."""
        self.timeline = timeline
        return self._announce(self._write_event(timeline))

    def _write_event(self, timeline: Timeline, between: Callable[[], object] = do_nothing) -> Event:
        frame = timeline.settings.top_frame
        return Event.of(timeline.change, self.event_number + 1, frame, between)

    def apply_at_once(self, timeline: Timeline) -> str:
        """Like `apply`, but publish samples that are due before and while the event is written.

        In the log the event still precedes its samples. If the motion is too fast to be followed,
        that is found again, and announced, after it.
        """
        self.timeline = timeline
        self._is_announcing = True
        try:
            with self._sink.put_events_first():
                if self.publish():
                    self._prepare_sample()
                event = self._write_event(timeline, self.publish)
                self.publish()
                return self._announce(event)
        finally:
            self._is_announcing = False

    def _prepare_sample(self) -> None:
        """Compute the next sample before it is due, and publish it on time."""
        block = self._blocks.current
        while block.work():
            self.publish()

    def _announce(self, event: Event) -> str:
        self.event_number += 1
        self._sink.send_event(event)
        return event.verdict

    def do(self, name: str, request: Request, told: Outcome | None = None) -> str:
        """Carry out an act at the next stamp; return the verdict."""
        return self.apply(self.timeline.follow(Act(name, self.stamp, request, told=told)))

    def pause(self, paused: bool) -> str:
        """Stop the motion, or continue it; return the verdict."""
        return self.do("pause" if paused else "resume", {})

    def begin_paused(self) -> None:
        """Pause a run at its very start, before any sample."""
        self.pause(True)

    def step(self, duration: float) -> str:
        """Advance a paused motion by a duration in s; return the verdict."""
        return self.do("step", {"duration": duration})

    def begin_jump(self) -> None:
        """Publish nothing from before the clock is set until `end_jump`, in the same thread.

        A sample in between would belong to the time of before, with a stamp of after.
        """
        self.turns.lock.acquire()

    def end_jump(self, jumped: bool) -> None:
        """Continue after the clock was set; if it jumped, the next tick follows it."""
        if jumped:
            self._clock.note_jump()
        self.turns.lock.release()

    def _follow_jump(self) -> None:
        """Continue the motion from its current state at the time the clock jumped to."""
        now = self._clock.take_jump(self.stamp, self.ticker.rate)
        if now is not None:
            stamp = self.stamp
            self._integrate_to(stamp)
            self.restart_grid(now)
            self.apply(self.timeline.move(stamp, now))

    def hold_torque(self, torque: Sequence[float], frame: str = "") -> None:
        """Apply a torque (3,) in N m from the next stamp on until its time-out."""
        self._apply_torque(self.timeline.hold_torque(self.stamp, torque, frame))

    def _release_torque(self) -> None:
        end = self.timeline.torque_end
        held = any(self.timeline.held_torque) and self.stamp >= end
        if held and self._integrate_to(end):
            self._apply_torque(self.timeline.release_torque(end))

    def _apply_torque(self, timeline: Timeline) -> None:
        """Continue under a torque; it is announced if it differs from the one before."""
        if timeline.segment is self.segment:
            self.timeline = timeline
        else:
            self.apply(timeline)

    def apply_settings(self, settings: Settings) -> None:
        """Continue from the current state with other settings."""
        old, stamp = self.settings, self.stamp
        for timeline in self.timeline.change_settings(settings, stamp):
            self.apply(timeline)
        if (settings.top, settings.body, settings.publish_tf) != (
            old.top,
            old.body,
            old.publish_tf,
        ):
            self._sink.send_description(stamp, settings)
        if settings.publish_rate != old.publish_rate:
            self.restart_grid(stamp)
        if settings.real_time_factor != old.real_time_factor:
            self._clock.set_factor(settings.real_time_factor)

    def restart_grid(self, stamp: int) -> None:
        """Continue with a grid of stamps that begins at a stamp."""
        self.ticker.restart(self.settings.publish_rate, stamp)
        self._blocks.restart(self.segment)  # the stamps of the blocks belong to the old grid
