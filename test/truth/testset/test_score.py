"""The scorer: errors that are known, and files that are no trajectory."""

import math

import numpy as np
import pytest
from trials import choose
from truth.testset.trajectories import NAMES, make_table, read_exact, write

from symtop_ros.base.arrays import compose
from symtop_ros.physics import State
from symtop_ros.truth.testset.score import (
    describe_start,
    find_problem,
    main,
    read_problems,
    read_trajectory,
)

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
    (EXACT * 1e300, None, "orientations must be finite numbers up to 1e\\+100, got"),
    (EXACT * 0.0, None, "orientations must be unit quaternions, got a norm of 0"),
    (EXACT, np.full((20, 3), -1e200), "angular_velocities must be finite numbers up to"),
]


@pytest.mark.parametrize(("orientations", "rates", "reason"), NO_STATES)
def test_states_that_cannot_be_scored_are_refused(orientations, rates, reason):
    with pytest.raises(ValueError, match=reason):
        CUSPS.score(orientations, rates)


def make_tables():
    """One trajectory in all forms that are read, and the same states in each."""
    good = make_table("cusps", 1e-7)
    text = write(good)
    lines = text.splitlines()
    more = ["a," + lines[0], *(f"x,{row}" for row in [*lines[1:], "0.1" + ",1" * 7])]
    world = np.column_stack((good[:, :5], State(good[:, 1:5], good[:, 5:]).to_world(good[:, 5:])))
    return {
        "commas": text,
        "bom": "\ufeff" + text,
        "semicolons": write(good, separator=";"),
        "tabs": write(good, separator="\t"),
        "spaces": write(good, separator="  "),
        "hash": "# " + write(good, separator=" "),
        "comments": "# engine: mine 1.0\n#\n# " + write(good, separator=" "),
        "quotes": text.replace("t,w", '"t","w"'),
        "blank lines and carriage returns": "\r\n\r\n".join(lines),
        "other columns and rows": "\n".join(more),
        "times that have added up": write(good * [1 + 5e-10, *[1.0] * 7]),
        "norms of 1.005": write(good * [1, *[1.005] * 4, 1, 1, 1]),
        "of one sign": write(good * [1, *[-1.0] * 4, 1, 1, 1]),
        "infinite time": text + "inf" + ",1" * 7 + "\n",
        "world rates": write(world, (*NAMES[:5], "omega_x", "omega_y", "omega_z")),
        "no rates": write(good[:, :5], NAMES[:5]),
    }


TABLES = make_tables()


@pytest.mark.parametrize("kind", TABLES)
def test_a_table_is_read_in_every_form(kind, tmp_path):
    good = make_table("cusps", 1e-7)
    path = tmp_path / "trajectory.csv"
    path.write_text(TABLES[kind], encoding="utf-8")
    wanted = CUSPS.score(good[:, 1:5], good[:, 5:])
    found = CUSPS.score(*read_trajectory(path, CUSPS))
    # a quaternion is divided by its norm: products and quotients of a few eps
    assert found.angles == pytest.approx(wanted.angles, abs=8 * np.finfo(float).eps)
    if kind == "no rates":
        assert found.rates is None
    else:  # rates of 200 rad/s, turned by a matrix of these quaternions and back
        assert found.rates == pytest.approx(wanted.rates, abs=200 * 16 * np.finfo(float).eps)


def test_a_score_says_how_large_errors_are_and_nothing_of_causes():
    _, q, omega = read_exact("cusps")
    for rates in (np.degrees(omega), omega * 1e6):
        assert CUSPS.score(q[:, [1, 2, 3, 0]], rates).format().count("\n") == 0


NO_TRAJECTORIES = [
    ("a,b\n1,2\n", "must have the columns t, w, x, y, z, got the header a,b"),
    (
        "t,w,x,y,z\n0.5,1,0,0,0\n",
        "state at each time of the problem, got none at 1 s; the nearest is 0.5 s",
    ),
    ("t,w,x,y,z\n0.5,1,0,0\n", "line 2 must have all columns"),
    ("t,w,x,y,z\none,1,0,0,0\n", "line 2 must consist of numbers"),
    ("t,w,x,y,z\nnan,1,0,0,0\n", "got none at 0.5 s; there is no row"),
    ("t,w,x,y,z\n0x1p-1,1,0,0,0\n", "line 2 must consist of numbers"),
    ("t,w,x,y,z\n0.5,1_0,0,0,0\n", "line 2 must consist of numbers"),
    ("\x00\x01\u00e9\u0416", "must have the columns t, w, x, y, z, got the header"),
    ("", "got the header nothing"),
    ("# engine: mine\n", "got the header nothing"),
    ("# engine: mine\nt,w,x,y,z\n0.5,1,0,0\n", "line 3 must have all columns"),
]


