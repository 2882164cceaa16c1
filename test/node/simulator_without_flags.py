"""The interface of simulators with messages before 2.1; `test_simulator` runs these tests."""

import numpy as np
import pytest
from node.test_simulator import FAILED, OK, _messages, client, numbers, vector  # noqa: F401


def test_pose_and_twist_are_set_and_the_acceleration_is_ignored(client):  # noqa: F811
    with pytest.raises(AttributeError):
        client.set_entity(set_pose=True)
    assert 11 in client.features().features  # ENTITY_STATE_SETTING
    turned = {"orientation": {"w": 0.8, "y": 0.6}}
    state = {
        "pose": turned,
        "twist": {"angular": {"z": 5.0}},
        "acceleration": {"linear": {"x": 1.0}},
    }
    client.set_state(2)
    assert client.set_entity(state=state).result == OK
    found = client.entity().state
    assert numbers(found.pose.orientation) == pytest.approx([0.8, 0.0, 0.6, 0.0], abs=1e-16)
    assert vector(found.twist.angular) == pytest.approx([0.0, 0.0, 5.0], abs=2e-15)


def test_a_state_that_was_read_is_set_again(client):  # noqa: F811
    client.set_state(2)
    before = client.run.top.simulation.state
    given = client.entity().state
    request = client.srv.SetEntityState.Request(entity="top", state=given)
    answer = client.run.connection._call(client.srv.SetEntityState, "set_entity_state", request)
    assert answer.result.result == OK
    after = client.run.top.simulation.state
    assert np.array_equal(after.orientation, before.orientation)
    # forth and back between world and body: some roundings of 200 rad/s
    assert after.angular_velocity == pytest.approx(before.angular_velocity, abs=2e-13)


def test_a_pose_that_no_top_has_is_refused(client):  # noqa: F811
    refused = client.set_entity(state={"pose": {"position": {"x": 1.0}}})
    assert refused.result == FAILED  # this version has no code for it
    assert refused.error_message.startswith("position must be 0 (the pivot is fixed), got ")
