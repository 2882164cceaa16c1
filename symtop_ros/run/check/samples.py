"""Check of a log: the whole run is computed again from its events and compared."""

from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Places, Real
from symtop_ros.run.log.batch import Batch, Columns
from symtop_ros.run.log.catalog import Catalog
from symtop_ros.run.log.event_order import EventOrder
from symtop_ros.run.log.intervals import Unknown
from symtop_ros.run.simulation.budget import SPARE_STEPS, StepBudget
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, STATE_TOPICS, Samples

# Under gravity alone a state has the same bits on every machine. So have all numbers that follow
# from it by products, sums and the arc tangent of this package, and no difference is accepted in
# them. The noise of the sensor uses a function whose last place depends on the version of SciPy,
# and version 0.3 recorded driven motions with other bits. The largest difference seen was 12 eps;
# the bound leaves a factor of five.
BOUND = 64 * float(np.finfo(float).eps)
# Another version differs in many samples. A difference in fewer than this share is damage, however
# small it is.
LEAST_SHARE = 0.01


@dataclass
class Deviation:
    """Difference between the samples of one topic and their computed values."""

    samples: int = 0  # number of samples that were compared
    differing: int = 0  # number of those that are not the same to the last bit
    exact: int = 0  # number of those that have the same bits on every machine
    largest: float = 0.0  # largest absolute difference
    relative: float = 0.0  # largest difference divided by the size of the quantity
    unchecked: int = 0  # samples before the first event
    # samples of a motion that is too fast or too long to be integrated for a check
    unreached: int = 0
    # samples where the motion is not known, and which do not agree with an event that is there
    unjudged: int = 0

    @property
    def is_rounding(self) -> bool:
        """True if the samples agree, up to rounding of another version where that is possible."""
        is_common = self.differing == 0 or self.differing >= LEAST_SHARE * self.samples
        return self.relative <= BOUND and is_common and not self.exact

    def add(self, difference: Real, scale: Real, is_exact: bool = False) -> None:
        """Add absolute differences of samples and the sizes of the quantities, (n, width)."""
        self.samples += len(difference)
        wrong = difference != 0  # True for nan
        count = int(wrong.any(axis=1).sum())
        self.differing += count
        self.exact += count if is_exact else 0
        self.largest = max(self.largest, _largest(difference))
        self.relative = max(self.relative, _largest(difference[wrong] / scale[wrong]))


def _largest(numbers: Real) -> float:
    """Return the largest number; infinity if one is nan."""
    return float(np.nan_to_num(numbers, nan=np.inf).max(initial=0.0))


class LogCheck:
    """The samples of a log, compared with what its events say."""

    def __init__(self, catalog: Catalog) -> None:
        self.deviations: dict[str, Deviation] = {}
        self._event_order = EventOrder(catalog.events, catalog.ordered.places)
        self._unknown = Unknown(catalog.unknown)
        self._budget = StepBudget(SPARE_STEPS)

    def add_batch(self, batch: Batch) -> None:
        """Compare the samples of a batch."""
        for name, columns in batch.columns.items():
            with np.errstate(all="ignore"):
                self.add(name, columns)

    def add(self, name: str, columns: Columns) -> None:
        """Compare samples of a topic."""
        deviation = self.deviations.setdefault(name, Deviation())
        owners = self._event_order.find_owners(columns.stamps, columns.places)
        follows = owners >= 0
        deviation.unchecked += int((~follows).sum())
        unknown = self._unknown.find(columns.stamps, columns.places) & follows
        # If the motion is not known, a sample that agrees exactly with an event belongs to it.
        left, _ = self._take_agreeing(
            deviation, name, columns.select(unknown), owners[unknown], 0.0
        )
        deviation.unjudged += len(left.stamps)
        known = follows & ~unknown
        self._add_known(deviation, name, columns.select(known), owners[known])

    def _add_known(self, deviation: Deviation, name: str, left: Columns, owners: Places) -> None:
        """Compare samples that follow from an event that is there."""
        # If stamps are repeated, a sample may agree with two events up to rounding: the event with
        # exact agreement is taken.
        for bound in [BOUND] if self._event_order.is_ordered else [0.0, BOUND]:
            left, owners = self._take_agreeing(deviation, name, left, owners, bound)
        for number in np.unique(owners).tolist():
            self._take_all(deviation, name, left.select(owners == number), number)

    def _take_agreeing(
        self,
        deviation: Deviation,
        name: str,
        left: Columns,
        owners: Places,
        bound: float,
    ) -> tuple[Columns, Places]:
        """Take the samples that agree with an event within a bound; return the others."""
        if not len(owners):
            return left, owners
        for number in self._event_order.candidates(left.stamps, owners):
            chosen = self._event_order.holds(number, left.stamps)
            segment = self._event_order.segment(number)
            part = left.select(chosen)
            if not chosen.any() or not self._budget.reach_stamps(segment, part.stamps):
                continue
            difference, scale = _compare(name, part, segment)
            agree = (difference <= bound * scale).all(axis=1)
            deviation.add(difference[agree], scale[agree], _is_exact(name, segment))
            chosen[chosen] = agree
            left, owners = left.select(~chosen), owners[~chosen]
        return left, owners

    def _take_all(self, deviation: Deviation, name: str, part: Columns, number: int) -> None:
        """Take samples of an event whether they agree or not."""
        segment = self._event_order.segment(number)
        if not self._budget.reach_stamps(segment, part.stamps):
            deviation.unreached += len(part.stamps)
            return
        difference, scale = _compare(name, part, segment)
        deviation.add(difference, scale, _is_exact(name, segment))


def _is_exact(name: str, segment: Segment) -> bool:
    """Return True if samples have the same bits on every machine."""
    return name in STATE_TOPICS and not segment.motion.is_driven


def _compare(name: str, columns: Columns, segment: Segment) -> tuple[Real, Real]:
    """Return differences of samples from their computed values, and the sizes of the latter."""
    topic = SAMPLE_TOPICS[name]
    samples = Samples.at(segment, columns.stamps)
    computed = np.broadcast_to(topic.compute(samples), columns.numbers.shape)
    difference = np.abs(columns.numbers - computed)
    difference[np.isnan(columns.numbers) & np.isnan(computed)] = 0.0  # a force that is unknown
    if topic.angles and segment.motion.clamped:
        # In logs up to version 0.5 phi' is a rounding error instead of 0, and so psi' is off, too.
        older = [*samples.state.euler_angles, *samples.state.euler_rates]
        difference[columns.numbers == np.stack(older, axis=-1)] = 0.0
    computed, scale = np.nan_to_num(computed), np.empty(computed.shape)
    for place in topic.format.quantities.values():
        scale[:, place] = np.abs(computed[:, place]).max(initial=0.0)
    if topic.angles:  # on the vertical phi and psi are undefined
        scale = np.maximum(scale, 1.0) / np.abs(np.sin(computed[:, 1:2]))
    if segment.motion.is_driven:
        if topic.angles:  # -pi and pi are the same angle
            place = topic.format.quantities[topic.angles]
            turns = np.abs(difference[:, place] - 2 * np.pi)
            difference[:, place] = np.minimum(difference[:, place], turns)
        # A difference in the last place of a rate grows with the phase of the motion.
        rate = np.abs(samples.state.angular_velocity).max(axis=-1)
        phase = rate * np.abs(segment.time_at(columns.stamps))
        scale = scale * (1 + np.broadcast_to(phase, len(scale))[:, np.newaxis])
    return difference, scale
