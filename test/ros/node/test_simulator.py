"""The interface of all simulators, called by a client as one would be written for Gazebo."""

import importlib
import os
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from documents import commands, names, rows
from geometry_msgs.msg import QuaternionStamped
from programs import execute
from rclpy.action import ActionClient
from ros.node.built_messages import find_messages, importing
from ros.node.listener import fill
from ros.node.running_top import stamp_of, vector
from rosgraph_msgs.msg import Clock

# The messages have to be built, as PyPI does not have them.
pytestmark = pytest.mark.slow

MS = 1_000_000
PERIOD = 5 * MS  # ns, at the 200 Hz of the scenes
UNSUPPORTED, OK, NOT_FOUND, FAILED = 0, 1, 2, 4
ALREADY, INVALID_POSE = 101, 101
STOPPED, PLAYING, PAUSED, QUITTING = 0, 1, 2, 3
# Variable for the version of the messages: a process has one.
VERSION, WITHOUT_FLAGS = "SIMULATION_INTERFACES", "simulation_interfaces-1.0.0"


@pytest.fixture(scope="module", autouse=True)
def _messages():
    """Make the messages importable for the tests of this module."""
    with importing(os.environ.get(VERSION, "simulation_interfaces")):
        yield
    sys.modules.pop("symtop_ros.ros.node.simulator", None)


class Client:
    """Calls the services of a simulator under the names that Gazebo gives them."""

    def __init__(self, run):
        self.run = run
        self.srv = importlib.import_module("simulation_interfaces.srv")
        action = importlib.import_module("simulation_interfaces.action").SimulateSteps
        self.steps = ActionClient(run.user, action, "/top/simulate_steps")
        self.goal = action.Goal

    def call(self, kind, name, **fields):
        kind = getattr(self.srv, kind)
        return self.run.connection.call(kind, name, fill(kind.Request(), fields))

    def features(self):
        return self.call("GetSimulatorFeatures", "get_simulator_features").features

    def state(self):
        response = self.call("GetSimulationState", "get_simulation_state")
        assert response.result.result == OK
        return response.state.state

    def set_state(self, state):
        fields = {"state": {"state": state}}
        return self.call("SetSimulationState", "set_simulation_state", **fields).result

    def reset(self, scope=0):
        return self.call("ResetSimulation", "reset_simulation", scope=scope).result

    def step(self, steps):
        return self.call("StepSimulation", "step_simulation", steps=steps).result

    def entities(self, **filters):
        return self.call("GetEntities", "get_entities", filters=filters)

    def entity(self, name="top"):
        return self.call("GetEntityState", "get_entity_state", entity=name)

    def set_entity(self, name="top", **fields):
        return self.call("SetEntityState", "set_entity_state", entity=name, **fields).result

    def simulate(self, steps, feedback=None):
        """Send a goal; return its handle once it is accepted."""
        self.run.spin_until(self.steps.server_is_ready)
        sent = self.steps.send_goal_async(self.goal(steps=steps), feedback)
        self.run.spin_until(sent.done)
        assert sent.result().accepted
        return sent.result()


def pose(fields):
    return {"set_pose": True, "state": {"pose": fields}}


def twist(fields):
    return {"set_twist": True, "state": {"twist": fields}}


@pytest.fixture
def client(start_top):
    return Client(start_top(scene="hurry_slow"))


def numbers(q):
    return [q.w, q.x, q.y, q.z]


def times(client):
    """Exact time of the motion in ns."""
    return client.run.top.simulation.segment.elapsed_at(client.run.top.simulation.stamp)


def test_the_features_are_those_that_the_services_have(client):
    found = client.features()
    assert sorted(found.features) == [10, 11, 20, 22, 24, 25, 26, 31, 32, 33]
    assert found.custom_info.startswith("symtop_ros ")


def test_it_is_paused_played_and_stopped_and_tells_so(client):
    run = client.run
    assert client.state() == PLAYING
    assert client.set_state(PAUSED).result == OK
    assert (client.state(), run.top.simulation.segment.running) == (PAUSED, False)
    assert client.set_state(PAUSED).result == ALREADY
    assert client.set_state(STOPPED).result == OK
    assert (client.state(), times(client)) == (STOPPED, 0)
    assert client.set_state(STOPPED).result == ALREADY
    assert client.step(1).result == OK
    assert client.state() == PAUSED  # it is no more at its start
    assert client.set_state(PLAYING).result == OK
    assert client.state() == PLAYING
    assert client.set_state(STOPPED).result == OK
    assert client.set_state(PLAYING).result == OK
    run.spin_until(lambda: times(client) > 100 * MS)
    refused = client.set_state(QUITTING)
    assert refused.result == UNSUPPORTED
    assert refused.error_message == "state must be 0 (stopped), 1 (playing) or 2 (paused), got 3"
    assert client.state() == PLAYING


