"""Measurements in messages; a quantity that a message marks as absent is nan.

- `sensor_msgs/Imu`: a covariance that begins with -1 means that its quantity is not measured.
- `nav_msgs/Odometry`: the twist is in the child frame; if that has no name, its axes are unknown.
- nan is nan in every type.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Mask, Real, Stamps
from symtop_ros.base.counts import write_count
from symtop_ros.run.wire.messages import Decoded, Format, decode_messages

ABSENT = -1.0  # the first number of a covariance
COVARIANCE = "_covariance"
IN_CHILD = ("linear", "angular")


@dataclass(frozen=True, eq=False)
class Measured:
    """Messages of one type, in the order in which they came, those of a layout together."""

    form: Format
    stamps: Stamps  # in ns
    numbers: Real  # doubles of the messages; nan: absent
    unreadable: int  # messages which could not be read

    def find(self, *names: str) -> Real | None:
        """Return the first of some quantities (n, k) that the type has."""
        places = [self.form.quantities[name] for name in names if name in self.form.quantities]
        return self.numbers[:, places[0]] if places else None

    def describe_absent(self, *names: str) -> Iterator[str]:
        """Yield how many messages lack one of some quantities that their type has."""
        for name in names:
            values = self.find(name)
            absent = 0 if values is None else int(find_absent(values).sum())
            if absent:
                number = write_count(absent, "message", "have")
                yield f"{number} no {name.replace('_', ' ')}: absent by covariance, frame or nan"


def read_measured(form: Format, messages: Sequence[bytes], frame: str | None = None) -> Measured:
    """Decode messages of a type; with a child frame, only those of that frame."""
    parts, refused = decode_messages(form, messages)
    parts = [part for part in parts if frame is None or frame == part.names[-1]]
    numbers = [_blank(form, part) for part in parts] or [np.empty((0, form.width))]
    stamps = [part.stamps for part in parts] or [np.empty(0, dtype=np.int64)]
    return Measured(form, np.concatenate(stamps), np.concatenate(numbers), len(refused))


def find_absent(values: Real) -> Mask:
    """Return True for the rows of a quantity (n, k) that are not measured."""
    return np.asarray(np.isnan(values).any(axis=1))


def _blank(form: Format, part: Decoded) -> Real:
    """Return the numbers of messages of one layout, nan for quantities marked as absent."""
    numbers = part.numbers.copy()
    for name, place in form.quantities.items():
        covariance = form.quantities.get(f"{name}{COVARIANCE}")
        if covariance:
            numbers[numbers[:, covariance.start] == ABSENT, place] = np.nan
        if name in IN_CHILD and len(part.names) == 2 and not part.names[-1]:
            numbers[:, place] = np.nan
    return numbers
