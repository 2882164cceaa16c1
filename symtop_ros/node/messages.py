"""From a state to standard messages, all in the world frame and SI units."""

from __future__ import annotations

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import (
    Quaternion,
    QuaternionStamped,
    TransformStamped,
    TwistStamped,
    Vector3,
    Vector3Stamped,
    WrenchStamped,
)
from numpy.typing import NDArray
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from symtop_ros.physics import State, Top

JOINTS = ("precession", "tilt", "spin")  # of the URDF: z-x-z


def time_message(stamp: int) -> Time:
    """Return a stamp in ns as a message."""
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    return Time(sec=seconds, nanosec=nanoseconds)


def orientation(header: Header, _: Top, state: State) -> QuaternionStamped:
    """Body -> world."""
    return QuaternionStamped(header=header, quaternion=_quaternion(state))


def angular_velocity(header: Header, _: Top, state: State) -> TwistStamped:
    """Angular velocity; the pivot does not move."""
    message = TwistStamped(header=header)
    message.twist.angular = _vector(state.to_world(state.angular_velocity))
    return message


def angular_momentum(header: Header, top: Top, state: State) -> Vector3Stamped:
    """Angular momentum about the pivot."""
    return Vector3Stamped(header=header, vector=_vector(top.angular_momentum(state)))


def torque(header: Header, top: Top, state: State) -> WrenchStamped:
    """Torque about the pivot; the force at the pivot is not modelled."""
    message = WrenchStamped(header=header)
    message.wrench.torque = _vector(top.torque(state))
    return message


def euler_angles(header: Header, _: Top, state: State) -> JointState:
    """Euler angles and their rates as joints."""
    return JointState(
        header=header,
        name=list(JOINTS),
        position=list(state.euler_angles),
        velocity=list(state.euler_rates),
    )


def transform(header: Header, top_frame: str, state: State) -> TransformStamped:
    """World -> top for /tf."""
    message = TransformStamped(header=header, child_frame_id=top_frame)
    message.transform.rotation = _quaternion(state)
    return message


def _quaternion(state: State) -> Quaternion:
    w, x, y, z = state.orientation.tolist()
    return Quaternion(x=x, y=y, z=z, w=w)


def _vector(vector: NDArray[np.float64]) -> Vector3:
    x, y, z = vector.tolist()
    return Vector3(x=x, y=y, z=z)
