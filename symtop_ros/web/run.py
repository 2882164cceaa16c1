"""The run that a page shows: its history, motion, ghost, trace and series."""

import math
from collections import deque
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real
from symtop_ros.drawing.ghost import Ghost
from symtop_ros.log.batch import Batch, Columns
from symtop_ros.physics import EffectivePotential, Motion, State
from symtop_ros.session.summary import constants_of_motion
from symtop_ros.simulation.budget import StepBudget
from symtop_ros.simulation.changes.outcomes import Record
from symtop_ros.simulation.events import RESTARTS, Event
from symtop_ros.simulation.segment import Segment

# The topic of the samples: with the motion of the last event it gives all others.
DRAWN = "orientation"
SERIES = ("theta", "phi_dot", "psi_dot", "energy", "L_z", "L_z'", "ghost theta")
UNITS = ("rad", "rad/s", "rad/s", "J", "N m s", "N m s", "rad")
ROWS = 20_000  # samples in the series at least: 100 s of the clock at 200 Hz
TRACE = 240  # lines of the trace
TRACE_NUTATIONS = 12  # longest trace and longest plot, in nutations
MOST_STEPS = 3000  # of an integration, for one batch
HISTORY = 100  # events, as many as the node keeps
KEPT = 4000  # events that are kept for a saved page
# Two samples that are nearer are one: the times of a run are sums of rounded parts.
SAME_TIME = 1e-9  # s
# Events that are no act of a user, or that change nothing of the motion.
UNLISTED = ("pause", "resume", "step", "record", "pace", "clock", "failure")
REPEATED = ("start", "reset", "parameters", "torque")  # of several in a row the last is listed
ANNOUNCED = ("start", "reset", "kick")  # events of which a page says what follows


class Moment(NamedTuple):
    """An event in the time of the run, and the motions without it and with it."""

    time: float  # s of the run
    event: Event
    before: Segment | None
    after: Segment


