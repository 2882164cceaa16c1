"""Driven motions with a tolerance against many digits, the closed form, and stored bits."""

import copy
import pickle

import numpy as np
import pytest
from drawn import Numbers
from physics.exact_motions import read_motions
from physics.kernel.driven.test_series import KINDS, draw_driven
from physics.tops import EPS, attitude_error, distance, error, follow_exactly
from trials import seeds

from symtop_ros.physics import Friction, Motion, Motions, Pushes, State, Top

pytestmark = [pytest.mark.untraced, pytest.mark.numbers]
ARTICLE = Top(0.000228, 0.0000572, 0.068)
START = State((0.96875, 0.248046875, 0.0, 0.0), (0.0, 0.0, 200.0))
FRICTION = Friction(2.0**-20, 2.0**-20)
TOLERANCES = 1e-6, 1e-9, 1e-12, 1e-15
# Of the attitude in rad. A step leaves out its terms from the 23rd on, the first of which is about
# as large as the two that are compared with the tolerance. They fall by the ratio r = tolerance^
# (1/22), 0.53 for 1e-6, so all of them are 1/(1 - r) = 2.2 times as large; the angle is twice the
# distance of quaternions, and the two terms may both be near a zero: as large again.
PER_STEP = 10
DRIVEN = [each for each in read_motions() if each.motion.is_driven]


def with_tolerance(motion, tolerance):
    acting = motion.friction, motion.applied_torque
    return Motion(motion.top, motion.start, *acting, tolerance=tolerance)


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", seeds(2, 100))
def test_the_error_of_two_steps_is_about_the_tolerance(tolerance, kind, seed):
    motion, far = draw_driven(Numbers(seed), kind)
    coarse = with_tolerance(motion, tolerance)
    t = coarse._reach(far, 1)  # up to the end of the second step
    exact, found = follow_exactly(motion, digits=45).at(t), coarse.at(t)
    allowed = 2 * PER_STEP * tolerance + 8 * EPS
    assert 2 * attitude_error(exact.orientation, found.orientation) < allowed
    # The first steps hardly change the rates of a slow body, which the weight makes faster.
    scale = np.abs(motion.at(np.linspace(0.0, t, 9)).angular_velocity).max() + 1 / t
    assert error(exact.angular_velocity, found.angular_velocity) < allowed * scale


def count_steps(motion, t):
    steps = 1
    while motion._reach(t, 1) != t:
        steps += 1
    return steps


@pytest.mark.parametrize("family", {each.family: None for each in DRIVEN})
def test_errors_of_steps_add_up_to_the_error_of_a_state(family):
    """Errors of the attitude, and of rates that turn it on in each of the later steps."""
    for each in (row for row in DRIVEN if row.family == family):
        t, (q, _) = each.times[-1], each.states[-1]
        for tolerance in TOLERANCES:
            coarse = with_tolerance(each.motion, tolerance)
            steps = count_steps(coarse, t)
            allowed = PER_STEP * (tolerance + EPS) * (steps + steps**2 / 2)
            assert 2 * attitude_error(q, coarse.at(t).orientation) < allowed


def test_a_tolerance_saves_steps_and_costs_digits():
    exact = Motion(ARTICLE, START, FRICTION)
    steps, errors = [count_steps(exact, 10.0)], [0.0]
    state = exact.at(10.0)
    for tolerance in (1e-12, 1e-9, 1e-6):
        coarse = with_tolerance(exact, tolerance)
        steps.append(count_steps(coarse, 10.0))
        errors.append(2 * distance(coarse.at(10.0), state))
    assert steps == sorted(steps, reverse=True)
    assert errors == sorted(errors)
    assert 0.1 * 1e-6 < errors[-1] < 100 * 1e-6  # of 130 steps some are near the tolerance


# States after 3 s with a tolerance of 2^-40: friction, a torque, and both.
STORED = [
    (
        FRICTION,
        (0.0, 0.0, 0.0),
        "0x1.6bb44e7fef37ap-1 -0x1.760a28750185ep-3 0x1.6ae0cd390ccb4p-3 -0x1.4ffd57ef9f3c5p-1 "
        "-0x1.9abbfb587981fp+0 -0x1.8533e298ccb09p-1 0x1.7c7c26aec04cbp+7",
    ),
    (
        Friction(),
        (2.0**-9, 0.0, 2.0**-10),
        "0x1.b693043165adfp-1 0x1.3be7cd71c762dp-4 -0x1.d8d640376f342p-3 -0x1.d1e46002fc007p-2 "
        "0x1.7c68174a311efp+2 0x1.d11c5b56e1f9ep-1 0x1.edd7cc4b02b0ap+7",
    ),
    (
        Friction(2.0**-18, 2.0**-16),
        (0.0, 2.0**-9, 2.0**-10),
        "-0x1.e49bae053150ep-1 -0x1.e3831c9bf9153p-6 -0x1.81837693b6443p-3 0x1.0ab2856595afcp-2 "
        "-0x1.251e1c94769acp+0 -0x1.acc83edbdff5fp+1 0x1.94e1bd3939ad4p+7",
    ),
]


