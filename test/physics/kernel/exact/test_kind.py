"""The seven kinds of motion, for either sign of Mgl."""

import math

import numpy as np
import pytest
from physics.tops import ARTICLE

from symtop_ros.physics import Motion, State, Top, perrys_rule, regular_precession_rates

KINDS = {
    "cusps": {"theta": 0.5, "psi_dot": 200.0},
    "looping": {"theta": 0.5, "psi_dot": 200.0, "phi_dot": -8.0},
    "unidirectional": {"theta": 0.5, "psi_dot": 200.0, "phi_dot": 9.0},
    "sleeping": {"theta": 0.0, "psi_dot": 200.0},
    "through the pole": {"theta": 1.0, "theta_dot": -20.0},
    "regular": {
        "theta": 0.5,
        "psi_dot": 200.0,
        "phi_dot": regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)[0],
    },
}


@pytest.mark.parametrize(("kind", "start"), KINDS.items())
def test_a_kind_is_the_same_upside_down(kind, start):
    upright = Motion(ARTICLE, State.from_euler(**start))
    Ix, Iz, Mgl = ARTICLE.moments
    w, x, y, z = upright.start.orientation
    motion = Motion(Top(Ix, Iz, -Mgl), State((-x, w, -z, y), upright.start.angular_velocity))
    assert motion.kind == upright.kind == kind
    low, high = upright.turning_angles
    assert motion.turning_angles == pytest.approx((math.pi - high, math.pi - low), abs=1e-15)


@pytest.mark.parametrize(
    ("Mgl", "upright", "factor", "stable"),
    [
        (0.068, True, 1.0 + 1e-12, True),
        (0.068, True, 1.0 - 1e-12, False),
        (0.068, False, 0.0, True),
        (-0.068, False, 0.9, False),
        (-0.068, False, 1.1, True),
        (0.0, True, 0.0, True),
    ],
)
def test_stability_of_sleeping_is_told_for_either_pole(Mgl, upright, factor, stable):
    top = Top(0.000228, 0.0000572, Mgl)
    q = (1.0, 0.0, 0.0, 0.0) if upright else (0.0, 1.0, 0.0, 0.0)
    state = State(q, (0.0, 0.0, factor * ARTICLE.critical_spin))
    assert top.sleeping_is_stable(state) is stable
    assert perrys_rule(top, state).reason.kind == ("stable" if stable else "unstable")


@pytest.mark.parametrize("kind", sorted(set(KINDS) - {"sleeping"}))
def test_a_kind_is_the_same_from_any_state_of_the_motion(kind):
    motion = Motion(ARTICLE, State.from_euler(**KINDS[kind], phi=0.3, psi=-1.1))
    assert motion.kind == kind
    states = motion.at(np.linspace(0.0, 7.3 * motion.nutation_period, 1000))
    for q, omega in zip(*states.parts, strict=True):
        assert Motion(ARTICLE, State(q, omega)).kind == kind


def test_a_kind_is_the_same_from_any_state_within_rounding_of_a_turning_point():
    motion = Motion(ARTICLE, State.from_euler(**KINDS["cusps"], phi=0.3, psi=-1.1))
    times = motion.nutation_period * (3 + np.geomspace(1e-16, 1e-3, 300))
    for q, omega in zip(*motion.at(times).parts, strict=True):
        assert Motion(ARTICLE, State(q, omega)).kind == "cusps"


@pytest.mark.parametrize("phi", np.linspace(-3.0, 3.0, 40).tolist())
def test_a_plane_pendulum_goes_through_the_pole_in_any_direction(phi):
    for theta, theta_dot in ((0.7, 0.0), (2.0, 3.0), (1.0, -40.0)):
        start = State.from_euler(theta=theta, theta_dot=theta_dot, phi=phi, psi=2.2 * phi + 0.1)
        motion = Motion(ARTICLE, start)
        assert motion.kind == "through the pole"
        assert math.isnan(motion.mean_precession_rate)
        assert math.isnan(motion.mean_spin_rate)


@pytest.mark.parametrize("phi_dot", [1e-16, -1e-16, 1e-17])
def test_a_precession_of_rounding_size_is_a_cusp(phi_dot):
    start = State.from_euler(**KINDS["cusps"], phi=0.3, phi_dot=phi_dot)
    assert Motion(ARTICLE, start).kind == "cusps"


@pytest.mark.parametrize("theta", [0.0, 0.5, math.pi])
def test_a_top_without_momentum_stays_at_its_tilt(theta):
    start = State.from_euler(theta=theta)
    angles = Motion(Top(1.0, 0.5, 0.0), start).turning_angles
    assert angles == pytest.approx((theta, theta), abs=4e-16)  # a rounding of pi
    hanging = Motion(Top(1.0, 0.5, 1.0), State((0, 1, 0, 0), (0, 0, 0)))
    assert hanging.turning_angles == (math.pi, math.pi)


def test_the_critical_spin_itself_is_stable():
    rng = np.random.default_rng(1)
    for Ix, ratio, Mgl in zip(*rng.uniform(0.01, 2.0, (3, 300)), strict=True):
        top = Top(Ix, Ix * ratio, Mgl)
        sleeping = State((1, 0, 0, 0), (0, 0, top.critical_spin))
        assert top.sleeping_is_stable(sleeping)
        assert not top.sleeping_is_stable(State((1, 0, 0, 0), (0, 0, top.critical_spin * 0.999)))
    huge = Top(1e100, 1e100, 1e-100)
    assert huge.sleeping_is_stable(State((1, 0, 0, 0), (0, 0, 1.0)))
