"""One MCAP file: the quality of service of its channels, and names that are never reused."""

from log_files import LAYOUTS, Run
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability, QosReliability

from symtop_ros.log.definitions import Channel
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
    log = LogFile(tmp_path, [Channel("/x", EVENTS)], {"ros_distro": "jazzy"}, {})
    log.write(0, 0, b"")
    log.finish({})
    with log.path.open("rb") as stream:
        found = {each.name: each.metadata for each in make_reader(stream).iter_metadata()}
    assert found["rosbag2"] == {"serialized_metadata": "", "ROS_DISTRO": "jazzy"}


def test_a_log_without_any_message_is_removed(tmp_path):
    """As of a node that is ended before its first sample."""
    log = LogFile(tmp_path, [Channel("/x", EVENTS)], {}, {0: b"latched"})
    log.finish({})
    assert list(tmp_path.iterdir()) == []
