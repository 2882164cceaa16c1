"""The Taylor series at any time (test_exact_motions.py compares it with the closed form)."""

import pytest
from mpmath import mp, mpf
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics.reference import ClosedForm, Inputs, Series
from workshop.testset.exact import ReturningSeries, distance


@pytest.mark.parametrize("periods", [1.4, -3.7, 1e9 + 0.2])
def test_one_period_serves_for_all_times(periods):
    inputs = Inputs.of(ARTICLE, CUSPS)
    exact = ClosedForm(inputs, 60)
    t = periods * float(exact.period)
    with mp.workdps(60):
        found = ReturningSeries(inputs, 50, exact.period).at(t)
        assert distance(found.orientation, exact.at(t).orientation) < mpf(10) ** -38


def test_a_period_after_which_the_height_does_not_return_is_refused():
    with pytest.raises(ValueError, match=r"the height must return after 0\.15 s"):
        ReturningSeries(Inputs.of(ARTICLE, CUSPS), 30, 0.15).at(1.0)


def test_times_before_the_start_are_integrated_back():
    inputs = Inputs.of(ARTICLE, CUSPS)
    exact = ClosedForm(inputs, 60).at(-0.3)
    assert distance(Series(inputs, 40).at(-0.3).orientation, exact.orientation) < 1e-15
