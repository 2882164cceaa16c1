"""Motions of 16 families against a Taylor series, which shares no formula with the package.

200 are stored; `make test-long` solves 2000 others, which takes half an hour.
"""

import math

import pytest
from physics.taylor_families import FAMILIES, STORED, make_case, read_stored
from physics.tops import EPS, attitude_error, error, largest_rate

from symtop_ros.physics import Motion

pytestmark = pytest.mark.untraced
SEEDS = 125  # of each family


@pytest.mark.parametrize("family", FAMILIES)
def test_every_state_is_right_to_five_eps(family):
    # From 1e-3 to 1e12 periods; 5 is what is promised.
    for data in STORED:
        if data["family"] != family:
            continue
        motion = Motion(*read_stored(data))
        for t, q, omega in zip(data["t"], data["q"], data["omega"], strict=True):
            state = motion.at(t)
            assert attitude_error(q, state.orientation) <= 5 * EPS
            assert error(omega[:2], state.angular_velocity[:2], data["largest"]) <= 5 * EPS
            assert state.angular_velocity[2] == data["omega0"][2]  # omega_z is constant


@pytest.mark.parametrize("data", STORED, ids=[data["family"] for data in STORED])
def test_every_period_is_right_and_finite_if_the_exact_one_is(data):
    motion = Motion(*read_stored(data))
    exact = math.inf if data["period"] is None else data["period"]
    assert motion.nutation_period == pytest.approx(exact, rel=2 * EPS)
    assert (motion.kind == "asymptotic") == (exact == math.inf)


def test_there_are_200_motions_of_16_families():
    assert len(STORED) == 200
    assert {data["family"] for data in STORED} == set(FAMILIES)


@pytest.mark.parametrize("family", ["ordinary", "upper pole", "separatrix of a pendulum"])
def test_the_stored_motions_are_those_of_the_series(family):
    data = next(data for data in STORED if data["family"] == family)
    series = make_case(family, 0).series
    for t, q in zip(data["t"], data["q"], strict=True):
        (exact, _) = series.at(t)
        assert max(abs(float(a) - float(b)) for a, b in zip(exact, q, strict=True)) <= EPS


@pytest.mark.long
@pytest.mark.parametrize("family", FAMILIES)
def test_many_new_motions_are_right_to_five_eps_and_every_period_is_finite(family):
    for seed in range(SEEDS):
        case = make_case(family, 1000 + seed)
        series, motion = case.series, case.motion
        assert math.isfinite(motion.nutation_period) == case.has_period, seed
        for t in case.times:
            (q, omega), state = series.at(t), motion.at(t)
            assert attitude_error(q, state.orientation) <= 5 * EPS, (seed, t)
            size = largest_rate(motion)
            assert error(omega, state.angular_velocity, size) <= 5 * EPS, (seed, t)
