"""A log against the closed form: the whole run computed again from its events."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symtop_ros.playback.top_log import Columns, TopLog
from symtop_ros.run.events import Event
from symtop_ros.run.samples import SAMPLES
from symtop_ros.run.segment import Segment

Real = NDArray[np.float64]

# Another machine's sine or arctangent may differ in the last place, and a motion next to the
# separatrix stretches that: 12 eps is the worst that was seen. This leaves a factor of five.
ROUNDING = 64 * float(np.finfo(float).eps)


@dataclass
class Deviation:
    """How far the samples of one topic are from what they should be.

    Attributes
    ----------
    samples : int
        Checked.
    largest : float
        Largest difference of a number.
    relative : float
        Largest difference over what the numbers are as large as.
    unchecked : int
        Samples before the first event, or without one.
    """

    samples: int = 0
    largest: float = 0.0
    relative: float = 0.0
    unchecked: int = 0

    @property
    def is_rounding(self) -> bool:
        """Whether the samples are right."""
        return self.relative <= ROUNDING

    def add(self, difference: Real, scale: Real) -> None:
        """Take the differences of some samples, and the sizes of the numbers, both (n, width)."""
        self.samples += len(difference)
        wrong = difference != 0  # nan too
        if wrong.any():
            with np.errstate(divide="ignore"):
                relative = difference[wrong] / scale[wrong]
            self.largest = max(self.largest, _largest(difference))
            self.relative = max(self.relative, _largest(relative))


def _largest(numbers: Real) -> float:
    """Largest of some numbers; infinity where one of them is none."""
    return float(np.nan_to_num(numbers, nan=np.inf).max(initial=0.0))


def check(log: TopLog) -> dict[str, Deviation]:
    """Return the deviations by the names of `run.samples`, of the topics that are there."""
    deviations: dict[str, Deviation] = {}
    segment: Segment | None = None
    for batch in log.batches():
        segments = [segment, *(event.segment() for _, event in batch.events)]
        for name, columns in batch.columns.items():
            deviation = deviations.setdefault(name, Deviation())
            owners = _owners(columns, batch.events)
            for owner in np.unique(owners):
                _compare(deviation, name, columns, owners == owner, segments[owner])
        segment = segments[-1]
    return deviations


def _owners(columns: Columns, events: list[tuple[int, Event]]) -> NDArray[np.intp]:
    """Return which event each sample comes after; 0 for what was before all of them.

    The node logs an event before the samples it governs. Others write in the order of arrival:
    there the stamps decide, unless the clock has jumped.
    """
    owners = np.searchsorted([place for place, _ in events], columns.places, side="right")
    for number, (_, event) in enumerate(events, start=1):
        if event.name != "clock":
            later = columns.stamps >= event.stamp
            owners[(owners == number - 1) & later] = number
            owners[(owners == number) & ~later] = number - 1
    return owners


def _compare(
    deviation: Deviation,
    name: str,
    columns: Columns,
    which: NDArray[np.bool_],
    segment: Segment | None,
) -> None:
    stamps, logged = columns.stamps[which], columns.numbers[which]
    if segment is None:
        deviation.unchecked += len(stamps)
        return
    computed = SAMPLES[name](segment.path.top, segment.state_at(stamps))
    computed = np.broadcast_to(computed, logged.shape)
    difference = np.abs(logged - computed)
    scale = np.concatenate([_size(block) for block in _blocks(computed)], axis=1)
    if name == "euler_angles":
        turns = np.abs(difference[:, :3] - 2 * np.pi)
        difference[:, :3] = np.minimum(difference[:, :3], turns)
        with np.errstate(divide="ignore"):  # on the vertical itself phi and psi mean nothing
            scale = np.maximum(scale, 1.0) / np.abs(np.sin(computed[:, 1:2]))
    deviation.add(difference, scale)


def _blocks(numbers: Real) -> list[Real]:
    """The quantities of a message: all in one, or three numbers and the rest."""
    return [numbers] if numbers.shape[1] < 6 else [numbers[:, :3], numbers[:, 3:]]


def _size(block: Real) -> Real:
    """Largest number, for each of them."""
    return np.full_like(block, np.abs(block).max(initial=0.0))
