"""Energy and angular momentum change by what the torques add, and by nothing else."""

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, EPS, random_case

from symtop_ros.physics import Friction, Motion, Top, balance
from symtop_ros.physics.balance import NODES

MOTIONS = {
    "closed form": Motion(ARTICLE, CUSPS),
    "free": Motion(Top(ARTICLE.Ix, ARTICLE.Iz, 0.0), CUSPS),
    "friction": Motion(ARTICLE, CUSPS, Friction(2e-6, 1e-5)),
    "torque": Motion(ARTICLE, CUSPS, Friction(), (1e-3, -2e-3, 1e-4)),
    "both": Motion(ARTICLE, CUSPS, Friction(1e-5, 1e-4), (0.0, 0.01, 0.02)),
}
# a sum of 24 terms, each with the rounding of a state
ROUNDING = NODES * EPS


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("end", [0.05, 2.0, -1.0])
def test_energy_and_angular_momentum_balance(name, end):
    assert_balanced(MOTIONS[name], end, longest=1.0)


def assert_balanced(motion, end, longest, other_momentum=0.0):
    top, state, found = motion.top, motion.at(end), balance(motion, end, longest)
    energy = np.abs(top.body_angular_momentum(state) * state.angular_velocity).sum() + abs(top.Mgl)
    assert abs(found.energy) < ROUNDING * energy
    momentum = np.linalg.norm(top.angular_momentum(state)) + other_momentum
    assert np.abs(found.angular_momentum).max() < ROUNDING * momentum


@pytest.mark.parametrize("seed", range(12))
def test_random_tops_balance(seed):
    case = random_case(seed, "any")
    Ix, Iz, Mgl = case.top.moments
    rate = np.sqrt(abs(Mgl) / Ix)
    drive = Friction(0.1 * Iz * rate, 0.1 * Ix * rate), [0.2 * Mgl, 0.1 * Mgl, -0.1 * Mgl]
    assert_balanced(Motion(case.top, case.start, *drive), 1 / rate, 1 / rate, Ix * rate)


def test_a_motion_that_is_wrong_does_not_balance():
    class Wrong(Motion):
        def at(self, t):
            return super().at(np.asarray(t) * (1 + 1e-9))

    found = balance(Wrong(ARTICLE, CUSPS), 2.0, longest=1.0)
    assert np.abs(found.angular_momentum).max() > 1e-10 * ARTICLE.Mgl / 50
