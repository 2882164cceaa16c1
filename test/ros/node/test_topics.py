"""Every topic against the library, evaluated again at the stamp of each message."""

import importlib
import sys
from xml.etree import ElementTree

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, TwistStamped, Vector3Stamped, WrenchStamped
from ros.node.built_messages import importing
from ros.node.running_top import LATCHED, STEP, facts, segment_of, stamp_of, vector
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from symtop_ros.physics import Body
from symtop_ros.run.log.writer import load_definitions

pytestmark = pytest.mark.untraced


JOINTS = ["precession", "tilt", "spin"]


# The type of a topic, and what its message says.
READ = {
    "orientation": (QuaternionStamped, lambda m: [m.quaternion.w, *vector(m.quaternion)]),
    "angular_velocity": (TwistStamped, lambda m: [vector(m.twist.angular), vector(m.twist.linear)]),
    "angular_momentum": (Vector3Stamped, lambda m: vector(m.vector)),
    "torque": (WrenchStamped, lambda m: [vector(m.wrench.torque), vector(m.wrench.force)]),
    "euler_angles": (JointState, lambda m: [m.name, *m.position, *m.velocity]),
}


def compute(motion, state):
    """Messages of a state of a motion by the library, by the topic."""
    top = motion.top
    omega = state.to_world(state.angular_velocity)
    force = Body.from_top(top).pivot_force(motion, state)
    return {
        "orientation": state.orientation.tolist(),
        "angular_velocity": [omega.tolist(), [0.0, 0.0, 0.0]],
        "angular_momentum": top.angular_momentum(state).tolist(),
        "torque": [top.gravity_torque(state).tolist(), force.tolist()],
        "euler_angles": [JOINTS, *state.euler_angles, *state.euler_rates],
    }


def test_all_state_topics_say_what_the_library_says_at_their_stamp(start_top):
    run = start_top(publish_rate=200.0)
    got = {name: run.collect(kind, f"/top/{name}") for name, (kind, _) in READ.items()}
    (event,) = run.collect_events()
    run.spin_until(lambda: all(len(messages) > 20 for messages in got.values()))
    segment = segment_of(event)
    for name, (_, read) in READ.items():
        for message in got[name][5:20]:
            expected = compute(segment.motion, segment.state_at(stamp_of(message)))[name]
            assert (name, read(message)) == (name, expected)
            assert message.header.frame_id == "world"


def test_the_description_is_latched_and_its_joints_are_those_of_the_euler_angles(start_top):
    run = start_top()
    assert run.change({"top.Iz": 6e-05})[0]
    late = run.collect(String, "/top/robot_description", LATCHED)  # of both it gets the present one
    run.spin_until(lambda: late)
    robot = ElementTree.fromstring(late[0].data)
    assert [joint.get("name") for joint in robot.iter("joint")] == JOINTS
    assert [axis.get("xyz") for axis in robot.iter("axis")] == ["0 0 1", "1 0 0", "0 0 1"]
    inertia = next(robot.iter("inertia"))
    assert float(inertia.get("izz")) == 6e-05


def test_diagnostics_report_the_motion_and_constants_that_do_not_drift(start_top):
    run = start_top()
    messages = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: len(messages) >= 2)
    values = facts(messages[-1], "top: motion")
    assert values["kind"] == "cusps"
    assert values["engine"] == "closed form"
    low, high = map(float, values["turning_angles"].split())
    assert abs(low - 0.5) < 1e-15
    assert 0.66 < high < 0.67
    # energy about 1.2 J: rounding of its few terms
    assert abs(float(values["energy.drift"])) < 1e-15
    assert abs(float(values["L_z'.drift"])) < 1e-17
    names = {(status.name, status.hardware_id) for status in messages[-1].status}
    kinds = ("motion", "pace", "log", "balance", "name", "clock")
    assert names == {(f"top: {kind}", "/top") for kind in kinds}
    (event,) = run.collect_events()
    assert [status.hardware_id for status in event.status] == ["/top"]
    pace = facts(messages[-1], "top: pace")
    assert pace["missed"] == "0"
    assert pace["real_time_factor.achieved"] == "1.0"
    balance = facts(messages[-1], "top: balance")
    assert balance["power"] == "0.0"
    assert abs(float(balance["energy.balance"])) < 1e-14  # 24 terms, each with the rounding of 1 J


def test_without_their_package_markers_are_only_logged(start_top, monkeypatch, capfd):
    monkeypatch.setitem(sys.modules, "visualization_msgs.msg", None)  # as if it were missing
    run = start_top(publish_markers=True)
    run.spin_until(lambda: run.top.simulation.stamp > 10 * STEP)
    line = "visualization_msgs is not installed: ~/markers is only logged"
    assert capfd.readouterr().err.count(line) == 1


@pytest.mark.slow  # it needs tf2_msgs, which PyPI does not have
def test_tf_has_the_quaternion_of_the_topic_and_the_type_of_the_log(start_top):
    with importing("tf2_msgs"):
        run = start_top(arguments=["--ros-args", "-r", "__ns:=/a"])
        heard = run.collect(importlib.import_module("tf2_msgs.msg").TFMessage, "/tf")
        samples = run.collect(QuaternionStamped, "/a/top/orientation")
        run.spin_until(lambda: len(heard) > 50)
    by_stamp = {stamp_of(each): each.quaternion for each in samples}
    transforms = [each for message in heard for each in message.transforms]
    found = [each for each in transforms if stamp_of(each) in by_stamp]
    assert len(found) > 40
    for each in found:
        moved = each.transform.translation
        assert (each.header.frame_id, each.child_frame_id) == ("world", "a/top")
        assert (moved.x, moved.y, moved.z) == (0.0, 0.0, 0.0)
        assert each.transform.rotation == by_stamp[stamp_of(each)]  # bit for bit
    (publisher,) = run.top.get_publishers_info_by_topic("/tf")
    definition = load_definitions()["tf2_msgs/msg/TFMessage"]
    assert str(publisher.topic_type_hash) == definition["hash"]
