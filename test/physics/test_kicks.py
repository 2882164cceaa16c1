import math

import numpy as np
import pytest
from drawn import Numbers
from mpmath import mp, mpf
from physics.tops import ARTICLE, EPS

from symtop_ros.physics import (
    State,
    Top,
    apply_impulse,
    hurry,
    push_axle,
    regular_precession_rates,
    set_precession_rate,
)

START = State.from_euler(theta=0.5, phi=0.3, psi=1.2, theta_dot=2.0, phi_dot=6.5, psi_dot=200.0)
ROUNDING = 8 * EPS * 210.0  # of the largest rate, rad/s


@pytest.mark.parametrize(("hold", "lost"), [("spin_rate", 0.0), ("spin_momentum", 2.6)])
def test_a_change_of_rate_holds_theta_dot_and_the_spin_rate_or_axial_momentum(hold, lost):
    after = hurry(START, 1.4, hold)
    assert after.orientation.tolist() == START.orientation.tolist()  # bit for bit
    if hold == "spin_momentum":
        assert ARTICLE.axial_momentum(after) == ARTICLE.axial_momentum(START)
    rates = after.euler_rates
    assert rates.phi_dot == pytest.approx(9.1, abs=4 * ROUNDING)  # 1/sin(theta) of rounding
    assert rates.theta_dot == pytest.approx(2.0, abs=ROUNDING)
    assert rates.psi_dot == pytest.approx(200.0 - lost * math.cos(0.5), abs=4 * ROUNDING)


J = np.array([1e-4, -2e-3, 5e-4])
TURN, TILT = 0.3, 0.5  # phi and theta of the start
UP = [-math.cos(TILT) * math.sin(TURN), math.cos(TILT) * math.cos(TURN), math.sin(TILT)]


KICKED = [
    (apply_impulse(ARTICLE, START, J), J),
    # across the axle, in its vertical plane
    (push_axle(ARTICLE, START, 1e-4), 1e-4 * np.array(UP)),
]


@pytest.mark.parametrize(("after", "J"), KICKED)
def test_an_impulse_or_a_push_on_the_axle_adds_to_the_angular_momentum_in_the_world(after, J):
    assert after.orientation.tolist() == START.orientation.tolist()  # bit for bit
    before = ARTICLE.angular_momentum(START)
    gained = ARTICLE.angular_momentum(after) - before
    assert np.abs(gained - J).max() <= 16 * EPS * np.abs(before).max()


def test_a_push_on_the_axle_holds_the_axial_momentum_bit_for_bit():
    after = push_axle(ARTICLE, START, 1e-4)
    assert ARTICLE.axial_momentum(after) == ARTICLE.axial_momentum(START)


def test_a_push_at_the_smallest_tilt_has_its_whole_size():
    start = State.from_euler(theta=1e-90, psi_dot=200.0)
    after = push_axle(ARTICLE, start, ARTICLE.Ix)
    assert np.hypot(*after.angular_velocity[:2]) == pytest.approx(1.0, rel=8 * EPS)


@pytest.mark.parametrize("hold", ["spin_rate", "spin_momentum"])
def test_a_new_rate_is_met_as_closely_as_omega_has_it(hold):
    rng = Numbers(9)
    for _ in range(200):
        theta = rng.power(-9, 0)
        theta_dot = rng.choice((0.0, rng.power(-3, 3)))
        angles = {"theta": theta, "phi": rng.uniform(-3, 3), "psi": rng.uniform(-3, 3)}
        before = State.from_euler(**angles, theta_dot=theta_dot, psi_dot=200.0)
        kicked = set_precession_rate(before, 1e6, hold)
        largest = max(math.hypot(*each.angular_velocity.tolist()) for each in (before, kicked))
        # 15 eps of the kick, and 12 of the rate that is read
        assert abs(kicked.euler_rates.phi_dot - 1e6) <= 27 * EPS * largest / math.sin(theta)


@pytest.mark.parametrize("hold", ["spin_rate", "spin_momentum"])
def test_a_kick_that_ends_the_precession_leaves_no_rounding_of_it(hold):
    rng = Numbers("an end")
    for _ in range(200):
        angles = {"phi": rng.uniform(-3, 3), "theta": rng.uniform(0.01, 3.13)}
        tilting, rate = rng.choice([0.0, 1.0]), rng.power(-2, 5)
        start = State.from_euler(**angles, psi=1.2, theta_dot=tilting, phi_dot=rate)
        ended = set_precession_rate(start, 0.0, hold)
        # What is left belongs to theta', to rounding of it, however fast the precession was.
        assert abs(ended.euler_rates.phi_dot) * math.sin(angles["theta"]) <= 8 * EPS * tilting
        if hold == "spin_rate":  # psi' was 0, and stays so
            assert ended.angular_velocity[2] == 0.0 or tilting


