"""Rounding: its step, and what it does to numbers if it follows the motion."""

import numpy as np
import pytest
from drawn import Numbers
from truth.fit.cases import CUSPS, TIMES

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit import make_record
from symtop_ros.truth.fit.model import Model, find_axis, name_parameters
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.starts import fill
from symtop_ros.truth.fit.values import find_slope, list_values
from symtop_ros.truth.residuals.rounding import find_step
from workshop.fit.records import draw_sample
from workshop.fit.trial import fit_from_truth

FAR = 5.0  # deviations; a normal number is farther once in two million
STEP = 2.0**-6
# 400 rows of a third of a turn of the precession, with 130 in a nutation: a number changes by a
# fraction of a step from row to row.
SLOW = Motion(Top(1.0, 0.5, 100.0), State.from_euler(theta=1.0, phi_dot=3.5, psi_dot=60.0))
OFTEN = np.arange(400) / 600


def fit_axis(seen, motion=SLOW, times=OFTEN):
    """Return the fit of points of an axis, from the truth on."""
    model = Model(make_record(times, seen, "axis"), np.asarray(motion.start.orientation))
    return refine(model, fill(model, name_parameters(motion)))


def round_to(values, place):
    """Return values at the nearest step, if one of them is at a place of it."""
    return STEP * (np.round(values / STEP + place) - place)


def measure_white(fit):
    """Return the deviations of white noise."""
    return np.sqrt(np.diag(fit.covariance))


def measure(fit):
    return np.array([fit.find_deviation(row) for row in np.eye(len(fit.x))])


@pytest.mark.parametrize("step", [0.25, 0.01, 1.4, 1e-6])
def test_the_step_is_found_if_no_two_values_are_one_step_apart(step):
    whole = np.array([0, 2, 5, 11, 14, 40, 2, 0, 5, 11, 14, 40])
    assert find_step(step * (whole + 0.5)) == pytest.approx(step, rel=1e-9)


def test_values_that_are_not_rounded_have_no_step():
    assert find_step(np.array(Numbers(3).normals(100))) == 0.0


def test_a_column_that_does_not_change_has_the_step_of_the_others():
    rates = CUSPS.at(TIMES).angular_velocity
    record = make_record(TIMES, 0.25 * np.round(rates / 0.25), "rates")
    assert np.ptp(record.values[:, 2]) == 0
    assert record.rounding * np.sqrt(12) == pytest.approx([0.25] * 3, rel=1e-12)


@pytest.mark.slow
def test_deviations_hold_wherever_the_steps_of_a_slow_motion_are():
    exact = find_axis(SLOW.at(OFTEN).orientation)
    fits = [fit_axis(round_to(exact, place)) for place in (np.arange(16) + 0.25) / 16]
    truth = fill(fits[0].model, name_parameters(SLOW))
    errors = np.array([fit.x - truth for fit in fits])
    # All three columns at one place of their steps are a part of what the deviations allow for.
    sizes = np.sqrt((errors**2).mean(axis=0))
    stated = np.sqrt(np.mean([measure(fit) ** 2 for fit in fits], axis=0))
    # The mean square of 16 numbers of which a few are independent: within a factor of two.
    assert np.all(sizes < 2 * stated)
    assert np.all(np.abs(errors) < FAR * np.array([measure(fit) for fit in fits]))


def test_rounding_that_follows_a_slow_motion_is_no_white_noise():
    sample = draw_sample("axis", "rounded", 414)  # 21 rows in a nutation of a few steps
    fit = fit_from_truth(sample)
    slope = find_slope(fit, lambda x: fit.model.find_motion(x).nutation_period)
    assert fit.find_deviation(slope) > 2 * np.sqrt(slope @ fit.covariance @ slope)
    values = list_values(fit)
    assert {"Mgl/Ix", "theta", "phi_dot", "nutation_period"} <= {v.name for v in values}
    for value in values:
        assert value.is_known
        assert abs(value.value - sample.truth[value.name]) < FAR * value.deviation


def test_noise_of_a_step_makes_rounding_noise():
    exact = find_axis(SLOW.at(OFTEN).orientation)
    noisy = exact + STEP * Numbers(4).normals(*exact.shape)
    fit = fit_axis(round_to(noisy, 0.25))
    assert not fit._shifts.any()
    # the larger of three estimates of one deviation: that of 400 rows is uncertain by a tenth
    assert measure(fit) == pytest.approx(measure_white(fit), rel=0.3)
