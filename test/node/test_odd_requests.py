"""Any values for requests and parameters: granted and sound, or refused in one sentence."""

import json
import math
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from odd_values import SIZES, VALUES, assert_one_sentence, deterministic, parameters

from symtop_ros.node import initial, kick
from symtop_ros.node.diagnostics import diagnostics, state_report
from symtop_ros.node.fields import RefusedError, named_values
from symtop_ros.node.initial import initial_state
from symtop_ros.node.parameters import DECLARATIONS, checked
from symtop_ros.node.ticker import Ticker
from symtop_ros.physics import State, Top, motion, perry, regular_precession_rates
from symtop_ros.physics.balance import balance
from symtop_ros.physics.perry import kick_verdict
from symtop_ros.recording.recorder import Limits, Recorder
from symtop_ros.run.events import Event
from symtop_ros.run.samples import SAMPLES
from symtop_ros.run.segment import Segment

DEFAULTS = {name: declaration.default for name, declaration in DECLARATIONS.items()}
HOLDS = st.sampled_from(["spin_rate", "spin_momentum"])
TILTS = st.floats(0, math.pi) | st.sampled_from([0.0, math.pi, math.pi / 2, 5e-324, 1e-160, 1e-12])
RATES = SIZES | st.sampled_from([0.0, 5e-324, 1e-200]) | st.floats(-1e3, 1e3)
EULER = {
    "theta": TILTS,
    **dict.fromkeys(("phi", "psi"), st.floats(-1e3, 1e3)),
    **dict.fromkeys(("theta_dot", "phi_dot", "psi_dot"), RATES),
}
TOPS = st.builds(
    lambda Ix, ratio, Mgl: {"top.Ix": Ix, "top.Iz": Ix * ratio, "top.Mgl": Mgl},
    st.floats(-30, 30).map(lambda digits: 10.0**digits),
    st.floats(-30, 0.3).map(lambda digits: 10.0**digits) | st.sampled_from([1.0, 2.0, 1 - 2**-53]),
    SIZES | st.just(0.0),
)
STARTS = (
    st.fixed_dictionaries({}, optional=EULER)
    | st.fixed_dictionaries(
        {"precession": st.sampled_from(["slow", "fast"])},
        optional={name: EULER[name] for name in ("theta", "psi", "psi_dot")},
    )
    | st.dictionaries(st.sampled_from(initial.NAMES), VALUES)
)
KICKS = (
    st.fixed_dictionaries({"precession_rate": SIZES}, optional={"hold": HOLDS})
    | st.fixed_dictionaries({"precession_rate_factor": SIZES}, optional={"hold": HOLDS})
    | st.fixed_dictionaries({"angular_impulse": st.lists(SIZES, min_size=3, max_size=3)})
    | st.dictionaries(st.sampled_from(kick.NAMES), VALUES)
)
DRIVING = st.fixed_dictionaries(
    {},
    optional={
        "friction.axial": SIZES.map(abs),
        "friction.transverse": SIZES.map(abs),
        "steady_torque": st.lists(SIZES, min_size=3, max_size=3),
    },
)


@pytest.fixture(autouse=True)
def _warnings_are_errors():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def refusal(call, *arguments):
    """The sentence of a refusal, or none."""
    try:
        call(*arguments)
    except RefusedError as refused:
        assert_one_sentence(str(refused))
        return str(refused)
    return None


@deterministic(500)
@given(parameters((*initial.NAMES, *kick.NAMES)))
def test_named_values_of_any_type_are_taken_or_refused_in_one_sentence(messages):
    refusal(named_values, messages, initial.NAMES)


@deterministic(1000)
@given(st.dictionaries(st.sampled_from(list(DECLARATIONS)), VALUES, max_size=4))
def test_parameters_of_any_value_are_taken_or_refused_in_one_sentence(changes):
    refusal(checked, {**DEFAULTS, **changes})


@deterministic(400)
@given(TOPS, DRIVING, STARTS, KICKS, st.sampled_from([0.0, 1e-3, 1.0, 1e9]))
def test_what_is_granted_is_a_sound_motion_and_can_be_told(top, driving, asked, kicked, t):
    try:
        settings = checked({**DEFAULTS, **top, **driving})
        start = initial_state(settings.top, settings.initial, asked)
    except RefusedError as refused:
        assert_one_sentence(str(refused))
        return
    path = motion(settings.top, start, settings.friction, settings.steady_torque)
    assert_one_sentence(str(perry(path.top, start)))
    segment = Segment(path, 0, path.reach(t, 100), 1.0, running=False)
    state = segment.state_at(0)
    assert all(np.isfinite(numbers(path, state)).all() for numbers in SAMPLES.values())
    json.loads(json.dumps(state_report(segment, 0), allow_nan=False))
    alone = SimpleNamespace(name="/top", count=0, sentence="no other node")
    diagnostics(settings, segment, 0, Ticker(1.0, 0), Recorder(None, Limits()), alone)
    again = Event.of(0, "start", "", asked, start, segment).segment()
    assert (again.path.start, again.elapsed) == (path.start, segment.elapsed)
    try:
        after, hold = kick.kicked(path, state, kicked)
    except RefusedError as refused:
        assert_one_sentence(str(refused))
    else:
        assert_one_sentence(kick_verdict(after, state, hold))


@pytest.mark.parametrize("value", [5, 0, True, 1.5, None, "", "abc", b"abc"])
def test_a_list_that_is_none_is_refused(value):
    told = refusal(checked, {**DEFAULTS, "initial.orientation": value})
    assert told.startswith("initial.orientation: got ")
    assert told.endswith(", allowed is 4 numbers, each from -2 to 2")


@pytest.mark.parametrize("name", ["world_frame", "top_frame", "record.directory"])
@pytest.mark.parametrize("value", ["a\nb", "\x1b[31m", "\udcff", ""])
def test_names_that_cannot_be_printed_are_refused(name, value):
    assert refusal(checked, {**DEFAULTS, name: value}).startswith(f"{name}: got ")


def test_a_frame_of_a_million_characters_is_refused():
    told = refusal(checked, {**DEFAULTS, "world_frame": "w" * 1_000_000})
    assert told.endswith("allowed is the name of a frame, up to 200 printable characters")


def test_roots_that_doubles_cannot_hold_are_none():
    # half a rate of 5e-33 rad/s, and a spin that is none: the slow root is 1e360 rad/s
    rates = regular_precession_rates(Top(1.0, 1.0, 1e30), theta=1.0, psi_dot=5e-324)
    assert all(map(math.isfinite, rates))


def test_a_root_faster_than_any_top_is_refused():
    settings = checked({**DEFAULTS, "top.Ix": 1.0, "top.Iz": 1.0, "top.Mgl": 1.0})
    asked = {"precession": "slow", "theta": 0.7, "psi_dot": 1e-20}
    told = refusal(initial_state, settings.top, settings.initial, asked)
    assert "regular precession has no real root below 1e+09 rad/s; allowed is another" in told


def test_the_balance_of_a_thin_top_under_a_torque_takes_some_steps_only():
    path = motion(Top(1.0, 1e-30, 1.0), State.from_euler(theta=0.5), torque=(1.0, 0.0, 0.0))
    reached = path.reach(1.0, 10)
    found = balance(path, reached, longest=1e-3)
    assert np.isfinite(found.energy)
