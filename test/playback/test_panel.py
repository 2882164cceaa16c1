"""The panel has the exact rates next to the approximations of textbooks."""

import pytest
from log_files import ARTICLE

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.playback.panel import describe_motion
from symtop_ros.simulation.segment import Segment


def facts(motion, equations=()):
    text = describe_motion(Segment.begin(motion, 0, 1.0), motion.start, {}, dict(equations))
    rows = [row.strip("| ").split(" | ") for row in text.splitlines()[2:]]
    return {name: value.strip("*") for name, value in rows}


def test_exact_rates_stand_next_to_those_of_the_fast_top():
    found = facts(Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0)))
    assert found["nutation"] == "0.15954 s, 39.382 rad/s (p_psi/Ix: 50.175)"
    assert found["mean precession"] == "6.6381 rad/s (Mgl/p_psi: 5.9441)"
    assert found["in a nutation"] == "0.16856 turns"


def test_a_spin_that_reverses_is_named():
    start = State.from_euler(theta=0.8, phi_dot=-60.0, psi_dot=60.0)
    assert facts(Motion(ARTICLE, start))["in a nutation"].endswith("turns, psi' changes sign")


@pytest.mark.parametrize("top", [ARTICLE, Top(1.0, 0.5, 0.0)])
def test_what_is_undefined_for_a_sleeping_top_is_a_dash(top):
    found = facts(Motion(top, State.from_euler(theta=0.0)))
    assert found["mean precession"] == "- (Mgl/p_psi: -)"
    assert found["in a nutation"] == "-"


def test_friction_and_the_equations_of_the_torques_have_rows_too():
    motion = Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0), Friction(1e-6, 2e-6))
    found = facts(motion, {"in the body frame": "torque = dL/dt"})
    assert found["friction axial, transverse"] == "1e-06, 2e-06 N m s"
    assert found["in the body frame"] == "torque = dL/dt"
