"""Numbers of all sizes, zeros and denormals: no combination breaks a motion or its verdict."""

import math
import re

import numpy as np
import pytest
from drawn import Numbers, normalize
from physics.refusals import TILTED, meet
from physics.tops import ARTICLE, EPS, seeds, within

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


def extreme(seed):
    rng = Numbers(seed)
    Ix = rng.choice([1e-30, 1e-6, 2.28e-4, 1.0, 1e30])
    Mgl = rng.choice([*WEIGHTS, Ix, -Ix, 1e4 * Ix])
    top = Top(Ix, Ix * rng.choice([1e-6, 0.25, 1.0, 1.0 + 1e-12, 2.0]), Mgl)
    if rng.random() < 0.5:
        rates = {f"{name}_dot": rng.choice(RATES) for name in ("theta", "phi", "psi")}
        return top, State.from_euler(theta=rng.choice(TILTS), phi=rng.choice([0, 1, 3]), **rates)
    q = np.array([rng.choice(PARTS) for _ in range(4)])
    q[rng.randrange(4)] = 1.0
    return top, State(normalize(q), [rng.choice(RATES) for _ in range(3)])


@pytest.mark.parametrize("block", seeds(6, 20))
def test_no_combination_of_numbers_breaks_anything(block):
    for seed in range(100 * block, 100 * block + 100):
        top, start = extreme(seed)
        motion = Motion(top, start)
        latest = meet(motion, 1e9)
        states = motion.at([0.0, 1e-9 * latest, -latest, 1e-18 * latest])
        assert np.isfinite(states.angular_velocity).all()
        there = states.orientation[0]
        off = min(
            np.linalg.norm(there - start.orientation), np.linalg.norm(there + start.orientation)
        )
        assert off <= 16 * EPS
        low, high = motion.turning_angles
        assert 0.0 <= low <= high + 8 * EPS
        assert high <= math.pi
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


def random_input(rng):
    """A top, a start and a time over hundreds of decades, of which some are refused."""

    def size(low, high):
        return rng.power(low, high)

    Ix = size(-100, 100)
    Iz = Ix * size(-60, 0.3)
    Mgl = rng.choice([-1, 0, 1]) * size(-320, 100)
    q = np.array([rng.gauss(0, 1) * rng.choice([1, 1, 0, 1e-9, 1e-90]) for _ in range(4)])
    q = normalize(q) if q.any() else np.array([1.0, 0, 0, 0])
    omega = [rng.choice([-1, 0, 1]) * size(-320, 100) for _ in range(3)]
    return (Ix, Iz, Mgl), q, omega, rng.choice([-1, 1]) * size(-320, 308)


def ask(moments, q, omega, t):
    """The motion, a state and the verdict, or the words of a refusal."""
    try:
        motion = Motion(Top(*moments), State(q, omega))
        return motion, motion.at(meet(motion, t)), str(perrys_rule(motion.top, motion.start))
    except ValueError as refusal:
        return str(refusal)


@pytest.mark.parametrize("block", seeds(4, 40))
def test_inputs_over_hundreds_of_decades_are_served_or_refused_in_a_sentence_and_in_time(block):
    rng, served = Numbers(block), 0
    for _ in range(500):
        moments, q, omega, t = random_input(rng)
        with within(20.0):  # a state takes a millisecond; the machine may stand still meanwhile
            found = ask(moments, q, omega, t)
        if isinstance(found, str):
            assert " must be " in found
            continue
        motion, state, verdict = found
        served += 1
        assert np.isfinite(state.orientation).all()
        assert np.isfinite(state.angular_velocity).all()
        assert abs(np.linalg.norm(state.orientation) - 1) <= 4 * EPS
        assert motion.kind
        assert verdict
    assert served > 300


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
