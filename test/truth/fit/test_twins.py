"""Twins: motions of which a kind of record is the same, to rounding."""

import numpy as np
import pytest

from symtop_ros.base.arrays import compose, invert
from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit import twins
from symtop_ros.truth.fit.camera import project
from symtop_ros.truth.fit.model import find_axis

MOTION = Motion(
    Top(Ix=1.0, Iz=0.25, Mgl=40.0),
    State.from_euler(theta=0.75, phi=0.25, psi=0.5, phi_dot=2.0, theta_dot=1.0, psi_dot=60.0),
)
TIMES = np.arange(40) / 32
CAMERA = {"u": 3.0, "v": 4.0, "log_scale": 1.0, "elevation": 0.5, "roll": 0.125, "nearness": 0.0}
# The promise of docs/fit.md. Phases of up to 100 rad are rounded to 1e-14, and coordinates follow.
EXACT = 1e-12


def axis(motion):
    return find_axis(motion.at(TIMES).orientation)


def rates(motion):
    return motion.at(TIMES).angular_velocity


def picture(motion, camera):
    cameras = {name: np.array([value]) for name, value in camera.items()}
    return project(axis(motion)[None], cameras)[0]


def differ(first, second):
    return np.abs(first - second).max()


def test_twice_the_moments_and_the_weight_move_the_same():
    twin = twins.scale_moments(MOTION, 2.0)
    assert twin.top.Ix == 2.0
    assert differ(MOTION.at(TIMES).orientation, twin.at(TIMES).orientation) < EXACT


def test_the_axis_is_the_same_for_each_Iz_with_one_p_psi():
    twin = twins.change_axial_moment(MOTION, 1.5)
    assert abs(twin.start.angular_velocity[2]) < abs(MOTION.start.angular_velocity[2]) / 5
    assert differ(axis(MOTION), axis(twin)) < EXACT


@pytest.mark.parametrize("change", [twins.exchange_momenta, twins.reverse_momenta])
def test_theta_is_the_same_with_momenta_exchanged_or_reversed(change):
    twin = change(MOTION)
    assert differ(axis(MOTION)[:, 2], axis(twin)[:, 2]) < EXACT
    assert differ(axis(MOTION)[:, 0], axis(twin)[:, 0]) > 0.1


def test_exchanged_momenta_are_those_of_the_motion():
    own, other = MOTION, twins.exchange_momenta(MOTION)
    p_psi, p_phi = (
        [m.top.Iz * m.start.angular_velocity[2], m.top.angular_momentum(m.start)[2]]
        for m in (own, other)
    )
    assert p_psi == pytest.approx(p_phi[::-1], rel=1e-13)


def test_rates_are_the_same_with_Mgl_and_the_vertical_turned_over():
    twin = twins.turn_over(MOTION)
    assert twin.top.Mgl == -MOTION.top.Mgl
    assert differ(rates(MOTION), rates(twin)) < EXACT


def test_rates_and_theta_do_not_show_the_azimuth():
    twin = twins.turn_azimuth(MOTION, 1.0)
    assert differ(rates(MOTION), rates(twin)) < EXACT
    assert differ(axis(MOTION)[:, 2], axis(twin)[:, 2]) < EXACT


@pytest.mark.parametrize("bias", [-3.0, 0.5, 4.0])
def test_a_bias_of_the_gyroscope_is_twice_as_much_of_p_psi(bias):
    twin = twins.bias_spin(MOTION, bias)
    biased = rates(MOTION) + np.array([0.0, 0.0, bias])
    assert differ(biased, rates(twin)) < EXACT
    p, other = (m.top.Iz * m.start.angular_velocity[2] for m in (MOTION, twin))
    assert other - p == pytest.approx(2 * bias, rel=1e-13)


def test_a_camera_above_or_below_shows_both_signs_of_p_psi():
    twin, camera = twins.mirror_view(MOTION, CAMERA)
    assert camera["elevation"] == -CAMERA["elevation"]
    assert twin.start.angular_velocity[2] == -MOTION.start.angular_velocity[2]
    assert differ(picture(MOTION, CAMERA), picture(twin, camera)) < EXACT


def test_a_camera_turned_over_shows_the_other_end_of_the_axis():
    twin = twins.take_other_end(MOTION)
    turned = {**CAMERA, "roll": CAMERA["roll"] + np.pi}
    assert differ(picture(MOTION, CAMERA), picture(twin, turned)) < EXACT


def test_a_scene_turned_over_with_its_camera_looks_the_same_with_perspective():
    twin, camera = twins.turn_camera(MOTION, CAMERA)
    assert twin.top.Mgl == -MOTION.top.Mgl
    assert twin.start.angular_velocity[2] == MOTION.start.angular_velocity[2]
    assert abs(camera["roll"]) <= np.pi
    near = {"nearness": 0.25}
    assert differ(picture(MOTION, CAMERA | near), picture(twin, camera | near)) < EXACT
    seen, low = twins.mirror_view(MOTION, CAMERA)
    assert differ(picture(MOTION, CAMERA | near), picture(seen, low | near)) > 0.1


def test_from_straight_above_the_vertical_has_no_sign():
    twin = twins.see_from_above(MOTION)
    assert twin.top.Mgl == -MOTION.top.Mgl
    assert differ(axis(MOTION)[:, :2], axis(twin)[:, :2]) < EXACT
    assert differ(axis(MOTION)[:, 2], -axis(twin)[:, 2]) < EXACT


def test_attitudes_at_equal_steps_do_not_show_whole_turns():
    twin = twins.add_turns(MOTION, 1 / 32)
    left = compose(invert(MOTION.at(TIMES).orientation), twin.at(TIMES).orientation)
    assert np.abs(left[:, 1:]).max() < EXACT
