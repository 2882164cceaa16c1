"""Perry's map against the closed form and the verdicts, point by point."""

import numpy as np
import pytest
from physics.tops import ARTICLE, DISC, EPS, FAST, SLOW, precess

from symtop_ros.physics import HOLDS, Motion, Top, compare_hurried, hurry, kick_verdict, perrys_rule

pytestmark = pytest.mark.untraced
TOPS = [ARTICLE, DISC, Top(1e-3, 1e-3, 0.2), Top(2e-4, 1e-4, 0.0)]
RULE = {True: "holds", False: "fails", None: None}


def points(seed, count=150):
    rng = np.random.default_rng(seed)
    theta = rng.uniform(0.05, np.pi - 0.05, count)
    return theta, rng.uniform(-120, 120, count), rng.uniform(-400, 400, count)


def tolerance(low, high, u):
    """Of an angle whose cosine is good to some eps: eps over its sine, a square root at a pole."""
    sine = np.sin(np.clip(np.array([low, high]), 1e-8, np.pi - 1e-8))
    return 64 * EPS / sine * (1 + abs(u))


@pytest.mark.parametrize("top", TOPS)
def test_turning_angles_are_those_of_the_closed_form(top):
    theta, phi_dot, psi_dot = points(1)
    found = compare_hurried(top, theta, phi_dot, psi_dot).before
    for k in range(len(theta)):
        start = precess(phi_dot[k], psi_dot[k], theta[k])
        expected = np.array(Motion(top, start).turning_angles)
        assert (np.abs(found[:, k] - expected) <= tolerance(*expected, np.cos(theta[k]))).all()


@pytest.mark.parametrize("hold", HOLDS)
@pytest.mark.parametrize("top", TOPS[:3])
@pytest.mark.parametrize("factor", [1.4, 0.0, 0.6, 2.5])
def test_the_map_says_what_kicks_and_verdicts_say(top, hold, factor):
    theta, phi_dot, psi_dot = points(2, 50)
    found = compare_hurried(top, theta, phi_dot, psi_dot, factor, hold)
    assert found.rule_applies.all()
    for k in range(len(theta)):
        start = precess(phi_dot[k], psi_dot[k], theta[k])
        motions = Motion(top, start), Motion(top, hurry(start, factor, hold))
        before, after = (motion.turning_angles for motion in motions)
        allowed = tolerance(*before, np.cos(theta[k])) + tolerance(*after, np.cos(theta[k]))
        changes = found.rise[k], -found.fall[k]
        assert (np.abs(np.subtract(before, after) - changes) <= allowed).all()
        verdict = perrys_rule(top, start, factor, hold)
        assert found.rule_holds[k] == verdict.rule_holds
        answer = kick_verdict(motions[1], start, hold)
        assert verdict.reason.rule == answer.reason.rule == RULE[verdict.rule_holds]


def test_at_a_root_the_other_turning_angle_is_the_tilt_itself():
    found = compare_hurried(ARTICLE, 0.5, [SLOW, FAST], 200.0).before
    # theta'' is a sum that vanishes but for rounding of phi', some eps of a slope of order one
    assert np.abs(found - 0.5).max() < 8 * EPS


def test_axes_are_broadcast_to_a_map():
    rates = np.linspace(-20, 90, 30)
    spins = np.linspace(50, 400, 20)
    found = compare_hurried(ARTICLE, 0.5, rates[:, None], spins)
    assert found.rise.shape == found.rule_holds.shape == (30, 20)
