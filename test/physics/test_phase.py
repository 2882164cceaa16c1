from decimal import Decimal

import numpy as np
import pytest
from mpmath import mp, mpf

from symtop_ros.physics.phase import Phases

RATES = (Decimal("6.49714481615578871234567890123456"), Decimal("-1234567890.123456789012345678"))


@pytest.mark.parametrize("t", [0.0, 1e-9, 0.3, 1.0, 1e6, -1e9, 123456789012.345])
def test_a_phase_is_reduced_without_loss_at_any_time(t):
    reduced = Phases(*RATES).at(np.array([t]))[:, 0]
    with mp.workdps(60):
        for rate, phase in zip(RATES, reduced, strict=True):
            whole = mpf(str(rate)) * mpf(t)
            off = (whole - mpf(float(phase))) / (2 * mp.pi)
            # two roundings of up to half a turn; the rate itself is held to 32 digits
            assert abs(off - mp.nint(off)) <= 3e-16 + 1e-31 * abs(whole)
    assert (abs(reduced) <= np.pi).all()


def test_times_beyond_all_digits_still_give_a_phase():
    assert np.isfinite(Phases(*RATES).at(np.array([1.7e308, -1.7e308]))).all()
