"""Samples compared with each other and with the moments in the events, by NumPy alone.

The other checks compute a run again with the same kernel. Here the laws of motion are tested: dL/dt
is the torque; the attitude turns with omega; L follows from omega, Ix and Iz; and the torque
follows from the attitude, Mgl, friction and applied torque. So a reader of a log need not trust the
kernel.

A derivative is taken within one motion at one pace: not across events, pushes, pauses and gaps.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from symtop_ros.base.arrays import Mask, Real, Stamps, axis_of
from symtop_ros.run.check.stencils import EPS, MARGIN, find_slopes
from symtop_ros.run.log.batch import Batch
from symtop_ros.run.log.catalog import Catalog
from symtop_ros.run.log.event_order import EventOrder
from symtop_ros.run.log.intervals import Unknown
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.wire.layout import NANOSECONDS

# Topics, and the places of their vector among the doubles of a message.
VECTORS = {
    "orientation": slice(0, 4),
    "angular_velocity": slice(3, 6),
    "angular_momentum": slice(0, 3),
    "torque": slice(3, 6),
}
MOMENTUM, ATTITUDE = "dL/dt = torque", "q' = omega q/2"
INERTIA, WEIGHT = "L of omega", "torque of q"
UNITS = {MOMENTUM: "N m", ATTITUDE: "1/s", INERTIA: "N m s", WEIGHT: "N m"}  # of deviations
# Bound of rounding errors, in EPS of the sizes of the terms: the rotations of both sides have
# errors of six each, and the sums of a few.
TERMS = 32
# Largest product of step and rate. With twice this product a slower motion would have the same
# samples.
FASTEST = 1.5
LEAST = 2 * MARGIN + 1  # samples of a stretch in which a derivative is taken
GAP = 1.5  # in usual steps; a longer step is a gap
KEPT = 2 * MARGIN  # rows before new ones, so that each derivative has its neighbours
NEAR = 1e-6  # of the time between two pushes, in which a sample may be before or after one


@dataclass
class Agreement:
    """Agreement of samples with a law of motion."""

    samples: int = 0  # number of samples that were compared
    wrong: int = 0  # number of samples whose deviation exceeds its bound
    largest: float = 0.0  # largest deviation
    share: float = 0.0  # largest deviation, as a share of its bound
    # number of samples not compared, because their rate is too low for the motion
    too_fast: int = 0

    def add(self, deviation: Real, bound: Real) -> None:
        """Add deviations of samples and their bounds, (n,)."""
        self.samples += len(deviation)
        self.wrong += int((~(deviation <= bound)).sum())  # nan counts as wrong
        self.largest = max(self.largest, float(deviation.max(initial=0.0)))
        with np.errstate(all="ignore"):
            shares = np.nan_to_num(deviation / bound)
        self.share = max(self.share, float(shares.max(initial=0.0)))


@dataclass(frozen=True, eq=False)
class Rows:
    """Samples in the order of their events and stamps; what a topic lacks is nan."""

    owners: Stamps  # number of the event of each
    stamps: Stamps
    vectors: Mapping[str, Real]  # by the names of topics, (n, 3 or 4)
    known: Mapping[str, Mask]  # whether the topic has the sample

    def select(self, chosen: slice) -> "Rows":
        """Return some consecutive rows."""
        vectors = {name: each[chosen] for name, each in self.vectors.items()}
        known = {name: each[chosen] for name, each in self.known.items()}
        return Rows(self.owners[chosen], self.stamps[chosen], vectors, known)

    def has(self, *names: str) -> Mask:
        """Return the mask of the rows that all of some topics have."""
        return np.asarray(np.logical_and.reduce([self.known[name] for name in names]))


class DifferenceCheck:
    """The laws of motion, tried with the samples of a log."""

    def __init__(self, catalog: Catalog) -> None:
        self.laws = {name: Agreement() for name in UNITS}
        self._event_order = EventOrder(catalog.events, catalog.ordered.places)
        self._unknown = Unknown(catalog.unknown)
        self._rows: Rows | None = None  # those before the next batch
        self._judged = 0  # of these, the rows whose derivatives have been compared

    def add_batch(self, batch: Batch) -> None:
        """Compare the samples of a batch."""
        rows = self._join(batch)
        if rows is None:
            return
        with np.errstate(all="ignore"):
            self._compare_terms(rows)
            before = self._rows
            self._rows = rows if before is None else _append(before, rows)
            self._compare_slopes(MARGIN)

    def finish(self) -> None:
        """Compare what is left at the end of the log."""
        with np.errstate(all="ignore"):
            self._compare_slopes(0)

    def _join(self, batch: Batch) -> Rows | None:
        """Return the samples of the topics by their event and stamp, each of them once."""
        found = {}
        for name in VECTORS.keys() & batch.columns.keys():
            columns = batch.columns[name]
            owners = self._event_order.find_owners(columns.stamps, columns.places)
            is_known = (owners >= 0) & ~self._unknown.find(columns.stamps, columns.places)
            keys = np.stack([owners, columns.stamps], axis=1)[is_known]
            _, first, counts = np.unique(keys, axis=0, return_index=True, return_counts=True)
            once = first[counts == 1]
            found[name] = keys[once], columns.numbers[is_known][once, VECTORS[name]]
        if not found:
            return None
        every = np.unique(np.concatenate([keys for keys, _ in found.values()]), axis=0)
        vectors, known = {}, {}
        for name, place in VECTORS.items():
            vectors[name] = np.full((len(every), place.stop - place.start), np.nan)
            known[name] = np.zeros(len(every), dtype=bool)
            if name in found:
                keys, numbers = found[name]
                is_here = _find_rows(every, keys)
                vectors[name][is_here], known[name][is_here] = numbers, True
        return Rows(every[:, 0], every[:, 1], vectors, known)

    # What holds at each sample

    def _compare_terms(self, rows: Rows) -> None:
        for owner in np.unique(rows.owners).tolist():
            part = rows.select(_find_slice(rows.owners == owner))
            segment = self._event_order.segment(owner)
            self._compare_momentum(part, segment)
            self._compare_torque(part, segment)

    def _compare_momentum(self, rows: Rows, segment: Segment) -> None:
        chosen = rows.has("orientation", "angular_velocity", "angular_momentum")
        q, omega, L = (rows.vectors[name][chosen] for name in VECTORS if name != "torque")
        Ix, Iz, _ = segment.motion.top.moments
        axis = axis_of(q)
        along = _dot(omega, axis)
        expected = Ix * (omega - along * axis) + Iz * along * axis
        bound = TERMS * EPS * max(Ix, Iz) * np.linalg.norm(omega, axis=1)
        self.laws[INERTIA].add(np.linalg.norm(L - expected, axis=1), bound)

    def _compare_torque(self, rows: Rows, segment: Segment) -> None:
        chosen = rows.has("orientation", "angular_velocity", "torque")
        q, omega, torque = (
            rows.vectors[name][chosen] for name in VECTORS if name != "angular_momentum"
        )
        expected, size = _find_torque(q, omega, segment)
        self.laws[WEIGHT].add(np.linalg.norm(torque - expected, axis=1), TERMS * EPS * size)

    # What holds between samples

    def _compare_slopes(self, left: int) -> None:
        """Compare the derivatives at the rows that at least `left` rows follow."""
        rows = self._rows
        if rows is None:
            return
        end = max(self._judged, len(rows.stamps) - left)
        for first, last in pairwise(self._find_breaks(rows)):
            if last - first >= LEAST:
                wanted = max(self._judged - first, 0), end - first
                self._compare_stretch(rows.select(slice(first, last)), *wanted)
        kept = max(0, len(rows.stamps) - KEPT)
        self._rows, self._judged = rows.select(slice(kept, None)), end - kept

    def _find_breaks(self, rows: Rows) -> list[int]:
        """Return the first row of each gapless stretch of one motion, and the number of rows."""
        pieces = np.zeros(len(rows.stamps))
        for owner in np.unique(rows.owners).tolist():
            mine = _find_slice(rows.owners == owner)
            pieces[mine] = _count_pushes(self._event_order.segment(owner), rows.stamps[mine])
        steps = np.diff(rows.stamps)
        is_same = (np.diff(rows.owners) == 0) & (np.diff(pieces) == 0) & (steps > 0)
        usual = np.median(steps[is_same]) if is_same.any() else 0.0
        breaks = np.flatnonzero(~(is_same & (steps <= GAP * usual))) + 1
        return [0, *breaks.tolist(), len(rows.stamps)]

    def _compare_stretch(self, rows: Rows, begin: int, end: int) -> None:
        """Compare the derivatives at the rows from `begin` to before `end`."""
        segment = self._event_order.segment(int(rows.owners[0]))
        if not segment.running:
            return
        times = (rows.stamps - rows.stamps[0]) * (segment.factor / NANOSECONDS)
        Ix = segment.motion.top.Ix
        L, torque = rows.vectors["angular_momentum"], rows.vectors["torque"]
        turning = np.linalg.norm(L, axis=1) / Ix + np.sqrt(np.linalg.norm(torque, axis=1) / Ix)
        wanted = slice(begin, end)
        if rows.has("angular_momentum", "torque").all():
            self._compare_law(MOMENTUM, times, L, torque, turning, wanted)
        if rows.has("orientation", "angular_velocity").all():
            omega = rows.vectors["angular_velocity"]
            q = _continue_signs(rows.vectors["orientation"])
            rate = np.linalg.norm(omega, axis=1) / 2 + np.nan_to_num(turning)
            self._compare_law(ATTITUDE, times, q, _turn(omega, q), rate, wanted)

    def _compare_law(
        self, name: str, times: Real, values: Real, expected: Real, rates: Real, wanted: slice
    ) -> None:
        """Compare the derivative of some values with what it must be, where the rate suffices."""
        law = self.laws[name]
        found = find_slopes(times, values)
        places = np.arange(MARGIN, len(times) - MARGIN)
        chosen = (places >= wanted.start) & (places < wanted.stop)
        step = float(np.diff(times).max())
        fastest = sliding_window_view(rates, KEPT + 1).max(axis=-1)
        is_slow = (fastest * step <= FASTEST) & found.converges
        law.too_fast += int((chosen & ~is_slow).sum())
        chosen &= is_slow
        right = expected[MARGIN:-MARGIN]
        bound = found.truncation + found.rounding + TERMS * EPS * np.linalg.norm(right, axis=1)
        deviation = np.linalg.norm(found.values - right, axis=1)
        law.add(deviation[chosen], bound[chosen])


def _append(before: Rows, rows: Rows) -> Rows:
    owners, stamps = (
        np.concatenate(pair)
        for pair in ((before.owners, rows.owners), (before.stamps, rows.stamps))
    )
    vectors = {name: np.concatenate([before.vectors[name], rows.vectors[name]]) for name in VECTORS}
    known = {name: np.concatenate([before.known[name], rows.known[name]]) for name in VECTORS}
    return Rows(owners, stamps, vectors, known)


def _find_rows(every: Stamps, keys: Stamps) -> Mask:
    """Return which of some sorted rows are among others."""
    kind = np.dtype([("owner", np.int64), ("stamp", np.int64)])
    one, other = (np.ascontiguousarray(each, np.int64).view(kind)[:, 0] for each in (every, keys))
    return np.asarray(np.isin(one, other))


def _find_slice(chosen: Mask) -> slice:
    """Return the place of rows that follow one another."""
    places = np.flatnonzero(chosen)
    return slice(int(places[0]), int(places[-1]) + 1)


def _count_pushes(segment: Segment, stamps: Stamps) -> Real:
    """Return numbers that differ for stamps between which the motion was pushed."""
    pushes = segment.motion.pushes
    if not pushes:
        return np.zeros(len(stamps))
    offset = (stamps - segment.stamp) / NANOSECONDS * segment.factor * segment.running
    count = (segment.begin_time + offset) * pushes.rate
    nearest = np.rint(count)
    is_near = (np.abs(count - nearest) < NEAR) & (nearest < pushes.number)
    # A sample at the time of a push belongs to no stretch, so it gets half a number.
    return np.where(is_near, nearest - 0.5, np.minimum(np.floor(count), pushes.number - 1))


def _continue_signs(q: Real) -> Real:
    """Return quaternions without changes of sign from one to the next."""
    signs = np.where((q[1:] * q[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    return np.asarray(q * np.concatenate([[1.0], np.cumprod(signs)])[:, np.newaxis])


def _turn(omega: Real, q: Real) -> Real:
    """Return the derivative of quaternions x, y, z, w (body to world) by omega (world)."""
    vector, scalar = q[:, :3], q[:, 3:]
    across = scalar * omega + np.cross(omega, vector)
    return np.concatenate([across, -_dot(omega, vector)], axis=1) / 2


def _find_torque(q: Real, omega: Real, segment: Segment) -> tuple[Real, Real]:
    """Return the torque on a top (n, 3), and the sizes of its terms (n,)."""
    motion = segment.motion
    Mgl, friction = motion.top.Mgl, motion.friction
    axis = axis_of(q)
    along, speed = _dot(omega, axis), np.linalg.norm(omega, axis=1)
    x, y, _ = axis.T
    weight = Mgl * np.stack([-y, x, np.zeros_like(x)], axis=1)
    rubbing = friction.transverse * (omega - along * axis) + friction.axial * along * axis
    torque = weight - rubbing + np.array(motion.applied_torque)
    size = abs(Mgl) + (friction.axial + friction.transverse) * speed
    size = size + np.linalg.norm(motion.applied_torque)
    if motion.clamped:  # the hand turns p_psi with the axle (derivation.md, section 11)
        torque = torque + motion.top.Iz * along * np.cross(omega, axis)
        size = size + motion.top.Iz * speed**2
    return torque, size


def _dot(one: Real, other: Real) -> Real:
    """Return the products of rows, (n, 1)."""
    return np.asarray((one * other).sum(axis=1, keepdims=True))
