"""The tilt's acceleration as the article's equation has it."""

import numpy as np
import pytest
from physics.tops import ARTICLE, DISC, EPS, random_states

from symtop_ros.physics import Top, theta_acceleration, theta_torque


@pytest.mark.parametrize("top", [ARTICLE, DISC, Top(2.0, 2.0, 7.0)])
def test_theta_acceleration_is_the_articles(top):
    (Ix, Iz, Mgl), states = top.moments, random_states(500)
    theta, rates = states.euler_angles.theta, states.euler_rates
    expected = (Ix - Iz) * rates.phi**2 * np.cos(theta) - Iz * rates.phi * rates.psi + Mgl
    found = theta_acceleration(top, theta, rates.phi, rates.psi)
    terms = (abs(rates.phi) + abs(rates.psi)) ** 2 + abs(Mgl) / Ix
    off = found - np.sin(theta) / Ix * expected
    assert (np.abs(off) <= 16 * EPS * terms).all()  # sums of three products
    # without sin(theta)/Ix, which the product takes back to a few roundings
    torque = theta_torque(top, theta, rates.phi, rates.psi)
    assert found == pytest.approx(np.sin(theta) / Ix * torque, rel=4 * EPS)
