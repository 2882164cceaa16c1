"""The separatrix from both sides: gaps of all sizes and none, compared with a Taylor series."""

import functools
import math
from itertools import product

import numpy as np
import pytest
from physics.tops import ARTICLE, EPS, Case, attitude_error, error, largest_rate, series_of

from symtop_ros.physics import ExactTimes, Motion, State, Top
from symtop_ros.physics.reference import ClosedForm, Inputs

pytestmark = pytest.mark.untraced
PENDULUM = Top(1.0, 0.5, 1.0)
THROWN_UP = {
    # The doubles nearest to the separatrix are not on it: theta' = -sqrt(2) is rounded.
    "a rounded root": (PENDULUM, State.from_euler(theta=math.pi / 2, theta_dot=-math.sqrt(2))),
    "the article's top": (
        ARTICLE,
        State.from_euler(
            theta=2, phi=1, psi=2, theta_dot=-2 * math.sqrt(0.068 / 0.000228) * math.sin(1)
        ),
    ),
}


def near(start, gap):
    """A pendulum pushed from the top, let go next to it, or pushed while it spins."""
    a, b = 0.6 * gap**0.5, 0.8 * gap**0.5
    if start == "let go":
        return PENDULUM, State((math.sqrt(1 - gap), a, b, 0), (0, 0, 0))
    return PENDULUM, State((1, 0, 0, 0), (a, -b, 1.5 if start == "spinning" else 0))


BETWEEN = (1e-6, 1e-14, 1e-22)  # these gaps are tried by `make test-long`
GAPS = [
    *product(("pushed", "let go"), (1e-2, *BETWEEN, 1e-30)),
    *product(("spinning",), (1e-2, 1e-14, 1e-30)),
]
STARTS = THROWN_UP | {f"{start}, {gap:g}": near(start, gap) for start, gap in GAPS}
MARKS = {f"{start}, {gap:g}": [pytest.mark.long] for start, gap in GAPS if gap in BETWEEN}
OFTEN = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=MARKS.get(name, [])) for name in STARTS]
)


@functools.cache
def solve(name):
    """The series of a start, with 62 digits, of which gaps of 1e-30 and 1e12 periods leave 29."""
    return series_of(Motion(*STARTS[name]), 62)


def find_period(name):
    """The exact period in s."""
    return float(ClosedForm(Inputs.of(*STARTS[name])).period)


@OFTEN
def test_a_period_is_finite_and_right_if_the_exact_one_is_finite(name):
    top, start = STARTS[name]
    motion = Motion(top, start)
    assert motion.nutation_period == pytest.approx(find_period(name), rel=2 * EPS)
    assert motion.kind != "asymptotic"


@OFTEN
def test_states_are_right_at_a_hundredth_and_at_a_million_million_periods(name):
    top, start = STARTS[name]
    motion, exact = Motion(top, start), solve(name)
    for periods in (0.01, 0.3, 0.5, 0.77, 1.2, -1000.3, 1e6 + 0.499, 1e12 + 0.8):
        t = periods * motion.nutation_period
        (q, omega), state = exact.at(t), motion.at(t)
        # as promised in docs/accuracy.md
        assert attitude_error(q, state.orientation) <= 5 * EPS
        assert error(omega, state.angular_velocity, largest_rate(motion)) <= 5 * EPS


@pytest.mark.parametrize("push", [1e-8, 1e-30, 1e-95])
def test_a_pendulum_hardly_pushed_from_the_top_is_right_at_the_bottom(push):
    # K/K' is 13, 45 and 140: so much would the rounding of the phase be magnified
    start = State((1, 0, 0, 0), (0.6 * push, -0.8 * push, 0))
    case = Case(PENDULUM, start, 0.4999 * Motion(PENDULUM, start).nutation_period)
    (q, omega), state = case.exact, case.found
    assert attitude_error(q, state.orientation) <= 5 * EPS
    assert error(omega, state.angular_velocity, 2.0) <= 5 * EPS


def test_a_motion_without_a_period_is_asymptotic_at_exact_times_too():
    motion = Motion(Top(1.0, 0.5, 2.5), State((0.5, 0.5, 0.5, 0.5), (1.0, 2.0, 4.0)))
    assert motion.kind == "asymptotic"
    assert motion.nutation_period == math.inf
    stamps = np.array([0, 500_000_000, 30_000_000_000])
    states = motion.at(ExactTimes(stamps))
    # away from the vertical the error of a double grows as exp(2 t): digits for 30 s
    exact = series_of(motion, 80)
    for k, t in enumerate((0.0, 0.5, 30.0)):
        (q, omega), state = exact.at(t), motion.at(t)
        assert states[k] == state
        assert attitude_error(q, state.orientation) <= 5 * EPS
        assert error(omega, state.angular_velocity, 3.0) <= 5 * EPS
