"""The sentence on friction at the spin, against the sampled motion."""

import math
import re

import numpy as np
import pytest
from drawn import Numbers
from trials import seeds

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.run.simulation.changes.decay import TELLING, Decay
from symtop_ros.run.simulation.changes.outcomes import Start
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.words import write

SENTENCE = re.compile(
    r"Friction slows the spin: in (\S+) s half of p_psi is lost\. The precession gets (\w+): on "
    r"average phi' is (\S+) rad/s then, and (\S+) rad/s at first\."
)
TOP, START = Top(0.000228, 0.0000572, 0.068), State.from_euler(theta=0.5, psi_dot=200.0)


def say(motion):
    """Return the numbers and the word of the sentence, None without one."""
    found = SENTENCE.search(write("start", Start.of(motion)))
    return found and (float(found[1]), found[2], float(found[3]), float(found[4]))


def sample_rate(motion, time):
    """The mean phi' of the motion in a nutation after a time, and the length of that (s)."""
    period = Motion(motion.top, motion.at(time)).nutation_period
    phi = np.unwrap(motion.at(np.linspace(time, time + period, 401)).euler_angles.phi)
    return float(phi[-1] - phi[0]) / period, period


def draw(rng):
    """A fast top with friction that takes half of the spin in 20 to 200 turns."""
    top = Top(1.0, rng.uniform(0.3, 1.9), rng.choice((-1, 1)) * rng.uniform(0.2, 2.0))
    spin = rng.choice((-1, 1)) * rng.uniform(6.0, 15.0)
    theta, phi_dot = rng.uniform(0.3, 2.8), rng.uniform(-1.0, 1.0)
    axial = top.Iz * abs(spin) / rng.uniform(180.0, 1800.0)
    start = State.from_euler(theta=theta, psi_dot=spin, phi_dot=phi_dot)
    return Motion(top, start, Friction(axial, rng.choice((0.0, 0.2)) * axial))


@pytest.mark.parametrize("seed", seeds(2, 100))
def test_what_is_said_of_the_precession_is_seen_in_the_motion(seed):
    rng = Numbers(seed)
    said = 0
    for _ in range(10):
        motion = draw(rng)
        found = say(motion)
        seconds = motion.top.Iz * math.log(2) / motion.friction.axial
        free = [Motion(motion.top, motion.at(t)) for t in (0.0, seconds)]
        if any(each.kind in ("through the pole", "asymptotic") for each in free):
            continue
        (first, one), (last, other) = (sample_rate(motion, t) for t in (0.0, seconds))
        # In a nutation friction takes this part of the spin momentum; a rate of precession, that
        # goes with a power of it up to the second, and the nutation change in proportion.
        loose = 4 * max(one, other) / seconds
        scale = max(abs(first), abs(last))
        if not found:
            ratio = max(abs(first), abs(last)) / min(abs(first), abs(last))
            assert first * last < 0 or ratio < TELLING + 2 * loose
            continue
        said += 1
        shown, word, after, before = found
        assert shown == pytest.approx(seconds, rel=5e-3)  # three digits
        assert word == ("faster" if abs(after) > abs(before) else "slower")
        digits = 5e-3 * scale + 5e-3
        assert after == pytest.approx(last, abs=loose * scale + digits)
        assert before == pytest.approx(first, abs=loose * scale + digits)
        momenta = motion.top.axial_momentum(motion.at(np.array([0.0, seconds])))
        # the promise of driven motions is 1e-9 of the state
        assert momenta[1] / momenta[0] == pytest.approx(0.5, abs=1e-8)
    assert said >= 3


def test_the_scene_with_friction_says_that_its_precession_gets_faster():
    assert say(start_motion(Settings.from_scene("friction"))) == (19.8, "faster", 14.57, 6.64)


@pytest.mark.parametrize(
    "motion",
    [
        Motion(TOP, START),
        Motion(TOP, START, Friction(0.0, 1e-5)),
        Motion(TOP, START, Friction(2e-6), (0.0, 0.0, 1e-5)),
        Motion(TOP, START, Friction(2e-12)),  # 200 million turns
        Motion(TOP, State.from_euler(theta=0.0, psi_dot=200.0), Friction(2e-6)),
        Motion(Top(0.000228, 0.0000572, 0.0), START, Friction(2e-6)),  # its axis stays
    ],
)
def test_nothing_is_said_where_friction_does_not_change_it_or_it_takes_long(motion):
    assert Decay.of(motion) is None
