"""The exact motion of a run, at any stamps, from the events of the run."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real, Stamps
from symtop_ros.log.reader import LogError
from symtop_ros.log.top_log import TopLog
from symtop_ros.simulation.budget import SPARE_STEPS, StepBudget
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment


class Truth:
    """The exact states of a run.

    Each stamp belongs to the last event up to it, so that kicks, pauses and changes of the
    real-time factor are followed at their very instants. If the clock of the run jumped back, the
    later run replaces what it repeats.
    """

    def __init__(self, events: Sequence[Event] = ()) -> None:
        self._events: list[Event] = []
        self._segments: dict[int, Segment] = {}  # by the number of the event
        self._budget = StepBudget(SPARE_STEPS)
        for event in events:
            self.add(event)

    def add(self, event: Event) -> None:
        """Add the next event of the run."""
        while self._events and self._events[-1].stamp > event.stamp:
            self._events.pop()
            self._segments.pop(len(self._events), None)
        self._events.append(event)

    @property
    def begin(self) -> int | None:
        """Stamp of the first event in ns, or None."""
        return self._events[0].stamp if self._events else None

    def states_at(self, stamps: Stamps) -> tuple[Real, Real, NDArray[np.bool_]]:
        """Return quaternions (n, 4), body rates (n, 3) and the mask of those known, at stamps."""
        orientations, rates = np.zeros((len(stamps), 4)), np.zeros((len(stamps), 3))
        orientations[:, 0] = 1.0
        known = np.zeros(len(stamps), dtype=bool)
        begins = [event.stamp for event in self._events]
        owners = np.searchsorted(begins, stamps, side="right") - 1
        for number in np.unique(owners[owners >= 0]).tolist():
            chosen = owners == number
            segment = self._segment(number)
            if self._budget.reach_stamps(segment, stamps[chosen]):
                orientations[chosen], rates[chosen] = segment.state_at(stamps[chosen])
                known[chosen] = True
        return orientations, rates, known

    def _segment(self, number: int) -> Segment:
        if number not in self._segments:
            self._segments[number] = self._events[number].segment()
        return self._segments[number]


def read_truth(log: TopLog) -> Truth:
    """Return the exact motion of the run in a log."""
    truth = Truth([event for batch in log.batches() for _, event in batch.events])
    if truth.begin is None:
        raise LogError(f"{log.file.path} must have the events of a top (~/events), got none")
    return truth
