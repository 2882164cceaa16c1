"""Our bytes and rclpy's are the same message, for any values and names."""

from operator import attrgetter

import numpy as np
import pytest
from geometry_msgs import msg as geometry
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState

from symtop_ros.run.wire import messages
from symtop_ros.run.wire.layout import DecodeError, Doubles, Layout, Reader, Stamp, Writer

DOUBLE = st.floats(allow_nan=False)
STAMP = st.integers(0, (2**31 - 1) * 10**9 + 999_999_998)
NAME = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=12)


TWIST = {"twist.linear": "xyz", "twist.angular": "xyz"}
WRENCH = {"wrench.force": "xyz", "wrench.torque": "xyz"}
# Class and format, and the vectors of which the numbers of a message consist.
CASES = {
    "orientation": (geometry.QuaternionStamped, messages.QUATERNION, {"quaternion": "xyzw"}),
    "angular_velocity": (geometry.TwistStamped, messages.TWIST, TWIST),
    "angular_momentum": (geometry.Vector3Stamped, messages.VECTOR, {"vector": "xyz"}),
    "torque": (geometry.WrenchStamped, messages.WRENCH, WRENCH),
    "euler_angles": (JointState, messages.JOINT_STATE, {}),
}


def numbers_of(message, vectors):
    """The doubles of a message in order."""
    if isinstance(message, JointState):
        return [*message.position, *message.velocity]
    return [attrgetter(f"{name}.{axis}")(message) for name in vectors for axis in vectors[name]]


@pytest.mark.parametrize("name", CASES)
@settings(max_examples=60)
@given(stamp=STAMP, frame=NAME, data=st.data())
def test_rclpy_reads_what_we_pack_and_we_read_what_rclpy_writes(name, stamp, frame, data):
    """Byte for byte the same, but for padding."""
    kind, form, vectors = CASES[name]
    names = (frame, *messages.JOINTS) if name == "euler_angles" else (frame,)
    layout = form.layout(*names)
    numbers = data.draw(st.lists(DOUBLE, min_size=form.width, max_size=form.width))
    packed = layout.encode(stamp, numbers)
    message = deserialize_message(packed, kind)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == divmod(stamp, 10**9)
    assert message.header.frame_id == frame
    assert numbers_of(message, vectors) == numbers
    theirs = serialize_message(message)
    assert 0 <= len(theirs) - len(packed) < 8  # rclpy estimates the size of an empty sequence
    rows = np.frombuffer(theirs[: len(packed)], np.uint8)[None]
    assert layout.match(rows)[0]
    assert layout.decode(rows)[1].tolist() == [numbers]
    both = [numbers, numbers[::-1]]  # messages that are encoded together are those of one by one
    together = layout.encode_many(np.array([stamp, stamp + 1]), np.array(both))
    assert together == [packed, layout.encode(stamp + 1, numbers[::-1])]
    found, refused = messages.decode_messages(form, [theirs])
    assert not refused
    assert found[0].stamps.tolist() == [stamp]
    assert found[0].numbers.tolist() == [numbers]
    assert found[0].names[0] == frame


def test_a_transform_is_a_sequence_of_one_transform_stamped():
    inner = geometry.TransformStamped(child_frame_id="top")
    inner.header.stamp.sec, inner.header.stamp.nanosec, inner.header.frame_id = 5, 7, "world"
    inner.transform.rotation.x, inner.transform.rotation.w = 0.6, 0.8
    # a sequence is its length and its elements, each aligned from the same origin; 4 bytes more
    # before the stamp shift nothing that is aligned to 8 here: world and top pad to the same place
    numbers = [0.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.8]
    packed = messages.TRANSFORM.layout("world", "top").encode(5_000_000_007, numbers)
    reader = Reader(packed)
    assert reader.count() == 1
    assert (reader.integer("i"), reader.integer()) == (5, 7)
    assert (reader.string(), reader.string()) == ("world", "top")
    assert packed[-56:] == serialize_message(inner)[-56:]


DAMAGED = [b"", b"\0", b"\0\1\0\0", b"\1\0\0\0" * 20, b"\0\0\0\0" * 20, b"\0\1\0\0" + b"\xff" * 60]


@pytest.mark.parametrize("damaged", DAMAGED)
@pytest.mark.parametrize("name", [*CASES, "tf"])
def test_bytes_that_are_no_message_are_refused_and_the_others_read(name, damaged):
    _, form, _ = CASES.get(name, (None, messages.TRANSFORM, {}))
    names = {"tf": ("world", "top"), "euler_angles": ("world", *messages.JOINTS)}
    good = form.layout(*names.get(name, ("world",)))
    mixed = [damaged, good.encode(1, [0.5] * form.width), damaged]
    found, refused = messages.decode_messages(form, mixed)
    assert len(refused) == 2
    assert found[0].indices.tolist() == [1]


def test_a_number_is_aligned_after_a_string_of_any_length():
    writer = Writer()
    for text in ("", "a", "four", "seven77"):
        writer.strings([text])
        writer.numbers([0.1, 0.2])
    reader = Reader(writer.data)
    found = [(reader.string(), reader.number(), reader.number()) for _ in range(4)]
    assert found == [(text, 0.1, 0.2) for text in ("", "a", "four", "seven77")]


def test_a_sequence_cannot_announce_more_than_there_is():
    with pytest.raises(DecodeError, match="sequence of 4294967295 elements does not fit in 12 b"):
        Reader(b"\0\1\0\0" + b"\xff" * 8).strings()


FORMATS = [each for each in vars(messages).values() if isinstance(each, messages.Format)]


@pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.type)
def test_the_quantities_of_a_message_follow_one_another_and_are_all_of_it(form):
    places = [range(form.width)[place] for place in form.quantities.values()]
    assert [number for place in places for number in place] == list(range(form.width))


STAMPS = [([Doubles(1)], 0), ([Stamp(), Doubles(1), Stamp()], 2)]


@pytest.mark.parametrize(("parts", "count"), STAMPS)
def test_a_layout_without_one_stamp_is_refused(parts, count):
    with pytest.raises(ValueError, match=rf"^a layout must have one Stamp, got {count}$"):
        Layout(*parts)


def test_doubles_are_arranged_by_quantity_and_a_covariance_by_its_variance():
    numbers = messages.MAGNETIC_FIELD.arrange((2,), {"magnetic_field_covariance": 4.0})
    assert numbers.tolist() == [[0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4]] * 2
