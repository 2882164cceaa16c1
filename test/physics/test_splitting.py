"""The engine for friction and applied torques: against 30 digits, the closed form, and itself."""

import math

import numpy as np
import pytest
from driven_motion import DrivenTop
from physics.tops import EPS, distance, random_case

from symtop_ros.physics import Friction, State, Top, motion
from symtop_ros.physics.split_motion import SplitMotion
from symtop_ros.physics.splitting import ORDER, PUSHES, TURNS, Point, Splitting

pytestmark = pytest.mark.untraced
ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
CUSPS = State.from_euler(theta=0.5, psi_dot=200.0)
DRIVES = {
    "friction": (Friction(2e-6, 1e-5), (0.0, 0.0, 0.0)),
    "vertical torque": (Friction(), (0.0, 0.0, 1e-4)),
    "both": (Friction(1e-6, 2e-5), (1e-3, -2e-3, 5e-4)),
}
STATED = 1e-13  # error of a step at worst, as `splitting.STEP` states


def exact(top, start, friction, torque, t):
    """The state at t as doubles, from 30 digits."""
    driven = DrivenTop(top.moments, (friction.axial, friction.transverse), torque)
    q, omega = driven.state_at(*(part.tolist() for part in start), t)
    return State([float(c) for c in q], [float(c) for c in omega])


def split(top, start, friction=Friction(), torque=(0.0, 0.0, 0.0)):  # noqa: B008
    return SplitMotion(top, start, friction, torque)


def states(engine, times):
    orientation, angular_velocity = np.empty((len(times), 4)), np.empty((len(times), 3))
    engine.fill(np.asarray(times), orientation, angular_velocity)
    return State.unchecked(orientation, angular_velocity)


def steps_to(engine, t):
    """How many steps there are on the way to t."""
    steps = 0
    while engine.reach(t, 1) != t:
        steps += 1
    return steps + 1


def test_ten_seconds_of_the_friction_scene_agree_with_thirty_digits():
    friction, torque = DRIVES["friction"]
    path = motion(ARTICLE, CUSPS, friction)
    assert path.engine == "splitting"
    expected = exact(ARTICLE, CUSPS, friction, torque, 10.0)
    # 1900 steps, of which most leave less than a tenth of what is stated; 1e-9 is asked
    assert distance(path.at(10.0), expected) < 2e-11
    largest = np.abs(path.at(10.0).angular_velocity - expected.angular_velocity).max()
    assert largest < 2e-11 * np.abs(expected.angular_velocity).max()


@pytest.mark.parametrize("name", DRIVES)
@pytest.mark.parametrize("t", [0.5, -0.3])
def test_driven_motions_agree_with_thirty_digits(name, t):
    friction, torque = DRIVES[name]
    path = motion(ARTICLE, CUSPS, friction, torque)
    expected = exact(ARTICLE, CUSPS, friction, torque, t)
    steps = steps_to(split(ARTICLE, CUSPS, friction, torque), t)
    assert distance(path.at(t), expected) < STATED * steps


@pytest.mark.parametrize("family", ["any", "pendulum", "from below", "critical"])
@pytest.mark.parametrize("seed", [0, 2, 9])
def test_random_tops_agree_with_thirty_digits(family, seed):
    case = random_case(seed, family)
    Ix, Iz, Mgl = case.top.moments
    swing = math.sqrt(abs(Mgl) / Ix)
    spin = float(np.abs(case.start.angular_velocity).max())
    friction = Friction(0.02 * Iz * swing, 0.05 * Ix * swing)
    torque = (0.05 * Mgl, -0.02 * Mgl, 0.03 * Mgl)
    t = min(4 / swing, 100 / max(spin, swing))
    path = motion(case.top, case.start, friction, torque)
    expected = exact(case.top, case.start, friction, torque, t)
    steps = steps_to(split(case.top, case.start, friction, torque), t)
    # the attitude follows the spin: an ulp of it is eps times the phase
    phase = t * np.abs(path.at(np.linspace(0, t, 50)).angular_velocity).max()
    assert distance(path.at(t), expected) < STATED * steps + EPS * phase


@pytest.mark.parametrize("phi_dot", [0.0, 6.5, 20.0])
def test_without_friction_it_gives_what_the_closed_form_gives(phi_dot):
    start = State.from_euler(theta=0.5, psi_dot=200.0, phi_dot=phi_dot)
    times = np.linspace(0.0, 1.0, 40)
    assert distance(states(split(ARTICLE, start), times), motion(ARTICLE, start).at(times)) < 1e-12


def test_friction_too_weak_to_be_felt_gives_what_the_closed_form_gives():
    path = motion(ARTICLE, CUSPS, Friction(1e-30, 1e-30), (0.0, 0.0, 1e-30))
    assert path.engine == "splitting"
    assert distance(path.at(1.0), motion(ARTICLE, CUSPS).at(1.0)) < 1e-12