@pytest.mark.parametrize(("friction", "torque", "stored"), STORED)
def test_the_bits_are_the_same_on_every_machine(friction, torque, stored):
    state = Motion(ARTICLE, START, friction, torque, tolerance=2.0**-40).at(3.0)
    found = *state.orientation.tolist(), *state.angular_velocity.tolist()
    assert [each.hex() for each in found] == stored.split()


LEANING = 0.96875, 0.125, -0.15625, 0.140625  # a quaternion; it is normalised
MIRROR = np.array([1, 1, -1, -1])  # of quaternions, in a vertical plane


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_twins_have_the_same_bits(tolerance):
    """A heavier top, a faster one, and the mirror image."""

    def find(top, omega, friction, t=5.0, q=LEANING):
        return Motion(top, State(q, omega), friction, tolerance=tolerance).at(t).orientation

    Ix, Iz, Mgl = ARTICLE.moments
    across = 2.0**-18
    found = find(ARTICLE, (1.0, -0.5, 200.0), Friction(2.0**-20, across))
    heavier = Top(128 * Ix, 128 * Iz, 128 * Mgl)
    assert np.array_equal(
        find(heavier, (1.0, -0.5, 200.0), Friction(2.0**-13, 128 * across)), found
    )
    faster = find(Top(Ix, Iz, 4 * Mgl), (2.0, -1.0, 400.0), Friction(2.0**-19, 2 * across), 2.5)
    assert np.array_equal(faster, found)
    turned = tuple(MIRROR * LEANING)
    mirrored = find(ARTICLE, (1.0, 0.5, -200.0), Friction(2.0**-20, across), q=turned)
    assert np.array_equal(MIRROR * mirrored, found)


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_without_friction_and_torque_no_bit_changes(tolerance):
    exact, coarse = Motion(ARTICLE, START), Motion(ARTICLE, START, tolerance=tolerance)
    t = np.linspace(-3.0, 10.0, 50)
    assert np.array_equal(exact.at(t).orientation, coarse.at(t).orientation)


def test_a_tolerance_is_kept_by_whatever_is_made_of_a_motion():
    motion = Motion(ARTICLE, START, FRICTION, tolerance=1e-9)
    assert "tolerance=1e-09" in repr(motion)
    expected = motion.at(5.0).orientation
    assert not np.array_equal(expected, Motion(ARTICLE, START, FRICTION).at(5.0).orientation)
    many = Motions(ARTICLE, START, Friction([2.0**-20, 2.0**-18], 2.0**-20), tolerance=1e-9)
    made = copy.copy(motion), pickle.loads(pickle.dumps(motion)), motion.restart(START)
    members = many[0], many[:1][0], pickle.loads(pickle.dumps(many))[0]
    for each in (*made, *members):
        assert each.tolerance == 1e-9
        assert np.array_equal(each.at(5.0).orientation, expected)
    assert np.array_equal(many.at(5.0).orientation[0], expected)


@pytest.mark.parametrize("tolerance", [9e-16, 1.1e-6, -1e-9, float("nan"), True, "small"])
@pytest.mark.parametrize("make", [Motion, Motions])
def test_other_tolerances_are_refused(tolerance, make):
    with pytest.raises(ValueError, match="tolerance must be"):
        make(ARTICLE, START, FRICTION, tolerance=tolerance)


def test_what_needs_all_digits_refuses_a_tolerance():
    pushes = Pushes(5e-5, 20.0, 20)
    with pytest.raises(ValueError, match="tolerance must be 0 with pushes or a clamp, got 1e-09"):
        Motion(ARTICLE, START, pushes=pushes, tolerance=1e-9)
    with pytest.raises(ValueError, match="tolerance must be 0 with pushes or a clamp, got 1e-09"):
        Motion(ARTICLE, START, clamped=True, tolerance=1e-9)
    with pytest.raises(ValueError, match="tolerance must be 0 for derivatives, got 1e-09"):
        Motion(ARTICLE, START, FRICTION, tolerance=1e-9).jacobian(1.0)
