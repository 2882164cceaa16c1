"""2000 random motions of 16 families against a Taylor series: `make test-long`, half an hour."""

import math

import pytest
from physics.taylor_families import FAMILIES, error, make_case
from physics.tops import EPS

pytestmark = [pytest.mark.long, pytest.mark.untraced]
SEEDS = 125  # of each family


@pytest.mark.parametrize("family", FAMILIES)
def test_every_state_is_right_to_five_eps_and_every_period_is_finite(family):
    for seed in range(SEEDS):
        case = make_case(family, 1000 + seed)
        series, motion = case.series, case.motion
        assert math.isfinite(motion.nutation_period) == case.has_period, seed
        for t in case.times(series):
            (q, omega), state = series.state_at(t), motion.at(t)
            assert error(q, state.orientation) <= 5 * EPS, (seed, t)
            largest = series.largest_rate if case.has_period else math.hypot(*case.omega[:2])
            assert error(omega, state.angular_velocity, largest) <= 5 * EPS, (seed, t)
