import math

import numpy as np
import pytest
from physics.tops import EPS, random_states

from symtop_ros.physics import State


@pytest.mark.parametrize(
    ("orientation", "omega", "sentence"),
    [
        ((1, 0, 0, 0, 0), (0, 0, 0), r"orientation: got shape \(5,\), allowed is \(..., 4\)"),
        ((1, 0, 0, 0), (0, 0), r"angular_velocity: got shape \(2,\), allowed is \(..., 3\)"),
        ((1, 0, 0, math.nan), (0, 0, 0), "orientation: got .*, allowed are finite numbers"),
        ((1, 0, 0, 0), (0, math.inf, 0), "angular_velocity: got .*, allowed are finite numbers"),
        ((1, 0, 0, 0.1), (0, 0, 0), "orientation: got a norm of 1.00499, allowed is 1 within"),
        (("a", 0, 0, 0), (0, 0, 0), "orientation: got .*, allowed are 4 numbers"),
        ((1, 0, 0, 0), (0, 0, 1e200), "angular_velocity: got 1e.200 rad/s, allowed is up to"),
        ([(1, 0, 0, 0)], (0, 0, 0), "do not go together"),
    ],
)
def test_bad_states_are_refused_in_words(orientation, omega, sentence):
    with pytest.raises(ValueError, match=sentence):
        State(orientation, omega)


def test_an_orientation_is_normalised_once_and_then_stays_bit_for_bit():
    once = State((1.0005, 0.0, 1e-3, 0.0), (1.0, 2.0, 3.0))
    assert np.linalg.norm(once.orientation) == pytest.approx(1.0, abs=EPS)
    assert State(*once) == once
    states = random_states(1000)
    assert State(*states) == states


def test_a_state_cannot_be_written_to():
    state = State((1, 0, 0, 0), (0, 0, 0))
    with pytest.raises(ValueError, match="read-only"):
        state.orientation[0] = 2.0


@pytest.mark.parametrize("theta", [1e-12, 1e-3, 0.5, math.pi / 2, 3.0])
def test_euler_angles_and_rates_come_back(theta):
    given = {"theta_dot": -3.0, "phi_dot": 0.7, "psi_dot": 11.0}
    state = State.from_euler(theta=theta, phi=0.4, psi=-2.0, **given)
    phi, tilt, psi = state.euler_angles
    assert tilt == pytest.approx(theta, rel=8 * EPS)
    assert (phi, psi) == pytest.approx((0.4, -2.0), abs=8 * EPS)
    rates = state.euler_rates
    rounding = 16 * EPS * 12 / math.sin(theta)  # phi' is a rate across the axis over sin(theta)
    assert rates.theta == pytest.approx(-3.0, rel=16 * EPS)
    assert rates.phi == pytest.approx(0.7, abs=rounding)
    assert rates.psi == pytest.approx(11.0, abs=rounding)


@pytest.mark.parametrize(("q", "psi"), [((0.8, 0, 0, 0.6), 1.287), ((0, 0.8, 0.6, 0), -1.287)])
def test_on_the_vertical_all_turning_is_spin(q, psi):
    state = State(q, (0.3, 0.4, 7.0))
    phi, _, spin = state.euler_angles
    assert phi == 0.0
    assert spin == pytest.approx(psi, abs=1e-3)
    assert state.euler_rates == (0.0, 0.5, 7.0)


def test_turning_to_the_world_and_back_is_nothing():
    states = random_states(100)
    vectors = states.angular_velocity
    there = states.to_world(vectors)
    assert np.abs(states.to_body(there) - vectors).max() <= 16 * EPS * np.abs(vectors).max()


def test_the_vertical_is_z_turned_into_the_body():
    states = random_states(100)
    assert np.abs(states.to_body([0.0, 0.0, 1.0]) - states.vertical).max() <= 8 * EPS


@pytest.mark.parametrize("name", ["theta", "phi", "psi", "theta_dot", "phi_dot", "psi_dot"])
def test_an_angle_or_rate_that_is_not_finite_is_refused(name):
    with pytest.raises(ValueError, match=f"{name}: got nan, allowed is a finite number"):
        State.from_euler(**{"theta": 0.5, name: math.nan})
