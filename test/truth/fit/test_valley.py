"""Deviations along a valley: of long records they hold, of short ones they may not."""

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit import make_record
from symtop_ros.truth.fit.model import Model, name_parameters
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.starts import fill
from symtop_ros.truth.fit.valley import Valley
from symtop_ros.truth.fit.values import list_values

# 4.3 nutations a second: 1100 of them, with 7.4 rows each.
MOTION = Motion(Top(1.0, 0.5, 100.0), State.from_euler(theta=1.0, phi_dot=1.0, psi_dot=60.0))
SIGMA = 2.0**-7


def fit_from_truth(times, seed):
    """Return the fit of attitudes, from the truth on."""
    exact = MOTION.at(times).orientation
    noisy = exact + SIGMA * Numbers(seed).normals(*exact.shape)
    model = Model(make_record(times, noisy, "attitude"), np.asarray(MOTION.start.orientation))
    return refine(model, fill(model, name_parameters(MOTION)))


@pytest.mark.slow
def test_a_long_record_shows_its_period_although_straight_steps_leave_the_valley():
    fit = fit_from_truth(np.arange(8192) / 32, 1)
    valley = Valley(fit)
    assert valley.is_left.any()
    assert not valley.is_curved.any()
    values = {each.name: each for each in list_values(fit)}
    for name, truth in {
        "Mgl/Ix": 100.0,
        "Iz/Ix": 0.5,
        "nutation_period": MOTION.nutation_period,
        "mean_precession_rate": MOTION.mean_precession_rate,
    }.items():
        assert values[name].is_known
        # a normal number is farther than five deviations once in two million
        assert abs(values[name].value - truth) < 5 * values[name].deviation


@pytest.mark.slow
def test_the_floor_of_a_valley_is_where_the_squares_grow_as_they_should():
    valley = Valley(fit_from_truth(np.arange(8192) / 32, 2))
    own = valley.fit.white
    for k, ends in valley.floors.items():
        straight = valley.fit.x + 3 * valley.steps[k]
        floor, higher = (
            float((valley.fit.noise.whiten(valley.fit.model.find_residuals(x)) ** 2).sum())
            - float((own**2).sum())
            for x in (ends[0], straight)
        )
        # three deviations away: nine, and within a factor of two if a deviation is to hold
        assert 4.5 < floor < 18 < higher


def test_a_valley_that_leads_to_no_motion_makes_a_number_doubtful():
    valley = Valley(fit_from_truth(np.arange(8192) / 32, 1))
    assert valley.floors

    def ask(x):
        if not np.array_equal(x, valley.fit.x):
            raise ValueError
        return 0.0

    assert not valley.is_straight(np.ones(len(valley.fit.x)), ask)
