"""All topics of the top: one record for each, with its name, ROS type, bytes and content.

The node publishes what this table says, the recorder logs it, and logs are read and checked with
it. World frame, SI units, radians.
"""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, split, stack
from symtop_ros.physics import State
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import EXACT
from symtop_ros.run.wire import messages
from symtop_ros.run.wire.diagnostics import DIAGNOSTIC_ARRAY
from symtop_ros.run.wire.layout import Layout
from symtop_ros.run.wire.messages import Format

DEFAULT_NAME = "top"  # of the node
DEPTH = 100  # samples of a topic that are kept for a slow subscriber


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic."""

    # name in the form that ROS resolves; `~` stands for the name of the node, and a name
    # without `~` or `/` at its start is in the namespace of the node
    ros_name: str
    type: str  # message type, such as "std_msgs/msg/String"
    depth: int = DEPTH  # messages that are kept for a slow (or, if latched, a late) subscriber
    # True if late subscribers get the last messages (durability "transient local")
    latched: bool = False

    @property
    def name(self) -> str:
        """Last part of the name: the key of the topic in logs and tables."""
        return self.ros_name.rpartition("/")[2]

    def resolve(self, node: str) -> str:
        """Return the full name of the topic for a node such as "/top"."""
        if self.ros_name.startswith("~"):
            return f"{node}{self.ros_name[1:]}"
        if self.ros_name.startswith("/"):
            return self.ros_name
        return f"{node.rpartition('/')[0]}/{self.ros_name}"

    def load_message_class(self) -> Any:
        """Return the Python class of the message type; the only method that needs ROS.

        None if its package is not installed (tf2_msgs is not on PyPI, where the rest of ROS 2 is).
        """
        package, _, name = self.type.split("/")
        try:
            return getattr(importlib.import_module(f"{package}.msg"), name)
        except ModuleNotFoundError:
            return None


@dataclass(frozen=True, slots=True)
class Samples:
    """States of a run at one stamp or at many: what the content of a message is computed from."""

    segment: Segment
    stamps: Any  # in ns
    state: State  # at these stamps; one state for all of them while paused

    @classmethod
    def at(cls, segment: Segment, stamps: Any) -> "Samples":
        """Return the samples of a segment at a stamp (ns) or an array of stamps."""
        return cls(segment, stamps, segment.state_at(stamps))


@dataclass(frozen=True, slots=True)
class StateTopic(Topic):
    """A topic with one message in every sample."""

    format: Format = messages.VECTOR  # encoding of the message; its type is the type of the topic
    # returns the doubles of the message, (..., width), from the samples
    compute: Callable[[Samples], Real] = lambda samples: samples.state.vertical
    # returns the constant names of the message from the world frame and the frame of the top
    names: Callable[[str, str], tuple[str, ...]] = lambda world, _: (world,)
    switch: str = ""  # parameter without which the topic does not exist; empty: it always does
    angles: str = ""  # quantity of Euler's angles, which are equal modulo 2 pi; empty: none

    def layout(self, world: str, top: str) -> Layout:
        """Return the layout of the message with the given frame names."""
        return self.format.layout(*self.names(world, top))


def _state_topic(
    ros_name: str, form: Format, compute: Callable[[Samples], Real], **options: Any
) -> StateTopic:
    return StateTopic(ros_name, form.type, format=form, compute=compute, **options)


def _quaternion(samples: Samples) -> Real:
    """Quaternion x, y, z, w, body -> world."""
    return samples.state.orientation[..., [1, 2, 3, 0]]


def _wrench(samples: Samples) -> Real:
    """Force of the pivot on the top, total torque about the pivot.

    The force depends on a mass, and is nan for a top that no body can be.
    """
    motion = samples.segment.motion
    state = samples.state
    wrench = _after_zeros(motion.total_torque(state))
    body = samples.segment.rig.find_body(motion.top)
    wrench[..., :3] = body.pivot_force(motion, state) if body else np.nan
    return wrench


def _euler_angles(samples: Samples) -> Real:
    """Euler's angles and their rates; phi' is exactly 0 while a hand holds the precession."""
    state = samples.state
    return np.stack([*state.euler_angles, *samples.segment.motion.euler_rates(state)], axis=-1)


def _imu(samples: Samples) -> Real:
    """Orientation, angular velocity and specific force of the sensor, each with its covariance."""
    imu = samples.segment.rig.imu
    shape = np.shape(samples.stamps)
    if not imu:
        return np.full((*shape, messages.IMU.width), np.nan)
    orientation, rates, force = imu.measure(
        samples.segment.motion, samples.state, samples.segment.rig.gravity
    )
    shown = imu.show(np.concatenate((rates, force), axis=-1), samples.stamps)
    measured = zip(imu.covariances, (orientation, shown[..., :3], shown[..., 3:]), strict=True)
    variances = {f"{name}_covariance": each for name, each in imu.covariances.items()}
    return messages.IMU.arrange(shape, {**dict(measured), **variances})


def _magnetic_field(samples: Samples) -> Real:
    """Magnetic field in the frame of the sensor, and its covariance."""
    imu = samples.segment.rig.imu
    form = messages.MAGNETIC_FIELD
    shape = np.shape(samples.stamps)
    if not (imu and imu.magnetometer):
        return np.full((*shape, form.width), np.nan)
    exact, errors = imu.measure_field(samples.state, samples.stamps)
    variance = imu.magnetometer.variance(imu.rate)
    return form.arrange(
        shape, {"magnetic_field": exact + errors, "magnetic_field_covariance": variance}
    )


def _odometry(samples: Samples) -> Real:
    """Pose and twist of the centre of mass, the latter in its own frame, with covariances."""
    state = samples.state
    body = samples.segment.rig.find_body(samples.segment.motion.top)
    omega = state.angular_velocity
    arm = body.arm if body else np.nan
    x, y, _ = split(omega)
    return messages.ODOMETRY.arrange(
        omega.shape[:-1],
        {
            "position": state.to_world([0.0, 0.0, 1.0]) * arm,
            "orientation": _quaternion(samples),
            "pose_covariance": EXACT,
            "linear": stack(y * arm, -x * arm, 0.0 * abs(x)),  # omega x (0, 0, arm)
            "angular": omega,
            "twist_covariance": EXACT,
        },
    )


def imu_frame(top: str) -> str:
    """Return the name of the frame of the sensor."""
    return f"{top}_imu"


def centre_frame(top: str) -> str:
    """Return the name of the frame in the centre of mass."""
    return f"{top}_centre_of_mass"


def _after_zeros(vector: Real) -> Real:
    return np.concatenate([np.zeros_like(vector[..., :3]), vector], axis=-1)


STATE_TOPICS: dict[str, StateTopic] = {
    topic.name: topic
    for topic in (
        _state_topic("~/orientation", messages.QUATERNION, _quaternion),
        _state_topic(
            "~/angular_velocity",
            messages.TWIST,
            # the linear velocity is zero: the pivot is fixed
            lambda samples: _after_zeros(samples.state.to_world(samples.state.angular_velocity)),
        ),
        _state_topic(
            "~/angular_momentum",
            messages.VECTOR,
            lambda samples: samples.segment.motion.top.angular_momentum(samples.state),
        ),
        _state_topic("~/torque", messages.WRENCH, _wrench),
        _state_topic(
            "~/euler_angles",
            messages.JOINT_STATE,
            _euler_angles,
            names=lambda world, _: (world, *messages.JOINTS),
            angles="position",
        ),
        _state_topic(
            "/tf",
            messages.TRANSFORM,
            # the origins of both frames are the pivot: the translation is zero
            lambda samples: _after_zeros(_quaternion(samples)),
            names=lambda world, top: (world, top),
        ),
    )
}
# Topics that exist only if a parameter asks for them.
SENSOR_TOPICS: dict[str, StateTopic] = {
    topic.name: topic
    for topic in (
        _state_topic(
            "~/imu",
            messages.IMU,
            _imu,
            names=lambda _, top: (imu_frame(top),),
            switch="imu.enabled",
        ),
        _state_topic(
            "~/magnetic_field",
            messages.MAGNETIC_FIELD,
            _magnetic_field,
            names=lambda _, top: (imu_frame(top),),
            switch="magnetic_field.enabled",
        ),
        _state_topic(
            "~/odometry",
            messages.ODOMETRY,
            _odometry,
            names=lambda world, top: (world, centre_frame(top)),
            switch="odometry.enabled",
        ),
    )
}
SAMPLE_TOPICS = {**STATE_TOPICS, **SENSOR_TOPICS}
TF_STATIC = Topic("/tf_static", "tf2_msgs/msg/TFMessage", depth=1, latched=True)
EVENTS = Topic("~/events", DIAGNOSTIC_ARRAY, latched=True)
DESCRIPTION = Topic("~/robot_description", "std_msgs/msg/String", depth=1, latched=True)
DIAGNOSTICS = Topic("/diagnostics", DIAGNOSTIC_ARRAY, depth=10)
CLOCK = Topic("/clock", "rosgraph_msgs/msg/Clock")
MARKERS = Topic("~/markers", "visualization_msgs/msg/MarkerArray", depth=10)
# Only received; logged with the bytes that came.
APPLIED_TORQUE = Topic("~/applied_torque", messages.WRENCH.type)
# Only in the log of a run with measured points: these, as in run.json.
POINTS = Topic("~/points", DESCRIPTION.type, depth=1, latched=True)
# Events come first, so that they precede the samples of the same stamp in every log.
TOPICS: dict[str, Topic] = {
    topic.name: topic
    for topic in (
        EVENTS,
        DESCRIPTION,
        TF_STATIC,
        *SAMPLE_TOPICS.values(),
        DIAGNOSTICS,
        CLOCK,
        MARKERS,
    )
}
