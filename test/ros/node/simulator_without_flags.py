"""The interface of simulators with messages before 2.1; `test_simulator` runs these tests."""

import pytest
from ros.node.test_simulator import FAILED, OK, _messages, client, numbers, vector  # noqa: F401


def test_pose_and_twist_are_set_and_the_acceleration_is_ignored(client):  # noqa: F811
    with pytest.raises(AttributeError):
        client.set_entity(set_pose=True)
    assert 11 in client.features().features  # ENTITY_STATE_SETTING
    turned = {"orientation": {"w": 0.8, "y": 0.6}}
    turning = {"angular": {"z": 5.0}}
    state = {"pose": turned, "twist": turning, "acceleration": {"linear": {"x": 1.0}}}
    client.set_state(2)
    assert client.set_entity(state=state).result == OK
    found = client.entity().state
    assert numbers(found.pose.orientation) == pytest.approx([0.8, 0.0, 0.6, 0.0], abs=1e-16)
    assert vector(found.twist.angular) == pytest.approx([0.0, 0.0, 5.0], abs=2e-15)
