"""The scorer: errors that are known, and files that are no trajectory."""

import math

import numpy as np
import pytest

from symtop_ros.arrays import compose
from symtop_ros.testset.score import main, read_problems, read_trajectory

CUSPS = read_problems()["cusps"]
EXACT = np.array([[float(c) for c in q] for q in CUSPS.facts["orientations"]])


def test_an_error_is_an_angle_whatever_the_sign_and_the_norm():
    angle = 1e-3
    turn = [math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)]  # about the vertical
    score = CUSPS.score(-1.001 * compose(turn, EXACT))
    # 2 |q - q_exact| is 4 sin(angle/4): below the angle by angle^3/96
    assert score.angles == pytest.approx(np.full(20, angle), rel=1e-7)
    least, of_floats = (min(CUSPS.facts[f"orientation_limits{end}"]) for end in ("", "_float32"))
    assert score.in_limits.max() == pytest.approx(angle / least, rel=1e-6)
    assert score.in_float32_limits.max() == pytest.approx(angle / of_floats, rel=1e-6)
    assert score.rates is None


NO_STATES = [
    (EXACT[:5], None, "orientations must be of shape \\(20, 4\\), got \\(5, 4\\)"),
    (EXACT * 1.1, None, "orientations must be unit quaternions, got a norm of 1.1"),
    (EXACT * np.nan, None, "orientations must be finite numbers up to 1e\\+100, got nan"),
    (EXACT, EXACT, "angular_velocities must be of shape \\(20, 3\\)"),
]


@pytest.mark.parametrize(("orientations", "rates", "reason"), NO_STATES)
def test_states_that_cannot_be_scored_are_refused(orientations, rates, reason):
    with pytest.raises(ValueError, match=reason):
        CUSPS.score(orientations, rates)


NO_TRAJECTORIES = [
    ("a,b\n1,2\n", "must have the columns t, w, x, y, z, got the header a,b"),
    ("t,w,x,y,z\n0.5,1,0,0,0\n", "a state at each time, got none at 1 s; the nearest is 0.5 s"),
    ("t,w,x,y,z\n0.5,1,0,0\n", "line 2 must have all columns"),
    ("t,w,x,y,z\none,1,0,0,0\n", "line 2 must consist of numbers"),
    ("t,w,x,y,z\nnan,1,0,0,0\n", "got none at 0.5 s; there is no row"),
]


@pytest.mark.parametrize(("text", "reason"), NO_TRAJECTORIES)
def test_a_file_that_is_no_trajectory_is_refused_in_a_line(text, reason, tmp_path, capsys):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=reason):
        read_trajectory(path, CUSPS)
    assert main(["cusps", str(path)]) == 1
    assert capsys.readouterr().err.count("\n") == 1


def test_other_refusals_are_a_line(capsys, tmp_path):
    for arguments, reason in (
        (["none"], "problem must be one of gentle_cusps, "),
        (["tops.turned"], "problem must be one of gentle_cusps, "),
        (["cusps.bent"], "description must be one of turned, offset, nested, nested_half, got b"),
        (["cusps."], "description must be one of turned, offset, nested, nested_half, got \n"),
        (["cusps"], "trajectory must be a CSV file for cusps, got none"),
        (["cusps", str(tmp_path / "no.csv")], f"{tmp_path / 'no.csv'}: No such file"),
    ):
        assert main(arguments) == 1
        assert capsys.readouterr().err.startswith(reason)
    assert main([]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 71
