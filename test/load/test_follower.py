import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import QuaternionStamped
from node.listener import Listener

from workshop.load.follower import Follower
from workshop.load.processes import domain

RATE = 100.0  # Hz


class StandIn:
    """Publishes what a top would, when it is asked to."""

    def __init__(self, node):
        self.orientation = node.create_publisher(QuaternionStamped, "/top/orientation", 1000)
        self.diagnostics = node.create_publisher(DiagnosticArray, "/diagnostics", 100)

    def sample(self, *ticks):
        for tick in ticks:
            message = QuaternionStamped()
            message.header.stamp.sec, message.header.stamp.nanosec = 1, tick * 10_000_000
            self.orientation.publish(message)

    def report(self, name, missed):
        values = {"name": name, "missed": str(missed), "energy.balance": "-1e-15"}
        pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
        self.diagnostics.publish(DiagnosticArray(status=[DiagnosticStatus(values=pairs)]))


@pytest.fixture
def top():
    with Listener(domain(), "stand_in") as stand_in:
        yield StandIn(stand_in.node)


@pytest.fixture
def follower(top):
    follower = Follower(RATE)
    wait(follower, lambda: all(count() for count in matches(top, follower)))
    top.sample(0)
    top.report("/top", missed=3)  # before the count begins
    follower.begin()
    yield follower
    follower.close()


def wait(follower, done):
    assert follower.connection.spin_until(done, 60.0)


def matches(top, follower):
    """Counts of both sides; a message that is sent before they know each other is lost."""
    yield top.orientation.get_subscription_count
    yield top.diagnostics.get_subscription_count
    for each in follower.node.subscriptions:
        yield each.get_publisher_count


def test_samples_that_the_node_reports_as_missed_are_not_lost(top, follower):
    top.sample(1, 2, 4, 7)  # 3, 5 and 6 are absent
    wait(follower, lambda: follower.samples == 4)
    top.report("/top", missed=5)
    wait(follower, lambda: follower.missed == 2)
    assert follower.lost == 1
    assert follower.balance == 1e-15
