"""The reference: its digits, against stored motions, other means, and itself."""

import ast
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from flint import arb, ctx
from mpmath import mp, mpf
from physics.tops import ARTICLE, CUSPS, EPS
from programs import run_python

from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top, reference
from symtop_ros.physics.reference import Inputs, exact_constants, exact_state
from symtop_ros.physics.reference.proved import prove_state
from workshop.digits import ClosedForm, ExactState, Series
from workshop.testset.exact import ReturningSeries, distance

pytestmark = pytest.mark.untraced
SOURCES = sorted(Path(reference.__file__).parent.glob("*.py"))


def assert_same(found, q, omega, digits):
    """Assert a quaternion, and rates relative to their size, to so many digits."""
    with mp.workdps(2 * digits):
        q, omega = ([mpf(each) for each in part] for part in (q, omega))
        rates = zip(found.angular_velocity, omega, strict=True)
        assert distance(found.orientation, q) < mpf(10) ** -digits
        assert mp.norm([a - b for a, b in rates]) <= mpf(10) ** -digits * mp.norm(omega)


def to_mpmath(found, digits=250):
    """A state of balls as the numbers of mpmath in their middles."""
    parts = found.orientation, found.angular_velocity
    with mp.workdps(digits), ctx.workdps(digits):
        middles = ([each.mid().str(digits, radius=False) for each in part] for part in parts)
        return ExactState(*(tuple(map(mpf, part)) for part in middles))


def test_balls_contain_those_of_more_digits_and_have_the_digits_of_both_references():
    for t in (1.0, 1e20):
        few, many = (exact_state(ARTICLE, CUSPS, t, digits) for digits in (25, 200))
        assert few.is_within(arb(10) ** -25)
        for one, other in zip(few[:2], many[:2], strict=True):
            with ctx.workdps(250):
                assert all(a.contains(b) for a, b in zip(one, other, strict=True))
        assert_same(ClosedForm(Inputs.of(ARTICLE, CUSPS), 100).at(t), *to_mpmath(many), 60)
    series = Series(Inputs.of(ARTICLE, CUSPS), 60).at(0.5)
    assert_same(series, *to_mpmath(exact_state(ARTICLE, CUSPS, 0.5)), 40)


def test_an_exact_time_is_taken_exactly():
    """A day and a nanosecond: the nearest double of seconds is 7 ps off."""
    times, factor = 86_400 * 10**9 + 1, 0.1
    found = exact_state(ARTICLE, CUSPS, ExactTimes(times, factor))
    t = Fraction(factor) * times / 10**9
    with ctx.workdps(60):
        right, rounded = (prove_state(Inputs.of(ARTICLE, CUSPS), each) for each in (t, float(t)))
        assert found.orientation[0].overlaps(right.orientation[0])
        assert not found.orientation[0].overlaps(rounded.orientation[0])


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"t": math.nan}, "t must be a finite number, got nan s"),
        ({"t": math.inf}, "t must be a finite number, got inf s"),
        ({"t": ExactTimes(np.arange(3))}, r"t must be one time, got shape \(3,\)"),
        ({"digits": 0}, "digits must be 1 or more, got 0"),
        ({"torque": (0.0, math.nan, 0.0)}, "torque must be three finite numbers"),
        ({"torque": (1.0,)}, "torque must be three finite numbers"),
        ({"top": Top([1.0, 2.0], 0.5, 2.0)}, r"must be those of one motion, got shapes \(2,\)"),
    ],
)
def test_what_has_no_single_state_is_refused(change, reason):
    with pytest.raises(ValueError, match=reason):
        exact_state(**{"top": ARTICLE, "start": CUSPS, "t": 1.0} | change)


def test_a_state_is_printed_with_the_digits_that_are_known():
    text = str(exact_state(ARTICLE, CUSPS, 10.0, 40))
    assert text.startswith("orientation: 0.5831799034733807704174032929833874478234")
    assert "angular_velocity: -4.55310103" in text
    assert text.endswith(" 200.00000000000000")


def test_doubles_are_exact_and_the_orientation_is_normalised_with_all_digits():
    longer = State(CUSPS.orientation * 1.0001, CUSPS.angular_velocity)
    q = [mpf(each) for each in longer.given_orientation.tolist()]
    with mp.workdps(60):
        unit = [each / mp.norm(q) for each in q]
    assert_same(to_mpmath(exact_state(ARTICLE, longer, 0.0)), unit, (0, 0, 200), 50)


