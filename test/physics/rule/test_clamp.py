"""Verdicts on a clamp, compared with the motions, for tops of all families."""

import math
from collections import Counter

import numpy as np
import pytest
from drawn import Numbers, cos, sin
from physics.clamped import fall, follow_clamped
from physics.tops import ARTICLE, CUSPS, DISC, FAMILIES, random_case
from trials import seeds, trials

from symtop_ros.physics import (
    ClampVerdict,
    Motion,
    State,
    Top,
    clamp_verdict,
    set_precession_rate,
)

NEAR = 1e-6  # rad; a tilt is an angle of which cos(theta) has half the digits


def draw_start(seed):
    """A start of any family, sometimes weightless, or with its axis at rest."""
    rng = Numbers(f"clamp {seed}")
    case = random_case(seed, FAMILIES[seed % len(FAMILIES)])
    top = Top(case.top.Ix, case.top.Iz, 0.0) if seed % 11 == 0 else case.top
    start = case.start
    if seed % 7 == 0:
        turned = (0.0, 0.0, start.angular_velocity[2])
        start = set_precession_rate(State(start.orientation, turned), rng.uniform(-9, 9))
    return top, start


def find_depth(top, state):
    """Return the angle in rad between the weight and its lowest place."""
    theta = state.euler_angles.theta
    return math.pi - theta if top.Mgl > 0 else theta


def check_lowest(top, motion, held):
    times = np.linspace(0.0, held.lowest_in, 33)
    depths = find_depth(top, motion.at(times))
    speed = abs(float(motion.at(held.lowest_in).euler_rates.theta_dot))
    assert depths[-1] <= 1e-9 + speed * held.lowest_in * 1e-12
    assert depths[:-1].min() > 0
    if held.kind == "falls":
        assert np.all(np.diff(depths) <= NEAR)


def check(top, start):
    held = clamp_verdict(top, start)
    motion = Motion(top, start, clamped=True)
    state = motion.at(0.0)
    assert held.theta == start.euler_angles.theta
    assert held.subject == ("axis" if top.Mgl < 0 else "top")
    across = float(np.hypot(*start.angular_velocity[:2]))
    assert held.rate == pytest.approx(abs(float(state.euler_rates.theta_dot)), abs=1e-13 * across)
    still = State(start.given_orientation, (*start.angular_velocity[:2], 0.0))
    unit = math.sqrt(abs(top.Mgl) / top.Ix) or 1.0
    for t in (0.1 / unit, 1.7 / unit, 23.0 / unit):  # as if it did not spin
        tilt = Motion(top, still, clamped=True).at(t).euler_angles.theta
        assert motion.at(t).euler_angles.theta == pytest.approx(tilt, abs=NEAR)
    low, high = held.angles_without
    span = Motion(top, start)
    tilts = span.at(np.linspace(0.0, min(span.nutation_period, 1e3), 65)).euler_angles.theta
    assert low - NEAR <= tilts.min()
    assert tilts.max() <= high + NEAR
    if held.lowest_in is not None:
        check_lowest(top, motion, held)
    elif held.kind == "rises":
        assert motion.nutation_period == math.inf
        assert find_depth(top, motion.at(40 / math.sqrt(abs(top.Mgl) / top.Ix))) > math.pi - NEAR
    elif held.kind == "turns":
        rates = [follow_clamped(top, start, t)[1] for t in (0.0, 5.0)]
        assert [math.hypot(x, y) for x, y, _ in rates] == pytest.approx([held.rate] * 2)
    else:
        assert (held.kind, top.Mgl) == ("rests", 0.0)
        fastest = float(np.abs(start.angular_velocity).max())
        assert float(np.hypot(*state.angular_velocity[:2])) <= 1e-13 * fastest  # by rounding alone
    return held.kind


@pytest.mark.parametrize("first", seeds(1, 20))
def test_each_sentence_is_true_of_its_motion(first):
    kinds = Counter(check(*draw_start(seed)) for seed in range(250 * first, 250 * (first + 1)))
    assert min(kinds["falls"], kinds["swings"]) > 20
    assert min(kinds["turns"], kinds["rests"]) > 0


