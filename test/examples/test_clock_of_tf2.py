"""The example with tf2's rule: what is interpolated is not late, the latest transform is."""

import numpy as np
import pytest

from examples.clock_of_tf2 import SECOND, TRUTH, look_up
from symtop_ros.truth.judge.clock import measure_clock
from symtop_ros.truth.judge.compare import compare

TIMES = np.sort(np.random.default_rng(5).integers(SECOND, 5 * SECOND, 2000))


@pytest.mark.parametrize("rate", [200, 1000])
def test_interpolation_is_not_late_and_the_latest_transform_is_by_half_a_period(rate):
    interpolated, latest = (measure_clock(each, TRUTH, "tf") for each in look_up(rate, TIMES))
    # errors of interpolation follow the motion: no deviation; the bound is a thousandth of a period
    assert interpolated.delay_deviation is None
    assert abs(interpolated.delay) < 1e3 / rate
    assert interpolated.kind == "none"
    # evenly between nothing and a period, at 2000 times: the mean is known to 1.3 %
    assert latest.delay == pytest.approx(5e5 / rate, rel=0.1)
    assert latest.jitter == pytest.approx(1e6 / rate / 12**0.5, rel=0.1)


def test_the_error_falls_with_the_square_of_the_rate():
    errors = [compare(look_up(rate, TIMES)[0], TRUTH).total.max() for rate in (200, 400)]
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)