def test_steps_are_periods_to_the_nanosecond(start_top):
    run = start_top(realtime=True, publish_clock=True, publish_rate=30.0)
    client = Client(run)
    clocks = run.collect(Clock, "/clock")
    assert client.step(1).result == FAILED  # not while it runs
    assert client.set_state(STOPPED).result == OK
    run.spin_until(lambda: clocks)
    clocks.clear()
    run.spin_until(lambda: clocks)
    before = clocks[-1].clock
    for steps in (1, 1, 28):
        assert client.step(steps).result == OK
    passed = 30 * round(1e9 / 30)
    end = divmod(before.sec * 10**9 + before.nanosec + passed, 10**9)
    run.spin_until(lambda: (clocks[-1].clock.sec, clocks[-1].clock.nanosec) == end)
    assert client.step(0).error_message == "steps must be at least 1, got 0"
    refused = client.step(2**63)
    assert refused.result == FAILED
    assert refused.error_message.startswith("duration must be ")


def test_a_reset_goes_back_to_the_parameters_and_says_that_the_time_does_not(client):
    run = client.run
    start = run.top.simulation.segment.motion.start
    assert client.set_entity(**twist({"angular": {"z": 5.0}})).result == OK
    before = run.top.simulation.stamp
    kept = "the state was reset; the time is not set back, as other programs share its clock"
    for scope, said in ((0, kept), (2, ""), (3, kept), (6, ""), (7, kept), (255, kept)):
        done = client.reset(scope)
        assert (done.result, done.error_message) == (OK, said)
        again = run.top.simulation.segment.motion.start
        assert np.array_equal(again.orientation, start.orientation)
        assert np.array_equal(again.angular_velocity, start.angular_velocity)
    assert run.top.simulation.stamp >= before
    assert client.state() == PLAYING
    for scope in (1, 4, 5, 8, 10, 254):  # without the state, or of something unknown
        refused = client.reset(scope)
        condition = "one that includes the state (2), 0 or 255"
        assert refused.result == UNSUPPORTED
        assert refused.error_message == f"scope must be {condition}, got {scope}"


def test_a_node_that_owns_the_clock_sets_it_back_and_its_log_is_exact(start_top, tmp_path):
    run = start_top(realtime=True, publish_clock=True, record=tmp_path)
    client = Client(run)
    clocks = run.collect(Clock, "/clock")
    assert 21 in client.features().features
    assert client.set_entity(**twist({"angular": {"z": 5.0}})).result == OK
    for scope in (1, 3, 0, 255, 2):
        run.wait_for(clocks, 20)
        before = nanoseconds(clocks[-1].clock)
        simulation = run.top.simulation
        done = client.reset(scope)
        assert (done.result, done.error_message) == (OK, "")
        assert (simulation.stamp < before) == (scope != 2)
        is_new = simulation.segment.motion.start == run.top.simulation.timeline.start
        assert (is_new, simulation.timeline.since[:5]) == (True, "start")
        if scope == 2:
            run.wait_for(clocks, len(clocks) + 20)
            assert not has_begun_again(clocks)
        else:
            run.spin_until(lambda: has_begun_again(clocks))
        clocks.clear()
    assert client.set_state(PAUSED).result == OK
    for scope in (1, 0):
        assert client.reset(scope).result == OK
        assert client.step(2).result == OK
        assert run.top.simulation.now == 2 * PERIOD
    refused = client.reset(4).error_message
    assert (
        refused == "scope must be one that includes the state (2) or the time (1), 0 or 255, got 4"
    )
    assert client.set_state(PLAYING).result == OK
    importlib.import_module("exact_log").assert_exact(run.end_log())


def has_begun_again(clocks):
    return any(nanoseconds(each.clock) == 0 for each in clocks)


def nanoseconds(time):
    return time.sec * 10**9 + time.nanosec


def test_entities_are_filtered_by_name(client):
    assert client.entities().entities == ["top"]
    assert client.entities(filter="^t.p$").entities == ["top"]
    assert client.entities(filter="[[:upper:]]").entities == []
    refused = client.entities(filter="(")
    assert (refused.result.result, refused.entities) == (FAILED, [])
    condition = "a POSIX extended regular expression (missing ): ()"
    assert refused.result.error_message == f"filter must be {condition}, got '('"
    assert client.entities(tags={"tags": ["a"]}).result.result == UNSUPPORTED
    assert client.entities(bounds={"type": 3}).result.result == UNSUPPORTED


def test_a_filter_that_no_backtracking_ends_is_answered(client):
    answer = client.entities(filter=".?" * 60 + "z")
    assert (answer.result.result, answer.entities) == (OK, [])
    assert client.entities(filter=r"top\n|^\d").result.result == FAILED  # not of POSIX
    assert client.entities(filter=".?" * 60 + "p").entities == ["top"]
    for large in ("(" * 5000 + ")" * 5000, "[a-z]{1,1000}" * 70):
        assert "pattern too large" in client.entities(filter=large).result.error_message


