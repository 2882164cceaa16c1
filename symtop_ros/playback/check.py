"""A log against the closed form: the whole run computed again from its events."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symtop_ros.playback.batch import Columns
from symtop_ros.playback.patience import Patience
from symtop_ros.playback.top_log import TopLog
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
    unreached : int
        Samples of a motion too fast, or too long, to be integrated for a check.
    """

    samples: int = 0
    largest: float = 0.0
    relative: float = 0.0
    unchecked: int = 0
    unreached: int = 0

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
    patience = Patience()
    for batch in log.batches():
        for event, samples in batch.stretches():
            segment = event.segment() if event else segment
            for name, columns in samples.items():
                deviation = deviations.setdefault(name, Deviation())
                if segment and _reached(segment, columns, patience):
                    with np.errstate(all="ignore"):
                        _compare(deviation, name, columns, segment)
                elif segment:
                    deviation.unreached += len(columns.stamps)
                else:
                    deviation.unchecked += len(columns.stamps)
    return deviations


def _reached(segment: Segment, columns: Columns, patience: Patience) -> bool:
    """Whether the states of some samples can be computed in a time that makes sense."""
    times = np.atleast_1d(segment.time_at(columns.stamps))
    ends = float(times.min()), float(times.max())
    return patience.reaches(segment.path, ends, len(columns.stamps))


def _compare(deviation: Deviation, name: str, columns: Columns, segment: Segment) -> None:
    states = segment.state_at(columns.stamps)
    computed = SAMPLES[name](segment.path, states)
    computed = np.broadcast_to(computed, columns.numbers.shape)
    difference = np.abs(columns.numbers - computed)
    scale = np.concatenate([_size(block) for block in _blocks(computed)], axis=1)
    if name == "euler_angles":
        turns = np.abs(difference[:, :3] - 2 * np.pi)
        difference[:, :3] = np.minimum(difference[:, :3], turns)
        with np.errstate(divide="ignore"):  # on the vertical itself phi and psi mean nothing
            scale = np.maximum(scale, 1.0) / np.abs(np.sin(computed[:, 1:2]))
    if segment.path.driven:
        # integrated in steps: what differs in the last place of a rate grows with the phase
        rate = np.abs(states.angular_velocity).max(axis=-1)
        phase = rate * np.abs(segment.time_at(columns.stamps))
        scale = scale * (1 + np.broadcast_to(phase, len(scale))[:, np.newaxis])
    deviation.add(difference, scale)


def _blocks(numbers: Real) -> list[Real]:
    """The quantities of a message: all in one, or three numbers and the rest."""
    return [numbers] if numbers.shape[1] < 6 else [numbers[:, :3], numbers[:, 3:]]


def _size(block: Real) -> Real:
    """Largest number, for each of them."""
    return np.full_like(block, np.abs(block).max(initial=0.0))
