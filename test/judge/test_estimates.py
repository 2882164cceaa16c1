"""Estimates from each message type."""

import pytest
from judge.cases import SOME, encode

from symtop_ros.judge.estimates import FORMATS, decode_estimates
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.wire.messages import TRANSFORM


@pytest.mark.parametrize("kind", sorted(FORMATS))
def test_every_type_with_an_attitude_is_read(kind):
    _, messages = encode(kind, SOME)
    found = decode_estimates(kind, [data for _, data in messages])
    assert (found.stamps == SOME.stamps).all()
    assert (found.orientations == SOME.orientations).all()
    if not {"angular_velocity", "angular"} & set(FORMATS[kind].quantities):
        assert found.angular_velocities is None
    else:
        assert (found.angular_velocities == SOME.angular_velocities).all()


@pytest.mark.parametrize("kind", sorted(FORMATS))
def test_the_real_message_classes_are_read(kind):
    serialization = pytest.importorskip("rclpy.serialization")
    package, _, name = kind.split("/")
    module = pytest.importorskip(f"{package}.msg")
    message = getattr(module, name)()
    message.header.stamp.sec, message.header.stamp.nanosec = 3, 7
    message.header.frame_id = "odd"
    holder = message
    for part in ("pose", "pose", "transform"):
        holder = getattr(holder, part, holder)
    field = "orientation" if hasattr(holder, "orientation") else "rotation"
    q = getattr(holder, field, None) or holder.quaternion
    q.w, q.x, q.y, q.z = 0.5, -0.5, 0.5, 0.5
    found = decode_estimates(kind, [serialization.serialize_message(message)])
    assert found.stamps.tolist() == [3_000_000_007]
    assert found.orientations.tolist() == [[0.5, -0.5, 0.5, 0.5]]


def test_an_imu_without_orientation_is_left_out():
    _, messages = encode("sensor_msgs/msg/Imu", SOME)
    layout = FORMATS["sensor_msgs/msg/Imu"].layout("imu")
    unknown = layout.encode(5, [0.0, 0, 0, 1, -1.0, *[0.0] * 32])
    found = decode_estimates("sensor_msgs/msg/Imu", [messages[0][1], unknown, b"noise"])
    assert (len(found), found.left_out) == (1, 2)


def test_transforms_of_several_frames_need_a_name():
    numbers = [0.0, 0, 0, 0, 0, 0, 1]
    data = [TRANSFORM.layout("world", child).encode(9, numbers) for child in ("a", "b")]
    with pytest.raises(RefusedError, match="--frame must be one of a, b, got none"):
        decode_estimates(TRANSFORM.type, data)
    assert decode_estimates(TRANSFORM.type, data, "b").stamps.tolist() == [9]
    assert len(decode_estimates(TRANSFORM.type, data, "c")) == 0