def test_digits_are_those_of_the_fastest_rate_and_not_of_what_friction_leaves():
    start = State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    found = exact_state(Top(1.0, 0.5, 0.0), start, 6.0, 20, friction=Friction(axial=10.0))
    with ctx.workdps(40):
        angle = (1 - arb(-120).exp()) / 10
        assert found.orientation[0].overlaps(angle.cos())
        assert found.angular_velocity[2].overlaps(4 * arb(-120).exp())
        assert found.angular_velocity[2].rad() < 4e-20


def test_the_mean_rates_are_those_of_a_nutation():
    for top in (ARTICLE, Top(ARTICLE.Ix, ARTICLE.Iz, -0.068)):
        start = State.from_euler(theta=0.7, phi=0.2, theta_dot=3.0, phi_dot=9.0, psi_dot=170.0)
        motion = ClosedForm(Inputs.of(top, start), 40)
        with mp.workdps(40):
            phases = []
            for t in (0, motion.period):
                w, x, y, z = motion.at(t).orientation
                plus, minus = mp.atan2(z, w), mp.atan2(y, x)
                phases.append((plus + minus, plus - minus))
            for first, last, rate in zip(*phases, motion.mean_rates, strict=True):
                turns = (last - first - rate * motion.period) / (2 * mp.pi)
                assert abs(turns - mp.nint(turns)) < mpf(10) ** -35
                assert abs(rate) > 1  # rad/s


def test_it_imports_nothing_of_the_kernel_and_nothing_imports_it():
    found = {
        each.module
        for path in SOURCES
        for each in ast.parse(path.read_text()).body  # types are imported below TYPE_CHECKING
        if isinstance(each, ast.ImportFrom)
    }
    ours = {name for name in found if name.startswith("symtop_ros")}
    ours -= {"symtop_ros.missing", "symtop_ros.physics.times"}
    assert all(name.startswith("symtop_ros.physics.reference.") for name in ours)
    done = run_python("import sys, symtop_ros.physics; assert 'flint' not in sys.modules")
    assert (done.returncode, done.stderr) == (0, "")


def test_without_the_extra_the_import_says_what_to_install():
    code = "import sys; sys.modules['flint'] = None\n"
    code += "try: import symtop_ros.physics.reference\nexcept ImportError as error: print(error)"
    advice = "pip install python-flint, on Debian and Ubuntu into a venv"
    assert run_python(code).stdout == f"No module named 'flint': {advice}\n"


TINY, HUGE = 1e-100, 1e100


@pytest.mark.parametrize("moments", [(1, 0.5, TINY), (TINY, TINY, HUGE), (HUGE, TINY, -HUGE)])
@pytest.mark.parametrize("omega", [(TINY, 0, 0), (1, 2, HUGE), (HUGE, 0, TINY), (0, 0, 0)])
@pytest.mark.parametrize("q", [(0.7, 0.5, 0.1, -0.5), (1, TINY, 0, 0), (0, 1, 0, 0)])
def test_numbers_of_extreme_sizes_have_states_and_constants(moments, omega, q):
    motion = Motion(Top(*moments), State(q, omega))
    t = min(1.0, motion.farthest_time / 2)
    found = exact_state(motion.top, motion.start, t, 20)
    assert found.is_within(arb(10) ** -20)
    constants = exact_constants(motion.top, motion.start, 20)
    assert all(angle.rad() <= 1e-20 for angle in constants.turning_angles)
    assert motion.certify(t).attitude < 20 * EPS


@pytest.mark.parametrize("periods", [1.4, -3.7, 1e9 + 0.2])
def test_one_period_serves_for_all_times(periods):
    inputs = Inputs.of(ARTICLE, CUSPS)
    exact = ClosedForm(inputs, 60)
    t = periods * float(exact.period)
    with mp.workdps(60):
        found = ReturningSeries(inputs, 50, exact.period).at(t)
        assert distance(found.orientation, exact.at(t).orientation) < mpf(10) ** -38


def test_a_period_after_which_the_height_does_not_return_is_refused():
    with pytest.raises(ValueError, match=r"the height must return after 0\.15 s"):
        ReturningSeries(Inputs.of(ARTICLE, CUSPS), 30, 0.15).at(1.0)


def test_times_before_the_start_are_integrated_back():
    inputs = Inputs.of(ARTICLE, CUSPS)
    exact = ClosedForm(inputs, 60).at(-0.3)
    assert distance(Series(inputs, 40).at(-0.3).orientation, exact.orientation) < 1e-15
