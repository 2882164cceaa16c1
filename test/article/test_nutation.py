import numpy as np

from symtop_ros.physics import Motion, State, Top
from workshop.article import nutation
from workshop.article.motions import TOP, cusps, regular, seven_motions, start

WEIGHTLESS = Top(TOP.Ix, TOP.Iz, 0.0)


def test_without_weight_the_momentum_does_not_swing():
    nodding = Motion(WEIGHTLESS, start(9.0))
    assert nutation.momentum_swings_with_the_tilt([cusps()]).holds
    assert not nutation.momentum_swings_with_the_tilt([nodding]).holds


def test_only_cusps_stop_the_precession():
    claim = nutation.precession_stops_at_the_cusps
    assert claim(cusps()).holds
    waves = [motion for motion in seven_motions() if motion.kind == "unidirectional"]
    assert [claim(motion).holds for motion in waves] == [False] * 4
    assert not claim(Motion(TOP, start(-8.0))).holds  # loops


def test_the_smallest_tilts_of_cusps_are_one_nutation_period_apart():
    times, period = nutation.times_of_smallest_tilt(cusps()), cusps().nutation_period
    # theta' is known to 1e-14 rad/s, and rises through zero with 300 rad/s^2
    np.testing.assert_allclose(times, period * np.arange(1, len(times) + 1), rtol=0, atol=1e-14)


def test_counted_maxima_leave_out_rounding():
    t = np.linspace(0.0, 10.25, 5000)
    assert nutation.count_maxima(3.0 - np.cos(2 * np.pi * t)) == 10
    assert nutation.count_maxima(3.0 + 1e-14 * np.cos(2 * np.pi * t)) == 0


def test_a_fall_that_is_fastest_at_a_quarter_period_would_be_detected():
    small = Motion(TOP, start(6.4))  # so near to regular precession that theta is a sine
    assert not nutation.fall_is_fastest_at_zero_acceleration(small).holds
    assert nutation.fall_is_fastest_at_zero_acceleration(cusps()).holds


def test_below_the_horizontal_the_spin_grows_as_the_axis_falls():
    falling = Motion(TOP, State.from_euler(theta=2.0, psi_dot=200.0))
    assert not nutation.spin_falls_with_the_axis(falling).holds


def test_the_projection_closes_in_regular_precession_only_and_has_another_gap_for_another_top():
    claim = nutation.momentum_does_not_close
    assert claim(cusps(), regular()).holds
    assert not claim(regular(), regular()).holds
    assert not claim(cusps(), cusps()).holds
    assert not claim(cusps(Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)), regular()).holds


def test_precession_is_fastest_at_the_top_above_the_fast_root():
    assert not nutation.precession_is_fastest_when_lowest(Motion(TOP, start(73.0))).holds
