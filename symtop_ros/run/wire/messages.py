"""Formats of the message types that carry samples, and decoding of many messages at once.

Doubles are in the order of the message: quaternions x, y, z, w; linear (or force) before angular
(or torque); positions before velocities.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.base.arrays import Real
from symtop_ros.run.wire.layout import (
    Count,
    DecodeError,
    Doubles,
    Layout,
    Reader,
    Stamp,
    Text,
    Writer,
)

JOINTS = ("precession", "tilt", "spin")  # joint names of the URDF; axes z-x-z
MAX_LAYOUTS = 256  # different frames on one topic that are decoded (/tf is shared by many)
MAX_PADDING = 7  # bytes that rclpy's serialize_message may append to a message


@dataclass(frozen=True, slots=True)
class Format:
    """Encoding of one ROS message type."""

    type: str  # name of the type, such as "geometry_msgs/msg/QuaternionStamped"
    # places of the quantities among the doubles of a message, in their order
    quantities: Mapping[str, slice]
    # returns the layout for given names: the frame, then the child frame or the joints
    layout: Callable[..., Layout]
    # returns these names from an encoded message; raises DecodeError
    read_names: Callable[[bytes], tuple[str, ...]]

    @property
    def width(self) -> int:
        """Number of doubles in a message."""
        return max(int(place.stop) for place in self.quantities.values())

    def arrange(self, shape: tuple[int, ...], values: Mapping[str, Any]) -> Real:
        """Return the doubles of messages (..., width) from some quantities; the others are zero.

        A covariance is given by the variance of each axis.
        """
        numbers = np.zeros((*shape, self.width))
        for name, value in values.items():
            place = self.quantities[name]
            is_covariance = name.endswith("_covariance")
            axes = np.eye(math.isqrt(place.stop - place.start)).reshape(-1)
            numbers[..., place] = value * axes if is_covariance else value
        return numbers


def _place(**sizes: int) -> dict[str, slice]:
    """Return the places of quantities of these sizes, one after the other."""
    ends = list(accumulate(sizes.values()))
    return {
        name: slice(end - size, end) for (name, size), end in zip(sizes.items(), ends, strict=True)
    }


def _read_names(integers: int, count: int, data: bytes) -> tuple[str, ...]:
    """Return names that follow some integers: those of the stamp, and lengths."""
    reader = Reader(data)
    reader.skip(4, integers)
    return tuple(reader.string() for _ in range(count))


def _read_joints(data: bytes) -> tuple[str, ...]:
    reader = Reader(data)
    reader.skip(4, 2)
    frame, names = reader.string(), reader.strings()
    if len(names) != len(JOINTS):
        raise DecodeError(f"JointState must have {len(JOINTS)} joints, got {len(names)}")
    return (frame, *names)


def _joint_state(frame: str, *names: str) -> Layout:
    count = len(names)
    return Layout(
        Stamp(),
        Text(frame),
        Count(count),
        *map(Text, names),
        Count(count),
        Doubles(count),  # positions
        Count(count),
        Doubles(count),  # velocities
        Count(0),  # no efforts
    )


def define_stamped(message_type: str, **sizes: int) -> Format:
    """Return the format of a type that consists of a header and some quantities."""
    return Format(
        message_type,
        _place(**sizes),
        lambda frame: Layout(Stamp(), Text(frame), Doubles(sum(sizes.values()))),
        partial(_read_names, 2, 1),
    )


QUATERNION = define_stamped("geometry_msgs/msg/QuaternionStamped", orientation=4)
VECTOR = define_stamped("geometry_msgs/msg/Vector3Stamped", vector=3)
TWIST = define_stamped("geometry_msgs/msg/TwistStamped", linear=3, angular=3)
IMU = define_stamped(
    "sensor_msgs/msg/Imu",
    orientation=4,
    orientation_covariance=9,
    angular_velocity=3,
    angular_velocity_covariance=9,
    linear_acceleration=3,
    linear_acceleration_covariance=9,
)
MAGNETIC_FIELD = define_stamped(
    "sensor_msgs/msg/MagneticField", magnetic_field=3, magnetic_field_covariance=9
)
WRENCH = define_stamped("geometry_msgs/msg/WrenchStamped", force=3, torque=3)
JOINT_STATE = Format(
    "sensor_msgs/msg/JointState", _place(position=3, velocity=3), _joint_state, _read_joints
)
TRANSFORM = Format(  # tf2_msgs/TFMessage with one transform
    "tf2_msgs/msg/TFMessage",
    _place(translation=3, rotation=4),
    lambda frame, child: Layout(Count(1), Stamp(), Text(frame), Text(child), Doubles(7)),
    partial(_read_names, 3, 2),
)
ODOMETRY = Format(
    "nav_msgs/msg/Odometry",
    _place(position=3, orientation=4, pose_covariance=36, linear=3, angular=3, twist_covariance=36),
    lambda frame, child: Layout(Stamp(), Text(frame), Text(child), Doubles(85)),
    partial(_read_names, 2, 2),
)
CLOCK = Layout(Stamp())  # rosgraph_msgs/Clock


@dataclass(frozen=True, slots=True)
class Transform:
    """A frame in its parent frame."""

    parent: str  # name of its parent frame
    child: str  # its name
    translation: tuple[float, float, float]  # in m
    rotation: tuple[float, float, float, float]  # quaternion x, y, z, w


def encode_transforms(stamp: int, transforms: Sequence[Transform]) -> bytes:
    """Encode a TFMessage with any number of transforms at one stamp (ns)."""
    writer = Writer()
    writer.integer(len(transforms))
    for each in transforms:
        writer.stamp(stamp)
        writer.strings([each.parent, each.child])
        writer.numbers((*each.translation, *each.rotation))
    return writer.data


@dataclass(frozen=True, eq=False)
class Decoded:
    """Messages of one layout."""

    names: tuple[str, ...]  # frames (the child last), or the frame and the joints
    indices: NDArray[np.int64]  # their places among the messages that were decoded together
    stamps: NDArray[np.int64]  # in ns
    numbers: NDArray[np.float64]  # their doubles


def decode_messages(form: Format, messages: Sequence[bytes]) -> tuple[list[Decoded], list[str]]:
    """Decode messages of one type, written by any program."""
    sizes = np.fromiter(map(len, messages), np.int64, len(messages))
    remaining = np.arange(len(messages))
    unread = np.ones(len(messages), dtype=bool)
    decoded: list[Decoded] = []
    refused: list[str] = []
    # Messages of one layout have one size. Each pass takes the layout of the first remaining
    # message and decodes all that match it, so that a log costs one array operation per frame name.
    while remaining.size and len(decoded) < MAX_LAYOUTS:
        same_size = remaining[sizes[remaining] == sizes[remaining[0]]]
        try:
            decoded.append(_decode_first_layout(form, messages, same_size))
            done = decoded[-1].indices
        except DecodeError as error:
            refused.append(str(error))
            done = remaining[:1]
        unread[done] = False
        remaining = remaining[unread[remaining]]
    refused += [f"a topic must have at most {MAX_LAYOUTS} frames"] * remaining.size
    return decoded, refused


def _decode_first_layout(
    form: Format, messages: Sequence[bytes], indices: NDArray[np.int64]
) -> Decoded:
    """Decode those of some messages of one size that have the layout of the first one."""
    first = messages[indices[0]]
    names = form.read_names(first)
    layout = form.layout(*names)
    if not (
        0 <= len(first) - layout.size <= MAX_PADDING and layout.match(_stack([first], layout))[0]
    ):
        raise DecodeError(f"{len(first)} bytes are not a {form.type} of one sample")
    rows = _stack([messages[k] for k in indices], layout)
    matching = layout.match(rows)
    return Decoded(names, indices[matching], *layout.decode(rows[matching]))


def _stack(messages: Sequence[bytes], layout: Layout) -> NDArray[np.uint8]:
    """Stack messages of one size into rows, cut to the size of the layout."""
    return np.frombuffer(b"".join(messages), np.uint8).reshape(len(messages), -1)[:, : layout.size]
