"""Check of a log: the whole run is computed again from its events and compared."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.log.batch import Columns
from symtop_ros.log.top_log import TopLog
from symtop_ros.physics import Motion
from symtop_ros.simulation.segment import RoundedSegment, Segment
from symtop_ros.simulation.topics import SAMPLE_TOPICS, Samples
from symtop_ros.wire.messages import IMU_WIDTH, ODOMETRY_WIDTH

# On the machine that recorded, all differences are 0. Sine and arctangent of another machine may
# differ in the last place, and a motion next to the separatrix amplifies that: the largest
# difference seen was 12 eps, and the bound leaves a factor of five.
BOUND = 64 * float(np.finfo(float).eps)
# Steps of the integration that a check of an integrated motion may take. A hostile log could ask
# for a motion that takes years to integrate.
STEPS_AT_ONCE = 1500  # about a tenth of a second
STEPS_PER_SAMPLE = 60  # a node may have taken as many for each sample
SPARE_STEPS = 3_000_000  # for what precedes the log
# A motion that slows down is followed in longer steps, so an estimate of the remaining work may be
# this many times too large.
OPTIMISM = 10.0
# Version 0.1 integrated by a splitting. Its error was up to 2e-11 for each radian by which the body
# turned: so many times as large as `BOUND`.
SPLITTING_ERROR = 1500.0
# First doubles of the quantities of an Imu and of an Odometry; of other messages with six doubles
# or more the first three are one quantity, the rest another.
BOUNDARIES = {IMU_WIDTH: (4, 13, 16, 25, 28), ODOMETRY_WIDTH: (3, 7, 43, 46, 49)}


@dataclass
class Deviation:
    """Difference between the samples of one topic and their computed values."""

    samples: int = 0  # number of samples that were compared
    largest: float = 0.0  # largest absolute difference
    relative: float = 0.0  # largest difference divided by the size of the quantity
    unchecked: int = 0  # samples before the first event
    # samples of a motion that is too fast or too long to be integrated for a check
    unreached: int = 0

    @property
    def is_rounding(self) -> bool:
        """True if the samples agree up to rounding."""
        return self.relative <= BOUND

    def add(self, difference: Real, scale: Real) -> None:
        """Add absolute differences of samples and the sizes of the quantities, (n, width)."""
        self.samples += len(difference)
        wrong = difference != 0  # True for nan
        if wrong.any():
            with np.errstate(divide="ignore"):
                relative = difference[wrong] / scale[wrong]
            self.largest = max(self.largest, _largest(difference))
            self.relative = max(self.relative, _largest(relative))


def _largest(numbers: Real) -> float:
    """Return the largest number; infinity if one is nan."""
    return float(np.nan_to_num(numbers, nan=np.inf).max(initial=0.0))


class StepLimit:
    """Limits the integration steps that are spent on one log."""

    def __init__(self, spare: int = SPARE_STEPS) -> None:
        self._spare = spare

    def allows(self, motion: Motion, times: tuple[float, ...], samples: int) -> bool:
        """Integrate a motion to some times (s); return False if that takes too many steps."""
        try:
            return all(
                self._reach(motion, t, STEPS_AT_ONCE + STEPS_PER_SAMPLE * samples) for t in times
            )
        except ValueError:  # the motion is too fast for doubles
            return False

    def _reach(self, motion: Motion, t: float, free: int) -> bool:
        begin = motion.reach(t, 0)
        while free + self._spare > 0:
            reached = motion.reach(t, STEPS_AT_ONCE)
            if reached == t:
                return True
            self._spare -= max(0, STEPS_AT_ONCE - max(0, free))
            free -= STEPS_AT_ONCE
            left = max(0, free) + self._spare
            if abs(t - reached) * STEPS_AT_ONCE > OPTIMISM * left * abs(reached - begin):
                return False
            begin = reached
        return False


def check_log(log: TopLog) -> dict[str, Deviation]:
    """Return the deviation of each topic in a log, by its name in `simulation.topics`."""
    deviations: dict[str, Deviation] = {}
    segment: Segment | None = None
    limit = StepLimit()
    for batch in log.batches():
        for event, samples in batch.stretches():
            segment = event.segment() if event else segment
            for name, columns in samples.items():
                deviation = deviations.setdefault(name, Deviation())
                if segment and _is_reachable(segment, columns, limit):
                    with np.errstate(all="ignore"):
                        _compare(deviation, name, columns, segment)
                elif segment:
                    deviation.unreached += len(columns.stamps)
                else:
                    deviation.unchecked += len(columns.stamps)
    return deviations


def _is_reachable(segment: Segment, columns: Columns, limit: StepLimit) -> bool:
    ends = tuple(
        segment.time_at(int(stamp)) for stamp in (columns.stamps.min(), columns.stamps.max())
    )
    return limit.allows(segment.motion, ends, len(columns.stamps))


def _compare(deviation: Deviation, name: str, columns: Columns, segment: Segment) -> None:
    samples = Samples.at(segment, columns.stamps)
    computed = SAMPLE_TOPICS[name].compute(samples)
    computed = np.broadcast_to(computed, columns.numbers.shape)
    difference = np.abs(columns.numbers - computed)
    difference[np.isnan(columns.numbers) & np.isnan(computed)] = 0.0  # a force that is unknown
    computed = np.nan_to_num(computed)
    scale = np.concatenate([_size(part) for part in _quantities(computed)], axis=1)
    if name == "euler_angles":
        # -pi and pi are the same angle
        turns = np.abs(difference[:, :3] - 2 * np.pi)
        difference[:, :3] = np.minimum(difference[:, :3], turns)
        with np.errstate(divide="ignore"):  # on the vertical phi and psi are undefined
            scale = np.maximum(scale, 1.0) / np.abs(np.sin(computed[:, 1:2]))
    if segment.motion.is_driven:
        # A difference in the last place of a rate grows with the phase of the motion.
        rate = np.abs(samples.state.angular_velocity).max(axis=-1)
        phase = rate * np.abs(segment.time_at(columns.stamps))
        phase *= SPLITTING_ERROR if isinstance(segment, RoundedSegment) else 1.0
        scale = scale * (1 + np.broadcast_to(phase, len(scale))[:, np.newaxis])
    deviation.add(difference, scale)


def _quantities(numbers: Real) -> list[Real]:
    """Split the doubles of a message into its quantities, by its width."""
    width = numbers.shape[1]
    return np.split(numbers, BOUNDARIES.get(width, (3,) if width >= 6 else ()), axis=1)


def _size(part: Real) -> Real:
    """Return the largest absolute value of a quantity, in its shape."""
    return np.full_like(part, np.abs(part).max(initial=0.0))
