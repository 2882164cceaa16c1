import math

import pytest
from physics.tops import EPS

from symtop_ros.physics import State, Top, motion, regular_precession_rates

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)


def test_the_articles_top_has_the_articles_roots():
    slow, fast = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
    assert round(slow, 2) == 6.50
    assert round(fast, 1) == 69.8


@pytest.mark.parametrize("psi_dot", [-1e9, -200.0, 150.0, 1e5, 1e9])
@pytest.mark.parametrize("theta", [0.1, 0.5, 2.0, 3.0])
@pytest.mark.parametrize("Mgl", [0.068, -0.068])
def test_a_root_is_a_root_to_rounding(psi_dot, theta, Mgl):
    top = Top(0.000228, 0.0000572, Mgl)
    for root in regular_precession_rates(top, theta=theta, psi_dot=psi_dot):
        a, b = (top.Ix - top.Iz) * math.cos(theta), top.Iz * psi_dot
        terms = abs(a) * root**2 + abs(b * root) + abs(Mgl)
        assert abs(a * root**2 - b * root + Mgl) <= 8 * EPS * terms


def test_degenerate_cases_have_one_root_or_none():
    sphere = Top(0.001, 0.001, 0.05)
    assert regular_precession_rates(sphere, theta=0.5, psi_dot=100.0) == (0.05 / (0.001 * 100.0),)
    assert regular_precession_rates(sphere, theta=0.5, psi_dot=0.0) == ()
    assert regular_precession_rates(ARTICLE, theta=0.5, psi_dot=50.0) == ()
    weightless = Top(0.001, 0.0005, 0.0)
    slow, fast = regular_precession_rates(weightless, theta=0.5, psi_dot=10.0)
    assert slow == 0.0
    assert fast == pytest.approx(10.0 * 0.0005 / (0.0005 * math.cos(0.5)))


def test_nearly_horizontal_the_fast_root_goes_to_infinity_and_the_slow_one_stays():
    slow, fast = regular_precession_rates(ARTICLE, theta=math.pi / 2, psi_dot=200.0)
    assert slow == pytest.approx(0.068 / (5.72e-05 * 200.0), rel=8 * EPS)
    assert abs(fast) > 1e15


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_what_is_not_finite_is_refused(bad):
    with pytest.raises(ValueError, match=r"theta: got .*, allowed is a finite number"):
        regular_precession_rates(ARTICLE, theta=bad, psi_dot=200.0)


@pytest.mark.parametrize("which", [0, 1])
def test_a_start_on_a_root_keeps_its_tilt(which):
    rate = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)[which]
    path = motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0, phi_dot=rate))
    assert path.kind == "regular"
    theta = path.at([0.01 * k for k in range(10_000)]).euler_angles.theta
    assert abs(theta - 0.5).max() <= 16 * EPS
    assert path.mean_precession_rate == pytest.approx(rate, rel=16 * 261 / rate * EPS)  # of omega
