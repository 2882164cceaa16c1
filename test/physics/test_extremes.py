"""Numbers of all sizes, zeros and denormals: no combination breaks a motion or its verdict."""

import math
import re

import numpy as np
import pytest
from drawn import Numbers, normalize
from physics.refusals import meet
from physics.tops import ARTICLE, EPS, distance, within
from trials import seeds

from symtop_ros.physics import (
    ExactTimes,
    Friction,
    Motion,
    State,
    Top,
    hurry,
    kick_verdict,
    perrys_rule,
)

RATES = [0.0, -0.0, 5e-324, 1e-300, 1e-160, 1e-30, 1e-9, 1.0, -3.0, 200.0, 1e5, -1e9, 1e9]
TILTS = [0.0, 1e-300, 1e-160, 1e-12, 0.5, math.pi / 2, 3.0, math.pi - 1e-12, math.pi]
PARTS = [0.0, 1.0, -1.0, 0.5, 1e-9, 1e-160, 1e-300]
WEIGHTS = [0.0, 5e-324, 1e-300, -1e-15, 0.068, -0.068, 1e30]


def draw_extreme(rng):
    """A top, a start and a time of numbers that decide something."""
    Ix = rng.choice([1e-30, 1e-6, 2.28e-4, 1.0, 1e30])
    Mgl = rng.choice([*WEIGHTS, Ix, -Ix, 1e4 * Ix])
    top = Top(Ix, Ix * rng.choice([1e-6, 0.25, 1.0, 1.0 + 1e-12, 2.0]), Mgl)
    if rng.random() < 0.5:
        rates = {f"{name}_dot": rng.choice(RATES) for name in ("theta", "phi", "psi")}
        start = State.from_euler(theta=rng.choice(TILTS), phi=rng.choice([0, 1, 3]), **rates)
        return top, start, 1e9
    q = np.array([rng.choice(PARTS) for _ in range(4)])
    q[rng.randrange(4)] = 1.0
    return top, State(normalize(q), [rng.choice(RATES) for _ in range(3)]), 1e9


def draw_any(rng):
    """A top, a start and a time over hundreds of decades, of which some are refused."""
    Ix = rng.power(-100, 100)
    Mgl = rng.choice([-1, 0, 1]) * rng.power(-320, 100)
    q = np.array([rng.gauss(0, 1) * rng.choice([1, 1, 0, 1e-9, 1e-90]) for _ in range(4)])
    q = normalize(q) if q.any() else np.array([1.0, 0, 0, 0])
    omega = [rng.choice([-1, 0, 1]) * rng.power(-320, 100) for _ in range(3)]
    t = rng.choice([-1, 1]) * rng.power(-320, 308)
    return Top(Ix, Ix * rng.power(-60, 0.3), Mgl), State(q, omega), t


def ask(draw, rng):
    """A motion, its states and the answer to a kick, or the words of a refusal."""
    try:
        top, start, t = draw(rng)
        motion = Motion(top, start)
        latest = meet(motion, t)
        states = motion.at([0.0, 1e-9 * latest, -latest, 1e-18 * latest, latest])
        assert str(perrys_rule(top, start))
    except ValueError as refusal:
        return str(refusal)
    try:
        return motion, states, str(kick_verdict(Motion(top, hurry(start)), start, "spin_rate"))
    except ValueError as refusal:
        return motion, states, str(refusal)


# Each motion takes some milliseconds; the machine may stand still meanwhile.
@pytest.mark.parametrize("block", seeds(2, 40))
@pytest.mark.parametrize(
    ("draw", "count", "least"), [(draw_extreme, 120, 120), (draw_any, 400, 240)]
)
def test_numbers_of_all_sizes_are_served_or_refused_in_a_sentence_and_in_time(
    draw, count, least, block
):
    rng, served = Numbers(block), 0
    for _ in range(count):
        with within(20.0):
            found = ask(draw, rng)
        if isinstance(found, str):
            assert " must be " in found
            continue
        motion, states, answer = found
        served += 1
        assert np.isfinite(states.angular_velocity).all()
        assert np.abs(np.linalg.norm(states.orientation, axis=1) - 1).max() <= 4 * EPS
        assert distance(states[0], motion.start) <= 16 * EPS
        low, high = motion.turning_angles
        assert 0.0 <= low <= high + 8 * EPS
        assert high <= math.pi
        assert answer
    assert served >= least


def test_the_separatrix_rests_at_its_end_at_any_time():
    upright = Motion(Top(1.0, 1.0, 1.0), State((0, 1, 0, 0), (2, 0, 0)))
    for t in (1e14, -1e14, ExactTimes(2**63 - 1, 1e4)):
        assert upright.at(t).euler_angles.theta == 0.0
    assert upright.at([1e14, 0.0]).euler_angles.theta[0] == 0.0


def test_a_friction_that_makes_a_time_too_far_is_refused_with_the_time_that_can_be_had():
    start = State.from_euler(theta=0.5, psi_dot=200.0)
    motion = Motion(ARTICLE, start, Friction(100.0, 100.0))
    words = "t must be within 0.0572 s of the start (friction stops the top in 5.72e-07 s"
    with within(20.0), pytest.raises(ValueError, match=re.escape(words)):
        motion.at(10.0)
    with within(60.0):
        assert np.isfinite(motion.at(0.057).orientation).all()
