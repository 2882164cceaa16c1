"""The bodies of strange records, where they are tops: held against exact motions."""

import numpy as np
import pytest

from symtop_ros.physics import Friction, Motion, State, Top
from workshop.records.bodies import Body, Course, Kick, place_body

TIMES = np.arange(60) / 32
NEAR = 1e-8  # of steps with errors of 1e-11, some thousand, and an interpolation between them


def start(motion):
    angles = motion.start.euler_angles
    return place_body(angles.theta, angles.phi), motion.start.angular_velocity


@pytest.mark.parametrize("friction", [(0.0, 0.0), (0.125, 0.0625)])
def test_a_symmetric_body_moves_as_a_top(friction):
    state = State.from_euler(theta=0.75, phi=0.5, phi_dot=2.0, theta_dot=-0.5, psi_dot=30.0)
    motion = Motion(Top(1.0, 0.5, 60.0), state, Friction(*friction))
    course = Course(Body((1.0, 1.0, 0.5), 60.0, linear=friction), *start(motion), 2.0)
    turned, rates = course.at(TIMES)
    exact = motion.at(TIMES)
    assert np.abs(rates - exact.angular_velocity).max() < NEAR
    axes = np.stack([exact.to_world(axis) for axis in np.eye(3)], axis=-1)
    assert np.abs(turned - axes).max() < NEAR


def test_a_kick_changes_the_rates_at_its_time():
    motion = Motion(Top(1.0, 0.5, 60.0), State.from_euler(theta=0.75, psi_dot=30.0))
    course = Course(
        Body((1.0, 1.0, 0.5), 60.0), *start(motion), 2.0, [Kick(1.0, (0.25, -0.5, 0.0))]
    )
    _, rates = course.at(np.array([1.0 - 2.0**-30, 1.0]))
    # in 2^-30 s rates of 100 rad/s^2 change by 1e-7
    assert np.abs(rates[1] - rates[0] - [0.25, -0.5, 0.0]).max() < 1e-6


def test_dry_friction_takes_the_same_from_the_spin_in_each_second():
    body = Body((1.0, 1.0, 0.5), 0.0, dry=0.5)
    course = Course(body, place_body(0.5, 0.0), np.array([0.0, 0.0, 20.0]), 2.0)
    _, rates = course.at(TIMES)
    assert np.abs(rates[:, 2] - (20.0 - TIMES)).max() < NEAR
