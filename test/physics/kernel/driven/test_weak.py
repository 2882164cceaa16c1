"""Torques, weights and rates of any smallness: no state is lost to an underflow."""

import numpy as np
import pytest
from drawn import Numbers
from physics.refusals import refused
from trials import seeds

from symtop_ros.physics import Friction, Motion, State, Top

CASES = 500  # of a seed


def draw(rng):
    """A small number of any size, or zero."""
    return rng.choice([0.0, rng.power(-320, 0), rng.power(-120, -60)])


def random_motion(rng):
    Ix = rng.power(-3, 3)
    top = Top(Ix, Ix * rng.uniform(0.1, 2.0), draw(rng) * rng.choice([-1, 1]))
    q = rng.choice([(1, 0, 0, 0), (0.6, 0.8, 0, 0), (0.5, 0.5, 0.5, 0.5)])
    start = State(q, [draw(rng) for _ in range(3)])
    friction = Friction(draw(rng) * Ix, draw(rng) * Ix)
    return top, start, friction, [draw(rng) * Ix for _ in range(3)]


@pytest.mark.parametrize(
    ("top", "omega", "torque", "turned"),
    [
        (Top(1, 1, 0), (0, 0, 1e-99), (1e-170, 0, 0), 2.5e-171),
        (Top(1, 1, 1e-250), (0, 0, 0), (1e-200, 0, 0), 2.5e-201),
    ],
)
def test_a_torque_of_which_the_square_is_zero_turns_the_top(top, omega, torque, turned):
    state = Motion(top, State((1, 0, 0, 0), omega), torque=torque).at(1.0)
    assert state.orientation[1] == pytest.approx(turned, rel=1e-15)  # torque t^2/(4 Ix)


def test_a_rod_that_turns_too_fast_for_all_digits_is_refused():
    start = State.from_euler(theta=0.5, psi_dot=200.0)
    motion = Motion(Top(1, 1e-21, 0.0), start, torque=(1, 1, 1))
    for state in (motion.at(1e-3), motion.at(-1e-3)):
        assert abs(np.linalg.norm(state.orientation) - 1) < 1e-15
    with refused("t", "the motion then becomes too fast"):
        motion.at([1e-3, 1.0])


@pytest.mark.parametrize("seed", seeds(20, 100))
def test_weak_motions_are_finite_and_have_norm_one(seed):
    rng = Numbers(seed)
    for _ in range(CASES):
        arguments = random_motion(rng)
        state = Motion(*arguments).at(rng.choice([1e-3, 1.0, 30.0]))
        assert np.isfinite(state.angular_velocity).all(), arguments
        assert abs(np.linalg.norm(state.orientation) - 1) < 1e-15, arguments
