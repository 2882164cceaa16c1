"""Of motions that fit as well the one that is sampled well comes first."""

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit import fit_motion, make_record
from symtop_ros.truth.fit.report import Report

FAR = 5.0  # deviations; a normal number is farther once in two million


def draw_small_nutation(seed):
    """Return a fast top with a nutation of some milliradians, and times of 6 to 8 rows in each."""
    draw = Numbers(f"small nutation {seed}")
    p, weight, theta = draw.uniform(100, 250), draw.uniform(500, 3000), draw.uniform(0.4, 1.2)
    p *= (-1) ** seed
    turning = weight / p + draw.uniform(0.004, 0.03) * abs(p)
    start = State.from_euler(theta=theta, phi_dot=turning, psi_dot=p - turning * np.cos(theta))
    motion = Motion(Top(1.0, 1.0, weight), start)
    times = np.arange(300) * (motion.nutation_period / draw.uniform(6, 8))
    axes = motion.at(times).to_world([0.0, 0.0, 1.0])
    return motion, make_record(times, axes + 0.003 * draw.normals(*axes.shape), "axis")


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_numbers_are_those_of_the_motion_with_enough_rows_in_a_nutation(seed):
    motion, record = draw_small_nutation(seed)
    report = Report("record", len(record), fit_motion(record), {})
    values = {each.name: each for each in report.values}
    truth = {"Mgl/Ix": motion.top.Mgl, "p_psi/Ix": motion.start.angular_velocity[2]}
    for name, true in truth.items():
        assert values[name].is_known
        assert abs(values[name].value - true) < FAR * values[name].deviation
    said = [each for each in report.unknown if each.kind == "alias"]
    assert {each.kind for each in report.unknown} == {"moments", "spin", "alias"}
    for each in said:
        weight, p, rows = each.numbers
        assert rows <= 2
        # its nutation has a frequency that equal steps cannot tell from that of the motion
        sampling = 2 * np.pi / record.step
        nutation = np.array([2 * np.pi / motion.nutation_period, sampling / rows])
        away = (nutation[1] + nutation[0] * np.array([1, -1])) / sampling
        assert np.abs(away - np.round(away)).min() < 0.02
        assert abs(p) > 2 * abs(truth["p_psi/Ix"])
        assert weight * truth["p_psi/Ix"] * p > 0  # the same precession