NEXT_TO_THE_LOWEST = [
    # lowest in 1e-17 s, then up to 1.047 rad; and over the top for ever
    (
        Top(1.0, 0.5, -1.0),
        State((1.0, float.fromhex("0x1.70ef54646d497p-58"), 0.0, 0.0), (-1, 0, 0)),
    ),
    (
        Top(1.0, 0.5, 1.0),
        State.from_euler(theta=float.fromhex("0x1.921fb54442d17p+1"), theta_dot=-3),
    ),
]


@pytest.mark.parametrize(("top", "start"), NEXT_TO_THE_LOWEST)
def test_an_axis_that_moves_next_to_its_lowest_point_passes_it(top, start):
    held = clamp_verdict(top, start)
    assert held.kind == "swings"
    check_lowest(top, Motion(top, start, clamped=True), held)


@pytest.mark.parametrize("count", trials(60, 3000))
def test_next_to_the_lowest_point_nothing_comes_to_rest_at_the_highest(count):
    """Half of them rotate, half of them swing; the sign of A or B after a period is rounding."""
    rng = Numbers("next to the lowest point")
    for _ in range(count):
        top = Top(1.0, rng.uniform(0.1, 2.0), rng.choice([1, -1]) * rng.power(-2, 2))
        near = rng.power(-17, -6)  # half an angle from the lowest point, by the part that vanishes
        turn = rng.uniform(-3, 3)
        parts = (near * cos(turn), near * sin(turn))
        q = (parts[0], 1.0, 0.0, parts[1]) if top.Mgl > 0 else (1.0, *parts, 0.0)
        rate = rng.uniform(0.1, 4) * float(np.sqrt(abs(top.Mgl)))
        way = rng.uniform(-3, 3)
        start = State(q, (rate * cos(way), rate * sin(way), rng.uniform(-9, 9)))
        held = clamp_verdict(top, start)
        assert held.kind in ("swings", "falls"), (top, start)
        assert held.lowest_in is not None


def test_with_the_energy_to_stand_upright_it_rises_or_falls_first():
    top = Top(1.0, 0.5, 0.5)
    q = (0.5, 0.5, 0.5, 0.5)
    assert clamp_verdict(top, State(q, (-1.0, 0.0, 3.0))).kind == "rises"
    down = clamp_verdict(top, State(q, (1.0, 0.0, 3.0)))
    _, rate = fall(0.5, math.pi / 4, 1.0, down.lowest_in)
    assert down.kind == "swings"
    assert float(rate) == pytest.approx(math.sqrt(2.0))  # Ix theta'^2/2 = 2 Mgl


@pytest.mark.parametrize(
    ("top", "start", "sentence"),
    [
        (
            ARTICLE,
            CUSPS,
            "Clamped, the axle falls as if the top did not spin, from theta = 0.500 rad to its "
            "lowest point in 0.163 s. Without the clamp theta would stay between 0.500 and 0.664 "
            "rad.",
        ),
        (
            DISC,
            State.from_euler(theta=0.5, theta_dot=1.0, psi_dot=200.0),
            "Clamped, the axle moves in a vertical plane as if the top did not spin: the weight is "
            "at its lowest point in 0.109 s. Without the clamp theta would stay between 0.496 and "
            "0.502 rad.",
        ),
    ],
)
@pytest.mark.wording
def test_the_sentences(top, start, sentence):
    assert str(clamp_verdict(top, start)) == sentence


def test_a_vertical_axis_is_refused():
    with pytest.raises(ValueError, match="a clamped motion must start with a tilted axis"):
        clamp_verdict(ARTICLE, State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 200.0)))


def test_the_record_has_no_time_where_there_is_none():
    rests = clamp_verdict(Top(1.0, 1.0, 0.0), CUSPS)
    assert rests == ClampVerdict("rests", "top", 0.5, 0.0, None, rests.angles_without)
