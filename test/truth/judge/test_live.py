"""Estimates of a running top, second by second, without a node."""

from types import SimpleNamespace

import numpy as np
import pytest
from truth.judge.cases import SECOND, encode, make_estimates, make_events

from symtop_ros.physics import Motion
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.truth.judge.live import Court
from symtop_ros.truth.judge.truth import Truth

IMU = "sensor_msgs/msg/Imu"
START = make_events()[0]
STAMPS = np.arange(5 * SECOND, 6 * SECOND, SECOND // 50)


@pytest.fixture
def court():
    """A court, and what it does with events and with estimates."""
    heard = []
    node = SimpleNamespace(create_subscription=lambda kind, topic, act, *_, **__: heard.append(act))
    found = Court(node, "/top", "/imu/data", IMU, None)
    return found, *heard


def jump_back():
    """The event of a clock that jumps back from 6 s to 5 s."""
    before = START.segment()
    state = before.state_at(6 * SECOND)
    after = Segment.begin(Motion(before.motion.top, state), 5 * SECOND, 1.0)
    request = {"from": 6 * SECOND, "to": 5 * SECOND}
    return Event.of(Change(Act("clock", 5 * SECOND, request), state, after), 2)


def send(hear, truth, stamps):
    for _, data in encode(IMU, make_estimates(truth, stamps))[1]:
        hear(data)


def test_estimates_wait_for_a_second_and_are_counted(court):
    judged, hear_event, hear = court
    assert judged.judge().format() == "no events of the top"
    hear_event(START.encode("world"))
    assert judged.judge().format() == "no estimates"
    send(hear, Truth([START]), STAMPS[:1])
    judged.judge()
    assert judged.judge().format().startswith("1 estimate: attitude ")


def test_estimates_outside_of_the_run_are_not_called_none(court):
    judged, hear_event, hear = court
    send(hear, Truth([START]), STAMPS)
    hear_event(jump_back().encode("world"))  # the first event that is heard, at 5 s
    judged.judge()
    judged.judge()
    truth = Truth([START])
    send(hear, truth, STAMPS - 2 * SECOND)
    judged.judge()
    assert judged.judge().format().startswith("50 estimates left out: their stamps are not within")


def test_estimates_of_before_a_jump_back_are_not_compared_with_the_motion_after_it(court):
    judged, hear_event, hear = court
    hear_event(START.encode("world"))
    send(hear, Truth([START]), STAMPS)
    judged.judge()
    hear_event(jump_back().encode("world"))
    send(hear, Truth([START]), STAMPS[-3:])  # which were still on their way
    assert judged.judge().format() == "53 estimates left out: the clock of the run went back"
    assert judged.judge().format() == "no estimates"
    send(hear, Truth([START, jump_back()]), STAMPS)
    judged.judge()
    assert judged.judge().errors.total.max() < 1e-14
