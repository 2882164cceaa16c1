"""Rerun's own MCAP loader agrees with our reader, message for message."""

import numpy as np
import pytest
from log_files import LAYOUTS, Run, topic
from rerun.chunk import McapReader

from symtop_ros.simulation.topics import STATE_TOPICS
from symtop_ros.wire.messages import decode_messages

RUN = Run(seconds=1.0)
VECTORS = {
    "angular_momentum": ("Vector3Stamped", lambda message: [message["vector"]]),
    "angular_velocity": ("TwistStamped", lambda message: list(message["twist"].values())),
    "torque": ("WrenchStamped", lambda message: list(message["wrench"].values())),
    "orientation": ("QuaternionStamped", lambda message: [message["quaternion"]]),
}


@pytest.fixture(scope="module")
def chunks(tmp_path_factory):
    path = RUN.write(tmp_path_factory.mktemp("logs"))
    return [chunk for chunk in McapReader(path).stream() if not chunk.is_static]


def ours(name):
    data = [data for each, _, data in RUN.messages if each == name]
    ((found,), _) = decode_messages(STATE_TOPICS[name].format, data)
    return found


@pytest.mark.parametrize("name", list(VECTORS))
def test_stamped_messages_are_the_same_numbers(name, chunks):
    kind, vectors = VECTORS[name]
    column = f"geometry_msgs.msg.{kind}:message"
    batches = [each.to_record_batch() for each in chunks if each.entity_path == topic(name)]
    messages = [value[0] for batch in batches for value in batch.column(column).to_pylist()]
    stamps = [each["header"]["stamp"] for each in messages]
    numbers = [[x for part in vectors(each) for x in part.values()] for each in messages]
    order = np.argsort([each["sec"] * 10**9 + each["nanosec"] for each in stamps])
    assert np.array(numbers)[order].tolist() == ours(name).numbers.tolist()


def test_transforms_are_the_same_rotations(chunks):
    batches = [each.to_record_batch() for each in chunks if each.entity_path == "/tf"]
    rows = [
        (time.value, value[0])
        for batch in batches
        for time, value in zip(
            batch.column("message_log_time"),
            batch.column("Transform3D:quaternion").to_pylist(),
            strict=True,
        )
    ]
    rows.sort(key=lambda row: row[0])
    expected = ours("tf")
    assert [time for time, _ in rows] == expected.stamps.tolist()
    drawn = np.array([value for _, value in rows])
    assert np.array_equal(drawn, expected.numbers[:, 3:].astype(np.float32))


def test_every_topic_has_as_many_messages(chunks):
    for name in LAYOUTS:
        batches = [each for each in chunks if each.entity_path == topic(name)]
        assert sum(each.num_rows for each in batches) == 200