def test_messages_without_flags_set_pose_and_twist():
    """Those before 2.1, which Humble, Jazzy and Kilted have; in a separate process."""
    find_messages(WITHOUT_FLAGS)
    tests = Path(__file__).with_name("simulator_without_flags.py")
    words = [sys.executable, "-m", "pytest", "-q", tests]
    done = execute(words, env={**os.environ, VERSION: WITHOUT_FLAGS}, timeout=120)
    assert done.returncode == 0, done.stdout
    assert " skipped" not in done.stdout


def test_the_state_of_the_top_is_that_of_the_topics(client):
    run = client.run
    messages = run.collect(QuaternionStamped, "/top/orientation")
    client.set_state(PAUSED)
    found = client.entity()
    assert (found.result.result, found.state.header.frame_id) == (OK, "world")
    stamp = stamp_of(found.state)
    run.spin_until(lambda: messages and stamp_of(messages[-1]) >= stamp)
    sample = next(each for each in messages if stamp_of(each) >= stamp).quaternion
    assert numbers(found.state.pose.orientation) == numbers(sample)
    state = run.top.simulation.state
    motion = run.top.simulation.segment.motion
    twist = np.array(vector(found.state.twist.angular))
    assert np.array_equal(twist, state.to_world(state.angular_velocity))
    # alpha, for which the change of omega in the world is measured: (0.1 us)^2 of curvature and
    # rounding of 2e-14 rad/s over it leave 1e-6 of 200 rad/s times 10 rad/s
    h = 1e-7
    t = run.top.simulation.segment.time_at(run.top.simulation.stamp)
    after, before = (motion.at(t + each) for each in (h, -h))
    change = after.to_world(after.angular_velocity) - before.to_world(before.angular_velocity)
    alpha = vector(found.state.acceleration.angular)
    assert alpha == pytest.approx(change / (2 * h), abs=2e-3)
    missing = client.entity("robot").result
    assert missing.result == NOT_FOUND
    assert missing.error_message == "entity must be 'top', got 'robot'"


def test_the_state_of_the_top_is_set_in_the_world(client):
    client.set_state(PAUSED)
    before = client.entity().state
    turned = pose({"orientation": {"w": 0.8, "x": 0.0, "y": 0.6, "z": 0.0}})
    assert client.set_entity(**turned).result == OK
    found = client.entity().state
    assert numbers(found.pose.orientation) == pytest.approx([0.8, 0.0, 0.6, 0.0], abs=1e-16)
    # forth and back between world and body: some roundings of 200 rad/s
    assert vector(found.twist.angular) == pytest.approx(vector(before.twist.angular), abs=2e-13)
    turning = twist({"angular": {"x": 1.0, "y": 2.0, "z": 3.0}})
    assert client.set_entity(**turning).result == OK
    found = client.entity().state
    assert numbers(found.pose.orientation) == pytest.approx([0.8, 0.0, 0.6, 0.0], abs=1e-16)
    assert vector(found.twist.angular) == pytest.approx([1.0, 2.0, 3.0], abs=2e-15)


FIXED = "must be 0 (the pivot is fixed), got ("
NAN = {"angular": {"z": float("nan")}}
FRAME = {"header": {"frame_id": "map"}}


@pytest.mark.parametrize(
    ("fields", "code", "message"),
    [
        (pose({"position": {"x": 1.0}}), INVALID_POSE, f"position {FIXED}1.0, 0.0, 0.0)"),
        (pose({"orientation": {"w": 2.0}}), INVALID_POSE, "orientation must be a quaternion of no"),
        (twist({"linear": {"y": 1.0}}), FAILED, f"twist.linear {FIXED}0.0, 1.0, 0.0)"),
        (twist(NAN), FAILED, "twist.angular must be 3 numbers from -1e+09 to 1e+09 (rad/s, world"),
        ({"set_twist": True, "state": FRAME}, FAILED, "header.frame_id must be 'world', got 'map'"),
        ({"set_acceleration": True}, UNSUPPORTED, "set_acceleration must be false: it follows fr"),
    ],
)
def test_what_no_top_can_do_is_refused_and_changes_nothing(client, fields, code, message):
    before = client.run.top.simulation.segment
    refused = client.set_entity(**fields)
    assert refused.result == code
    assert refused.error_message.startswith(message)
    assert client.run.top.simulation.segment is before


