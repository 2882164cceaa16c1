"""Which message each topic of a sample is, and its layout.

Doubles stand in the order of the message: quaternions x, y, z, w; linear (or force) before angular
(or torque); positions before velocities.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symtop_ros.wire.cdr import DecodeError, Reader
from symtop_ros.wire.layout import Count, Doubles, Layout, Stamp, Text

JOINTS = ("precession", "tilt", "spin")  # of the URDF: z-x-z
MOST_LAYOUTS = 256  # of one topic at a time: frames of /tf


def quaternion(frame: str) -> Layout:
    """geometry_msgs/QuaternionStamped."""
    return Layout(Stamp(), Text(frame), Doubles(4))


def vector(frame: str) -> Layout:
    """geometry_msgs/Vector3Stamped."""
    return Layout(Stamp(), Text(frame), Doubles(3))


def twist(frame: str) -> Layout:
    """geometry_msgs/TwistStamped and WrenchStamped."""
    return Layout(Stamp(), Text(frame), Doubles(6))


def joints(frame: str, names: Sequence[str] = JOINTS) -> Layout:
    """sensor_msgs/JointState with positions and velocities."""
    count = len(names)
    return Layout(
        Stamp(),
        Text(frame),
        Count(count),
        *map(Text, names),
        Count(count),
        Doubles(count),
        Count(count),
        Doubles(count),
        Count(0),
    )


def transform(frame: str, child: str) -> Layout:
    """tf2_msgs/TFMessage with one transform: translation, rotation."""
    return Layout(Count(1), Stamp(), Text(frame), Text(child), Doubles(7))


@dataclass(frozen=True, eq=False)
class Unpacked:
    """Messages of one layout.

    Attributes
    ----------
    names : tuple of str
        Frames (the child last), or the frame and the joints.
    which : ndarray (n,)
        Where they stood among the messages.
    stamps : ndarray (n,)
        In ns.
    numbers : ndarray (n, width)
    """

    names: tuple[str, ...]
    which: NDArray[np.int64]
    stamps: NDArray[np.int64]
    numbers: NDArray[np.float64]


Named = tuple[Layout, tuple[str, ...]]


def _framed(make: Callable[[str], Layout]) -> Callable[[bytes], Named]:
    def layout_of(data: bytes) -> Named:
        reader = Reader(data)
        reader.skip(4, 2)
        frame = reader.string()
        return make(frame), (frame,)

    return layout_of


def _joints_of(data: bytes) -> Named:
    reader = Reader(data)
    reader.skip(4, 2)
    frame, names = reader.string(), reader.strings()
    if len(names) != len(JOINTS):
        msg = f"{len(names)} joints, readable are {len(JOINTS)}"
        raise DecodeError(msg)
    return joints(frame, names), (frame, *names)


def _transform_of(data: bytes) -> Named:
    reader = Reader(data)
    reader.skip(4, 3)
    names = reader.string(), reader.string()
    return transform(*names), names


KINDS = {
    "orientation": "geometry_msgs/msg/QuaternionStamped",
    "angular_velocity": "geometry_msgs/msg/TwistStamped",
    "angular_momentum": "geometry_msgs/msg/Vector3Stamped",
    "torque": "geometry_msgs/msg/WrenchStamped",
    "euler_angles": "sensor_msgs/msg/JointState",
    "tf": "tf2_msgs/msg/TFMessage",
}
LAYOUT_OF: dict[str, Callable[[bytes], Named]] = {
    KINDS["orientation"]: _framed(quaternion),
    KINDS["angular_momentum"]: _framed(vector),
    KINDS["angular_velocity"]: _framed(twist),
    KINDS["torque"]: _framed(twist),
    KINDS["euler_angles"]: _joints_of,
    KINDS["tf"]: _transform_of,
}


def unpacked(kind: str, messages: Sequence[bytes]) -> tuple[list[Unpacked], list[str]]:
    """Read messages of one kind, whoever wrote them.

    Parameters
    ----------
    kind : str
        As in `LAYOUT_OF`.
    messages : sequence of bytes

    Returns
    -------
    found : list of Unpacked
        One for each layout.
    refused : list of str
        What is wrong with each message that is of another kind, or varies in more than doubles.
    """
    sizes = np.fromiter(map(len, messages), np.int64, len(messages))
    left, unread = np.arange(len(messages)), np.ones(len(messages), dtype=bool)
    found: list[Unpacked] = []
    refused: list[str] = []
    while left.size and len(found) < MOST_LAYOUTS:
        alike = left[sizes[left] == sizes[left[0]]]
        try:
            found.append(_of_first_layout(kind, messages, alike))
            done = found[-1].which
        except DecodeError as error:
            refused.append(str(error))
            done = left[:1]
        unread[done] = False
        left = left[unread[left]]
    refused += [f"more than {MOST_LAYOUTS} frames on one topic"] * left.size
    return found, refused


def _of_first_layout(kind: str, messages: Sequence[bytes], which: NDArray[np.int64]) -> Unpacked:
    """Read those of some messages of one size that have the layout of the first of them."""
    first = messages[which[0]]
    layout, names = LAYOUT_OF[kind](first)
    # rclpy's serialize_message hands out up to seven bytes more than are sent
    if not 0 <= len(first) - layout.size < 8 or not layout.fits(_rows([first], layout))[0]:
        msg = f"{len(first)} bytes that are not a {kind} of one sample"
        raise DecodeError(msg)
    rows = _rows([messages[k] for k in which], layout)
    fits = layout.fits(rows)
    return Unpacked(names, which[fits], *layout.unpack(rows[fits]))


def _rows(messages: Sequence[bytes], layout: Layout) -> NDArray[np.uint8]:
    """Messages of one size as an array, without what is behind the layout."""
    return np.frombuffer(b"".join(messages), np.uint8).reshape(len(messages), -1)[:, : layout.size]
