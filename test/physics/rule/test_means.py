"""Means with a kick and without it, against averages of the sampled motions."""

import math
from collections import Counter

import numpy as np
import pytest
from drawn import Numbers
from physics.reference.cases import ASYMPTOTIC
from physics.tops import ARTICLE, SLOW, precess
from trials import trials

from symtop_ros.physics import (
    HOLDS,
    Friction,
    Motion,
    State,
    Top,
    apply_impulse,
    hurry,
    kick_verdict,
    perrys_rule,
    set_precession_rate,
)

SAMPLES = 4096
# The mean of a smooth periodic function over equal steps converges faster than any power of the
# step: what is left are 4096 roundings, and the digits of sin(theta)^2 next to a pole.
ROUNDING = 1e-11


def draw(rng):
    """A top of either sign of Mgl or without weight, and a state at any instant of its nutation."""
    Ix, unit = rng.power(-4, 0), rng.power(0, 1.5)
    Iz = Ix * rng.choice([rng.uniform(0.05, 1.0), rng.uniform(1.0, 2.0)])
    top = Top(Ix, Iz, rng.choice([1, 1, -1, -1, 0]) * Ix * unit * unit)
    rates = {"phi_dot": rng.choice([0.0, rng.uniform(-3, 3) * unit, rng.uniform(-3, 3) * unit])}
    rates["theta_dot"] = rng.choice([0.0, rng.uniform(-1, 1) * unit])
    rates["psi_dot"] = rng.uniform(-12, 12) * Ix / Iz * unit
    return top, State.from_euler(theta=rng.uniform(0.2, 2.9), phi=rng.uniform(-3, 3), **rates)


def average(motion):
    """Return the means of phi' and of cos(theta), and how far the axis stays from the vertical."""
    times = np.linspace(0.0, motion.nutation_period, SAMPLES + 1)
    axle = motion.at(times).to_world([0.0, 0.0, 1.0])
    way = np.unwrap(np.arctan2(axle[:, 1], axle[:, 0]))
    margin = float(np.hypot(axle[:, 0], axle[:, 1]).min())
    return (way[-1] - way[0]) / motion.nutation_period, float(axle[:-1, 2].mean()), margin


def is_followed(motion, margin):
    """True if the period is one, and phi is sampled finely enough to be unwrapped."""
    return motion.kind in {"cusps", "looping", "unidirectional"} and margin > 0.05


@pytest.mark.parametrize("count", trials(150, 20_000))
def test_means_and_sense_are_those_of_the_sampled_motions(count):
    rng = Numbers("means")
    said = Counter()
    for _ in range(count):
        top, before = draw(rng)
        hold = rng.choice(HOLDS)
        rate = before.euler_rates.phi_dot
        wanted = rng.choice([1.4 * rate, rate / 1.4, rate + 0.3 * rng.uniform(-1, 1)])
        after = set_precession_rate(before, wanted, hold)
        motions = [Motion(top, before), Motion(top, after)]
        (was, low, *margins), (now, high, _) = averages = [average(each) for each in motions]
        margins = [each[2] for each in averages]
        found = kick_verdict(motions[1], before, hold).means
        if not all(map(is_followed, motions, margins)):
            continue
        assert found.cosines == pytest.approx((low, high), abs=ROUNDING)
        fastest = max(np.abs(each.start.angular_velocity).max() for each in motions)
        assert found.rates == pytest.approx((was, now), abs=ROUNDING * fastest)
        change = after.euler_rates.phi_dot - rate
        if min(abs(was), abs(now), abs(change)) < ROUNDING * fastest:
            continue
        speaks = top.Mgl != 0 and was * now > 0
        sense = ("along" if was * change > 0 else "against") if speaks else None
        assert found.sense == sense, (top, before, after)
        if abs(high - low) > 2 * ROUNDING:
            assert found.height == ("higher" if high > low else "lower")
        said[found.sense, found.height] += 1
    assert min(said[s, h] for s in ("along", "against") for h in ("higher", "lower")) > count / 100


