"""Mean phi' and psi' keep their digits, however much of their terms cancels."""

import random
from decimal import Decimal, localcontext

import pytest
from physics.tops import EPS, random_case, seeds

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics.exact.closed_form import ClosedFormMotion
from symtop_ros.physics.exact.mean_rates import _compute_terms
from symtop_ros.physics.exact.precise import PRECISE

WEIGHTS = [10.0**-n for n in (20, 30, 35, 40, 50, 100, 150, 190)]
OMEGA = (1.0, 2.0, -0.5)


@pytest.mark.parametrize("weight", WEIGHTS)
def test_the_mean_spin_of_a_sphere_is_proportional_to_a_weak_weight(weight):
    q = State((0.8, 0.36, -0.24, 0.416), OMEGA).orientation
    rate = Motion(Top(1, 1, weight), State(q, OMEGA)).mean_spin_rate
    assert rate / weight == pytest.approx(0.21389419546691283, rel=4 * EPS)  # by 110 digits


def random_weak_motion(rng):
    ratio = rng.choice([1.0, 1.0 + 1e-15, rng.uniform(0.1, 2.0), 10 ** rng.uniform(-20, 0)])
    q = [rng.gauss(0, 1) for _ in range(4)]
    norm = sum(c * c for c in q) ** 0.5
    omega = [rng.choice([0.0, 1.0, -2.0, rng.gauss(0, 3)]) for _ in range(3)]
    orientation = tuple(c / norm for c in q)
    return (1.0, ratio, 10 ** rng.uniform(-60, 2)), orientation, tuple(omega)


def assert_rates_have_all_digits(moments, orientation, omega):
    motion = ClosedFormMotion(moments, orientation, omega)
    with localcontext(PRECISE) as context:
        context.prec = 300
        a, b, c = _compute_terms(moments, orientation, omega)
        for rate, exact in zip(motion.mean_rates, (a + b, a - b + c), strict=True):
            assert abs(Decimal(rate) - exact) <= abs(exact) * Decimal(EPS) or abs(exact) < 1e-250


@pytest.mark.parametrize("seed", seeds(10, 100))
def test_mean_rates_of_weak_tops_have_all_digits(seed):
    rng = random.Random(seed)
    for _ in range(100):
        moments, orientation, omega = random_weak_motion(rng)
        if any(omega[:2]):
            assert_rates_have_all_digits(moments, orientation, omega)


@pytest.mark.parametrize("family", ["any", "fast", "critical", "pendulum", "from below"])
def test_mean_rates_of_all_families_have_all_digits(family):
    for seed in range(100):
        case = random_case(seed, family)
        Ix, Iz, Mgl = case.top.moments
        parts = (tuple(part.tolist()) for part in case.start.parts)
        assert_rates_have_all_digits((Ix, Iz, abs(Mgl)), *parts)