def test_no_friction_and_no_torque_is_the_closed_form():
    path = motion(ARTICLE, CUSPS, Friction(0.0, 0.0), [0, 0, 0])
    assert path.engine == "closed form"
    assert path.at(3.0) == motion(ARTICLE, CUSPS).at(3.0)


@pytest.mark.parametrize("name", DRIVES)
def test_forth_and_back_ends_where_it_began(name):
    friction, torque = DRIVES[name]
    there = motion(ARTICLE, CUSPS, friction, torque).at(5.0)
    back = motion(ARTICLE, there, friction, torque).at(-5.0)
    assert distance(back, CUSPS) < 1e-10
    assert np.abs(back.angular_velocity - CUSPS.angular_velocity).max() < 1e-10 * 200


@pytest.mark.parametrize("name", DRIVES)
def test_the_observed_order_is_the_nominal_one(name):
    friction, torque = DRIVES[name]
    splitting = Splitting(ARTICLE, friction, torque)
    w, x, y, z = CUSPS.orientation.tolist()
    start = Point(0.0, complex(w, z), complex(x, y), 0j, 200.0)

    def after(steps, t=0.5):
        point = start
        for k in range(steps):
            point = splitting.step(point, t * (k + 1) / steps)
        A, B = point.attitude
        return State((A.real, B.real, B.imag, A.imag), point.rates)

    fine = after(160)
    # between errors of 1e-8 and 1e-10: below the next order's share, above rounding
    coarse, medium = (distance(after(steps), fine) for steps in (24, 40))
    assert math.log(coarse / medium) / math.log(40 / 24) == pytest.approx(ORDER, abs=0.1)


def test_the_coefficients_meet_the_conditions_of_a_symmetric_composition():
    assert tuple(reversed(TURNS)) == TURNS
    rounding = 4 * EPS  # of 17 coefficients
    assert math.fsum(TURNS) == pytest.approx(1.0, abs=rounding)
    assert math.fsum(PUSHES) == pytest.approx(1.0, abs=rounding)
    assert math.fsum(turn**3 for turn in TURNS) == pytest.approx(0.0, abs=rounding)


def test_axial_momentum_is_kept_to_the_bit_and_vertical_momentum_to_rounding():
    times = np.linspace(0.0, 20.0, 200)
    found = states(split(ARTICLE, CUSPS), times)
    assert set(found.angular_velocity[:, 2]) == {200.0}
    vertical = ARTICLE.vertical_momentum(found)
    # each of 60 000 pushes rounds: a random walk of their root times eps
    assert np.abs(vertical / vertical[0] - 1).max() < math.sqrt(6e4) * EPS


def test_a_vertical_torque_changes_the_vertical_momentum_alone_by_torque_times_time():
    path = motion(ARTICLE, CUSPS, torque=(0.0, 0.0, 1e-4))
    gained = ARTICLE.vertical_momentum(path.at(2.0)) - ARTICLE.vertical_momentum(path.start)
    # the difference of numbers of 1e-2 that each carry the rounding of 6000 pushes
    assert gained == pytest.approx(2e-4, rel=1e-2 / 2e-4 * math.sqrt(6e3) * EPS)


def test_a_sleeping_top_spins_down_exponentially_and_stays_upright():
    friction = Friction(axial=1e-5, transverse=2e-5)
    state = motion(ARTICLE, State.from_euler(theta=0.0, psi_dot=200.0), friction).at(3.0)
    assert state.angular_velocity.tolist()[:2] == [0.0, 0.0]
    assert state.euler_angles.theta == 0.0
    expected = 200 * math.exp(-1e-5 / 5.72e-5 * 3.0)
    assert state.angular_velocity[2] == pytest.approx(
        expected, rel=2e-14
    )  # 60 steps of 17 products


def test_a_free_sphere_under_friction_comes_to_rest_as_its_formula_says():
    sphere, k, t = Top(Ix=1e-3, Iz=1e-3, Mgl=0.0), 1e-3, 4.0
    omega = np.array([3.0, -4.0, 12.0])
    state = motion(sphere, State((1, 0, 0, 0), omega), Friction(k, k)).at(t)
    assert state.angular_velocity == pytest.approx(omega * math.exp(-t), rel=1e-13)  # 200 steps
    angle = 13.0 * (1 - math.exp(-t)) / 2
    expected = [math.cos(angle), *(math.sin(angle) * omega / 13)]
    assert distance(state, State(expected, state.angular_velocity)) < 1e-12


def test_torques_are_checked_and_told():
    for wrong in ([1, 2], "abc", [0, 0, math.inf], [[0, 0, 1]]):
        with pytest.raises(ValueError, match=r"torque: got .*, allowed are 3 finite numbers \(N m"):
            motion(ARTICLE, CUSPS, torque=wrong)


def test_a_motion_that_becomes_too_fast_is_refused_in_a_sentence():
    path = motion(ARTICLE, CUSPS, torque=(0.0, 0.0, 1e300))
    with pytest.raises(ValueError, match=r"t: the motion is too fast to be followed further than"):
        path.at(1.0)
