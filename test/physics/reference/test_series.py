"""The closed form and the Taylor series, which share no formula, have the same digits."""

import pytest
from mpmath import mp, mpf
from physics.taylor_families import FAMILIES, make_case
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics.reference import ClosedForm, Inputs, Series
from workshop.testset.exact import distance


@pytest.mark.parametrize("family", FAMILIES)
def test_both_have_forty_digits_of_each_family(family):
    case = make_case(family, 2)
    exact, series = ClosedForm(case.inputs, 60), Series(case.inputs, case.digits)
    t = case.times[0]  # of less than a period
    (q, omega), (other_q, other_omega) = exact.at(t), series.at(t)
    with mp.workdps(60):
        assert distance(q, other_q) < mpf(10) ** -40
        rates = zip(omega, other_omega, strict=True)
        assert mp.norm([a - b for a, b in rates]) <= mpf(10) ** -40 * mp.norm(omega)


@pytest.mark.parametrize("periods", [1.4, -3.7, 1e9 + 0.2])
def test_one_period_serves_for_all_times(periods):
    inputs = Inputs.of(ARTICLE, CUSPS)
    exact = ClosedForm(inputs, 60)
    t = periods * float(exact.period)
    with mp.workdps(60):
        found = Series(inputs, 50, period=exact.period).at(t)
        assert distance(found.orientation, exact.at(t).orientation) < mpf(10) ** -38


def test_a_period_after_which_the_height_does_not_return_is_refused():
    with pytest.raises(ValueError, match=r"the height must return after 0\.15 s"):
        Series(Inputs.of(ARTICLE, CUSPS), 30, period=0.15).at(1.0)


def test_times_before_the_start_are_integrated_back():
    inputs = Inputs.of(ARTICLE, CUSPS)
    exact = ClosedForm(inputs, 60).at(-0.3)
    assert distance(Series(inputs, 40).at(-0.3).orientation, exact.orientation) < 1e-15
