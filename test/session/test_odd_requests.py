"""Arbitrary values in requests and parameters: granted and sound, or refused in one sentence."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from odd_values import SIZES, VALUES, assert_one_sentence, deterministic
from trials import trials

from symtop_ros.physics import Motion, kick_verdict, perrys_rule
from symtop_ros.session.diagnostics import summarize_state
from symtop_ros.simulation.changes.requests import (
    KICK_FIELDS,
    START_FIELDS,
    initial_state,
    plan_kick,
)
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment, to_nanoseconds
from symtop_ros.simulation.sensor.imu import find_body
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.topics import STATE_TOPICS, Samples
from symtop_ros.simulation.validation import RefusedError

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
    | st.dictionaries(st.sampled_from(START_FIELDS), VALUES)
)
KICKS = (
    st.fixed_dictionaries({"precession_rate": SIZES}, optional={"hold": HOLDS})
    | st.fixed_dictionaries({"precession_rate_factor": SIZES}, optional={"hold": HOLDS})
    | st.fixed_dictionaries({"angular_impulse": st.lists(SIZES, min_size=3, max_size=3)})
    | st.dictionaries(st.sampled_from(KICK_FIELDS), VALUES)
)
FRICTION = dict.fromkeys(("friction.axial", "friction.transverse"), SIZES.map(abs))
VECTORS = st.lists(SIZES, min_size=3, max_size=3)
TORQUES = st.fixed_dictionaries({}, optional={**FRICTION, "steady_torque": VECTORS})


@pytest.mark.parametrize("examples", trials(100, 400))
def test_a_granted_request_gives_a_sound_motion_with_a_verdict(examples):
    @deterministic(examples)
    @given(TOPS, TORQUES, STARTS, KICKS, st.sampled_from([0.0, 1e-3, 1.0, 1e9]))
    def check(top, torques, asked, kicked, t):
        try:
            settings = Settings.from_values({**top, **torques})
            start = initial_state(settings.top, settings.initial, asked)
        except RefusedError as refused:
            assert_one_sentence(str(refused))
            return
        motion = Motion(settings.top, start, settings.friction, settings.steady_torque)
        assert_one_sentence(str(perrys_rule(motion.top, start)))
        segment = Segment(motion, 0, to_nanoseconds(motion.reach(t, 100)), 1.0, running=False)
        state = segment.state_at(0)
        for topic in STATE_TOPICS.values():
            numbers = topic.compute(Samples(segment, 0, state))
            if topic.name == "torque" and not find_body(motion.top, segment.rig.gravity):
                numbers = numbers[topic.format.quantities["torque"]]  # the force is unknown
            assert np.isfinite(numbers).all()
        json.loads(json.dumps(summarize_state(segment, 0), allow_nan=False))
        again = Event.of(0, "start", None, asked, start, segment).segment()
        assert (again.motion.start, again.elapsed) == (motion.start, segment.elapsed)
        try:
            after, hold = plan_kick(motion, state, kicked)
        except RefusedError as refused:
            assert_one_sentence(str(refused))
        else:
            assert_one_sentence(str(kick_verdict(after, state, hold)))

    check()