@pytest.mark.parametrize(("text", "reason"), NO_TRAJECTORIES)
def test_a_file_that_is_no_trajectory_is_refused_in_a_line(text, reason, tmp_path, capsys):
    path = tmp_path / "bad.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=reason):
        read_trajectory(path, CUSPS)
    assert main(["cusps", str(path)]) == 1
    assert capsys.readouterr().err.count("\n") == 1


def test_other_refusals_are_a_line(capsys, tmp_path):
    for arguments, reason in (
        (["none"], "problem must be one of gentle_cusps, "),
        (["tops.turned"], "problem must be one of gentle_cusps, "),
        (
            ["looping.bent"],
            "description must be one of turned, inertial, offset, nested, nested_half, got b",
        ),
        (
            ["looping."],
            "description must be one of turned, inertial, offset, nested, nested_half, got \n",
        ),
        (["cusps"], "trajectory must be a CSV file for cusps, got none"),
        (["cusps", str(tmp_path / "no.csv")], f"{tmp_path / 'no.csv'}: No such file"),
    ):
        assert main(arguments) == 1
        assert capsys.readouterr().err.startswith(reason)
    assert main([]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 71


def rotate(q, v):
    """R v of a unit quaternion, in vectors."""
    w = q[0]
    u = q[1:]
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


def mistake_starts(facts):
    """Wrong starts of a problem: the words, an attitude, and rates."""
    q, omega = np.array(facts["orientation"]), np.array(facts["angular_velocity"])
    unit = q / np.linalg.norm(q)
    w, x, y, z = q
    back = unit * [1, -1, -1, -1]
    yield "attitude is the conjugate", q * [1, -1, -1, -1], omega
    yield "read as x, y, z, w", np.array([z, w, x, y]), omega
    yield "read as w, x, y, z", np.array([x, y, z, w]), omega
    yield "that of the world frame", q, rotate(unit, omega)
    yield "taken for those of the world", q, rotate(back, omega)
    yield "in deg/s", q, omega * 180 / math.pi
    yield "taken for deg/s", -q, omega * math.pi / 180


@pytest.mark.parametrize("step", choose((5, 1), (5,)))  # of the problems that are tried
@pytest.mark.parametrize("description", ["", ".turned"])
def test_a_start_that_was_read_wrongly_is_named_and_a_right_one_never(description, step):
    named = 0
    changed = 0
    rng = np.random.default_rng(3)
    for name in [*read_problems()][::step]:
        problem = find_problem(read_problems(), name + description)
        q, omega = (np.array(problem.facts[k]) for k in ("orientation", "angular_velocity"))
        assert describe_start(problem, -q, omega) == ""
        assert (
            describe_start(problem, *(np.float32(each).astype(float) for each in (q, omega))) == ""
        )
        assert describe_start(problem, np.full(4, np.nan), np.full(3, np.nan)) == ""
        unit = q / np.linalg.norm(q)
        size = np.linalg.norm(omega)
        for words, attitude, rates in mistake_starts(problem.facts):
            ends = attitude / np.linalg.norm(attitude)
            turned = min(np.linalg.norm(ends - sign * unit) for sign in (1, -1))
            if turned < 1e-3 and np.linalg.norm(rates - omega) <= 1e-3 * size:
                continue  # the mistake changes nothing in this problem
            text = describe_start(problem, attitude, rates)
            changed += 1
            named += words in text
            assert text, (name, words)
        noisy = q + 0.1 * rng.normal(size=4)
        assert describe_start(problem, noisy, None).startswith("its attitude is off by ")
    # of two mistakes that make the same of a start none is named
    assert named >= 0.9 * changed


def test_the_row_at_the_start_is_told_with_the_score(tmp_path, capsys):
    path = tmp_path / "mine.csv"
    rows = make_table("heavy_top")
    problem = read_problems()["heavy_top"].facts
    q = problem["orientation"]
    omega = np.array(problem["angular_velocity"])
    start = np.array([[0.0, *q, *rotate(np.array(q) / np.linalg.norm(q), omega)]])
    path.write_text(write(np.concatenate([start, rows])))
    assert main(["heavy_top", str(path)]) == 0
    told = "the row at t = 0 is not the start: its angular velocity is that of the world frame\n"
    assert capsys.readouterr().out.splitlines(keepends=True)[0].endswith(told)
