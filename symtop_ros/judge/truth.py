"""The exact motion of a run, at any stamps, from the events of the run."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from symtop_ros.arrays import Mask, Real, Stamps, compose
from symtop_ros.judge.estimates import Estimates
from symtop_ros.simulation.budget import SPARE_STEPS, StepBudget
from symtop_ros.simulation.changes.requests import start_motion
from symtop_ros.simulation.events import Event, start_event
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.validation import RefusedError

if TYPE_CHECKING:  # logs need mcap
    from symtop_ros.log.top_log import TopLog


class Truth:
    """The exact states of a run.

    Each stamp belongs to the last event up to it, so that kicks, pauses and changes of the
    real-time factor are followed at their very instants. If the clock of the run jumped back, the
    later run replaces what it repeats.
    """

    def __init__(self, events: Sequence[Event] = (), end: int | None = None) -> None:
        self.end = end  # stamp of the last sample in ns; None: the run has no known end
        self._events: list[Event] = []
        self._segments: list[Callable[[], Segment]] = []  # of the events
        self._budget = StepBudget(SPARE_STEPS)
        for event in events:
            self.add(event)

    def add(self, event: Event) -> None:
        """Add the next event of the run."""
        while self._events and self._events[-1].stamp > event.stamp:
            self._events.pop()
            self._segments.pop()
        self._events.append(event)
        self._segments.append(cache(event.segment))

    @property
    def begin(self) -> int | None:
        """Stamp of the first event in ns, or None."""
        return self._events[0].stamp if self._events else None

    @property
    def is_driven(self) -> bool:
        """True if friction or a torque acts at the start: no motion repeats."""
        return bool(self._events) and self._segments[0]().motion.is_driven

    @property
    def kind(self) -> str:
        """Kind of the motion of a run of one motion; empty for several."""
        return self._segments[0]().motion.kind if len(self._events) == 1 else ""

    @property
    def period(self) -> float | None:
        """Nutation period under gravity of a run of one motion in s of its clock, or None."""
        if len(self._events) != 1:
            return None
        segment = self._segments[0]()
        period = segment.motion.nutation_period / segment.factor
        return float(period) if np.isfinite(period) and period > 0 else None

    def count_outside(self, stamps: Stamps) -> tuple[int, int]:
        """Return how many stamps are before the run, and how many after its last sample."""
        early = 0 if self.begin is None else int((stamps < self.begin).sum())
        return early, 0 if self.end is None else int((stamps > self.end).sum())

    def states_at(self, stamps: Stamps, of_sensor: bool = False) -> tuple[Real, Real, Mask]:
        """Return quaternions (n, 4), rates (n, 3) and the mask of those known, at stamps.

        They are those of the body and in its frame; with `of_sensor` those of the sensor that is
        mounted on it.
        """
        orientations, rates = np.zeros((len(stamps), 4)), np.zeros((len(stamps), 3))
        orientations[:, 0] = 1.0
        known = np.zeros(len(stamps), dtype=bool)
        inside = stamps <= (np.iinfo(np.int64).max if self.end is None else self.end)
        owners = np.searchsorted([each.stamp for each in self._events], stamps, side="right") - 1
        for number in np.unique(owners[inside & (owners >= 0)]).tolist():
            chosen = inside & (owners == number)
            segment = self._segments[number]()
            if self._budget.reach_stamps(segment, stamps[chosen]):
                q, omega = segment.state_at(stamps[chosen]).parts
                if of_sensor and (imu := segment.rig.imu):
                    q, omega = compose(q, imu.mount.orientation), imu.mount.to_body(omega)
                orientations[chosen], rates[chosen] = q, omega
                known[chosen] = True
        return orientations, rates, known

    def select(self, estimates: Estimates) -> Estimates:
        """Return the estimates at stamps of which the exact motion is known."""
        return estimates.select(self.states_at(estimates.stamps, estimates.of_sensor)[2])


def read_truth(log: TopLog) -> Truth:
    """Return the exact motion of the run in a log, up to its last sample."""
    events: list[Event] = []
    ends: list[int] = []
    for batch in log.batches():
        events += (event for _, event in batch.events)
        ends += (int(columns.stamps.max()) for columns in batch.columns.values())
    if not events:
        raise RefusedError(f"{log.file.path} must have the events of a top (~/events), got none")
    return Truth(events, max(ends, default=None))


def scene_truth(name: str) -> Truth:
    """Return the exact motion of a scene that starts at the stamp 0."""
    return Truth([start_event(start_motion(Settings.from_scene(name)))])


def read_events(path: Path) -> Truth:
    """Return the exact motion of a run whose events are in a JSON file of `top_imu`."""
    try:
        facts = json.loads(path.read_text(encoding="utf-8"))
        events = [Event(**each) for each in facts["events"]]
        texts = [text for each in events for text in (each.name, *each.values.values())]
        if not all(type(each.stamp) is int for each in events) or set(map(type, texts)) - {str}:
            raise TypeError
        return Truth(events, int(facts["end"]))
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError):
        raise RefusedError(f"{path} must have the events of a run as top_imu writes them") from None
