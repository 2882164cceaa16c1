"""Services as a user calls them: a granted request takes effect at one instant."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from node.running_top import LATCHED, events_named, stamp_of
from sensor_msgs.msg import JointState


def theta(message):
    return message.position[1]


@pytest.mark.wording
def test_hurrying_the_slow_root_raises_the_top_and_says_so(start_top):
    run = start_top(scene="hurry_slow")
    angles = run.collect(JointState, "/top/euler_angles")
    run.wait_for(angles, 5)
    assert all(abs(theta(message) - 0.5) < 1e-14 for message in angles)  # a few ulp: regular
    granted, answer = run.trigger("hurry_precession")
    assert granted
    assert answer.startswith("Precession 6.50 -> 9.10 rad/s. The top rises: theta will stay ")
    assert "between 0.437 and 0.500 rad" in answer
    assert "Perry's rule holds" in answer
    angles.clear()
    run.spin_until(lambda: len(angles) > 100)  # three nutations
    assert min(map(theta, angles)) == pytest.approx(0.437, abs=2e-3)  # 5 ms between samples
    assert max(map(theta, angles)) <= 0.5 + 1e-14


def test_the_first_message_of_the_new_motion_comes_within_one_period_of_the_answer(start_top):
    run = start_top(publish_rate=50.0)
    messages = run.collect(JointState, "/top/euler_angles")
    run.spin_until(lambda: len(messages) > 2)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    for count in range(1, 6):
        run.set("set_initial_conditions", theta=1.0)
        asked = run.now
        run.spin_until(lambda count=count: len(events_named(events, "start")) == count + 1)
        start = stamp_of(events_named(events, "start")[-1])
        run.spin_until(lambda start=start: stamp_of(messages[-1]) >= start)
        first = next(each for each in messages if stamp_of(each) >= start)
        assert stamp_of(first) == start
        assert theta(first) == pytest.approx(1.0, abs=1e-15)  # the start, to rounding
        assert start - asked <= 20_000_000
        run.trigger("reset")
