import math

import numpy as np
import pytest
from physics.tops import EPS

from symtop_ros.physics import State, Top, hurry, impulse, push, set_precession_rate

TOP = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
START = State.from_euler(theta=0.5, phi=0.3, psi=1.2, theta_dot=2.0, phi_dot=6.5, psi_dot=200.0)
ROUNDING = 8 * EPS * 210.0  # of the largest rate, rad/s


def test_a_change_of_rate_holds_theta_dot_and_the_spin_rate():
    after = hurry(TOP, START, 1.4)
    rates = after.euler_rates
    assert rates.phi == pytest.approx(9.1, abs=4 * ROUNDING)  # 1/sin(theta) of rounding
    assert rates.theta == pytest.approx(2.0, abs=ROUNDING)
    assert rates.psi == pytest.approx(200.0, abs=4 * ROUNDING)


def test_a_push_holds_theta_dot_and_the_axial_momentum():
    after = push(TOP, START, 1.4)
    assert TOP.axial_momentum(after) == TOP.axial_momentum(START)
    assert after.euler_rates.phi == pytest.approx(9.1, abs=4 * ROUNDING)
    assert after.euler_rates.theta == pytest.approx(2.0, abs=ROUNDING)
    lost = START.euler_rates.psi - after.euler_rates.psi
    assert lost == pytest.approx(2.6 * math.cos(0.5), abs=8 * ROUNDING)


def test_an_impulse_adds_to_the_angular_momentum_in_the_world():
    J = np.array([1e-4, -2e-3, 5e-4])
    after = impulse(TOP, START, J)
    gained = TOP.angular_momentum(after) - TOP.angular_momentum(START)
    assert np.abs(gained - J).max() <= 16 * EPS * np.abs(TOP.angular_momentum(START)).max()


@pytest.mark.parametrize(
    "kick",
    [hurry, push, lambda *at: set_precession_rate(*at, -3.0), lambda *at: impulse(*at, [0, 0, 1])],
)
def test_a_kick_leaves_the_attitude_bit_for_bit(kick):
    assert kick(TOP, START).orientation.tolist() == START.orientation.tolist()


def test_a_kick_at_the_smallest_tilt_needs_no_division():
    start = State.from_euler(theta=1e-12, psi_dot=200.0)
    after = set_precession_rate(TOP, start, 9.0)
    assert after.euler_rates.phi == pytest.approx(9.0, rel=8 * EPS)


@pytest.mark.parametrize("theta", [0.0, "hanging"])
def test_on_the_vertical_a_rate_is_refused_and_an_impulse_is_not(theta):
    q = (1.0, 0.0, 0.0, 0.0) if theta == 0.0 else (0.0, 1.0, 0.0, 0.0)
    start = State(q, (0.0, 0.0, 200.0))
    with pytest.raises(ValueError, match="the axis is vertical: the precession rate phi' is"):
        hurry(TOP, start)
    assert impulse(TOP, start, [1e-4, 0.0, 0.0]).angular_velocity[2] == 200.0


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: hurry(TOP, START, math.nan), "factor: got nan"),
        (lambda: set_precession_rate(TOP, START, math.inf), "phi_dot: got inf"),
        (lambda: hurry(TOP, START, 1.4, "breath"), "hold: got 'breath', allowed is 'spin_rate' or"),
        (lambda: impulse(TOP, START, [1.0, 2.0]), "angular_impulse: got .*, allowed are 3 finite"),
    ],
)
def test_a_bad_kick_is_refused_in_words(call, sentence):
    with pytest.raises(ValueError, match=sentence):
        call()
