"""Lines in what a motion leaves: a body that is not symmetric is no top of this model."""

import re

import numpy as np
import pytest
from drawn import Numbers
from scipy.integrate import solve_ivp
from truth.fit.cases import CUSPS, SIGMA, TIMES, make_noisy, write_table

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit import fit_motion
from symtop_ros.truth.fit.check import HOLDS, Check
from symtop_ros.truth.fit.lines import name_frequencies
from symtop_ros.truth.fit.main import main
from symtop_ros.truth.fit.model import Model, name_parameters
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.starts import fill
from workshop.fit.records import draw_sample
from workshop.fit.trial import fit_from_truth

SPIN, TILT, WEIGHT = 40.0, 0.75, 100.0
TOP = Top(1.0, 0.5, WEIGHT)
START = (1.0, -0.5, SPIN)


def see_body(second, times):
    """Return the rates of a body with the moments 1, `second` and Iz, by Euler's equations."""
    moments = np.array([1.0, second, TOP.Iz])

    def derive(_, state):
        omega, up = state[:3], state[3:]
        torque = WEIGHT * np.cross(up, [0.0, 0.0, 1.0])
        return np.r_[(torque - np.cross(omega, moments * omega)) / moments, -np.cross(omega, up)]

    start = [*START, np.sin(TILT), 0.0, np.cos(TILT)]
    exact = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12}
    return solve_ivp(derive, (0.0, times[-1]), start, t_eval=times, **exact).y[:3].T


def fit_rates(seen):
    """Return the fit of rates next to the symmetric motion."""
    record = make_noisy("rates", seen, 0.02)
    motion = Motion(TOP, State.from_euler(theta=TILT, psi_dot=SPIN))
    model = Model(record, np.asarray(motion.start.orientation))
    return refine(model, fill(model, name_parameters(motion)))


def test_a_symmetric_body_leaves_no_line():
    check = Check(fit_rates(see_body(1.0, TIMES)))
    assert (check.lines, check.verdict) == ((), HOLDS)


def test_a_body_that_is_not_symmetric_leaves_a_line_at_the_spin():
    fit = fit_rates(see_body(1.02, TIMES))
    check = Check(fit)
    assert check.is_white  # an autoregression has taken the line for noise
    assert {line.name for line in check.lines} & {"spin", "twice_spin"}
    assert check.verdict == "fails"


@pytest.mark.slow
def test_the_report_names_the_line_with_its_cause(tmp_path, capsys):
    seen = see_body(1.02, TIMES) + 0.02 * Numbers(3).normals(len(TIMES), 3)
    path = write_table(tmp_path / "body.csv", seen, head="t,wx,wy,wz")
    assert main([str(path)]) == 1
    out = capsys.readouterr().out
    found = re.search(r"w[xy] swings at (\S+) Hz \(the spin: the body is not symmetric", out)
    turns = name_frequencies(fit_rates(see_body(1.02, TIMES)))["spin"]
    assert abs(float(found[1]) - turns) < 1 / TIMES[-1]
    assert "damping" not in out


@pytest.mark.slow
def test_a_line_that_is_none_of_the_motion_is_named_and_the_model_holds(tmp_path, capsys):
    seen = np.asarray(CUSPS.at(TIMES).angular_velocity)
    seen = seen + 0.05 * Numbers(4).normals(*seen.shape)
    seen[:, 1] += 0.1 * np.sin(2 * np.pi * 50.0 * TIMES)  # mains
    path = write_table(tmp_path / "mains.csv", seen, head="t,wx,wy,wz")
    assert main([str(path)]) == 0
    out = capsys.readouterr().out
    assert "holds except for a line in the spectrum of the residuals" in out
    assert re.search(r"; wy swings at (50|50\.\d+|49\.\d+) Hz, with", out)


@pytest.mark.parametrize("kind", ["rates", "axis"])
def test_errors_of_rounding_that_follow_the_motion_are_no_line(kind):
    sample = draw_sample(kind, "rounded", 402)
    assert Check(fit_from_truth(sample)).lines == ()


def test_frequencies_of_the_motion_are_its_own_and_of_an_axis_without_the_spin():
    record = make_noisy("axis", np.asarray(CUSPS.at(TIMES).to_world([0.0, 0.0, 1.0])), SIGMA)
    fit = fit_motion(record)
    found = name_frequencies(fit)
    motion = fit.model.find_motion(fit.x)
    assert found["nutation"] == pytest.approx(1 / motion.nutation_period)
    assert found["twice_precession"] == pytest.approx(abs(motion.mean_precession_rate) / np.pi)
    assert not any("spin" in name for name in found)
