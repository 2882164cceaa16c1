"""A hand that pushes along finds no speed, only height; its pushes are exact."""

import copy
from fractions import Fraction

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, FAST, SLOW, precess

from symtop_ros.physics import ExactTimes, Motion, push_axle
from symtop_ros.simulation.changes.outcomes import Pushed
from symtop_ros.simulation.segment import PushedMotion, Pushes

START = push_axle(ARTICLE, CUSPS, 2.0**-15)
PUSHES = Pushes(2.0**-15, 30.0, 7)  # a third of a second is no whole number of ns
MOTION = PushedMotion(ARTICLE, START, PUSHES)


PUSHED = [
    # phi' in the first and in the last 0.1 s, in rad/s; tilt then, in rad; work, and what the
    # weight has gained then, in mJ
    (0, ("6.58", "6.58", "0.396", "2.81", "3.06", "gained")),
    (1, ("69.9", "72.1", "0.553", "35.8", "-1.80", "lost")),
]


@pytest.mark.parametrize(("root", "numbers"), PUSHED)
def test_the_numbers_of_the_article_s_top_pushed_for_a_second(root, numbers):
    before = precess((SLOW, FAST)[root])
    pushes = Pushes(2.5e-6, 400.0, 400)  # 1e-3 N m for 1 s
    motion = PushedMotion(ARTICLE, push_axle(ARTICLE, before, pushes.impulse), pushes)
    states = motion.at(ExactTimes(np.arange(1, 401) * 2_500_000 - 1))  # each before a push
    rates, tilt = states.euler_rates.phi, states.euler_angles.theta[-40:]
    found = [f"{each.mean():#.3g}" for each in (rates[:40], rates[-40:], tilt)]
    weight = 1e3 * ARTICLE.Mgl * (np.cos(tilt) - np.cos(0.5)).mean()
    told = Pushed.of(motion, before)
    assert (*found, f"{told.work:.3g}", f"{weight:.2f}", told.weight.kind) == numbers


def test_states_at_any_stamps_are_those_of_one_push_after_the_other():
    """At a stamp of a push, it has been given."""
    stamps = np.array([0, 7, 33_333_332, 33_333_333, 66_666_667, 100_000_000, 199_999_999, 10**9])
    found = MOTION.at(ExactTimes(stamps))
    for place, stamp in enumerate(stamps.tolist()):
        motion, begin = Motion(ARTICLE, START), 0
        for k in range(1, PUSHES.number):
            if PUSHES.time(k) > stamp:
                break
            state = motion.at(ExactTimes(PUSHES.time(k) - begin))
            motion, begin = Motion(ARTICLE, push_axle(ARTICLE, state, 2.0**-15)), PUSHES.time(k)
        expected = motion.at(ExactTimes(stamp - begin))
        assert found[place] == expected == MOTION.at(ExactTimes(stamp))
        slow = (np.array([4 * stamp - 4]), 0.25)
        own = motion.at(ExactTimes(*slow, Fraction(1 - begin)))
        assert MOTION.at(ExactTimes(*slow, Fraction(1))) == own
    assert copy.copy(MOTION).at(0.19) == MOTION.at(0.19) == MOTION.at([0.19])[0]


def test_pushes_hold_the_spin_momentum_and_do_the_work_that_the_energy_gains():
    momenta = {float(ARTICLE.axial_momentum(piece.start)) for piece in MOTION.pieces}
    assert max(momenta) - min(momenta) <= 8 * 2**-52 * max(momenta)
    last = MOTION.pieces[-1].start
    gained = 1e3 * float(ARTICLE.energy(last) - ARTICLE.energy(CUSPS))
    assert Pushed.of(MOTION, CUSPS).work == gained > 0
