"""The run that the page shows: its history, motion, ghost, trace and series."""

import math
from collections import deque
from collections.abc import Mapping

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.drawing.ghost import Ghost
from symtop_ros.log.batch import Batch, Columns
from symtop_ros.panel.source import DRAWN
from symtop_ros.physics import EffectivePotential, Motion, State
from symtop_ros.session.summary import constants_of_motion
from symtop_ros.simulation.budget import StepBudget
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment

SERIES = ("theta", "phi_dot", "psi_dot", "energy", "L_z", "L_z'")
UNITS = ("rad", "rad/s", "rad/s", "J", "N m s", "N m s")
ROWS = 20_000  # samples in the series at least: 100 s of the clock at 200 Hz
TRACE = 240  # lines of the trace
TRACE_NUTATIONS = 12  # longest trace and longest plot, in nutations
MOST_STEPS = 3000  # of an integration, for one batch
HISTORY = 100  # events, as many as the node keeps
# Events that are no act of a user, or that change nothing of the motion.
UNLISTED = ("pause", "resume", "step", "record", "pace", "clock", "failure")
REPEATED = ("start", "reset", "parameters", "torque")  # of several in a row the last is listed


class Run:
    """State of the page, from the events and samples of a run."""

    def __init__(self) -> None:
        # the motion of the last event, None before the first one
        self.segment: Segment | None = None
        self.event: Event | None = None  # the last event
        self.verdict = ""  # effect of the last start, kick or change, in a sentence
        self.ghost = Ghost()  # the run without its last kick
        # starts, kicks and changes, the newest last
        self.history: deque[Event] = deque(maxlen=HISTORY)
        self.state: State | None = None  # the state of the last sample
        self.stamp = 0  # its stamp in ns
        self.is_recording = False  # True while a log is written
        self.window = 1.0  # time (s of the motion) that the plots show
        # points of the trace in scene units, the newest last
        self.axes: Real = np.zeros((TRACE + 1, 3))
        self._rows: Real = np.empty((2 * ROWS, 1 + len(SERIES)))
        self._count = 0  # of the rows in use
        self._begin = 0.0  # s of the run at the last event
        self._traced: float | None = None  # s of the run at the newest point of the trace

    def follow(self, batch: Batch) -> list[Event]:
        """Take over events and samples in their order; return the events."""
        for event, columns in batch.stretches():
            if event:
                self._take_event(event)
            if columns and self.segment:
                self._take_samples(columns, self.segment)
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
        """Return time of the run (s) and the quantities of `SERIES`, (n, 7)."""
        return self._rows[: self._count]

    def csv(self) -> str:
        """Return the series as comma-separated values, in decimals that read back the same."""
        names = [f"{name} ({unit})" for name, unit in zip(SERIES, UNITS, strict=True)]
        rows = (",".join(map(repr, row)) for row in self.series().tolist())
        return "\n".join([",".join(["time (s)", *names]), *rows, ""])

    def _take_event(self, event: Event) -> None:
        before, after = self.segment, event.segment()
        self._begin = self._time_after(event, before, after)
        self.segment, self.event = after, event
        self.ghost.follow(event.name, before, after)
        if event.name == "record":
            verdict = event.verdict
            self.is_recording = verdict.startswith("recording to ") and not verdict.endswith(
                "ended"
            )
        if event.name not in UNLISTED:
            self.verdict = event.verdict
            self._list(event)
        if before is None or after.motion != before.motion:
            self.window = _choose_window(after.motion)
        if event.name in ("start", "reset"):
            self._traced = None

    def _list(self, event: Event) -> None:
        """Add an event to the history; a slider or a held button sends many of one kind."""
        if self.history and self.history[-1].name == event.name and event.name in REPEATED:
            self.history.pop()
        self.history.append(event)

    def _time_after(self, event: Event, before: Segment | None, after: Segment) -> float:
        """Return the time of the run (s) at an event; a step takes no time of the clock."""
        if before is None:
            return 0.0
        elapsed = before.elapsed_at(event.stamp) - before.elapsed
        if event.name == "step":
            elapsed += after.elapsed - before.elapsed_at(event.stamp)
        return self._begin + float(elapsed) * 1e-9

    def _take_samples(self, columns: Mapping[str, Columns], segment: Segment) -> None:
        orientation = columns[DRAWN]
        stamps, motion = orientation.stamps, segment.motion
        end = segment.time_at(int(stamps[-1]))
        if not StepBudget().reach(motion, end, MOST_STEPS):
            return  # a driven motion is too fast: the next samples find it further on
        elapsed = segment.time_at(stamps) - segment.time_at(segment.stamp)
        times = self._begin + np.broadcast_to(elapsed, stamps.shape)
        # The attitude is the published one; the rates follow from the motion, which is exact.
        quaternions = orientation.numbers[:, [3, 0, 1, 2]]
        rates = np.broadcast_to(segment.state_at(stamps).angular_velocity, (len(stamps), 3)).copy()
        self.stamp, self.state = int(stamps[-1]), State.wrap(quaternions[-1], rates[-1])
        last = self._rows[self._count - 1, 0] if self._count else -math.inf
        fresh = np.flatnonzero(times > last)
        if len(fresh):
            self._extend_series(times[fresh], State.wrap(quaternions[fresh], rates[fresh]))
        self._extend_trace(times, State.wrap(quaternions, rates))

    def _extend_series(self, times: Real, states: State) -> None:
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
        ]
        self._make_room(len(times))
        self._rows[self._count : self._count + len(times)] = np.stack(columns, axis=1)
        self._count += len(times)

    def _make_room(self, count: int) -> None:
        """Drop the oldest rows, many at once: each move of the others takes time."""
        if self._count + count > len(self._rows):
            kept = self._rows[self._count - ROWS + count : self._count].copy()
            self._rows[: len(kept)], self._count = kept, len(kept)

    def _extend_trace(self, times: Real, states: State) -> None:
        """Add points at equal distances in time, so that the trace lasts for the window."""
        period = self.window / TRACE
        if self._traced is None:
            self.axes[:] = _axis(states)[0]
            self._traced = float(times[0])
        for time, point in zip(times.tolist(), _axis(states), strict=True):
            if time >= self._traced + period:
                self.axes[:-1] = self.axes[1:]
                self._traced = time
            self.axes[-1] = point


def _axis(states: State) -> Real:
    """Return the symmetry axis in the world frame (n, 3)."""
    return states.to_world(np.broadcast_to([0.0, 0.0, 1.0], (len(states.orientation), 3)))


def _choose_window(motion: Motion) -> float:
    """Return the time (s) for trace and plots: one turn of the precession, or some nutations."""
    rate, nutation = motion.mean_precession_rate, motion.nutation_period
    turn = 2 * math.pi / abs(rate) if rate else math.inf
    shown = min(turn, TRACE_NUTATIONS * nutation)
    return min(max(shown, 0.05), 30.0) if math.isfinite(shown) else 5.0