def test_the_action_steps_with_feedback_and_leaves_the_node_free(client):
    run = client.run
    feedback = []
    client.set_state(STOPPED)
    goal = client.simulate(40, lambda each: feedback.append(each.feedback))
    result = goal.get_result_async()
    assert client.entity().result.result == OK  # answered meanwhile
    run.spin_until(lambda: result.done() and len(feedback) == 40)
    assert result.result().result.result.result == OK
    counts = [(each.completed_steps, each.remaining_steps) for each in feedback]
    assert counts == [(n, 40 - n) for n in range(1, 41)]
    # each duration is a double of 5 ms, exact to 2^-60 s
    assert float(times(client)) == pytest.approx(40 * PERIOD, abs=1e-6)
    assert client.state() == PAUSED


def test_the_action_is_cancelled_and_refused(client):
    run = client.run
    refused = client.simulate(3).get_result_async()  # it runs
    run.spin_until(refused.done)
    assert refused.result().result.result.result == FAILED
    client.set_state(STOPPED)
    goal = client.simulate(10**6)
    cancelled, result = goal.cancel_goal_async(), goal.get_result_async()
    run.spin_until(lambda: cancelled.done() and result.done())
    assert 0 < times(client) < 10**6 * PERIOD
    none = client.simulate(0).get_result_async()
    run.spin_until(none.done)
    assert none.result().result.result.error_message == "steps must be at least 1, got 0"


def test_goals_that_come_together_are_carried_out_one_after_the_other(client):
    run = client.run
    ends = []
    client.set_state(STOPPED)
    goals = [client.simulate(steps) for steps in (300, 10**6, 40)]
    results = [each.get_result_async() for each in goals]
    for number, result in enumerate(results):
        result.add_done_callback(lambda _, number=number: ends.append((number, times(client))))
    run.spin_until(results[0].done)
    cancelled = goals[1].cancel_goal_async()
    run.spin_until(lambda: cancelled.done() and len(ends) == 3)
    assert [number for number, _ in ends] == [0, 1, 2]
    assert [each.result().status for each in results] == [4, 5, 4]  # succeeded, canceled
    # An end is reported when the next goal has made some steps, at most those of this one.
    assert 300 <= float(ends[0][1]) / PERIOD < 320
    assert 20 < float(ends[2][1] - ends[1][1]) / PERIOD < 60


def test_a_goal_that_waits_is_cancelled_at_once_and_makes_no_step(client):
    run = client.run
    client.set_state(STOPPED)
    first, second = client.simulate(10**6), client.simulate(10**6)
    result = second.get_result_async()
    second.cancel_goal_async()
    run.spin_until(result.done)
    assert (result.result().status, result.result().result.result.result) == (5, OK)
    ended = first.get_result_async()
    first.cancel_goal_async()
    run.spin_until(ended.done)
    steps = round(float(times(client)) / PERIOD)
    run.spin(0.1)
    assert round(float(times(client)) / PERIOD) == steps > 0


def test_the_goal_of_a_client_that_leaves_goes_on_and_can_be_cancelled_by_others(client):
    run = client.run
    client.set_state(STOPPED)
    client.simulate(10**6)
    client.steps.destroy()
    before = times(client)
    run.spin_until(lambda: times(client) > before + 20 * PERIOD)
    assert client.entity().result.result == OK
    kind = importlib.import_module("action_msgs.srv").CancelGoal
    name = "simulate_steps/_action/cancel_goal"
    cancelled = run.connection.call(kind, name, kind.Request())  # without an id: all goals
    assert len(cancelled.goals_canceling) == 1
    again = Client(run).simulate(3).get_result_async()
    run.spin_until(again.done)
    assert again.result().result.result.result == OK


def test_a_stop_and_a_play_are_events_from_which_the_log_is_computed(start_top, tmp_path):
    run = start_top(scene="cusps", record=tmp_path)
    client = Client(run)
    for act in (lambda: client.set_state(STOPPED), lambda: client.step(7), client.reset):
        assert act().result == OK
    client.set_entity(**twist({"angular": {"z": 5.0}}))
    client.set_state(PLAYING)
    importlib.import_module("exact_log").assert_exact(run.end_log())


def test_the_commands_and_the_table_of_the_page_on_ros_are_those_of_the_node(client):
    page = Path(__file__).parents[3] / "docs" / "ros_reference.md"
    called = [words for words, _ in commands(page) if "simulation_interfaces/" in " ".join(words)]
    assert len(called) == 3
    for *_, name, kind, text in called:
        fields = yaml.safe_load(text)
        answer = client.call(kind.split("/")[2], name.removeprefix("/top/"), **fields)
        assert answer.result.result == OK
    cells = [row[0] for row in rows(page, "The interface of simulators")]
    listed = {name.replace("~", "/top") for cell in cells for name in names(cell)}
    pairs = client.run.user.get_service_names_and_types_by_node("top", "/")
    found = {name for name, (kind,) in pairs if kind.startswith("simulation_interfaces/srv")}
    assert listed == found | {"/top/simulate_steps"}
