"""The closed form and the series in mpmath: their digits are those that are proved."""

import pytest
from flint import ctx
from mpmath import mp, mpf
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics import State, Top
from symtop_ros.physics.reference import exact_constants, exact_state
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm, ExactState, Series
from workshop.testset.exact import ReturningSeries, distance

pytestmark = pytest.mark.untraced
MANY = 250


def assert_same(found, q, omega, digits):
    """Assert a quaternion, and rates relative to their size, to so many digits."""
    with mp.workdps(2 * digits):
        q, omega = ([mpf(each) for each in part] for part in (q, omega))
        rates = zip(found.angular_velocity, omega, strict=True)
        assert distance(found.orientation, q) < mpf(10) ** -digits
        assert mp.norm([a - b for a, b in rates]) <= mpf(10) ** -digits * mp.norm(omega)


def to_mpmath(balls):
    """Middles of balls as numbers of mpmath."""
    with mp.workdps(MANY), ctx.workdps(MANY):
        return tuple(mpf(each.mid().str(MANY, radius=False)) for each in balls)


def prove(t, digits):
    """A proved state as one of mpmath."""
    found = exact_state(ARTICLE, CUSPS, t, digits)
    return ExactState(to_mpmath(found.orientation), to_mpmath(found.angular_velocity))


@pytest.mark.parametrize("t", [1.0, -0.3, 1e20])
def test_the_closed_form_has_the_digits_that_are_proved(t):
    assert_same(ClosedForm(Inputs.of(ARTICLE, CUSPS), 100).at(t), *prove(t, 90), 60)


@pytest.mark.parametrize("t", [0.5, -0.3])
def test_the_series_has_the_digits_that_are_proved(t):
    assert_same(Series(Inputs.of(ARTICLE, CUSPS), 60).at(t), *prove(t, 60), 40)


def test_periods_and_mean_rates_have_the_digits_that_are_proved():
    for top in (ARTICLE, Top(ARTICLE.Ix, ARTICLE.Iz, -0.068)):
        start = State.from_euler(theta=0.7, phi=0.2, theta_dot=3.0, phi_dot=9.0, psi_dot=170.0)
        motion = ClosedForm(Inputs.of(top, start), 60)
        exact = exact_constants(top, start)
        with mp.workdps(60):
            found = motion.period, *motion.mean_rates
            pairs = zip(found, to_mpmath((exact.period, *exact.mean_rates)), strict=True)
            assert all(abs(a - b) < mpf(10) ** -48 * abs(b) for a, b in pairs)


def test_the_mean_rates_are_those_of_a_nutation():
    for top in (ARTICLE, Top(ARTICLE.Ix, ARTICLE.Iz, -0.068)):
        start = State.from_euler(theta=0.7, phi=0.2, theta_dot=3.0, phi_dot=9.0, psi_dot=170.0)
        motion = ClosedForm(Inputs.of(top, start), 40)
        with mp.workdps(40):
            phases = []
            for t in (0, motion.period):
                w, x, y, z = motion.at(t).orientation
                plus, minus = mp.atan2(z, w), mp.atan2(y, x)
                phases.append((plus + minus, plus - minus))
            for first, last, rate in zip(*phases, motion.mean_rates, strict=True):
                turns = (last - first - rate * motion.period) / (2 * mp.pi)
                assert abs(turns - mp.nint(turns)) < mpf(10) ** -35
                assert abs(rate) > 1  # rad/s


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
