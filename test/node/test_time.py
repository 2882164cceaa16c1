"""Simulation time: the top follows /clock, and goes on from where it is when the clock jumps."""

from itertools import pairwise

import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from node.running_top import LATCHED, segment_of, stamp_of
from rosgraph_msgs.msg import Clock

from symtop_ros.node.fields import RefusedError

MS = 1_000_000


class SimulatedClock:
    """A /clock that a test turns."""

    def __init__(self, run):
        self.run = run
        self.publisher = run.user.create_publisher(Clock, "/clock", 10)
        run.spin_until(lambda: self.publisher.get_subscription_count() > 0)

    def turn_to(self, stamp):
        seconds, nanoseconds = divmod(stamp, 1_000_000_000)
        self.publisher.publish(Clock(clock=Time(sec=seconds, nanosec=nanoseconds)))
        self.run.spin_until(lambda: self.run.top.get_clock().now().nanoseconds == stamp)

    def run_from(self, stamp, count):
        for k in range(count):
            self.turn_to(stamp + k * 10 * MS)


def test_stamps_and_motion_follow_the_clock_also_when_it_jumps(start_top):
    run = start_top(use_sim_time=True, publish_rate=100.0)
    messages = run.collect(QuaternionStamped, "/top/orientation")
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    clock = SimulatedClock(run)
    clock.run_from(50_000 * MS, 30)
    run.spin_until(lambda: len(messages) >= 20)
    clock.run_from(20_000 * MS, 30)  # back
    run.spin_until(lambda: any(20_100 * MS <= stamp_of(each) < 21_000 * MS for each in messages))
    clock.run_from(90_000 * MS, 30)  # and forward
    run.spin_until(lambda: any(stamp_of(each) >= 90_100 * MS for each in messages))
    # to the first /clock, back, and forward
    run.spin_until(lambda: [each.status[0].name for each in events].count("top: clock") >= 3)
    segments = [segment_of(message) for message in events]
    assert max(segment.elapsed for segment in segments) < 1.0  # no catching up with the jumps
    for message in messages:
        stamp, q = stamp_of(message), message.quaternion
        states = [each.state_at(stamp) for each in segments if each.stamp <= stamp]
        assert [q.w, q.x, q.y, q.z] in [state.orientation.tolist() for state in states]


def test_while_the_clock_stands_still_so_does_the_top(start_top):
    run = start_top(use_sim_time=True, publish_rate=100.0)
    messages = run.collect(QuaternionStamped, "/top/orientation")
    clock = SimulatedClock(run)
    clock.run_from(50_000 * MS, 5)
    run.spin_until(lambda: messages and stamp_of(messages[-1]) == 50_040 * MS)
    told = [run.trigger("get_state")[1] for _ in range(20)]  # real time goes by
    assert len(set(told)) == 1
    assert stamp_of(messages[-1]) == 50_040 * MS
    clock.run_from(50_050 * MS, 3)
    run.spin_until(lambda: stamp_of(messages[-1]) == 50_070 * MS)
    assert {b - a for a, b in pairwise(map(stamp_of, messages))} == {10 * MS}


def test_a_published_clock_and_simulation_time_contradict_each_other(start_top):
    with pytest.raises(RefusedError, match="publish_clock: got true together with use_sim_time"):
        start_top(use_sim_time=True, publish_clock=True)
