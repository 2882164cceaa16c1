"""The exact motion of a run, at any stamps, from the events of the run."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Real, Stamps, compose
from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.log.intervals import partition
from symtop_ros.run.simulation.budget import SPARE_STEPS, StepBudget
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.events import Event, start_event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.truth.topics.estimates import Estimates

if TYPE_CHECKING:  # logs need mcap
    from symtop_ros.run.log.catalog import Catalog


class Truth:
    """The exact states of a run.

    Each stamp belongs to the last event up to it, so that kicks, pauses and changes of the
    real-time factor are followed at their very instants. No state is known where events are lost,
    and at stamps that a log has twice, as a clock that goes back leaves them. An event that is
    added to a run that is under way replaces what it repeats.
    """

    def __init__(self, events: Sequence[Event] = (), end: int | None = None) -> None:
        self.end = end  # stamp of the last sample in ns; None: the run has no known end
        self._begins: list[int] = []  # stamps in ns from which on each of the following holds
        # the motion after an event; None where it is not known
        self._segments: list[Callable[[], Segment] | None] = []
        self._is_repeated: list[bool] = []  # True if more than one motion may hold
        self._budget = StepBudget(SPARE_STEPS)
        for event in events:
            self.add(event)

    def add(self, event: Event) -> None:
        """Add the next event of the run."""
        self._add(event.stamp, cache(event.segment))

    def _add(
        self, begin: int, segment: Callable[[], Segment] | None, is_repeated: bool = False
    ) -> None:
        columns: tuple[list[Any], ...] = self._begins, self._segments, self._is_repeated
        while self._begins and self._begins[-1] > begin:
            for column in columns:
                column.pop()
        for column, value in zip(columns, (begin, segment, is_repeated), strict=True):
            column.append(value)

    @classmethod
    def of(cls, catalog: Catalog) -> Truth:
        """Return what the catalog of a log knows, up to its last sample."""
        truth = cls(end=catalog.end)
        segments = {
            id(each.event): cache(each.event.segment) for each in catalog.intervals if each.event
        }
        for begin, holding in partition(catalog.intervals):
            event = holding[0].event if len(holding) == 1 else None
            truth._add(begin, segments[id(event)] if event else None, len(holding) > 1)
        return truth

    @property
    def begin(self) -> int | None:
        """Stamp at which the run begins in ns, or None."""
        return self._begins[0] if self._begins else None

    @property
    def latest(self) -> int | None:
        """Stamp in ns of the latest event, or None."""
        return self._begins[-1] if self._begins else None

    @property
    def _only(self) -> Segment | None:
        """The segment of a run of one motion, all of which may not be known; None for several."""
        known = {*filter(None, self._segments)}
        return known.pop()() if len(known) == 1 else None

    @property
    def is_driven(self) -> bool:
        """True if friction or a torque acts at the start: no motion repeats."""
        first = next(filter(None, self._segments), None)
        return first is not None and first().motion.is_driven

    @property
    def kind(self) -> str:
        """Kind of the motion of a run of one motion; empty for several."""
        return self._only.motion.kind if self._only else ""

    @property
    def period(self) -> float | None:
        """Nutation period under gravity of a run of one motion in s of its clock, or None."""
        segment = self._only
        if segment is None:
            return None
        period = segment.motion.nutation_period / segment.factor
        return float(period) if np.isfinite(period) and period > 0 else None

    @property
    def rates(self) -> dict[str, float]:
        """Mean rates in rad/s of the motion of a run of one motion, by name; empty for others."""
        segment = self._only
        if segment is None or segment.motion.is_driven:
            return {}
        motion = segment.motion
        rates = {
            "nutation": motion.nutation_rate,
            "spin": motion.mean_spin_rate,
            "precession": motion.mean_precession_rate,
        }
        found = {name: float(rate) * segment.factor for name, rate in rates.items()}
        return {name: rate for name, rate in found.items() if math.isfinite(rate)}

    @property
    def frequencies(self) -> dict[str, float]:
        """Frequencies in Hz of these rates."""
        return {name: abs(rate) / math.tau for name, rate in self.rates.items() if rate}

    def find_unjudged(self, stamps: Stamps) -> Mask:
        """Return the mask of the stamps within the run at which the motion is not known."""
        return self._find(stamps, [each is None for each in self._segments])

    def find_repeated(self, stamps: Stamps) -> Mask:
        """Return the mask of those stamps at which more than one motion may hold."""
        return self._find(stamps, self._is_repeated)

    def _find(self, stamps: Stamps, wanted: Sequence[bool]) -> Mask:
        owners = self._find_owners(stamps)
        is_there = owners >= 0
        is_there[is_there] = np.array(wanted, dtype=bool)[owners[is_there]]
        return is_there

    def _find_owners(self, stamps: Stamps) -> Places:
        """Return the number of the segment that holds at each stamp; -1 outside of the run."""
        owners = np.searchsorted(self._begins, stamps, side="right") - 1
        end = np.iinfo(np.int64).max if self.end is None else self.end
        return np.where(stamps <= end, owners, -1)

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
        owners = self._find_owners(stamps)
        for number in np.unique(owners[owners >= 0]).tolist():
            chosen = owners == number
            find_segment = self._segments[number]
            segment = find_segment() if find_segment else None
            if segment and self._budget.reach_stamps(segment, stamps[chosen]):
                q, omega = segment.state_at(stamps[chosen])._parts
                if of_sensor and (imu := segment.rig.imu):
                    q, omega = compose(q, imu.mount.orientation), imu.mount.to_body(omega)
                orientations[chosen], rates[chosen] = q, omega
                known[chosen] = True
        return orientations, rates, known

    def select(self, estimates: Estimates) -> Estimates:
        """Return the estimates at stamps of which the exact motion is known."""
        return estimates.select(self.states_at(estimates.stamps, estimates.of_sensor)[2])


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