@pytest.mark.parametrize("count", trials(60, 3000))
def test_a_kick_that_is_considered_has_the_means_of_that_kick(count):
    rng = Numbers("considered")
    for _ in range(count):
        top, before = draw(rng)
        hold, factor = rng.choice(HOLDS), rng.choice([1.4, 0.5, 0.0, 2.0])
        considered = perrys_rule(top, before, factor, hold)
        after = hurry(before, factor, hold)
        made = kick_verdict(Motion(top, after), before, hold).means
        if considered.reason.kind == "no_precession":
            assert considered.means is None
        elif factor:  # a hurry to rest takes off the rounding as well
            assert considered.means == made
        many = perrys_rule(top, before, [factor, 1.0], hold)
        means = considered.means
        assert many.sense.tolist() == [(means and means.sense) or "", ""]
        assert many.mean_height.tolist() == [means.height if means else "", ""]


def test_in_the_backward_part_of_a_loop_the_mean_says_what_the_rule_denies():
    """At the top of a loop a delay is a push along the precession that is seen."""
    motion = Motion(ARTICLE, State.from_euler(theta=0.5, phi_dot=20.0, psi_dot=200.0))
    back = motion.at(motion.nutation_period / 2)  # theta' = 0 at the other turning point
    assert back.euler_rates.phi_dot < 0 < motion.mean_precession_rate
    found = kick_verdict(Motion(ARTICLE, hurry(back, 0.5, "spin_momentum")), back, "spin_momentum")
    assert found.reason.rule == "fails"
    assert (found.means.sense, found.means.height) == ("along", "higher")


SILENT = [
    ("an impulse of any direction", ARTICLE, precess(SLOW), (1e-4, 2e-4, 0.0)),
    ("no weight", Top(1.0, 0.5, 0.0), precess(6.5), 1.4),
    ("no change", ARTICLE, precess(6.5), 1.0),
    ("through the pole", ARTICLE, State.from_euler(theta=0.5, phi_dot=-400.0, psi_dot=464.0), 1.0),
    ("a mean of the other sign", ARTICLE, precess(6.5), -30.0),
]


@pytest.mark.parametrize(("why", "top", "before", "act"), SILENT)
def test_where_the_mean_says_nothing_of_the_sense(why, top, before, act):
    if isinstance(act, tuple):
        after, hold = apply_impulse(top, before, act), None
    else:
        after, hold = hurry(before, act), "spin_rate"
    found = kick_verdict(Motion(top, after), before, hold)
    assert found.means is None or found.means.sense is None, why
    assert "mean precession" not in str(found)


def test_of_an_axis_that_is_driven_there_are_no_means():
    driven = Motion(ARTICLE, hurry(precess(SLOW)), Friction(axial=2e-6))
    assert kick_verdict(driven, precess(SLOW), "spin_rate").means is None
    assert math.isnan(driven.mean_precession_rate)
    pendulum = State.from_euler(theta=1.0)
    kicked = Motion(ARTICLE, set_precession_rate(pendulum, 1.0))
    assert kick_verdict(kicked, pendulum, "spin_rate").means.rates is None


def test_of_an_axis_that_approaches_the_vertical_there_are_no_means():
    top, start, _ = ASYMPTOTIC
    assert Motion(top, start).kind == "asymptotic"
    after = hurry(start, 1.5)
    assert kick_verdict(Motion(top, after), start, "spin_rate").means is None
    assert perrys_rule(top, start).means is None


def test_a_push_at_a_cusp_has_a_sense_although_there_is_no_precession_to_hurry():
    before = State.from_euler(theta=0.5, psi_dot=200.0)
    for rate, sense, height in ((2.0, "along", "higher"), (-2.0, "against", "lower")):
        motion = Motion(ARTICLE, set_precession_rate(before, rate, "spin_momentum"))
        found = kick_verdict(motion, before, "spin_momentum")
        assert (found.reason.kind, found.means.sense) == ("no_precession", sense)
        assert found.means.height == height


@pytest.mark.wording
@pytest.mark.parametrize(
    ("Mgl", "words"),
    [
        (0.068, "the mean height rises"),
        (-0.068, "the mean height of the axis falls and that of the centre of mass rises"),
    ],
)
def test_the_mean_height_is_of_the_axis_and_once_more_of_the_centre_of_mass(Mgl, words):
    top = Top(ARTICLE.Ix, ARTICLE.Iz, Mgl)
    theta = 0.5 if Mgl > 0 else math.pi - 0.5
    before = State.from_euler(theta=theta, phi_dot=math.copysign(SLOW, Mgl), psi_dot=200.0)
    found = kick_verdict(Motion(top, hurry(before)), before, "spin_rate")
    assert f", and {words} (mean of cos(theta): " in str(found)
    assert "The kick is along the mean precession (" in str(found)
