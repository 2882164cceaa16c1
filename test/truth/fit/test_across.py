"""Rates across the axis alone: motions of other tops that show the same, and their constants."""

import numpy as np
import pytest
from truth.fit.cases import CUSPS

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit.across import Across, measure_across

HANGING = Motion(Top(2.0, 0.5, -40.0), State.from_euler(theta=1.25, phi_dot=-2.0, psi_dot=30.0))
FLAT = Motion(Top(1.0, 1.75, 90.0), State.from_euler(theta=0.75, theta_dot=1.5, psi_dot=-40.0))
WEIGHTLESS = Motion(Top(1.0, 0.25, 0.0), State.from_euler(theta=0.5, phi_dot=3.0, psi_dot=20.0))
TIMES = np.arange(200) / 128
RATIOS = 0.0625, 0.5, 1.0, 1.5, 1.9375


@pytest.mark.parametrize("motion", [CUSPS, HANGING, FLAT, WEIGHTLESS])
@pytest.mark.parametrize("ratio", RATIOS)
def test_a_top_of_any_ratio_shows_the_same_rates_across_the_axis(motion, ratio):
    other = Across.of(motion).find_motion(ratio)
    assert other.top.Iz / other.top.Ix == ratio
    ours, theirs = (each.at(TIMES).angular_velocity[:, :2] for each in (motion, other))
    # The constants of the other motion have the rounding of a start, some eps; it makes phases of
    # wz t in the frame of the body wrong by as many eps of them, and W by as much of itself.
    fastest = max(abs(each.start.angular_velocity[2]) for each in (motion, other))
    weights = [abs(each.top.Mgl / each.top.Ix) ** 0.5 for each in (motion, other)]
    phase = (fastest + max(weights)) * TIMES[-1]
    assert np.abs(ours - theirs).max() < 64 * 2.0**-52 * phase * (1 + np.abs(ours).max())


def test_its_own_ratio_gives_the_motion_back():
    own = Across.of(FLAT).find_motion(1.75)
    assert own.top.Mgl == pytest.approx(90.0, rel=1e-14)
    assert own.start.angular_velocity[2] == pytest.approx(FLAT.start.angular_velocity[2], rel=1e-14)
    assert own.start.vertical[2] == pytest.approx(FLAT.start.vertical[2], rel=1e-13)


def test_constants_are_measured_without_a_derivative():
    """The rule of trapezoids has an error of (rate step)^2/12 of the phases: 0.05 % of 40 rad/s.

    Of the double integral and of W together a few times as much.
    """
    times = np.arange(240) / 512
    x, y = FLAT.at(times).angular_velocity[:, :2].T
    found, true = measure_across(times, x + 1j * y), Across.of(FLAT)
    assert abs(found.k - true.k) < 0.005 * 40
    assert abs(found.w - true.w) < 0.005 * abs(true.w)
