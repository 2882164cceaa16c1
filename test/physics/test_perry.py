"""Perry's rule: the article's cases, and the verdict against what the top then does."""

import random

import pytest

from symtop_ros.physics import State, Top, hurry, motion, perry, push, regular_precession_rates
from symtop_ros.physics.perry import kick_verdict

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
SIX = {0.0: "falls", 3.0: "falls", 9.0: "rises", 67.0: "rises", 73.0: "falls", 6.49: "falls"}


def start(phi_dot, psi_dot=200.0, theta=0.5):
    return State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot)


@pytest.mark.parametrize(("phi_dot", "direction"), SIX.items())
def test_the_articles_rates_do_what_the_article_says(phi_dot, direction):
    verdict = perry(ARTICLE, start(phi_dot))
    assert verdict.direction == direction
    low, high = verdict.turning_angles
    assert (high if direction == "rises" else low) == pytest.approx(0.5, abs=1e-15)


def test_hurrying_the_slow_root_raises_and_the_fast_root_lowers():
    slow, fast = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
    for rate, direction, holds in ((slow, "rises", True), (fast, "falls", False)):
        before = start(rate)
        assert perry(ARTICLE, before).direction == "stays"
        assert perry(ARTICLE, before).rule_holds is holds
        for kick in (hurry, push):
            assert perry(ARTICLE, kick(ARTICLE, before, 1.05)).direction == direction


def test_with_everything_reversed_hurrying_the_slow_root_lowers():
    disc = Top(Ix=0.0002, Iz=0.00035, Mgl=-0.05)
    slow = regular_precession_rates(disc, theta=0.5, psi_dot=-120.0)[0]
    before = start(slow, psi_dot=-120.0)
    assert perry(disc, before).rule_holds is False
    assert perry(disc, hurry(disc, before)).direction == "falls"


@pytest.mark.parametrize("seed", range(200))
def test_the_verdict_is_what_the_top_then_does(seed):
    rng = random.Random(seed)
    Ix = 10 ** rng.uniform(-4, 0)
    top = Top(Ix, Ix * rng.uniform(0.05, 2.0), Ix * rng.uniform(-300, 300))
    state = start(rng.uniform(-40, 40), rng.uniform(-200, 200), rng.uniform(0.05, 3.0))
    theta = motion(top, state).at(1e-5).euler_angles.theta - state.euler_angles.theta
    # theta''/2 t^2 with t = 10 us is seen above rounding of theta where theta'' > 1e-4
    expected = "rises" if theta < 0 else "falls"
    if abs(theta) > 1e-14:
        assert perry(top, state).direction == expected


@pytest.mark.parametrize("hold", ["spin_rate", "spin_momentum"])
@pytest.mark.parametrize("seed", range(50))
def test_the_rule_holds_where_a_little_more_precession_lowers_the_acceleration(seed, hold):
    rng = random.Random(seed)
    Ix = 10 ** rng.uniform(-4, 0)
    top = Top(Ix, Ix * rng.uniform(0.05, 2.0), Ix * rng.uniform(-300, 300))
    state = start(rng.uniform(1, 40) * rng.choice([-1, 1]), rng.uniform(-200, 200), 0.7)

    def lift(factor):
        after = hurry(top, state, factor, hold)
        t = 1e-5
        return motion(top, after).at(t).euler_angles.theta

    change = lift(1.1) - lift(0.9)
    if abs(change) > 1e-13:  # rounding of theta
        assert perry(top, state, hold).rule_holds is (change < 0)


def test_the_reason_names_the_root_the_place_and_the_condition():
    slow, _ = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
    assert "is the slow rate of regular precession" in perry(ARTICLE, start(slow)).reason
    reason = perry(ARTICLE, start(9.0)).reason
    assert "phi' = 9.00 is between the roots 6.50 and 69.82 rad/s" in reason
    assert "2 (Ix - Iz) cos(theta) phi' < Iz psi'" in reason
    assert "no rate is regular" in perry(ARTICLE, start(5.0, psi_dot=20.0)).reason


def test_on_the_vertical_the_rule_is_not_defined():
    verdict = perry(ARTICLE, State.from_euler(theta=0.0, psi_dot=200.0))
    assert verdict.direction == "stays"
    assert verdict.rule_holds is None
    moving = State((1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 200.0))
    assert perry(ARTICLE, moving).direction == "falls"


def test_a_kick_is_told_in_one_sentence():
    slow, fast = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
    raised = kick_verdict(motion(ARTICLE, hurry(ARTICLE, start(slow))), start(slow))
    assert raised.startswith("precession 6.50 -> 9.10 rad/s (regular at 6.50 and 69.82): the top")
    assert "the top rises, theta 0.437 .. 0.500 rad" in raised
    assert "Perry's rule holds here" in raised
    lowered = kick_verdict(motion(ARTICLE, hurry(ARTICLE, start(fast), 1.05)), start(fast))
    assert "the top falls" in lowered
    assert "Perry's rule fails here" in lowered
    delayed = kick_verdict(motion(ARTICLE, hurry(ARTICLE, start(slow), 0.8)), start(slow))
    assert "delayed: Perry's rule holds here" in delayed
    reversed_ = kick_verdict(motion(ARTICLE, hurry(ARTICLE, start(slow), -1.0)), start(slow))
    assert "reversed" in reversed_
    none = kick_verdict(motion(ARTICLE, hurry(ARTICLE, start(0.0))), start(0.0))
    assert "the precession was not changed" in none
