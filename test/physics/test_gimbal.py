"""Ring and stand of a gimbal: by the momentum about the vertical, and by what is left of K."""

import math

import numpy as np
import pytest
from drawn import Numbers
from physics.tops import ARTICLE, SLOW, precess

from symtop_ros.physics import Motion, State, Top, gimbal_shares, push_axle

STEP = 1e-5  # s


def vertical_momentum(motion, t):
    return float(motion.top.angular_momentum(motion.at(t))[2])


@pytest.mark.parametrize("seed", range(20))
def test_a_hand_at_the_ring_gives_what_the_momentum_about_the_vertical_gains(seed):
    """Gravity and the stand have no torque about the vertical."""
    rng = Numbers(f"ring {seed}")
    Ix, unit = rng.power(-4, 0), rng.power(0, 1)
    top = Top(Ix, Ix * rng.uniform(0.1, 2.0), rng.choice([1, -1]) * Ix * unit * unit)
    start = State.from_euler(
        theta=rng.uniform(0.2, 2.9), phi=rng.uniform(-3, 3), psi_dot=rng.uniform(-9, 9) * unit
    )
    motion = Motion(top, start, clamped=True)
    for t in (0.3 / unit, 1.1 / unit):
        step = STEP / unit
        gained = vertical_momentum(motion, t + step) - vertical_momentum(motion, t - step)
        ring = gimbal_shares(motion.added_torque(motion.at(t))).ring
        size = float(np.abs(motion.top.angular_momentum(motion.at(t))).max()) * unit
        # the difference quotient is off by step^2/6 of the third derivative, and by its rounding
        assert ring == pytest.approx(gained / (2 * step), abs=1e-8 * size)


def test_at_the_lowest_point_the_stand_gives_all_of_it():
    motion = Motion(ARTICLE, precess(SLOW), clamped=True)
    times = np.linspace(0.1, 0.25, 100_001)
    states = motion.at(times)
    lowest = motion.at(float(times[np.argmin(states.vertical[:, 2])]))
    shares = gimbal_shares(motion.added_torque(lowest))
    assert abs(shares.ring) < 1e-5
    assert shares.stand == pytest.approx(0.394, abs=5e-4)


def test_of_a_push_at_the_axle_the_ring_gives_the_sine_and_the_stand_the_cosine():
    start = State.from_euler(theta=0.5, phi=0.7, psi_dot=200.0)
    pushed = push_axle(ARTICLE, start, 1e-4)
    impulse = ARTICLE.angular_momentum(pushed) - ARTICLE.angular_momentum(start)
    shares = gimbal_shares(impulse)
    assert shares.ring == pytest.approx(1e-4 * math.sin(0.5), rel=1e-10)
    assert shares.stand == pytest.approx(1e-4 * math.cos(0.5), rel=1e-10)


def test_shares_of_many_torques_have_their_shape():
    shares = gimbal_shares(np.array([[[3.0, 4.0, -1.0]], [[0.0, 0.0, 2.0]]]))
    assert shares.ring.tolist() == [[-1.0], [2.0]]
    assert shares.stand.tolist() == [[5.0], [0.0]]
    with pytest.raises(ValueError, match="torque must be 3 finite numbers"):
        gimbal_shares([1.0, 2.0])
