"""The panel has the exact rates next to the approximations of textbooks."""

import pytest
from log_files import ARTICLE

from symtop_ros.physics import Motion, State, Top
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


@pytest.mark.parametrize("top", [ARTICLE, Top(1.0, 0.5, 0.0)])
def test_what_is_undefined_for_a_sleeping_top_is_a_dash(top):
    found = facts(Motion(top, State.from_euler(theta=0.0)))
    assert found["mean precession"] == "- (Mgl/p_psi: -)"
    assert found["in a nutation"] == "-"
