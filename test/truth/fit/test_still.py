"""A rate that is the same in all rows, though others have noise: a sensor at an unknown limit."""

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.truth.fit import fit_motion, make_record
from symtop_ros.truth.fit.check import Check
from symtop_ros.truth.fit.limits import fit_record
from symtop_ros.truth.fit.report import Report
from workshop.records.bodies import Body
from workshop.records.draws import Start

START = Start(Body((1.0, 1.0, 0.5), 120.0), 0.75, 0.5, (0.5, 3.5, 60.0))
TIMES = np.arange(300) / 200


def draw(sigma, wz):
    """Return rates with noise across the axis, and a constant one about it."""
    _, rates = START.follow().at(TIMES)
    seen = rates + sigma * Numbers("still").normals(*rates.shape)
    seen[:, 2] = wz
    return make_record(TIMES, seen, "rates")


def fit(sigma, wz):
    return fit_motion(draw(sigma, wz))


@pytest.mark.slow
def test_a_limit_that_no_list_has_puts_the_model_in_doubt():
    found = fit(0.02, 47.123456)
    assert Check(found).verdict != "holds"
    text = Report("record", len(TIMES), found, {}).write_verdict()
    assert "wz is the same in all rows" in text


@pytest.mark.slow
def test_a_spin_at_such_a_limit_is_left_out():
    found = fit_record(draw(0.02, 47.123456), lambda part: None)
    assert found.model.kind.name == "across"
    assert Check(found).verdict == "holds"
    assert found.model.record.notes[-1].startswith("wz at 47.123 rad/s (2700 deg/s), the limit")
    Ix, _, Iz = START.body.moments
    known = Report("record", len(TIMES), found, {}).unknown
    (constant,) = [each.numbers for each in known if each.kind == "cut"]
    assert abs(constant[0] - (2 - Iz / Ix) * START.rates[2]) < 5 * constant[1]


@pytest.mark.slow
def test_a_constant_spin_without_noise_is_that_of_an_exact_motion():
    """Nothing has noise: what is left is that of the integration."""
    found = fit(0.0, 60.0)
    assert Check(found).still == ()


@pytest.mark.slow
def test_a_spin_that_is_rounded_far_above_the_noise_may_stay():
    found = fit(0.02, 60.0)  # its last decimal is that of whole numbers
    assert Check(found).still == ()