def test_a_kick_at_the_smallest_tilt_needs_no_division():
    start = State.from_euler(theta=1e-12, psi_dot=200.0)
    after = set_precession_rate(start, 9.0)
    assert after.euler_rates.phi_dot == pytest.approx(9.0, rel=8 * EPS)


@pytest.mark.parametrize("q", [(1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)])
def test_on_the_vertical_an_impulse_is_not_refused(q):
    start = State(q, (0.0, 0.0, 200.0))
    assert apply_impulse(ARTICLE, start, [1e-4, 0.0, 0.0]).angular_velocity[2] == 200.0


@pytest.mark.parametrize("psi_dot", [-1e9, -200.0, 150.0, 1e5, 1e9])
@pytest.mark.parametrize("theta", [0.1, 0.5, 2.0, 3.0])
@pytest.mark.parametrize("Mgl", [0.068, -0.068])
def test_a_root_is_a_root_to_rounding(psi_dot, theta, Mgl):
    top = Top(0.000228, 0.0000572, Mgl)
    for root in regular_precession_rates(top, theta=theta, psi_dot=psi_dot):
        a = (top.Ix - top.Iz) * math.cos(theta)
        b = top.Iz * psi_dot
        terms = abs(a) * root**2 + abs(b * root) + abs(Mgl)
        assert abs(a * root**2 - b * root + Mgl) <= 8 * EPS * terms


def test_degenerate_cases_have_one_root_or_none():
    sphere = Top(0.001, 0.001, 0.05)
    slow, fast = regular_precession_rates(sphere, theta=0.5, psi_dot=100.0)
    assert slow == 0.05 / (0.001 * 100.0)
    assert math.isnan(fast)
    assert np.isnan(regular_precession_rates(sphere, theta=0.5, psi_dot=0.0)).all()
    assert np.isnan(regular_precession_rates(ARTICLE, theta=0.5, psi_dot=50.0)).all()
    weightless = Top(0.001, 0.0005, 0.0)
    slow, fast = regular_precession_rates(weightless, theta=0.5, psi_dot=10.0)
    assert slow == 0.0
    assert fast == pytest.approx(10.0 * 0.0005 / (0.0005 * math.cos(0.5)))


@pytest.mark.parametrize("theta", [math.pi / 2, -math.pi / 2, math.pi / 2 + 2e-16])
def test_an_axis_horizontal_to_rounding_has_the_slow_rate_alone(theta):
    slow, fast = regular_precession_rates(ARTICLE, theta=theta, psi_dot=200.0)
    assert math.isnan(fast)
    assert slow == pytest.approx(0.068 / (5.72e-05 * 200.0), rel=2 * EPS)


@pytest.mark.parametrize("steps", range(-4, 5))
@pytest.mark.parametrize("theta", [0.0, 0.5, 1.4, 1.5707])
def test_merging_roots_are_those_of_the_exact_quadratic(steps, theta):
    with mp.workdps(60):
        Ix, Iz, Mgl = map(mpf, ARTICLE.moments)
        a = (Ix - Iz) * mp.cos(theta)
        psi_dot = float(2 * mp.sqrt(a * Mgl) / Iz)  # within half an ulp of merging
        for _ in range(abs(steps)):
            psi_dot = math.nextafter(psi_dot, math.copysign(math.inf, steps))
        half = Iz * mpf(psi_dot) / 2
        discriminant = half**2 - a * Mgl
        found = regular_precession_rates(ARTICLE, theta=theta, psi_dot=psi_dot)
        assert np.isfinite(found).tolist() == [discriminant >= 0] * 2
        if discriminant >= 0:
            roots = ((half + sign * mp.sqrt(discriminant)) / a for sign in (-1, 1))
            assert found == tuple(map(float, roots))


def test_a_tilt_may_be_of_many_turns():
    assert np.isfinite(regular_precession_rates(ARTICLE, theta=1e15, psi_dot=200.0)).all()


def test_a_spin_of_minus_zero_is_no_spin():
    top = Top(2.28e-4, 5.72e-5, -0.068)
    found = [regular_precession_rates(top, theta=0.5, psi_dot=spin) for spin in (0.0, -0.0)]
    assert found[0] == found[1] == (-found[0][1], found[0][1])
