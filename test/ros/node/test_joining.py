"""A request, its event and the first sample of the new motion are found from each other."""

import re

import pytest
from geometry_msgs.msg import QuaternionStamped
from ros.node.running_top import RunningTop, facts, stamp_of
from waiting import TIMEOUT

NUMBER = re.compile(r"[.)a-z] \[event (\d+)\]")  # at the end of a sentence


def read_number(answer):
    granted, text = answer
    assert granted, text
    sentence, bracket, end = text.rpartition(" [event ")
    assert (bracket, "[event" in sentence) == (" [event ", False)
    assert NUMBER.fullmatch(sentence[-1] + bracket + end), text
    return int(end.removesuffix("]"))


@pytest.fixture(scope="module", params=[False, True], ids=["time of ROS", "own time"])
def run(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs")
    clock = {"realtime": True, "publish_clock": True} if request.param else {}
    with RunningTop(**clock, record__directory=str(folder)) as running:
        yield running


# Each changes something, in this order.
REQUESTS = {
    "start": lambda run: run.set("set_initial_conditions", theta=0.5, psi_dot=200.0, phi_dot=2.0),
    "kick": lambda run: run.set("kick", precession_rate=9.0),
    "push": lambda run: run.set("kick", axle_impulse=1e-6, rate=1.0, number=1000),
    "release": lambda run: run.trigger("release"),
    "clamp": lambda run: run.switch("clamp", True),
    "unclamp": lambda run: run.switch("clamp", False),
    "record": lambda run: run.switch("record", True),
    "pause": lambda run: run.switch("pause", True),
    "step": lambda run: run.set("step", duration=0.125),
    "resume": lambda run: run.switch("pause", False),
    "reset": lambda run: run.trigger("reset"),
}


def test_every_answer_ends_with_the_number_of_its_event(run):
    events = run.collect_events()
    numbers = {name: read_number(ask(run)) for name, ask in REQUESTS.items()}
    assert len(set(numbers.values())) == len(numbers)
    found = {}

    def find_all():
        found.update((int(facts(each)["number"]), each) for each in events)
        return {*numbers.values()} <= found.keys()

    run.spin_until(find_all, TIMEOUT)
    names = {name: found[number].status[0].name for name, number in numbers.items()}
    assert names == {name: f"top: {name}" for name in numbers}


def test_a_request_that_changes_nothing_names_the_latest_event(run):
    number = run.top.simulation.event_number
    assert read_number(run.switch("pause", False)) == number
    assert run.state()["event"] == run.top.simulation.event_number


def test_stamps_of_states_are_exact_and_an_event_has_the_first_of_its_motion(run):
    events = run.collect_events()
    samples = run.collect(QuaternionStamped, "/top/orientation")
    run.wait_for(samples)
    number = read_number(run.set("kick", precession_rate=8.0))
    run.spin_until(lambda: any(int(facts(each)["number"]) == number for each in events))
    (event,) = (each for each in events if int(facts(each)["number"]) == number)
    run.spin_until(lambda: stamp_of(samples[-1]) >= stamp_of(event))
    first = next(each for each in samples if stamp_of(each) >= stamp_of(event))
    q = first.quaternion
    segment = run.top.simulation.segment
    after = segment.state_at(stamp_of(first))
    assert after.orientation.tolist() == pytest.approx([q.w, q.x, q.y, q.z], abs=1e-15)
    state = run.state()
    assert state["sec"] * 1e-9 < state["stamp"] <= state["sec"] + 1
    nearest = float(f"{state['sec']}.{state['nanosec']:09d}")
    # A product with 1e-9 is off by a unit in the last place: 2.4e-7 s of a time of today.
    assert state["stamp"] == pytest.approx(nearest, rel=2**-51)
    assert 0 <= state["nanosec"] < 10**9
