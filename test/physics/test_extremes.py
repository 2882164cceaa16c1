"""Numbers of all sizes, zeros and denormals: no combination breaks a motion or its verdict."""

import itertools
import math
import random

import numpy as np
import pytest
from physics.refusals import TILTED
from physics.tops import ARTICLE, EPS, seeds

from symtop_ros.physics import Motion, State, Top, hurry, kick_verdict, perrys_rule

RATES = [0.0, -0.0, 5e-324, 1e-300, 1e-160, 1e-30, 1e-9, 1.0, -3.0, 200.0, 1e5, -1e9, 1e9]
TILTS = [0.0, 1e-300, 1e-160, 1e-12, 0.5, math.pi / 2, 3.0, math.pi - 1e-12, math.pi]
PARTS = [0.0, 1.0, -1.0, 0.5, 1e-9, 1e-160, 1e-300]
WEIGHTS = [0.0, 5e-324, 1e-300, -1e-15, 0.068, -0.068, 1e30]


def extreme(seed):
    rng = random.Random(seed)
    Ix = rng.choice([1e-30, 1e-6, 2.28e-4, 1.0, 1e30])
    Mgl = rng.choice([*WEIGHTS, Ix, -Ix, 1e4 * Ix])
    top = Top(Ix, Ix * rng.choice([1e-6, 0.25, 1.0, 1.0 + 1e-12, 2.0]), Mgl)
    if rng.random() < 0.5:
        rates = {f"{name}_dot": rng.choice(RATES) for name in ("theta", "phi", "psi")}
        return top, State.from_euler(theta=rng.choice(TILTS), phi=rng.choice([0, 1, 3]), **rates)
    q = np.array([rng.choice(PARTS) for _ in range(4)])
    q[rng.randrange(4)] = 1.0
    return top, State(q / np.linalg.norm(q), [rng.choice(RATES) for _ in range(3)])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("block", seeds(6, 20))
def test_no_combination_of_numbers_breaks_anything(block):
    for seed in range(100 * block, 100 * block + 100):
        top, start = extreme(seed)
        motion = Motion(top, start)
        states = motion.at([0.0, 1.0, -1e9, 1e-9])
        assert np.isfinite(states.angular_velocity).all()
        there = states.orientation[0]
        off = min(
            np.linalg.norm(there - start.orientation), np.linalg.norm(there + start.orientation)
        )
        assert off <= 16 * EPS
        low, high = motion.turning_angles
        assert 0.0 <= low <= high + 8 * EPS
        assert str(perrys_rule(top, start))
        after = kick(start)
        if isinstance(after, str):
            assert TILTED in after or "must be at most" in after
        else:
            assert kick_verdict(Motion(top, after), start, "spin_rate")


def kick(start):
    """The state after a kick, or the words of its refusal."""
    try:
        return hurry(start)
    except ValueError as refusal:
        return str(refusal)


def test_every_tilt_goes_with_every_rate():
    top = ARTICLE
    for theta, phi_dot, psi_dot in itertools.product(TILTS, RATES, RATES):
        start = State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot)
        assert np.isfinite(Motion(top, start).at(1.0).orientation).all()
