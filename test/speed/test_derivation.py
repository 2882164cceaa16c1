"""docs/closed_form.py, written from docs/derivation.md alone, and the package are the same."""

import math
import runpy
import sys
from pathlib import Path

import pytest
from mpmath import mp, mpf
from programs import execute

from symtop_ros.physics import Motion, State, Top
from workshop.speed.reference import EPS, Reference, read_entries

pytestmark = pytest.mark.untraced
SCRIPT = Path(__file__).parents[2] / "docs" / "closed_form.py"
DERIVED = runpy.run_path(str(SCRIPT))["motion"]
STORED = read_entries()
REFERENCE = Reference.read()
UPSIDE_DOWN = State((0.0, 1.0, 0.0, 0.0), (2.0, 0.0, 0.0))  # rad/s
SPINNING = State.from_euler(theta=1.0, phi_dot=1.0, psi_dot=3.0)
HARD = {
    "a pendulum at rest": (Top(1.0, 0.5, 1.0), State((0.6, 0.8, 0.0, 0.0), (0.0, 0.0, 0.0)), 3.0),
    "a pendulum that just reaches the top": (Top(1.0, 0.5, 1.0), UPSIDE_DOWN, 3.0),
    "a push of 1e-6 off the vertical": (
        *(Top(1.0, 0.5, 1.0), State((1.0, 0.0, 0.0, 0.0), (2.0**-20, 0.0, 1.0)), 70.0),
    ),
    "a hanging weight": (Top(1.0, 0.5, -1.0), SPINNING, 7.0),
    "no weight": (Top(1.0, 0.5, 0.0), SPINNING, 7.0),
    "a sleeping top": (Top(1.0, 0.5, 2.0), State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 3.0)), 7.0),
    "a sphere": (Top(0.5, 0.5, 1.0), SPINNING, 1e6),
}


def derive(top, start, t):
    return DERIVED(*top.moments, start.orientation.tolist(), start.angular_velocity.tolist())(t)


@pytest.mark.parametrize("name", ["a pendulum at rest", "a pendulum that just reaches the top"])
def test_a_pendulum_keeps_the_digits_of_the_computation(name):
    top, start, t = HARD[name]
    found = []
    for digits in (45, 120):
        with mp.workdps(digits):
            found.append(derive(top, start, t))
    for few, many in zip(*found, strict=True):
        # as a difference of roots, a small distance had half of them: 8e-25
        assert mp.norm([x - y for x, y in zip(few, many, strict=True)]) < mpf(10) ** -43


def distance(a, b):
    """Return the distance of two quaternions, of which q and -q are the same attitude."""
    pairs = [(mpf(x), mpf(y)) for x, y in zip(a, b, strict=True)]
    return min(mp.norm([x - sign * y for x, y in pairs]) for sign in (1, -1))


def assert_as_derived(top, start, t, least=0):
    """The package has the attitude to 5 eps, and rates to 5 eps of the largest, as promised."""
    orientation, angular_velocity = derive(top, start, t)
    state = Motion(top, start).at(t)
    assert distance(orientation, state.orientation.tolist()) <= 5 * EPS
    pairs = zip(angular_velocity, state.angular_velocity.tolist(), strict=True)
    size = max(least, mp.norm(angular_velocity))
    assert mp.norm([a - mpf(b) for a, b in pairs]) <= 5 * EPS * size


@pytest.mark.parametrize("data", STORED["article"][:7], ids=lambda data: data["name"])
def test_the_articles_motions_have_the_digits_of_other_methods(data):
    top = Top(data["Ix"], data["Iz"], data["Mgl"])
    start = State(data["orientation"], data["angular_velocity"])
    for t, exact in zip(data["t"], data["exact"], strict=True):
        assert distance(derive(top, start, t)[0], exact) < 1e-24  # 25 digits are stored


@pytest.mark.parametrize("number", range(0, len(STORED["hard"]), 8))
def test_hard_cases_have_the_digits_of_other_methods(number):
    data, problem = STORED["hard"][number], REFERENCE.hard[number]
    (t,) = problem.times
    found, _ = derive(problem.task.top, problem.task.start, t)
    assert distance(found, data["exact"][0]) < 1e-24


@pytest.mark.parametrize("problem", REFERENCE.article[:7], ids=lambda problem: problem.name)
def test_the_package_computes_the_articles_motions_as_derived(problem):
    for t in (0.0, 1e-3, 0.7, 31.4, 1e5, -2.0):
        assert_as_derived(problem.task.top, problem.task.start, t)


@pytest.mark.parametrize("name", HARD)
def test_the_package_computes_hard_motions_as_derived(name):
    assert_as_derived(*HARD[name], least=3)  # rates are 3 rad/s


def test_a_motion_next_to_the_separatrix_has_its_finite_period():
    """The exact doubles miss the separatrix by 1e-17."""
    top = Top(1.0, 0.5, 1.0)
    start = State.from_euler(theta=math.pi / 2, theta_dot=-math.sqrt(2))
    period = mpf("39.2296")  # s, by a Taylor integration with 80 digits
    there, back = derive(top, start, 0.0)[0], derive(top, start, period)[0]
    # A period to 6 digits, during which the axis moves at up to 2 rad/s
    assert distance(there, back) < 1e-4


def test_the_script_prints_the_articles_top_after_ten_seconds():
    result = execute([sys.executable, SCRIPT], check=True)
    assert len(result.stdout.split()) == 4