class Run:
    """State of a page, from the events and samples of a run."""

    def __init__(self) -> None:
        # the motion of the last event, None before the first one
        self.segment: Segment | None = None
        self.event: Event | None = None  # the last event
        self.ghost = Ghost()  # the run without its last kick
        # starts, kicks and changes, the newest last
        self.history: deque[Event] = deque(maxlen=HISTORY)
        self.moments: deque[Moment] = deque(maxlen=KEPT)  # all events, the newest last
        # the last start, kick or change of the top
        self.announced: Moment | None = None
        self.state: State | None = None  # the state of the last sample
        self.stamp = 0  # its stamp in ns
        self.time = 0.0  # its time of the run in s
        self.is_recording = False  # True while a log is written
        self.window = 1.0  # time (s of the motion) that the plots show
        # Points of the trace in scene units, the newest last, and how many there were.
        self.axes: Real = np.zeros((TRACE + 1, 3))
        self.traced = 0
        self._rows: Real = np.empty((2 * ROWS, 1 + len(SERIES)))
        self._count = 0  # of the rows in use
        self._dropped = 0  # of the oldest rows
        self._offset = Fraction(0)  # ns: time of the run minus time of the motion
        self._last = -math.inf  # time of the run at the newest point of the trace

    def follow(self, batch: Batch) -> list[Event]:
        """Take over events and samples in their order; return the events."""
        for event, columns in batch.stretches():
            if event:
                self._take_event(event)
            if columns and self.segment:
                self._take_samples(columns[DRAWN], self.segment)
        return [event for _, event in batch.events]

    @property
    def motion(self) -> Motion | None:
        """The motion; None before the first event."""
        return self.segment.motion if self.segment else None

    @property
    def potential(self) -> EffectivePotential | None:
        """The effective potential of the state, None before the first sample."""
        if self.segment is None or self.state is None:
            return None
        return EffectivePotential.of(self.segment.motion.top, self.state)

    def drifts(self) -> dict[str, tuple[float, float]]:
        """Return each constant of the motion, and its change since the motion began."""
        if self.segment is None or self.state is None:
            return {}
        motion = self.segment.motion
        now = constants_of_motion(motion.top, self.state)
        start = constants_of_motion(motion.top, motion.start)
        return {name: (value, value - start[name]) for name, value in now.items()}

    def series(self) -> Real:
        """Return time of the run (s) and the quantities of `SERIES`, (n, 8)."""
        return self._rows[: self._count]

    def series_since(self, number: int) -> tuple[int, Real]:
        """Return how many rows there were in all, and those from a number on that are left."""
        skipped = max(0, number - self._dropped)
        return self._dropped + self._count, self._rows[min(skipped, self._count) : self._count]

    def csv(self) -> str:
        """Return the series as comma-separated values, in decimals that read back the same.

        The column of the ghost is empty if there is no ghost.
        """
        names = [f"{name} ({unit})" for name, unit in zip(SERIES, UNITS, strict=True)]
        rows = (
            ",".join("" if math.isnan(value) else repr(value) for value in row)
            for row in self.series().tolist()
        )
        return "\n".join([",".join(["time (s)", *names]), *rows, ""])

    def _take_event(self, event: Event) -> None:
        before, after = self.segment, event.segment()
        self._continue_time(event, before, after)
        moment = Moment(self._run_time(after, event.stamp), event, before, after)
        self.moments.append(moment)
        self.segment, self.event = after, event
        self.ghost.follow(event.name, before, after)
        outcome = event.outcome() if event.name == "record" else None
        if isinstance(outcome, Record):
            self.is_recording = outcome.kind == "begun"
        changed = before is None or not _is_same(before.motion, after.motion)
        if event.name in ANNOUNCED or (event.name == "parameters" and changed):
            self.announced = moment
        if event.name not in UNLISTED:
            self._list(event)
        if changed:
            self.window = _choose_window(after.motion)
        if event.name in RESTARTS:
            self.traced, self._last = 0, -math.inf

    def _list(self, event: Event) -> None:
        """Add an event to the history; a slider or a held button sends many of one kind."""
        if self.history and self.history[-1].name == event.name and event.name in REPEATED:
            self.history.pop()
        self.history.append(event)

    def _continue_time(self, event: Event, before: Segment | None, after: Segment) -> None:
        """Continue the time of the run after an event.

        It is the time of the motion plus an offset, which changes with the motion only. A step
        advances both, and a jump of the clock neither.
        """
        if before is None:
            self._offset = -after.elapsed_at(event.stamp)
        elif event.name in ANNOUNCED or not _is_same(before.motion, after.motion):
            self._offset += before.elapsed_at(event.stamp) - after.elapsed_at(event.stamp)

    def _run_time(self, segment: Segment, stamp: int) -> float:
        return float((self._offset + segment.elapsed_at(stamp)) / 10**9)

    def _take_samples(self, orientation: Columns, segment: Segment) -> None:
        stamps, motion = orientation.stamps, segment.motion
        end = segment.time_at(int(stamps[-1]))
        if not StepBudget().reach(motion, end, MOST_STEPS):
            return  # a driven motion is too fast: the next samples find it further on
        times = np.broadcast_to(segment.time_at(stamps), stamps.shape)
        times = times + float(self._offset / 10**9)
        # The attitude is the published one; the rates follow from the motion, which is exact.
        quaternions = orientation.numbers[:, [3, 0, 1, 2]]
        rates = np.broadcast_to(segment.state_at(stamps).angular_velocity, (len(stamps), 3)).copy()
        self.stamp, self.state = int(stamps[-1]), State.wrap(quaternions[-1], rates[-1])
        self.time = float(times[-1])
        last = self._rows[self._count - 1, 0] if self._count else -math.inf
        fresh = np.flatnonzero(np.diff(times, prepend=last) > SAME_TIME)
        if len(fresh):
            states = State.wrap(quaternions[fresh], rates[fresh])
            self._extend_series(times[fresh], states, self._find_ghost(stamps[fresh]))
        self._extend_trace(times, State.wrap(quaternions, rates))

    def _find_ghost(self, stamps: NDArray[np.int64]) -> Real:
        """Return the tilt of the ghost at some stamps; nan if there is no ghost."""
        ghost = self.ghost.reach(int(stamps[-1]))
        if ghost is None:
            return np.full(len(stamps), np.nan)
        return np.broadcast_to(ghost.state_at(stamps).euler_angles.theta, stamps.shape)

    def _extend_series(self, times: Real, states: State, ghost: Real) -> None:
        top = self.segment.motion.top if self.segment else None
        if top is None:
            return
        rates = states.euler_rates
        columns = [
            times,
            states.euler_angles.theta,
            rates.phi,
            rates.psi,
            top.energy(states),
            top.axial_momentum(states),
            top.vertical_momentum(states),
            ghost,
        ]
        self._make_room(len(times))
        self._rows[self._count : self._count + len(times)] = np.stack(columns, axis=1)
        self._count += len(times)

    def _make_room(self, count: int) -> None:
        """Drop the oldest rows, many at once: each move of the others takes time."""
        if self._count + count > len(self._rows):
            kept = self._rows[self._count - ROWS + count : self._count].copy()
            self._dropped += self._count - len(kept)
            self._rows[: len(kept)], self._count = kept, len(kept)

    def _extend_trace(self, times: Real, states: State) -> None:
        """Add points at equal distances in time, so that the trace lasts for the window."""
        period = self.window / TRACE
        for time, point in zip(times.tolist(), _axis(states), strict=True):
            if self._last == -math.inf:
                self.axes[:], self._last = point, time
            if time >= self._last + period:
                self.axes[:-1] = self.axes[1:]
                self.traced, self._last = self.traced + 1, time
            self.axes[-1] = point


def _is_same(before: Motion, after: Motion) -> bool:
    """Return True if both are the motion of one top from one start."""
    first, second = (
        (each.top, each.start, each.friction, each.applied_torque) for each in (before, after)
    )
    return first == second


def _axis(states: State) -> Real:
    """Return the symmetry axis in the world frame (n, 3)."""
    return states.to_world(np.broadcast_to([0.0, 0.0, 1.0], (len(states.orientation), 3)))


def _choose_window(motion: Motion) -> float:
    """Return the time (s) for trace and plots: one turn of the precession, or some nutations."""
    rate, nutation = motion.mean_precession_rate, motion.nutation_period
    turn = 2 * math.pi / abs(rate) if rate else math.inf
    shown = min(turn, TRACE_NUTATIONS * nutation)
    return min(max(shown, 0.05), 30.0) if math.isfinite(shown) else 5.0
