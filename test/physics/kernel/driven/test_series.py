"""The engine for friction and applied torques: against 30 digits, the closed form, and itself."""

import math
from fractions import Fraction

import numpy as np
import pytest
from drawn import Numbers, cos, sin
from mpmath import mp, mpf
from physics.driven_families import FAMILIES, DrivenCase
from physics.refusals import refused
from physics.tops import ARTICLE, CUSPS, EPS, distance, random_case, series_of, to_state

from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top

pytestmark = pytest.mark.untraced
LONG = pytest.mark.long
NONE = (0.0, 0.0, 0.0)
SHIFT = 1e-9  # of the angular velocity at the start: small, and far above rounding
DRIVES = {
    "friction": (Friction(2e-6, 1e-5), NONE),
    "vertical torque": (Friction(), (0.0, 0.0, 1e-4)),
    "both": (Friction(1e-6, 2e-5), (1e-3, -2e-3, 5e-4)),
}


def exact(motion, t):
    """The state at t as doubles, from 30 digits."""
    return to_state(series_of(motion).at(t))


# It changes no bit of a state, and makes a motion under gravity one that is integrated.
HARDLY_ANY = Friction(1e-300, 1e-300)


def steps_to(motion, t):
    """Return the number of steps on the way to t."""
    steps = 0
    while motion.reach(t, 1) != t:
        steps += 1
    return steps + 1


def allowed(case_motion, t, swing=0.0):
    """Return the error of the attitude that is promised: 2 eps and a part of what rounding changes.

    The growth is the change of the attitude over a relative change of the angular velocity at the
    start. An ulp of it changes the attitude by up to eps times the growth, and docs/accuracy.md
    promises a tenth of that; distances are half as large as angles.
    """
    top, start = case_motion.top, case_motion.start
    shifted = State(start.orientation, start.angular_velocity * (1 + SHIFT) + SHIFT * swing)
    other = Motion(top, shifted, case_motion.friction, case_motion.applied_torque)
    return EPS * (2 + distance(case_motion.at(t), other.at(t)) / SHIFT / 10)


@LONG
def test_ten_seconds_of_the_friction_scene_agree_with_thirty_digits():
    motion = Motion(ARTICLE, CUSPS, *DRIVES["friction"])
    expected = exact(motion, 10.0)
    assert motion.engine == "taylor"
    # rounding of the angular velocity at the start would make 1000 eps
    assert distance(motion.at(10.0), expected) < 2 * EPS
    largest = np.abs(motion.at(10.0).angular_velocity - expected.angular_velocity).max()
    assert largest < 4 * EPS * np.abs(expected.angular_velocity).max()


BACKWARDS = [
    pytest.param(name, -0.3, marks=() if name == "both" else pytest.mark.long) for name in DRIVES
]


@pytest.mark.parametrize(("name", "t"), [*((name, 0.5) for name in DRIVES), *BACKWARDS])
def test_driven_motions_agree_with_thirty_digits(name, t):
    motion = Motion(ARTICLE, CUSPS, *DRIVES[name])
    assert distance(motion.at(t), exact(motion, t)) < EPS


@pytest.mark.parametrize("family", ["any", "pendulum", "from below", "critical"])
@pytest.mark.parametrize("seed", [0, 2, pytest.param(9, marks=LONG)])
def test_random_tops_agree_with_thirty_digits(family, seed):
    case = random_case(seed, family)
    Ix, Iz, Mgl = case.top.moments
    swing = math.sqrt(abs(Mgl) / Ix)
    spin = float(np.abs(case.start.angular_velocity).max())
    friction = Friction(0.02 * Iz * swing, 0.05 * Ix * swing)
    torque = (0.05 * Mgl, -0.02 * Mgl, 0.03 * Mgl)
    t = min(4 / swing, 100 / max(spin, swing))
    motion = Motion(case.top, case.start, friction, torque)
    assert distance(motion.at(t), exact(motion, t)) < allowed(motion, t, swing)


OFTEN = [(name, 1000) for name in ("strong friction", "fast spin", "mixed", "tumbling")]
RARELY = [pytest.param(name, seed, marks=LONG) for name in FAMILIES for seed in range(2000, 2020)]


@pytest.mark.parametrize(("family", "seed"), [*OFTEN, *RARELY])
def test_a_new_case_of_a_family_agrees_with_thirty_digits(family, seed):
    case = DrivenCase(family, seed)
    motion = case.motion
    for t, expected in zip(case.times, map(to_state, case.solve()), strict=True):
        found, bound = motion.at(t), allowed(motion, t, case.swing)
        assert distance(found, expected) < bound
        largest = np.abs(motion.at(np.linspace(0, t, 50)).angular_velocity).max()
        off = np.abs(found.angular_velocity - expected.angular_velocity).max()
        assert off < 2 * bound * largest


