import numpy as np
import pytest

from symtop_ros.physics import Friction, Motion, State, Top
from workshop.speed.peers.peer import Task, body_rates, count_steps, euler_rates, initial_values

STEP = 1e-4  # s


@pytest.mark.parametrize("theta", [0.0, 0.5, 3.0])
@pytest.mark.parametrize("friction", [Friction(), Friction(1e-5, 3e-5)])
def test_the_body_rates_are_those_of_the_motion(theta, friction):
    task = task_of(theta, friction)
    moving = Motion(task.top, task.start, friction)
    ahead, behind = (np.concatenate(moving.at(t).parts) for t in (STEP, -STEP))
    slopes = body_rates(task, 0.0, np.array(initial_values(task)))
    # central difference: h^2/6 times a third derivative of order 50^3, times angular velocity
    np.testing.assert_allclose((ahead - behind) / (2 * STEP), slopes, atol=STEP**2 * 50**4)


@pytest.mark.parametrize("theta", [0.5, 3.0])
def test_the_rates_of_the_euler_angles_are_those_of_the_motion(theta):
    task = task_of(theta, Friction())
    moving = Motion(task.top, task.start)
    ahead, behind, here = (
        np.array([state.euler_angles, state.euler_rates]).ravel()
        for state in (moving.at(STEP), moving.at(-STEP), task.start)
    )
    slopes = euler_rates(task, 0.0, here)
    # the same, and rates that 1/sin(theta) makes up to seven times as large
    within = STEP**2 * 50**4 / np.sin(theta)
    np.testing.assert_allclose((ahead - behind) / (2 * STEP), slopes, atol=within)


def test_steps_are_counted_without_rounding_down():
    assert count_steps(10.0, 3.125e-5) == 320_000
    assert count_steps(0.3, 0.1) == 3  # 0.3 / 0.1 is 2.9999999999999996


def task_of(theta, friction):
    start = State.from_euler(theta=theta, theta_dot=2.0, phi_dot=3.0, psi_dot=50.0)
    return Task(Top(0.0002, 0.0003, -0.05), start, friction)
