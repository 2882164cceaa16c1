"""The reference: its digits, against stored motions, other means, and itself."""

import ast
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from flint import arb, ctx
from physics.tops import ARTICLE, CUSPS, EPS
from programs import run_python

from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top, reference
from symtop_ros.physics.reference import exact_constants, exact_state
from symtop_ros.physics.reference.balls import norm
from symtop_ros.physics.reference.proved import prove_state
from symtop_ros.physics.reference.series import Inputs

pytestmark = pytest.mark.untraced
SOURCES = sorted(Path(reference.__file__).parent.glob("*.py"))


def test_balls_contain_those_of_more_digits():
    for t in (1.0, 1e20):
        few, many = (exact_state(ARTICLE, CUSPS, t, digits) for digits in (25, 200))
        assert few.is_within(arb(10) ** -25)
        for one, other in zip(few[:2], many[:2], strict=True):
            with ctx.workdps(250):
                assert all(a.contains(b) for a, b in zip(one, other, strict=True))


def test_an_exact_time_is_taken_exactly():
    """A day and a nanosecond: the nearest double of seconds is 7 ps off."""
    times = 86_400 * 10**9 + 1
    factor = 0.1
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
    found = exact_state(ARTICLE, longer, 0.0)
    with ctx.workdps(60):
        q = [arb(each) for each in longer.given_orientation.tolist()]
        unit = [each / norm(q) for each in q]
        pairs = zip(found.orientation, unit, strict=True)
        assert all(ball.overlaps(each) and ball.rad() < 1e-50 for ball, each in pairs)
    rates = zip(found.angular_velocity, (0, 0, 200), strict=True)
    assert all(ball.contains(each) for ball, each in rates)


def test_digits_are_those_of_the_fastest_rate_and_not_of_what_friction_leaves():
    start = State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    found = exact_state(Top(1.0, 0.5, 0.0), start, 6.0, 20, friction=Friction(axial=10.0))
    with ctx.workdps(40):
        angle = (1 - arb(-120).exp()) / 10
        assert found.orientation[0].overlaps(angle.cos())
        assert found.angular_velocity[2].overlaps(4 * arb(-120).exp())
        assert found.angular_velocity[2].rad() < 4e-20


def test_it_imports_nothing_of_the_kernel_and_nothing_imports_it():
    found = {
        each.module
        for path in SOURCES
        for each in ast.parse(path.read_text()).body  # types are imported below TYPE_CHECKING
        if isinstance(each, ast.ImportFrom)
    }
    ours = {name for name in found if name.startswith("symtop_ros")}
    ours -= {"symtop_ros.base.missing", "symtop_ros.physics.times"}
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
@pytest.mark.parametrize("q", [(0.7, 0.5, 0.1, -0.5), (1, TINY, 0, 0)])
def test_numbers_of_extreme_sizes_have_states_and_constants(moments, omega, q):
    motion = Motion(Top(*moments), State(q, omega))
    t = min(1.0, motion.farthest_time / 2)
    found = exact_state(motion.top, motion.start, t, 20)
    assert found.is_within(arb(10) ** -20)
    constants = exact_constants(motion.top, motion.start, 20)
    assert all(angle.rad() <= 1e-20 for angle in constants.turning_angles)
    assert motion.certify(t).attitude < 20 * EPS
