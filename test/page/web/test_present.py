"""Why the axle moves as it does just now: the sentence, against motion and torques."""

import collections
import math
import re

import numpy as np
import pytest
from drawn import Numbers
from page.web.modules import load_kernel
from trials import trials

from symtop_ros.page.web.join import LANGUAGES
from symtop_ros.physics import Motion, State, Top

EFFECTS = ("moves down faster", "moves down more and more slowly", "moves up faster")
EFFECTS += ("moves up more and more slowly", "begins to move up", "begins to move down")
NEEDS = {"only a part": (0.05, 1.0), "more than": (1.0, math.inf), "hardly any": (-0.05, 0.05)}
NEEDS |= {"a torque against": (-math.inf, -0.05)}
# Of the torque: its parts are sums of products of doubles, the largest perhaps 1e4 times it.
ROUNDING = 1e-10
# Of a nutation: within it the pace does not change its sign, and many roundings are left.
SHORT = 1e-5
# Of a nutation. A turning point is named within 0.01 of it at the acceleration of now, which is
# that at the turning point within a factor of two.
NEAR = 0.02


def draw_instants(count):
    """Instants of tops of either sign of Mgl and of Iz - Ix: fast, slow, without spin, at roots."""
    rng = Numbers("instants of nutations")
    for _ in range(count):
        Ix, unit = rng.power(-4, -1), rng.power(0, 1.5)
        Iz = Ix * rng.choice([rng.uniform(0.05, 1.0), rng.uniform(1.0, 2.0)])
        top = {"Ix": Ix, "Iz": Iz, "Mgl": rng.choice([1, -1]) * Ix * unit * unit}
        spin = rng.choice([rng.uniform(-9, 9), rng.uniform(-1, 1), 0.0]) * Ix / Iz * unit
        rates = {"phi_dot": rng.choice([0.0, rng.uniform(-3, 3) * unit]), "psi_dot": spin}
        rates["theta_dot"] = rng.choice([0.0, rng.uniform(-1, 1) * unit])
        motion = Motion(Top(**top), State.from_euler(theta=rng.uniform(0.1, 3.0), **rates))
        period = motion.nutation_period
        # now and then at a turning point, as one who pauses there
        part = rng.choice([rng.uniform(0, 1), rng.choice([0.0, 0.5]) + rng.uniform(-0.004, 0.004)])
        state = motion.at(part * period if math.isfinite(period) else rng.uniform(0, 3) / unit)
        orientation, omega = state.orientation.tolist(), state.angular_velocity.tolist()
        yield {"top": top, "orientation": orientation, "omega": omega}


@pytest.mark.wording
@pytest.mark.parametrize("count", trials(100, 20_000))
def test_an_instant_of_a_nutation_is_explained_by_what_is_so(tab, count):
    cases = list(draw_instants(count))
    heard = collections.Counter()
    for case, text in zip(cases, tab.evaluate("sayPresents", cases), strict=True):
        if not text:
            heard["silence"] += 1
            continue
        (effect,) = [each for each in EFFECTS if each in text]
        (needs,) = [each for each in NEEDS if each in text]
        heard[effect] += 1
        heard[needs] += 1
        assert ("the weight" in text) == (case["top"]["Mgl"] < 0)
        check_effect(effect, *sample(case))
        check_needs(needs, case)
    assert heard.keys() >= {*EFFECTS, *NEEDS}
    assert heard["silence"] < 0.2 * count  # steady, small and endless nutations, and balance


def sample(case):
    """Return the motion from an instant, its period, and the sign of the weight."""
    state = State(np.array(case["orientation"]), np.array(case["omega"]))
    motion = Motion(Top(**case["top"]), state)
    return motion, motion.nutation_period, math.copysign(1, case["top"]["Mgl"])


def check_effect(effect, motion, period, sign):
    """Check the way and the pace by the rates at which the weight goes down."""

    def fall(time):
        return sign * motion.at(time).euler_rates.theta_dot

    if "begins" in effect:
        before, after = fall(-NEAR * period), fall(NEAR * period)
        assert (before > 0 > after) if effect.endswith("up") else (before < 0 < after)
        return
    assert (fall(0.0) > 0) == ("down" in effect)
    before, after = abs(fall(-SHORT * period)), abs(fall(SHORT * period))
    assert (after > before) == ("faster" in effect)


def check_needs(needs, case):
    """Check what it takes to turn L with the axle, along the line of nodes."""
    motion, *_ = sample(case)
    state = motion.at(0.0)
    phi, theta, _ = state.euler_angles
    nodes = np.array([math.cos(phi), math.sin(phi), 0.0])
    momentum = motion.top.angular_momentum(state)
    taken = state.euler_rates.phi_dot * (np.cross([0.0, 0.0, 1.0], momentum) @ nodes)
    share = taken / (motion.top.Mgl * math.sin(theta))
    low, high = NEEDS[needs]
    assert low - ROUNDING <= share <= high + ROUNDING


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_says_the_same_of_an_instant(tab, language):
    """The two arrows are named, and the texts of two records differ as the English ones do."""
    cases = list(draw_instants(60))
    english = tab.evaluate("sayPresents", cases)
    load_kernel(tab, language)
    said = tab.evaluate("sayPresents", cases)
    load_kernel(tab)
    assert len(set(zip(english, said, strict=True))) == len(set(english)) == len(set(said))
    for text in filter(None, said):
        assert re.findall(r"\|(\w+)\]", text) in (["L", "torque"], ["torque", "L"])
