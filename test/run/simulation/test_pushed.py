"""A hand that pushes along finds no speed, only height."""

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, FAST, SLOW, precess

from symtop_ros.physics import ExactTimes, Friction, Motion, Pushes, push_axle
from symtop_ros.run.simulation.changes.outcomes import Pushed
from symtop_ros.words import write


def push(before, pushes, *forces):
    """The motion that a state is pushed to."""
    return Motion(ARTICLE, push_axle(ARTICLE, before, pushes.impulse), *forces, pushes=pushes)


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
    motion = push(before, pushes)
    states = motion.at(ExactTimes(np.arange(1, 401) * 2_500_000 - 1))  # each before a push
    rates = states.euler_rates.phi
    tilt = states.euler_angles.theta[-40:]
    found = [f"{each.mean():#.3g}" for each in (rates[:40], rates[-40:], tilt)]
    weight = 1e3 * ARTICLE.Mgl * (np.cos(tilt) - np.cos(0.5)).mean()
    told = Pushed.of(motion, pushes, before)
    assert (*found, f"{told.work:.3g}", f"{weight:.2f}", told.weight.kind) == numbers


def test_the_work_of_pushes_is_what_the_energy_gains_and_a_release_says_the_same():
    pushes = Pushes(2.0**-15, 30.0, 7)
    motion = push(CUSPS, pushes)
    last = motion.piece_at(1.0).motion.start
    told = Pushed.of(motion, pushes, CUSPS)
    assert told.work == 1e3 * float(ARTICLE.energy(last) - ARTICLE.energy(CUSPS)) > 0
    assert write("push", Pushed.of_given(motion, pushes)) == write("push", told)


def test_where_friction_acts_too_nothing_is_said_of_work():
    pushes = Pushes(2.0**-15, 30.0, 7)
    told = Pushed.of(push(CUSPS, pushes, Friction(2.0**-20)), pushes, CUSPS)
    text = "Pushed sideways 7 times in 0.2 s, while friction or a torque acts."
    assert (write("push", told), told.work) == (text, None)
