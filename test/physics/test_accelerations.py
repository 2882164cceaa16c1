"""The angular acceleration is that of the exact motion and of the points of the body."""

import numpy as np
import pytest
from physics.tops import random_states

from symtop_ros.physics import (
    Friction,
    Motion,
    State,
    Top,
    angular_acceleration,
    point_acceleration,
)

TOP = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
PLACE = np.array((0.3, -0.2, 0.7))  # m


def test_points_of_the_body_are_accelerated_by_it():
    states = random_states(500)
    motion = Motion(TOP, State.from_euler(theta=0.5), Friction(1e-6, 2e-6), (1e-4, 0.0, -1e-4))
    alpha = states.to_body(angular_acceleration(motion, states))
    omega = states.angular_velocity
    expected = np.cross(alpha, PLACE) + np.cross(omega, np.cross(omega, PLACE))
    error = np.abs(point_acceleration(motion, states, PLACE) - expected).max(axis=-1)
    size = np.linalg.norm(alpha, axis=-1) + (omega**2).sum(axis=-1)
    assert (error / size).max() < 1e-15  # some roundings of its two parts; 6e-16 in this sample


@pytest.mark.parametrize("t", [0.0, 0.013, 0.2])
def test_it_is_the_rate_of_change_of_omega_in_the_world(t):
    motion = Motion(TOP, State.from_euler(theta=0.5, phi_dot=3.0, psi_dot=200.0))
    h = 2e-6  # s; what is left of the difference is its curvature, of the order of h^2
    omega = [state.to_world(state.angular_velocity) for state in map(motion.at, (t - h, t + h))]
    alpha = angular_acceleration(motion, motion.at(t))
    assert alpha == pytest.approx((omega[1] - omega[0]) / (2 * h), abs=1e-6)
