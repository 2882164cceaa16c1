"""The simulation: a sample at every stamp of a grid, and an event for every change.

A change takes effect at the next stamp that is not published yet: samples before it belong to the
old motion, samples from it on to the new one.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import Any, Protocol

from symtop_ros.physics import Motion, State, perrys_rule
from symtop_ros.simulation.block import Block
from symtop_ros.simulation.budget import SHARE, ComputeBudget, Shortfall
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.initial import initial_state
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.sensor import ALONG, find_body
from symtop_ros.simulation.settings import MAX_MOMENT, NO_TORQUE, Settings
from symtop_ros.simulation.ticker import CATCH_UP, Ticker
from symtop_ros.simulation.topics import centre_frame, imu_frame
from symtop_ros.simulation.urdf import robot_description
from symtop_ros.simulation.validation import RefusedError, one_line, refuse, vector
from symtop_ros.wire.layout import NANOSECONDS
from symtop_ros.wire.messages import Transform

AHEAD = 0.05  # s of samples that are computed together; a kick makes them useless
# Samples in a block at most. Requests wait while a block is computed, so blocks are short; those of
# integrated motions are shorter, because it takes a block to find that one is too fast.
MAX_BLOCK, MAX_INTEGRATED_BLOCK = 16, 4
JUMP = 1.0  # s; a larger step of the clock is a jump, which the motion follows
Request = Mapping[str, Any]


class Clock(Protocol):
    """Source of the stamps."""

    @property
    def now(self) -> int:
        """Current time in ns."""

    @property
    def is_simulated(self) -> bool:
        """True if the time is set from outside (use_sim_time)."""


class Sink(Protocol):
    """Destination of samples and events."""

    @property
    def is_open(self) -> bool:
        """False when the program is shutting down and nothing can be sent."""

    @property
    def publishes_tf(self) -> bool:
        """True if the transform of the top is published on /tf."""

    def send_sample(self, stamp: int, block: Block) -> None:
        """Send the sample of a stamp (ns) on all topics that somebody needs."""

    def send_event(self, event: Event) -> None:
        """Send an event."""

    def send_description(self, stamp: int, urdf: str) -> None:
        """Send the description of the top."""

    def send_fixed_frames(self, stamp: int, transforms: Sequence[Transform]) -> None:
        """Send the frames of the sensor and of the centre of mass."""

    def put_events_first(self) -> AbstractContextManager[None]:
        """In the log, put the events sent in this context before its samples."""

    def warn(self, text: str) -> None:
        """Warn the user."""

    def report_error(self, text: str) -> None:
        """Report an error to the user."""


@dataclass
class Turn:
    """Result of a turn; `failure` describes an unexpected exception, else it is empty."""

    failure: str = ""


class Simulation:
    """A top that moves with a clock.

    All public methods may be called from any thread: each takes a lock.
    """

    def __init__(self, settings: Settings, clock: Clock, sink: Sink) -> None:
        self.settings, self._clock, self._sink = settings, clock, sink
        self._lock = threading.RLock()
        self._failures: dict[str, str] = {}
        self._jumped_to: int | None = None
        # the last initial conditions
        self.start = initial_state(settings.top, settings.initial, {})
        self.ticker = Ticker(settings.publish_rate, clock.now)  # the grid of stamps
        self._held_torque, self._torque_end = NO_TORQUE, 0  # ~/applied_torque, until a stamp in ns
        self._budget, self._spent = ComputeBudget(self.stamp), 0.0
        self._gap_reported = -NANOSECONDS
        motion = Motion(settings.top, self.start, settings.friction, settings.steady_torque)
        self._switched_on = self.stamp  # the stamp at which the biases of the sensor are zero
        rig = settings.rig(self._switched_on)
        # the motion of the next stamp
        self.segment = Segment.begin(motion, self.stamp, settings.real_time_factor, rig)
        self._announced, self.motion_begin = motion, _describe_begin("start", self.stamp)
        self._block = Block(self.segment, [])
        self._send_description()

    @property
    def now(self) -> int:
        """Current time of the clock in ns."""
        return self._clock.now

    @property
    def stamp(self) -> int:
        """Next stamp in ns."""
        return self.ticker.next_stamp

    @property
    def state(self) -> State:
        """State at the next stamp."""
        return self.segment.state_at(self.stamp)

    @property
    def verdict(self) -> str:
        """Kind of the motion and what follows from its start, in a sentence."""
        motion = self.segment.motion
        return f"{motion.kind}: {perrys_rule(motion.top, motion.start)}"

    # Turns. Ticks, requests and timers run in different threads; each takes a turn.

    @contextmanager
    def turn(self, name: str) -> Iterator[Turn]:
        """Take the lock, bring the run up to date and survive an unexpected exception.

        An exception is reported as an error and as an event, once until `name` succeeds again, and
        the motion keeps running. `RefusedError` is expected: handle it inside.
        """
        turn = Turn()
        with self._lock:
            self._settle()
            stamp, before = self.stamp, self.segment
            try:
                yield turn
                self._failures.pop(name, None)
            except Exception as error:
                if not self._sink.is_open:
                    raise
                turn.failure = f"{name} failed: {type(error).__name__}: {one_line(error)}"
                if self._failures.get(name) != turn.failure or self.segment is not before:
                    self._failures[name] = turn.failure
                    self._sink.report_error(turn.failure)
                    self.announce("failure", turn.failure, {}, before.state_at(stamp), stamp)

    def answer(self, name: str, act: Callable[[], str]) -> tuple[bool, str]:
        """Carry out a request in a turn; return success and the answer."""
        granted, text = False, ""
        with self._lock:
            with self.turn(f"~/{name}") as turn:
                try:
                    granted, text = True, act()
                except RefusedError as refusal:
                    granted, text = False, str(refusal)
            # The first sample of the new motion need not wait for the pacing thread.
            self.tick()
        return (False, turn.failure) if turn.failure else (granted, text)

    def tick(self) -> float | None:
        """Publish all samples that are due."""
        with self._lock:
            jumped_to, self._jumped_to = self._jumped_to, None
            # The system clock can be set back without any notification.
            if self.now < self.stamp - (JUMP + 1 / self.ticker.rate) * NANOSECONDS:
                jumped_to = self.now
            if jumped_to is not None:
                self._follow_jump(jumped_to)
            self._release_torque()
            if not (self._publish() and self._prepare_block()):
                return 0.0
            wait = (self.stamp - self.now) / NANOSECONDS
            return None if self._clock.is_simulated and wait > 0 else wait

    def note_jump(self) -> None:
        """Note that the clock jumped to its current time; the next tick follows it.

        Does not take the lock, because it is called from within the clock.
        """
        self._jumped_to = self.now

    # Samples

    def _publish(self) -> bool:
        """Publish what is due; return False if the motion is not integrated up to there."""
        ready = self._prepare_block()
        if ready:
            missed, simulated = self.ticker.missed, self._clock.is_simulated
            catch_up = JUMP if simulated else CATCH_UP
            for stamp in self.ticker.due(self.now, catch_up, self._block.last, not simulated):
                self._sink.send_sample(stamp, self._block)
            if self.ticker.missed > missed:
                self._report_gap(self.ticker.missed - missed)
        return ready

    def _prepare_block(self) -> bool:
        """Compute the samples of the next stamps; return False if that needs more calls."""
        stamp, segment = self.stamp, self.segment
        if self._block.covers(segment, stamp):
            return True
        stamps = self.ticker.grid(stamp, self._next_block_length())
        if any(self._held_torque):
            stamps = [each for each in stamps if each < self._torque_end]
        if not stamps:  # the torque ends with the next turn
            return False
        ready = self._budget.prepare(segment, stamps[-1])
        if ready:
            self._block = self._block.continue_with(segment, stamps)
        elif self._budget.shortfall:
            self._slow_down(stamp, self._budget.shortfall)
        return ready

    def _next_block_length(self) -> int:
        """Return 1 for the first block of a motion, so that its first sample comes soon."""
        segment, rate = self.segment, self.ticker.rate
        longest = MAX_INTEGRATED_BLOCK if segment.motion.is_driven else MAX_BLOCK
        grown = 4 * self._block.length if self._block.segment is segment else 1
        return max(1, min(longest, grown, int(AHEAD * rate)))

    def _report_gap(self, missed: int) -> None:
        if self.now - self._gap_reported < NANOSECONDS:  # at most one warning a second
            return
        self._gap_reported = self.now
        self._sink.warn(
            f"no samples for {missed / self.ticker.rate:.3g} s ({missed} missed): the process was "
            "stopped or has too little CPU time; the motion follows the clock"
        )

    # The compute budget of integrated motions

    def _settle(self) -> None:
        """Bring the run up to date: the state at the next stamp is ready afterwards."""
        self._release_torque()
        self._integrate_to(self.stamp)

    def _integrate_to(self, stamp: int) -> None:
        while not self._budget.prepare(self.segment, stamp):
            if self._budget.shortfall:
                self._slow_down(stamp, self._budget.shortfall)

    def _slow_down(self, stamp: int, shortfall: Shortfall) -> None:
        reached, factor = shortfall
        previous, before = self.segment.factor, self.segment.motion.at(reached)
        self.segment = self.segment.slow_down(reached, factor, stamp)
        verdict = (
            f"the motion is too fast for the compute budget: real-time factor {previous:.3g} -> "
            f"{factor:.3g}"
        )
        self._sink.warn(verdict)
        self.announce("pace", verdict, {"reached": reached}, before, stamp)

    def speed_up(self) -> None:
        """Return towards the real-time factor of the settings if the budget allows it."""
        work, self._spent = self._budget.spent - self._spent, self._budget.spent
        current, asked = self.segment.factor, self.settings.real_time_factor
        if current < asked and work < SHARE / 2:
            factor = min(asked, 2 * current) if self.segment.motion.is_driven else asked
            before = self.state
            self.segment = self.segment.set_factor(factor, self.stamp)
            verdict = f"real-time factor {current:.3g} -> {factor:.3g}"
            self.announce("pace", verdict, {}, before)

    # Changes

    def change(self, name: str, segment: Segment, request: Request, verdict: str) -> str:
        """Continue with another segment and announce it; return the verdict."""
        before, self.segment = self.state, segment
        self.announce(name, verdict, request, before)
        return verdict

    def change_at_once(
        self,
        name: str,
        segment: Segment,
        request: Request,
        before: State,
        verdict: Callable[[], str],
    ) -> str:
        """Like `change`, but publish the first sample before the verdict is computed.

        In the log the event still precedes its samples.
        """
        stamp = self.stamp
        self.segment = segment
        with self._sink.put_events_first():
            self._publish()
            text = verdict()
            self._publish()
            self.announce(name, text, request, before, stamp)
        return text

    def _follow_jump(self, now: int) -> None:
        """Continue the motion from its current state at the time (ns) the clock jumped to."""
        stamp = self.stamp
        self._integrate_to(stamp)
        before = self.state
        self.segment = self.segment.move(stamp, now)
        self.ticker.restart(self.settings.publish_rate, now)
        self._torque_end += now - stamp
        self.announce("clock", "the clock jumped", {"from": stamp, "to": now}, before)

    def hold_torque(self, torque: Sequence[float], frame: str = "") -> None:
        """Apply a torque (3,) in N m from the next stamp on until its time-out."""
        world = self.settings.world_frame
        if frame not in ("", world):
            raise refuse("applied_torque frame_id", f'"{world}" or empty', frame)
        x, y, z = vector("applied_torque", torque, 3, MAX_MOMENT, "N m, world frame")
        self._held_torque = x, y, z
        self._torque_end = self.stamp + round(self.settings.applied_torque_timeout * NANOSECONDS)
        self._apply_torque(self.stamp, "the applied torque changed")

    def _release_torque(self) -> None:
        if any(self._held_torque) and self.stamp >= self._torque_end:
            self._integrate_to(self._torque_end)
            self._held_torque = NO_TORQUE
            self._apply_torque(self._torque_end, "the applied torque timed out")

    def _apply_torque(self, stamp: int, verdict: str) -> None:
        """Continue from a stamp under the current torque if it differs from the motion's."""
        (a, b, c), (x, y, z) = self.settings.steady_torque, self._held_torque
        total = (a + x, b + y, c + z)
        if total != self.segment.motion.applied_torque:
            before = self.segment.state_at(stamp)
            self.segment = self.segment.change(stamp, torque=total)
            self.announce("torque", verdict, {"torque": total}, before, stamp)

    def apply_settings(self, settings: Settings) -> None:
        """Continue from the current state with other settings."""
        old, self.settings = self.settings, settings
        changes = {
            name: value for name, value in settings.values.items() if value != old.values[name]
        }
        if not changes:
            return
        stamp, before = self.stamp, self.state
        if settings.initial != old.initial:  # ~/reset then starts from them
            self.start = initial_state(settings.top, settings.initial, {})
        if (settings.top, settings.friction) != (old.top, old.friction):
            self.segment = self.segment.change(stamp, settings.top, settings.friction)
        if (settings.top, settings.publish_tf) != (old.top, old.publish_tf):
            self._send_description()
        if "real_time_factor" in changes:
            self.segment = self.segment.set_factor(settings.real_time_factor, stamp)
        if "publish_rate" in changes:
            self.ticker.restart(settings.publish_rate, stamp)
            self.segment = self.segment.equip(settings.rig(self._switched_on))
            self._block = Block(self.segment, [])  # its stamps belong to the old grid
        verdict = "; ".join(f"{name} is now {value}" for name, value in changes.items())
        self.announce("parameters", verdict, changes, before)
        if settings.steady_torque != old.steady_torque:
            self._apply_torque(stamp, "the steady torque changed")

    def announce(
        self,
        name: str,
        verdict: str,
        request: Request,
        before: State,
        stamp: int | None = None,
    ) -> None:
        """Send the event with which the current segment began, or that reports something."""
        stamp = self.stamp if stamp is None else stamp
        if self.segment.motion is not self._announced:
            self._announced = self.segment.motion
            # the event at which the motion of the segment began, and its stamp in s
            self.motion_begin = _describe_begin(name, stamp)
        frame = self.settings.top_frame
        self._sink.send_event(Event.of(stamp, name, verdict, request, before, self.segment, frame))

    def _send_description(self) -> None:
        settings = self.settings
        frames = settings.world_frame, settings.top_frame
        urdf = robot_description(
            settings.top,
            *frames,
            tf_moves_it=self._sink.publishes_tf,
            gravity=settings.gravity,
        )
        self._sink.send_description(self.stamp, urdf)
        transforms = list_fixed_frames(settings)
        if transforms:
            self._sink.send_fixed_frames(self.stamp, transforms)


def list_fixed_frames(settings: Settings) -> list[Transform]:
    """Return the frames on the body: that of the sensor, and that in the centre of mass."""
    frame, transforms = settings.top_frame, []
    if settings.imu:
        imu = settings.imu
        transforms.append(Transform(frame, imu_frame(frame), imu.position, imu.orientation))
    body = find_body(settings.top, settings.gravity)
    if settings.odometry and body:
        place = (0.0, 0.0, body.arm)
        transforms.append(Transform(frame, centre_frame(frame), place, ALONG))
    return transforms


def _describe_begin(name: str, stamp: int) -> str:
    return f"{name} at stamp {stamp / NANOSECONDS:.9f} s"
