"""Messages on ~/applied_torque: what they may not say, and that the next one acts."""

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from node.running_top import events_named, facts, torque_of

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
    run = start_top()
    events = run.collect_events()
    hand = run.publisher(WrenchStamped, "/top/applied_torque")
    for each in (message, torque_of(z=2e-4, frame="world")):
        hand.publish(each)
    run.spin_until(lambda: events_named(events, "torque"))
    assert facts(events_named(events, "torque")[0])["applied_torque"] == "0.0 0.0 0.0002"
    assert sentence in capfd.readouterr().err
