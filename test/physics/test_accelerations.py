"""The angular acceleration is that of points of the body, of which test_body.py has 50 digits."""

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, random_states

from symtop_ros.physics import Friction, Motion, angular_acceleration, point_acceleration


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
