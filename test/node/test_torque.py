"""Friction and applied torques in the node: what acts when, and that the run can be recomputed."""

import numpy as np
import pytest
from geometry_msgs.msg import QuaternionStamped, WrenchStamped
from node.running_top import (
    events_named,
    facts,
    stamp_of,
    torque_of,
)

VERTICAL = 2e-4  # N m


class Hand:
    """A publisher of applied torques."""

    def __init__(self, run):
        self.publish = run.publisher(WrenchStamped, "/top/applied_torque").publish

    def push(self, x=0.0, y=0.0, z=0.0, frame="world"):
        self.publish(torque_of(x, y, z, frame))


def start(start_top, **parameters):
    run = start_top(**parameters)
    return run, run.collect_events()


def test_samples_that_repeat_themselves_hold_the_torque_without_events(start_top):
    run, events = start(start_top)
    orientations = run.collect(QuaternionStamped, "/top/orientation")
    hand = Hand(run)
    hand.push(z=VERTICAL)
    run.spin_until(lambda: events_named(events, "torque"))
    begin = stamp_of(events_named(events, "torque")[0])
    while not orientations or stamp_of(orientations[-1]) - begin < 0.4e9:
        hand.push(z=VERTICAL)
        run.wait_for(orientations)
    assert len(events_named(events, "torque")) == 1
    run.spin_until(lambda: len(events_named(events, "torque")) == 2)
    assert stamp_of(events_named(events, "torque")[1]) - begin > 0.4e9


BY_FORCE = torque_of(z=1e-4)
BY_FORCE.wrench.force.x = 1.0
NUMBERS = "applied_torque must be 3 numbers from -1e+30 to 1e+30 (N m, world frame), got [nan"


@pytest.mark.parametrize(
    ("message", "sentence"),
    [
        (torque_of(x=np.nan), NUMBERS),
        (torque_of(z=1.0, frame="top"), """frame_id must be "world" or empty, got 'top'"""),
        (BY_FORCE, "applied_torque force must be 0 (only the torque acts), got (1.0, 0.0, 0.0)"),
    ],
)
def test_a_bad_torque_is_reported_and_changes_nothing(start_top, capfd, message, sentence):
    run, events = start(start_top)
    hand = Hand(run)
    hand.publish(message)
    hand.push(z=VERTICAL)  # comes after it
    run.spin_until(lambda: events_named(events, "torque"))
    assert facts(events_named(events, "torque")[0])["applied_torque"] == f"0.0 0.0 {VERTICAL}"
    assert sentence in capfd.readouterr().err
