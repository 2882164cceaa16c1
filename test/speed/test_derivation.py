"""The reference, written from docs/derivation.md alone, and the kernel are the same."""

import re
from pathlib import Path

import pytest
from mpmath import mp
from physics.tops import attitude_error, error

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics.reference import ClosedForm, Inputs, closed_form
from workshop.speed.reference import EPS, Reference

pytestmark = pytest.mark.untraced
PAGE = Path(__file__).parents[2] / "docs/derivation.md"
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


def derive(top, start, t, digits=60):
    return ClosedForm(Inputs.of(top, start), digits).at(t)


def assert_as_derived(top, start, t, least=0):
    """The kernel has the attitude to 5 eps, and rates to 5 eps of the largest, as promised."""
    orientation, angular_velocity = derive(top, start, t)
    state, size = Motion(top, start).at(t), max(least, mp.norm(angular_velocity))
    assert attitude_error(orientation, state.orientation) <= 5 * EPS
    assert error(angular_velocity, state.angular_velocity, size) <= 5 * EPS


@pytest.mark.parametrize("problem", REFERENCE.article[:7], ids=lambda problem: problem.name)
def test_the_package_computes_the_articles_motions_as_derived(problem):
    for t in (0.0, 1e-3, 0.7, 31.4, 1e5, -2.0):
        assert_as_derived(problem.task.top, problem.task.start, t)


@pytest.mark.parametrize("name", HARD)
def test_the_package_computes_hard_motions_as_derived(name):
    assert_as_derived(*HARD[name], least=3)  # rates are 3 rad/s


def test_what_the_derivation_quotes_is_the_code_of_the_reference():
    code = dedent_lines(Path(closed_form.__file__).read_text())
    quoted = re.findall(r"^```py\n(.+?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    assert len(quoted) == 6
    for each in quoted:
        assert dedent_lines(each) in code


def dedent_lines(text):
    return "\n".join(line.strip() for line in text.splitlines())
