import os

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import QuaternionStamped
from rclpy.serialization import serialize_message
from waiting import until

from workshop.load.follower import Follower

RATE = 100.0  # Hz


def make_sample(tick):
    message = QuaternionStamped()
    message.header.stamp.sec = 1
    message.header.stamp.nanosec = tick * 10_000_000
    return serialize_message(message)


def make_report(missed, name="/top", tick=99):
    values = {"name": name, "missed": str(missed), "energy.balance": "-1e-15"}
    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    report = DiagnosticArray(status=[DiagnosticStatus(values=pairs)])
    report.header.stamp.sec = 1
    report.header.stamp.nanosec = tick * 10_000_000
    return report


def test_samples_that_the_node_reports_as_missed_are_not_lost():
    follower = Follower(RATE)
    follower.read_diagnostics(make_report(missed=3))  # before the count begins
    follower.reset_counts()
    for tick in (1, 2, 4, 7):  # 3, 5 and 6 are absent
        follower.receive(make_sample(tick))
    for report in (make_report(missed=5), make_report(missed=9, name="/other")):
        follower.read_diagnostics(report)
    assert (follower.samples, follower.missed) == (4, 2)
    assert (follower.lost, follower.balance) == (1, 1e-15)
    follower.receive(make_sample(20))  # 8 to 19 are of the next report
    follower.read_diagnostics(make_report(missed=5, tick=20))
    assert follower.lost == 1
    follower.read_diagnostics(make_report(missed=5, tick=21))
    assert follower.lost == 13
    follower.close()


def count_threads():
    return len(os.listdir("/proc/self/task"))


def test_a_follower_that_has_left_receives_nothing_of_later_nodes():
    """Its participant would take part in every measurement that follows in the same process."""
    left = [Follower(RATE)]
    left[0].close()
    before = count_threads()  # some threads belong to the process
    for _ in range(3):
        left.append(Follower(RATE))
        left[-1].close()
    until(lambda: count_threads() <= before)
