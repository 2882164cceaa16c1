"""Accelerations: of the tilt as the article has it, and of points of the body."""

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, DISC, EPS, random_states

from symtop_ros.physics import (
    Friction,
    Motion,
    Top,
    angular_acceleration,
    point_acceleration,
    theta_acceleration,
    theta_torque,
)


@pytest.mark.parametrize("place", [(0.3, -0.2, 0.7), (0.5, 0.4, 0.0)])
def test_points_of_the_body_are_accelerated_by_it(place):
    states = random_states(500)
    motion = Motion(ARTICLE, CUSPS, Friction(1e-6, 2e-6), (1e-4, 0.0, -1e-4))
    alpha = states.to_body(angular_acceleration(motion, states))
    omega = states.angular_velocity
    expected = np.cross(alpha, place) + np.cross(omega, np.cross(omega, place))
    error = np.abs(point_acceleration(motion, states, place) - expected).max(axis=-1)
    size = np.linalg.norm(alpha, axis=-1) + (omega**2).sum(axis=-1)
    assert (error / size).max() < 1e-15  # some roundings of its two parts; 6e-16 in this sample


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