@pytest.mark.parametrize("phi_dot", [0.0, 6.5, 20.0])
def test_without_friction_it_gives_what_the_closed_form_gives(phi_dot):
    start = State.from_euler(theta=0.5, psi_dot=200.0, phi_dot=phi_dot)
    times = np.linspace(0.0, 1.0, 40)
    found = Motion(ARTICLE, start, HARDLY_ANY).at(times)
    assert distance(found, Motion(ARTICLE, start).at(times)) < 2 * EPS  # each has up to one


@pytest.mark.parametrize(
    ("tiny", "t"),
    [(1e-30, 1.0), (1e-300, 100.0)]
    + [pytest.param(*rare, marks=LONG) for rare in ((1e-30, 100.0), (1e-300, 1.0))],
)
def test_friction_too_weak_to_be_felt_gives_what_the_closed_form_gives(t, tiny):
    motion = Motion(ARTICLE, CUSPS, Friction(tiny, tiny), (0.0, 0.0, tiny))
    assert motion.engine == "taylor"
    assert distance(motion.at(t), Motion(ARTICLE, CUSPS).at(t)) < allowed(motion, t)


def test_no_friction_and_no_torque_is_the_closed_form():
    motion = Motion(ARTICLE, CUSPS, Friction(0.0, 0.0), [0, 0, 0])
    assert motion.engine == "closed form"
    assert motion.at(3.0) == Motion(ARTICLE, CUSPS).at(3.0)


@pytest.mark.parametrize("name", DRIVES)
def test_forth_and_back_ends_where_it_began(name):
    friction, torque = DRIVES[name]
    there = Motion(ARTICLE, CUSPS, friction, torque).at(5.0)
    back = Motion(ARTICLE, there, friction, torque).at(-5.0)
    # the state in between is rounded to doubles, and the body turns by 1000 rad on the way back
    assert distance(back, CUSPS) < 1000 * EPS
    assert np.abs(back.angular_velocity - CUSPS.angular_velocity).max() < 1000 * EPS * 200


def test_the_spin_of_a_rod_needs_no_steps():
    rod = Top(Ix=1.0, Iz=1e-8, Mgl=50.0)
    slow, fast = (State.from_euler(theta=1.0, phi_dot=1.0, psi_dot=spin) for spin in (1.0, 1e5))
    friction = Friction(1e-9, 0.1)
    steps = [steps_to(Motion(rod, start, friction), 2.0) for start in (slow, fast)]
    assert steps[1] <= steps[0] + 1


def test_axial_momentum_is_kept_to_the_bit_and_vertical_momentum_to_rounding():
    times = np.linspace(0.0, 20.0, 200)
    found = Motion(ARTICLE, CUSPS, HARDLY_ANY).at(times)
    assert set(found.angular_velocity[:, 2]) == {200.0}
    vertical = ARTICLE.vertical_momentum(found)
    # products of rounded states
    assert np.abs(vertical / vertical[0] - 1).max() < 4 * EPS


def test_a_sleeping_top_spins_down_exponentially_and_stays_upright():
    friction = Friction(axial=1e-5, transverse=2e-5)
    state = Motion(ARTICLE, State.from_euler(theta=0.0, psi_dot=200.0), friction).at(3.0)
    assert state.angular_velocity.tolist()[:2] == [0.0, 0.0]
    assert state.euler_angles.theta == 0.0
    expected = 200 * math.exp(-1e-5 / 5.72e-5 * 3.0)
    assert state.angular_velocity[2] == pytest.approx(expected, rel=2 * EPS)


def test_a_free_sphere_under_friction_comes_to_rest_as_its_formula_says():
    sphere, k, t = Top(Ix=1e-3, Iz=1e-3, Mgl=0.0), 1e-3, 4.0
    omega = np.array([3.0, -4.0, 12.0])
    state = Motion(sphere, State((1, 0, 0, 0), omega), Friction(k, k)).at(t)
    assert state.angular_velocity == pytest.approx(omega * math.exp(-t), rel=4 * EPS)
    angle = 13.0 * (1 - math.exp(-t)) / 2
    expected = [math.cos(angle), *(math.sin(angle) * omega / 13)]
    assert distance(state, State(expected, state.angular_velocity)) < 2 * EPS


def test_a_top_at_rest_stays_there_at_any_time_in_one_step():
    motion = Motion(ARTICLE, State.from_euler(theta=0.0), Friction(1e-6, 1e-5))
    assert motion.reach(1e300, 0) == 1e300
    assert motion.at([1e300, -1e9]).orientation.tolist() == [[1, 0, 0, 0]] * 2


