"""Estimates of attitude and angular velocity, and the messages that hold them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from symtop_ros.base.arrays import Mask, Real, Stamps
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.run.wire.layout import (
    NANOSECONDS,
    DecodeError,
    Doubles,
    Layout,
    Reader,
    Stamp,
    Text,
)
from symtop_ros.run.wire.messages import (
    IMU,
    ODOMETRY,
    QUATERNION,
    TRANSFORM,
    Format,
    define_stamped,
)
from symtop_ros.truth.residuals.sampling import (
    describe_repeats,
    describe_time_step,
    find_time_step,
)
from symtop_ros.truth.topics.measured import read_measured

if TYPE_CHECKING:  # logs need mcap
    from symtop_ros.run.log.source import MessageSource

MAX_STAMP = 2**62  # ns
MAX_ESTIMATES = 20_000_000
LARGEST_NORM_ERROR = 0.1  # of a quaternion; one further from 1 is no attitude
ODD_NORM = 1e-3  # off 1, beyond which a quaternion was rounded no more, but meant otherwise
ALIKE = 2e-5  # distance of quaternions of one attitude that has five decimals
NORM_ROUNDING = 2.0**-50  # of a quaternion that is normalised


@dataclass(frozen=True, eq=False)
class Estimates:
    """Estimates at their own stamps."""

    stamps: Stamps  # in ns
    orientations: Real  # unit quaternions w, x, y, z, frame of body or sensor to world
    angular_velocities: Real | None  # in that frame, in rad/s
    left_out: int = 0  # messages without an attitude, or which could not be read
    unreadable: int = 0  # those which could not be read
    of_sensor: bool = False  # True: of the mounted sensor, not of the body
    notes: tuple[str, ...] = ()  # what was odd about the file, in sentences

    @classmethod
    def of(
        cls,
        stamps: Sequence[int] | Stamps,
        orientations: Sequence[Sequence[float]] | Real,
        angular_velocities: Real | None = None,
        left_out: int = 0,
    ) -> Estimates:
        """Return estimates sorted by stamp, without invalid attitudes."""
        times = np.asarray(stamps, dtype=np.int64)
        q = np.asarray(orientations, dtype=float).reshape(-1, 4)
        with np.errstate(all="ignore"):
            norms = np.linalg.norm(q, axis=1)
            # A filter's quaternion of norm 2 is an attitude; zeros, the default of a message that
            # was never filled, are none.
            good = np.isfinite(norms) & (norms > LARGEST_NORM_ERROR)
            if angular_velocities is not None and not _has_any(angular_velocities):
                angular_velocities = None
            if angular_velocities is not None:
                good &= np.isfinite(angular_velocities).all(axis=1)
        good &= np.abs(times) < MAX_STAMP
        order = np.flatnonzero(good)[np.argsort(times[good], kind="stable")]
        rates = None if angular_velocities is None else angular_velocities[order]
        # Unit quaternions stay unchanged: a division would add the rounding that is measured.
        scale = np.where(np.abs(norms - 1) <= NORM_ROUNDING, 1.0, norms)[order, np.newaxis]
        notes = tuple(_describe_norms(norms[order]))
        found = cls(times[order], q[order] / scale, rates, left_out + int((~good).sum()))
        return replace(found, notes=notes)

    def __len__(self) -> int:
        """Return the number of estimates."""
        return len(self.stamps)

    def select(self, chosen: Mask) -> Estimates:
        """Return the estimates for which `chosen` (n,) is True."""
        rates = self.angular_velocities
        return replace(
            self,
            stamps=self.stamps[chosen],
            orientations=self.orientations[chosen],
            angular_velocities=None if rates is None else rates[chosen],
        )

    def count_once(self) -> Estimates:
        """Return the estimates without repeated ones, as merged bags have.

        One of two may have fewer decimals, or the quaternion of the other sign.
        """
        again = self._find_repeats()
        seconds = self.stamps / NANOSECONDS
        found = self.select(~again)
        times, counts = np.unique(found.stamps, return_counts=True)
        notes = [*describe_repeats(seconds[again])]
        if others := len(found) - len(times):
            first = times[counts.argmax()] / NANOSECONDS
            rows = "row repeats" if others == 1 else "rows repeat"
            notes.append(f"{others} {rows} a time, among them {first:.9g} s")
        notes += describe_time_step(find_time_step(found.stamps))
        return replace(found, notes=(*self.notes, *notes))

    def _find_repeats(self) -> Mask:
        """Return True (n,) for sorted estimates that repeat an earlier row up to rounding."""
        again = np.zeros(len(self), dtype=bool)
        lag, q = 1, self.orientations
        while (same := self.stamps[lag:] == self.stamps[:-lag]).any():
            dots = np.abs((q[lag:] * q[:-lag]).sum(axis=1))
            again[lag:] |= same & (2 * (1 - dots) < ALIKE**2)
            lag += 1
        return again

    def thin(self, most: int) -> Estimates:
        """Return estimates spread over the run: at least a number, less than twice as many.

        One of each group of consecutive estimates is drawn at random. With a fixed step, all drawn
        estimates could come from one of two publishers that take turns. The first one is kept, as
        drifts count from it.
        """
        width = max(1, len(self) // most)
        if width == 1:
            return self
        draws = np.random.default_rng(0).integers(0, width, len(self) // width)
        draws[0] = 0
        chosen = np.zeros(len(self), dtype=bool)
        chosen[np.arange(len(draws)) * width + draws] = True
        return self.select(chosen)


def _has_any(rates: Real) -> bool:
    """Return True if there are no rows (n, 3), or one of them has rates."""
    return not len(rates) or bool(np.isfinite(rates).all(axis=1).any())


def _describe_norms(norms: Real) -> Iterator[str]:
    """Name quaternions that were no attitudes before they were divided by their norms."""
    wrong = int((np.abs(norms - 1) > ODD_NORM).sum())
    if wrong:
        ends = dict.fromkeys(f"{float(each):.3g}" for each in (norms.min(), norms.max()))
        counted = f"{wrong} of {write_count(len(norms), 'quaternion')}"
        were = "was" if wrong == 1 else "were"
        range_ = f"norm{'s' if len(ends) > 1 else ''} {' to '.join(ends)}"
        yield f"{counted} did not have the norm 1, and {were} divided by the norm ({range_})"


ATTITUDES, RATES = ("orientation", "rotation"), ("angular_velocity", "angular")
POSE = {"position": 3, "orientation": 4}
FORMATS = {
    form.type: form
    for form in (
        QUATERNION,
        IMU,
        define_stamped("geometry_msgs/msg/PoseStamped", **POSE),
        define_stamped("geometry_msgs/msg/PoseWithCovarianceStamped", **POSE, pose_covariance=36),
        Format(
            "geometry_msgs/msg/TransformStamped",
            TRANSFORM.quantities,
            lambda frame, child: Layout(Stamp(), Text(frame), Text(child), Doubles(7)),
            ODOMETRY.read_names,
        ),
        ODOMETRY,
    )
}


def decode_estimates(kind: str, messages: Sequence[bytes], frame: str | None = None) -> Estimates:
    """Decode messages of a type; with a child frame, only those of that frame."""
    if kind == TRANSFORM.type:
        return _decode_transforms(messages, frame)
    if kind not in FORMATS:
        known = ", ".join(name.rpartition("/")[2] for name in (*FORMATS, TRANSFORM.type))
        raise RefusedError(
            f"topic must have a type with an attitude ({known}), got {one_line(kind)}"
        )
    measured = read_measured(FORMATS[kind], messages, frame)
    q = np.asarray(measured.find(*ATTITUDES))[:, [3, 0, 1, 2]]
    rates = measured.find(*RATES)
    found = Estimates.of(measured.stamps, q, rates, measured.unreadable)
    notes = (*found.notes, *measured.describe_absent(*ATTITUDES, *RATES))
    of_sensor = kind == IMU.type
    return replace(found, of_sensor=of_sensor, unreadable=measured.unreadable, notes=notes)


def _decode_transforms(messages: Sequence[bytes], frame: str | None) -> Estimates:
    """Decode TFMessages, each with any number of transforms."""
    found: dict[str, list[tuple[int, tuple[float, ...]]]] = {}
    refused = 0
    for data in messages:
        try:
            for child, stamp, q in _read_transforms(Reader(data)):
                if child:  # tf2 drops the others, too
                    found.setdefault(child, []).append((stamp, q))
        except DecodeError:
            refused += 1
    if frame is None and len(found) > 1:
        raise RefusedError(f"--frame must be one of {', '.join(sorted(found)[:20])}, got none")
    chosen = found.get(frame, []) if frame else next(iter(found.values()), [])
    estimates = Estimates.of([stamp for stamp, _ in chosen], [q for _, q in chosen], None, refused)
    return replace(estimates, unreadable=refused)


def _read_transforms(reader: Reader) -> Iterator[tuple[str, int, tuple[float, ...]]]:
    for _ in range(reader.count()):
        seconds = reader.integer("i")
        nanoseconds = reader.integer()
        reader.string()
        child = reader.string()
        reader.skip(8, 3)
        x, y, z, w = (reader.number() for _ in range(4))
        yield child, seconds * NANOSECONDS + nanoseconds, (w, x, y, z)


def read_topic(source: MessageSource, topic: str, frame: str | None = None) -> Estimates:
    """Return the estimates on a topic of a log, or RefusedError; /tf needs the child frame."""
    kind, messages = read_messages(source, topic)
    found = decode_estimates(kind, messages, frame)
    if frame and not len(found):
        raise RefusedError(
            f"--frame must be the child frame of an estimate on {topic}, got {frame}"
        )
    return found


def read_messages(source: MessageSource, topic: str) -> tuple[str, list[bytes]]:
    """Return the type of a topic of a log, and its messages."""
    messages: list[bytes] = []
    for chunk in source.chunks():
        numbers = {n for n, channel in source.channels.items() if channel.topic == topic}
        messages += [bytes(each.data) for each in chunk if each.channel_id in numbers]
        if len(messages) > MAX_ESTIMATES:
            raise RefusedError(f"{topic} must have at most {MAX_ESTIMATES} messages, got more")
    channels = [channel for channel in source.channels.values() if channel.topic == topic]
    if not channels:
        known = sorted({one_line(channel.topic) for channel in source.channels.values()})
        raise RefusedError(
            f"--topic must be one of {', '.join(known[:20]) or 'none'}, got {one_line(topic)}"
        )
    schema = source.schemas.get(channels[0].schema_id)
    return schema.name if schema else "unknown", messages
