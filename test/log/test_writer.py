"""One MCAP file: the quality of service of its channels, and names that are never reused."""

import errno
import os

import pytest
from log_files import LAYOUTS, Run
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability, QosReliability

from symtop_ros.log.reader import LogError, McapFile
from symtop_ros.log.repair import repair
from symtop_ros.log.writer import LogFile
from symtop_ros.simulation.topics import EVENTS, TOPICS


def test_channels_store_the_quality_of_service_that_the_node_offers(tmp_path):
    path = Run(seconds=0.1).write(tmp_path)
    with AnyReader([path]) as reader:
        profiles = {each.topic: each.ext.offered_qos_profiles for each in reader.connections}
    assert len(profiles) == len(LAYOUTS) + 2
    for name, (profile,) in profiles.items():
        topic = TOPICS[name.rpartition("/")[2]]
        assert profile.depth == topic.depth
        assert profile.reliability == QosReliability.RELIABLE
        latched, volatile = QosDurability.TRANSIENT_LOCAL, QosDurability.VOLATILE
        assert profile.durability == (latched if topic.latched else volatile)


def test_the_distribution_is_written_where_ros2_bag_info_reads_it(tmp_path):
    """rosbag2_storage_mcap: record "rosbag2", an empty text for no further metadata."""
    log = LogFile(tmp_path, [EVENTS], {"ros_distro": "jazzy"}, {})
    log.write(0, 0, b"")
    log.finish({})
    with log.path.open("rb") as stream:
        found = {each.name: each.metadata for each in make_reader(stream).iter_metadata()}
    assert found["rosbag2"] == {"serialized_metadata": "", "ROS_DISTRO": "jazzy"}


def test_a_log_without_any_message_is_removed(tmp_path):
    """As of a node that is ended before its first sample."""
    log = LogFile(tmp_path, [EVENTS], {}, {0: b"latched"})
    log.finish({})
    assert list(tmp_path.iterdir()) == []


RUN = Run()


@pytest.fixture
def cut(tmp_path):
    whole = RUN.write(tmp_path / "logs").read_bytes()
    path = tmp_path / "cut.mcap"
    path.write_bytes(whole[: len(whole) * 2 // 3])
    return path


def test_the_readable_messages_become_a_complete_file_for_every_reader(cut, tmp_path):
    target = tmp_path / "whole.mcap"
    file = McapFile(cut)
    count = repair(file, target)
    assert 0 < count < len(RUN.messages)
    assert "messages after" in file.problems[0]
    with target.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert reader.get_summary().statistics.message_count == count
        channels = reader.get_summary().channels.values()
        kept = {each.name: each.metadata for each in reader.iter_metadata()}
        assert kept["symtop_ros"] == file.metadata["symtop_ros"]
        assert {each.metadata["topic_type_hash"][:7] for each in channels} == {"RIHS01_"}
        messages = [message.data for _, _, message in reader.iter_messages(log_time_order=False)]
    assert messages == [data for _, _, data in RUN.messages[:count]]
    with AnyReader([target]) as other:
        assert sum(1 for _ in other.messages()) == count


def test_the_target_is_never_overwritten(cut, tmp_path):
    target = tmp_path / "there.mcap"
    target.write_text("mine")
    with pytest.raises(LogError, match=r"there\.mcap must not exist \(nothing is overwritten\)"):
        repair(McapFile(cut), target)
    assert target.read_text() == "mine"


def test_a_target_that_cannot_be_written_is_reported(cut, tmp_path):
    with pytest.raises(LogError, match=os.strerror(errno.ENOENT)):
        repair(McapFile(cut), tmp_path / "none" / "whole.mcap")


def test_messages_of_a_channel_without_a_description_are_omitted_and_reported(tmp_path):
    path = tmp_path / "odd.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start("ros2")
        known = writer.register_channel("/known", "cdr", 0)
        writer.add_message(known, 1, b"mine", 1)
        writer.add_message(known + 1, 2, b"whose", 2)
        writer.finish()
    file = McapFile(path)
    assert repair(file, tmp_path / "whole.mcap") == 1
    assert any(each.startswith(f"channel {known + 1} ") for each in file.problems)
    with (tmp_path / "whole.mcap").open("rb") as stream:
        found = [message.data for _, _, message in make_reader(stream).iter_messages()]
    assert found == [b"mine"]
