"""Roots of the cubic against mpmath, for tilts of all sizes and roots that nearly meet."""

from decimal import localcontext

import pytest
from mpmath import mp, mpf
from physics.tops import random_case

from symtop_ros.physics.nutation import Start, turning_heights
from symtop_ros.physics.precise import PRECISE


@pytest.mark.parametrize("family", ["any", "fast", "critical", "pendulum"])
@pytest.mark.parametrize("seed", range(20))
def test_roots_are_roots_and_lie_in_order(family, seed):
    case = random_case(seed, family)
    Ix, Iz, Mgl = case.top.moments
    with localcontext(PRECISE):
        start = Start.of((Ix, Iz, abs(Mgl)), *(part.tolist() for part in case.start))
        heights = turning_heights(start)
    assert heights.s1 <= 0 <= heights.s2 <= heights.s3
    with mp.workdps(60):
        roots = [mpf(str(root)) for root in (heights.s1, heights.s2, heights.s3)]
        pull, spin, below, above, around, fall, across = (
            mpf(str(getattr(start, name)))
            for name in ("pull", "spin", "below", "above", "around", "fall", "across")
        )
        u = (above - below) / 2
        f0, f1 = fall**2, 2 * spin * around - 2 * u * across - pull * above * below
        f2 = 2 * pull * u - across - spin**2
        for s in roots:
            terms = [f0, f1 * s, f2 * s**2, pull * s**3]
            # 50 digits, less the ten that f2 loses to cancellation at 1e-9 from the critical spin
            assert abs(sum(terms)) <= mpf("1e-39") * sum(map(abs, terms))


def test_the_top_of_the_separatrix_is_one_double_root():
    with localcontext(PRECISE):
        start = Start.of((1.0, 0.5, 1.0), (0.0, 1.0, 0.0, 0.0), (2.0, 0.0, 0.0))
        heights = turning_heights(start)
    assert heights.s2 == heights.s3 == 2
    assert heights.s32 == 0
