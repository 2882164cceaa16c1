"""A hand that pushes along finds no speed, only height."""

import re

import numpy as np
import pytest
from drawn import Numbers
from physics.tops import ARTICLE, CUSPS, FAST, SLOW, precess
from trials import trials

from symtop_ros.physics import ExactTimes, Friction, Motion, Pushes, State, Top, push_axle
from symtop_ros.run.simulation.changes.outcomes import Pushed
from symtop_ros.words import write

pytestmark = pytest.mark.numbers


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
    rates = states.euler_rates.phi_dot
    tilt = states.euler_angles.theta[-40:]
    found = [f"{each.mean():#.3g}" for each in (rates[:40], rates[-40:], tilt)]
    weight = 1e3 * ARTICLE.Mgl * (np.cos(tilt) - np.cos(0.5)).mean()
    told = Pushed.of(motion, pushes, before)
    assert (*found, f"{told.work:.3g}", f"{weight:.2f}", told.weight.kind) == numbers


def draw_pushed(rng):
    """A top of either sign of Mgl that is pushed along, or back, at times that are no multiples."""
    Ix, unit = rng.power(-4, -1), rng.power(0, 1.3)
    top = Top(Ix, Ix * rng.uniform(0.05, 2.0), rng.choice([1, -1]) * Ix * unit * unit)
    spin = rng.uniform(-12, 12) * Ix / top.Iz * unit
    rate = rng.choice([0.0, rng.uniform(-2, 2) * unit])
    before = State.from_euler(theta=rng.uniform(0.1, 3.0), phi_dot=rate, psi_dot=spin)
    size = rng.choice([1, -1]) * rng.power(-3, -0.5) * Ix * unit
    return top, before, Pushes(size, rng.uniform(1, 20) * unit, 1 + int(rng.uniform(0, 30)))


def find_mean_weight(motion):
    """The potential energy at equal times over a nutation, in mJ: to all digits if it is smooth."""
    times = np.linspace(0.0, motion.nutation_period, 2048, endpoint=False)
    w, x, y, z = motion.at(times).orientation.T
    return 1e3 * motion.top.Mgl * ((w * w + z * z) - (x * x + y * y)).mean()


@pytest.mark.wording
@pytest.mark.parametrize("count", trials(40, 2000))
def test_what_the_weight_is_said_to_gain_is_what_it_gains_in_the_mean_of_its_states(count):
    rng = Numbers("weights of pushed tops")
    for _ in range(count):
        top, before, pushes = draw_pushed(rng)
        motion = Motion(top, push_axle(top, before, pushes.impulse), pushes=pushes)
        text = write("push", Pushed.of(motion, pushes, before))
        word, amount = re.search(
            r"on average the weight (gained|lost) ([\d.e+-]+) mJ\.", text
        ).groups()
        means = [
            find_mean_weight(Motion(top, each)) for each in (before, last_state(motion, pushes))
        ]
        change = (means[1] - means[0]) * (1 if word == "gained" else -1)
        digit = 10.0 ** (np.floor(np.log10(float(amount))) - 2)
        # sums of 2048 states to EPS each; next to the separatrix equal times are too few
        assert float(amount) == pytest.approx(change, abs=0.501 * digit + 1e-9 * abs(1e3 * top.Mgl))


def last_state(motion, pushes):
    return motion.piece_at(ExactTimes(pushes.last_time)).motion.start


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
