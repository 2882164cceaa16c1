"""Delays of steady motions: many are as good, or none is known."""

import math
import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from truth.judge.cases import SECOND, Made, heading

from symtop_ros.truth.judge.aliases import find_period
from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.truth import scene_truth

STAMPS = np.arange(SECOND, 6 * SECOND, SECOND // 200)
NUMBER = r"(-?\d[\d.]*)"
FAMILY = re.compile(
    rf"a delay of {NUMBER} \+- {NUMBER} ms \+ n x {NUMBER} ms, "
    rf"a heading of {NUMBER} \+- {NUMBER} rad \+ n x {NUMBER} rad"
)
BODY = Rotation.from_rotvec([0.2, -0.1, 0.3])
CASES = {  # scene: delay in ms
    "regular_precession": 3.0,
    "hurry_slow": 35.0,
    "toy_gyroscope": 20.0,
}


def say(scene, **made):
    """Return what is said of estimates with noise of 1 mrad: the judgement, and its text."""
    found = judge(
        Made(**made, noise=1e-3).make(scene_truth(scene), STAMPS), scene_truth(scene), "x"
    )
    return found, found.format()


@pytest.mark.slow
@pytest.mark.parametrize("scene", CASES)
def test_a_delay_with_a_heading_is_a_family_that_has_the_true_one(scene):
    judgement, text = say(scene, world=heading(0.3), delay=CASES[scene] * 1e-3)
    found = FAMILY.search(text)
    assert found, text
    delay, off, period, angle, spread, step = map(float, found.groups())
    n = round((CASES[scene] - delay) / period)
    # A normal number is beyond 4.5 once in 150 000 times; the period is rounded to the last digit.
    assert abs(delay + n * period - CASES[scene]) < 4.5 * off + abs(n) * 1e-5
    turned = math.remainder(angle + n * step - 0.3, math.tau)
    assert abs(turned) < 4.5 * spread + abs(n) * 1e-6
    assert abs(delay) <= period / 2 + off  # the smallest comes first
    assert "not identifiable" not in text
    facts = judgement.facts()["found"]
    assert facts["delay_period"] == pytest.approx(period * 1e-3, rel=1e-4)
    assert any(
        abs(1e3 * each - CASES[scene]) < 4.5 * off
        for each in [facts["delay"], *facts["other_delays"]]
    )


def test_the_turn_of_the_spin_is_the_period():
    """A delay that is longer by it leaves the body as it is."""
    spin = abs(scene_truth("regular_precession").rates["spin"])
    judgement, _ = say("regular_precession", world=heading(0.3), delay=3e-3)
    assert judgement.found.period == pytest.approx(2 * math.pi / spin, rel=1e-5)


@pytest.mark.slow
def test_a_delay_alone_is_one_and_what_it_equals_is_said():
    judgement, text = say("regular_precession", delay=0.02)
    assert judgement.found.aliases == ()
    assert "best explained by a delay of 20.00" in text
    found = re.search(
        rf"in this steady motion the same as a rotation of the world by {NUMBER}", text
    )
    assert found, text
    turned = 0.02 * abs(scene_truth("regular_precession").rates["precession"])
    assert float(found[1]) == pytest.approx(turned, abs=5e-4)
    assert "not identifiable" not in text


@pytest.mark.slow
@pytest.mark.parametrize("world", [0.0, 0.4])
def test_where_the_body_is_turned_too_the_known_combination_is_said(world):
    truth = scene_truth("regular_precession")
    made = Made(world=heading(world), body=BODY, delay=0.02)
    judgement, text = say("regular_precession", world=made.world, body=BODY, delay=0.02)
    best, rates = judgement.found.best, truth.rates
    assert best.kind == ("", "both", ())
    assert judgement.facts()["found"]["delay"] is None
    found = re.search(
        rf"heading minus {NUMBER} rad/s x delay, .* axis of the body minus {NUMBER} rad/s x delay",
        text,
    )
    assert found, text
    assert float(found[1]) == pytest.approx(rates["precession"], rel=1e-3)
    assert float(found[2]) == pytest.approx(rates["spin"], rel=1e-3)
    # a delay of 20 ms turns world and body back by these
    turned = [Rotation.from_rotvec([0, 0, -0.02 * rates[n]]) for n in ("precession", "spin")]
    wanted = heading(world) * turned[0], turned[1] * BODY
    for own, other, deviation in zip(
        (best.offset.world, best.offset.body), wanted, best.turn_deviations, strict=True
    ):
        off = (Rotation.from_quat(own[[1, 2, 3, 0]]) * other.inv()).magnitude()
        assert off < 6 * deviation  # of three components


def test_delays_of_a_family_may_be_missing():
    assert find_period(np.array([-2.0, 1.0, 7.0])) == pytest.approx(3.0)
    assert find_period(np.array([-2.0, 1.0, 5.5])) is None