@pytest.mark.parametrize("upright", [True, False])
@pytest.mark.parametrize(
    "small", [1e-3, pytest.param(1e-6, marks=LONG), pytest.param(1e-9, marks=LONG), 1e-12]
)
@pytest.mark.parametrize("turned", [pytest.param(0.0, marks=LONG), 0.7])
def test_a_swing_near_the_vertical_is_right_to_rounding_of_itself(upright, small, turned):
    c, s = cos(turned), sin(turned)
    q = (c, 0.0, 0.0, s) if upright else (0.0, c, s, 0.0)
    start = State(q, (small, 0.0, 300.0 if upright else 0.0))
    motion = Motion(ARTICLE, start, Friction(1e-6, 1e-6))
    expected = exact(motion, 2.0)
    across = motion.at(np.linspace(0.0, 2.0, 400)).angular_velocity[:, :2]
    off = np.abs(motion.at(2.0).angular_velocity - expected.angular_velocity)[:2].max()
    # two roundings; upright the body turns by 600 rad, of which the rounding of its spin, half
    # an ulp at the start, is 300 eps of the direction
    assert off < (2 + (400 if upright else 0)) * EPS * np.abs(across).max()


def test_a_tiny_torque_moves_a_resting_top_as_much_as_it_should():
    motion = Motion(ARTICLE, State((0, 1, 0, 0), (0, 0, 0)), torque=(0.068e-9, 0.0, 0.0))
    largest = np.abs(motion.at(np.linspace(0.0, 2.0, 400)).angular_velocity).max()
    off = np.abs(motion.at(2.0).angular_velocity - exact(motion, 2.0).angular_velocity).max()
    assert off < 2 * EPS * largest  # the rounding of the answer


@pytest.mark.parametrize("nanoseconds", [999_999_937, pytest.param(9_999_999_967, marks=LONG)])
def test_exact_times_are_not_rounded_to_doubles(nanoseconds):
    times = ExactTimes(np.array([5, nanoseconds]), factor=0.7, elapsed=Fraction(1, 4))
    motion = Motion(ARTICLE, CUSPS, *DRIVES["friction"])
    t = (times.elapsed + Fraction(times.factor) * nanoseconds) / 10**9
    # as at times that are doubles; as a double the time would be off by 400 eps in the second case
    assert distance(motion.at(times)[1], exact(motion, t)) < 2 * EPS
    assert motion.at(ExactTimes(nanoseconds, times.factor, times.elapsed)) == motion.at(times)[1]


@pytest.mark.parametrize(
    "elapsed", [sum(Fraction(1, 2**n) for n in range(0, 400, 80)), Fraction(1, 2**400)]
)
def test_an_elapsed_time_of_more_digits_than_four_doubles_is_refused(elapsed):
    times = ExactTimes(np.array([10**8, 2 * 10**8]), elapsed=elapsed)
    with refused("elapsed", "a sum of four doubles"):
        Motion(ARTICLE, CUSPS, *DRIVES["both"]).at(times)


@pytest.mark.parametrize(
    "seed", [*range(2), *(pytest.param(n, marks=LONG) for n in range(100, 160))]
)
def test_a_random_top_swings_some_radians_about_the_lower_vertical_as_it_should(seed):
    rng = Numbers(seed)
    Ix, ratio, Mgl = rng.uniforms(0.1, 2.0, 3).tolist()
    top, small = Top(Ix, Ix * min(ratio, 2.0), Mgl), rng.power(-12, -2)
    swing, turned = math.sqrt(Mgl / Ix), rng.uniform(-3, 3)
    q = (0.0, cos(turned), sin(turned), 0.0)
    start = State(q, (*(small * swing * rng.normals(2)), 0.0))
    motion = Motion(top, start, Friction(*(0.1 * Ix * swing * rng.uniforms(0, 1, 2))))
    t = 4 / swing
    expected = exact(motion, t)
    largest = np.abs(motion.at(np.linspace(0.0, t, 100)).angular_velocity).max()
    off = np.abs(motion.at(t).angular_velocity - expected.angular_velocity).max()
    assert off < 4 * EPS * largest  # docs/accuracy.md: eps (4 + growth/10), about 0.5 rad here


@pytest.mark.parametrize(
    ("top", "torque", "t"),
    [
        (ARTICLE, 0.07, 10.0),
        (Top(1.0, 0.001, 1.0), 1.0294117647058825, 10.0),
        (Top(1.0, 2.0, 1.0), 1.0294117647058825, 777.7),
    ],
)
def test_a_spin_up_from_rest_is_as_good_as_is_said(top, torque, t):
    start = State((1, 0, 0, 0), (0, 0, 0))
    state = Motion(top, start, torque=(0.0, 0.0, torque)).at(t)
    with mp.workdps(40):  # it stays upright: psi = torque t^2/(2 Iz)
        rate = mpf(torque) * t / mpf(top.Iz)
        half = rate * t / 4
        expected = State((float(mp.cos(half)), 0, 0, float(mp.sin(half))), (0, 0, float(rate)))
    assert distance(state, expected) < 2 * EPS
    off = np.abs(state.angular_velocity - expected.angular_velocity).max()
    assert off < 2 * EPS * expected.angular_velocity[2]
