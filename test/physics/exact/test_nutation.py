"""Roots of the cubic against mpmath, for tilts of all sizes and roots that nearly meet."""

from dataclasses import fields

import pytest
from mpmath import mp, mpf
from physics.tops import EPS, random_case

from symtop_ros.physics.exact.nutation import Nutation, find_roots


@pytest.mark.parametrize("family", ["any", "fast", "critical", "pendulum"])
@pytest.mark.parametrize("seed", range(20))
def test_roots_are_roots_and_lie_in_order(family, seed):
    case = random_case(seed, family)
    Ix, Iz, Mgl = case.top.moments
    nutation = Nutation.of((Ix, Iz, abs(Mgl)), *(part.tolist() for part in case.start.parts))
    roots = find_roots(nutation)
    assert roots.s1 <= 0 <= roots.s2 <= roots.s3
    with mp.workdps(60):
        a, beta, below, above, b_minus_au, u_dot, omega_squared, *_ = (
            mpf(str(getattr(nutation, field.name))) for field in fields(nutation)
        )
        u = (above - below) / 2
        f0, f1 = u_dot**2, 2 * a * b_minus_au - 2 * u * omega_squared - beta * above * below
        f2 = 2 * beta * u - omega_squared - a**2
        for s in (mpf(str(root)) for root in (roots.s1, roots.s2, roots.s3)):
            terms = [f0, f1 * s, f2 * s**2, beta * s**3]
            # 50 digits, less the ten that f2 loses to cancellation at 1e-9 from the critical spin
            assert abs(sum(terms)) <= mpf("1e-39") * sum(map(abs, terms))


def test_the_top_of_the_separatrix_is_one_double_root():
    nutation = Nutation.of((1.0, 0.5, 1.0), (0.0, 1.0, 0.0, 0.0), (2.0, 0.0, 0.0))
    roots = find_roots(nutation)
    assert roots.s2 == roots.s3 == 2
    assert roots.s32 == roots.below_pole == roots.above_pole == 0


@pytest.mark.parametrize("small", [1e-8, 1e-15, 1e-60, 1e-95])
def test_distances_from_the_pole_keep_their_digits(small):
    # pushed from the top: omega^2/2 + cos(theta) is 1 + small^2/2
    nutation = Nutation.of((1.0, 0.5, 1.0), (1.0, 0.0, 0.0, 0.0), (small, 0.0, 0.0))
    roots = find_roots(nutation)
    assert roots.below_pole == 0
    assert float(roots.above_pole) == pytest.approx(small**2 / 2, rel=4 * EPS)
    assert roots.s32 == roots.above_pole
