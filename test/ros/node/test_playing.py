"""A log of the node, played again and again as `ros2 bag play --loop` does, and recorded."""

import pytest
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from ros.node.listener import Listener
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from waiting import until

from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.topics import DESCRIPTION, EVENTS, MARKERS
from workshop.load.domains import claim_domain, release_domain

DESCRIBED = DESCRIPTION.resolve("/top")
EVENT, MARKED = EVENTS.resolve("/top"), MARKERS.resolve("/top")
LOOPS = 3
STORE = get_typestore(Stores.ROS2_JAZZY)


class Player(Listener):
    """Publishes the messages of a log with the quality of service that it stores for each topic."""

    def __init__(self, log, domain):
        super().__init__(domain, "player")
        with AnyReader([log]) as reader:
            self.messages = [(each.topic, data) for each, _, data in reader.messages()]
            self.kinds = {each.topic: each.msgtype for each in reader.connections if each.msgcount}
            self.publishers = dict(map(self._publish, reader.connections))

    def _publish(self, connection):
        (offered,) = connection.ext.offered_qos_profiles
        latched, volatile = QoSDurabilityPolicy.TRANSIENT_LOCAL, QoSDurabilityPolicy.VOLATILE
        is_latched = offered.durability == QosDurability.TRANSIENT_LOCAL
        qos = QoSProfile(depth=offered.depth, durability=latched if is_latched else volatile)
        kind = load(connection.msgtype)
        return connection.topic, kind and self.node.create_publisher(kind, connection.topic, qos)

    def play(self, between=lambda: None):
        for topic, data in self.messages:
            if self.publishers[topic]:
                self.publishers[topic].publish(data)
                between()


def load(kind):
    """The class of a message, None if its package is not installed (tf2_msgs)."""
    package, _, name = kind.split("/")
    try:
        return getattr(__import__(f"{package}.msg", fromlist=[name]), name)
    except ModuleNotFoundError:
        return None


@pytest.fixture
def player(start_top, tmp_path):
    run = start_top(publish_markers=True, publish_rate=100.0, record=tmp_path)
    for _ in range(2):
        run.trigger("hurry_precession")
        later = run.now + 2 * 10**8
        run.spin_until(lambda later=later: run.now > later)
    domain = claim_domain()
    with Player(run.end_log(), domain) as player:
        yield player
    release_domain(domain)


def subscribe(listener, player, topic, latched=False):
    durability = QoSDurabilityPolicy.TRANSIENT_LOCAL if latched else QoSDurabilityPolicy.VOLATILE
    qos = QoSProfile(depth=1000, durability=durability)
    return listener.collect(load(player.kinds[topic]), topic, qos, raw=True)


def test_a_late_subscriber_gets_the_latched_messages_at_once_and_the_next_markers(player):
    player.play()
    with Listener(player.context.get_domain_id()) as late:
        sent = {
            name: [data for topic, data in player.messages if topic == name]
            for name in (EVENT, MARKED)
        }
        events = subscribe(late, player, EVENT, latched=True)
        described = subscribe(late, player, DESCRIBED, latched=True)
        markers = subscribe(late, player, MARKED)
        late.spin_until(lambda: len(events) == len(sent[EVENT]) and described)
        assert events == sent[EVENT]
        until(player.publishers[MARKED].get_subscription_count)
        assert markers == []
        player.play()
        late.spin_until(lambda: len(markers) == len(sent[MARKED]))
    assert markers == sent[MARKED]


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_bag_of_a_log_in_a_loop_is_exact_and_said_to_be_repeated(storage, player, tmp_path):
    """Its times of arrival continue, and its stamps go back to the beginning with each loop."""
    bag = Writer(tmp_path / "bag", version=9, storage_plugin=storage)
    with bag:
        channels = {
            topic: bag.add_connection(topic, kind, typestore=STORE)
            for topic, kind in player.kinds.items()
        }
        for arrival, (topic, data) in enumerate(LOOPS * player.messages):
            bag.write(channels[topic], arrival, data)
    log = TopLog(open_run([bag.path]))
    found = check_run(log)
    assert found.mismatches == []
    assert {each.largest for each in found.deviations.values()} == {0.0}
    for name, each in found.deviations.items():
        count = sum(topic == log.catalog.topics[name].name for topic, _ in player.messages)
        assert each.samples + each.unjudged == LOOPS * count
        assert log.catalog.topics[name].repeated == (LOOPS - 1) * count
    (line,) = (each for each in log.catalog.problems if "the stamps of others: repeated" in each)
    assert all(name in line for name in found.deviations)
