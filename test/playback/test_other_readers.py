"""Rerun's own MCAP loader agrees with our reader, message for message."""

import numpy as np
import pytest
from log_files import LAYOUTS, Run, topic
from programs import execute
from rerun.chunk import McapReader

from symtop_ros.log.reader import McapFile
from symtop_ros.log.repair import repair
from symtop_ros.playback import viewer
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


@pytest.mark.parametrize("name", list(VECTORS))
def test_stamped_messages_are_the_same_numbers(name, chunks):
    kind, vectors = VECTORS[name]
    column = f"geometry_msgs.msg.{kind}:message"
    batches = [each.to_record_batch() for each in chunks if each.entity_path == topic(name)]
    messages = [value[0] for batch in batches for value in batch.column(column).to_pylist()]
    stamps = [each["header"]["stamp"] for each in messages]
    numbers = [[x for part in vectors(each) for x in part.values()] for each in messages]
    order = np.argsort([each["sec"] * 10**9 + each["nanosec"] for each in stamps])
    data = [data for each, _, data in RUN.messages if each == name]
    ((ours,), _) = decode_messages(STATE_TOPICS[name].format, data)
    assert np.array(numbers)[order].tolist() == ours.numbers.tolist()


@pytest.mark.parametrize("part", [1.0, 0.75, 0.5])
def test_rerun_finds_no_fault_in_a_log_that_is_complete_or_repaired(part, tmp_path):
    content = Run(seconds=1.0, described=True).write(tmp_path).read_bytes()
    (path := tmp_path / "cut.mcap").write_bytes(content[: round(part * len(content))])
    if part < 1:
        assert execute([viewer.PROGRAM, "mcap", "check", path]).returncode == 1
        repair(McapFile(path), path := tmp_path / "repaired.mcap")
    done = execute([viewer.PROGRAM, "mcap", "check", "--full", path])
    assert done.returncode == 0, done.stdout
    assert all(topic(name) in done.stdout for name in LAYOUTS)
