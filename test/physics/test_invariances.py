"""Changes that leave a motion the same: of the origin of time, of axes and units, and mirrors.

Of 12500 random cases the worst is known for every law, and a quarter of each tolerance.
"""

import math

import numpy as np
import pytest
from drawn import ten_to
from hypothesis import given, settings
from hypothesis import strategies as st
from physics.tops import EPS, FAMILIES, distance, random_case

from symtop_ros.physics import Motion, State, Top

pytestmark = pytest.mark.untraced

CASES = st.builds(random_case, st.integers(0, 10**6), st.sampled_from(FAMILIES[:-1]))
ANGLES = st.floats(-math.pi, math.pi)
POWERS_OF_TWO = st.integers(-20, 20).map(lambda k: 2.0**k)
FACTORS = st.floats(0.1, 10.0)
PHASES = st.floats(-2.0, 6.0).map(ten_to)  # rad
often = settings(max_examples=100)


def natural_rate(case):
    """The rate at which an axis falls at most: exp(natural_rate t) (rad/s)."""
    return math.sqrt(abs(case.top.Mgl) / case.top.Ix)


def largest_rate(case):
    return max(np.abs(case.start.angular_velocity).max(), natural_rate(case))


def moderate(case, phase):
    """Time in which it turns by `phase` rad, or falls over."""
    return float(min(phase / largest_rate(case), 3.0 / natural_rate(case)))


def stretched(case, t):
    """Rounding of a start after a time: it grows as the phase and as an unstable axis falls."""
    return EPS * (1 + largest_rate(case) * t) * math.exp(natural_rate(case) * t)


def difference(case, a, b):
    """Distance of the orientations or, relative to the largest, of the rates."""
    rates = np.abs(a.angular_velocity - b.angular_velocity).max() / largest_rate(case)
    return max(distance(a, b), float(rates))


def turned(state, before, after):
    """Turn a state about the vertical by `before`, and its body about the axis by `after`."""
    (w, x, y, z), (wx, wy, wz) = state.parts
    A = complex(w, z) * np.exp(0.5j * (before + after))
    B = complex(x, y) * np.exp(0.5j * (before - after))
    across = complex(wx, wy) * np.exp(-1j * after)
    return State((A.real, B.real, B.imag, A.imag), (across.real, across.imag, wz))


def mirrored(state):
    """Reflect the world in its plane x'z', and the body in its plane xz."""
    (w, x, y, z), (wx, wy, wz) = state.parts
    return State((w, -x, y, -z), (-wx, wy, -wz))


def backwards(state):
    return State(state.orientation, -state.angular_velocity)


def scaled(top, factor):
    return Top(*(factor * moment for moment in top.moments))


@often
@given(case=CASES)
def test_reversed_rates_lead_into_the_past(case):
    back = Motion(case.top, backwards(case.start)).at(case.t)
    motion = Motion(case.top, case.start)
    # only signs differ: two results of up to 12 eps (near the separatrix). Worst seen: 17 eps
    assert difference(case, backwards(back), motion.at(-case.t)) <= 64 * EPS


@often
@given(case=CASES, phase=PHASES, share=st.floats(0.0, 1.0))
def test_a_motion_goes_on_from_where_it_is(case, phase, share):
    first = share * moderate(case, phase)
    second = moderate(case, phase) - first
    motion = Motion(case.top, case.start)
    there = Motion(case.top, motion.at(first)).at(second)
    limit = stretched(case, first + second)
    assert difference(case, there, motion.at(first + second)) <= 16 * limit  # worst seen: 4.1


@often
@given(case=CASES, phase=PHASES, before=ANGLES, after=ANGLES)
def test_turns_about_the_vertical_and_about_the_axis_change_nothing_else(
    case, phase, before, after
):
    t = moderate(case, phase)
    first = Motion(case.top, turned(case.start, before, after)).at(t)
    last = turned(Motion(case.top, case.start).at(t), before, after)
    assert difference(case, first, last) <= 10 * stretched(case, t)  # worst seen: 2.5


@often
@given(case=CASES, factor=POWERS_OF_TWO)
def test_a_unit_of_mass_changes_nothing(case, factor):
    other = Motion(scaled(case.top, factor), case.start)
    assert other.at(case.t) == Motion(case.top, case.start).at(case.t)  # bit for bit


@often
@given(case=CASES, phase=PHASES, factor=FACTORS)
def test_any_unit_of_mass_changes_no_more_than_rounding(case, phase, factor):
    t = moderate(case, phase)
    other = Motion(scaled(case.top, factor), case.start).at(t)
    limit = stretched(case, t)  # the three moments are rounded. Worst seen: 4.0
    assert difference(case, other, Motion(case.top, case.start).at(t)) <= 16 * limit


def in_other_time(case, unit):
    """The state at t, by way of a unit of time `unit` times as long."""
    Ix, Iz, Mgl = case.top.moments
    start = State(case.start.orientation, case.start.angular_velocity * unit)
    there = Motion(Top(Ix, Iz, Mgl * unit**2), start).at(case.t / unit)
    return State(there.orientation, there.angular_velocity / unit)


@often
@given(case=CASES, unit=POWERS_OF_TWO)
def test_a_unit_of_time_changes_nothing(case, unit):
    assert in_other_time(case, unit) == Motion(case.top, case.start).at(case.t)  # bit for bit


@pytest.mark.parametrize(("seed", "unit"), [(71212035, 2.0**13), (826598714, 2.0**-13)])
def test_a_unit_of_time_changes_nothing_next_to_the_separatrix(seed, unit):
    case = random_case(seed, "from below")
    there = Motion(case.top, case.start).at(case.t)
    assert difference(case, in_other_time(case, unit), there) <= 16 * EPS


@often
@given(case=CASES)
def test_a_mirror_image_moves_as_the_mirror_image_of_the_motion(case):
    image = Motion(case.top, mirrored(case.start)).at(case.t)
    there = Motion(case.top, case.start).at(case.t)
    # only signs differ, and thereby the order of some sums. Worst seen: 7.9 eps
    assert difference(case, mirrored(image), there) <= 32 * EPS
