import math

import numpy as np
import pytest
from physics.tops import ARTICLE, EPS

from symtop_ros.physics import State, apply_impulse, hurry, set_precession_rate

START = State.from_euler(theta=0.5, phi=0.3, psi=1.2, theta_dot=2.0, phi_dot=6.5, psi_dot=200.0)
ROUNDING = 8 * EPS * 210.0  # of the largest rate, rad/s


@pytest.mark.parametrize(("hold", "lost"), [("spin_rate", 0.0), ("spin_momentum", 2.6)])
def test_a_change_of_rate_holds_theta_dot_and_the_spin_rate_or_axial_momentum(hold, lost):
    after = hurry(START, 1.4, hold)
    if hold == "spin_momentum":
        assert ARTICLE.axial_momentum(after) == ARTICLE.axial_momentum(START)
    rates = after.euler_rates
    assert rates.phi == pytest.approx(9.1, abs=4 * ROUNDING)  # 1/sin(theta) of rounding
    assert rates.theta == pytest.approx(2.0, abs=ROUNDING)
    assert rates.psi == pytest.approx(200.0 - lost * math.cos(0.5), abs=4 * ROUNDING)


def test_an_impulse_adds_to_the_angular_momentum_in_the_world():
    J = np.array([1e-4, -2e-3, 5e-4])
    after = apply_impulse(ARTICLE, START, J)
    gained = ARTICLE.angular_momentum(after) - ARTICLE.angular_momentum(START)
    assert np.abs(gained - J).max() <= 16 * EPS * np.abs(ARTICLE.angular_momentum(START)).max()


@pytest.mark.parametrize(
    "kick",
    [
        hurry,
        lambda state: hurry(state, hold="spin_momentum"),
        lambda state: set_precession_rate(state, -3.0),
        lambda state: apply_impulse(ARTICLE, state, [0, 0, 1]),
    ],
)
def test_a_kick_leaves_the_attitude_bit_for_bit(kick):
    after = kick(START)
    assert after.orientation.tolist() == START.orientation.tolist()
    assert after.angular_velocity.tolist() != START.angular_velocity.tolist()


def test_a_kick_at_the_smallest_tilt_needs_no_division():
    start = State.from_euler(theta=1e-12, psi_dot=200.0)
    after = set_precession_rate(start, 9.0)
    assert after.euler_rates.phi == pytest.approx(9.0, rel=8 * EPS)


@pytest.mark.parametrize("q", [(1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)])
def test_on_the_vertical_an_impulse_is_not_refused(q):
    start = State(q, (0.0, 0.0, 200.0))
    assert apply_impulse(ARTICLE, start, [1e-4, 0.0, 0.0]).angular_velocity[2] == 200.0
