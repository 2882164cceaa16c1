"""What breaks twins: an accelerometer at a known place, and the perspective of a pinhole."""

import numpy as np
import pytest
from drawn import Numbers
from truth.fit.cases import CUSPS, TIMES, make_noisy

from symtop_ros.physics import Motion, State, Top, specific_force
from symtop_ros.truth.fit import fit_motion
from symtop_ros.truth.fit.camera import project
from symtop_ros.truth.fit.check import HOLDS
from symtop_ros.truth.fit.model import find_axis
from symtop_ros.truth.fit.report import Report

FAR = 5.0  # deviations; a normal number is farther once in two million
POSITION = (0.0625, 0.0, 0.125)
BIASES = {"bias_x": 0.125, "bias_y": -0.25, "bias_z": 0.25}
FORCE_BIASES = {"bias_fx": 0.0625, "bias_fy": -0.125, "bias_fz": 0.125}
CAMERA = {"u": 600.0, "v": 400.0, "log_scale": 5.5, "elevation": 0.5, "roll": 0.0625}


def measure(motion, more, **known):
    """Return the report of rates and forces with biases."""
    state = motion.at(TIMES)
    forces = specific_force(motion, state, POSITION, 9.8125)
    seen = np.concatenate([state.angular_velocity, forces], axis=1) + np.array(more)
    record = make_noisy("inertial", seen, 0.0625, position=POSITION, **known)
    return Report("record", len(TIMES), fit_motion(record), {})


def read_known(report):
    return {each.name: each for each in report.values if each.is_known}


def assert_near(value, truth):
    assert abs(value.value - truth) < FAR * value.deviation


@pytest.mark.slow
@pytest.mark.parametrize("Mgl", [200.0, -200.0])
def test_an_accelerometer_shows_the_sign_of_the_weight_and_gravity(Mgl):
    motion = Motion(Top(1.0, 0.25, Mgl), State.from_euler(theta=0.75, phi_dot=1.0, psi_dot=100.0))
    report = measure(motion, np.zeros(6))
    values = read_known(report)
    assert report.check.verdict == HOLDS
    assert_near(values["Mgl/Ix"], Mgl)
    assert_near(values["gravity"], 9.8125)
    assert_near(values["theta"], 0.75)
    assert {each.kind for each in report.unknown} == {"moments", "azimuth"}


@pytest.mark.slow
def test_an_accelerometer_shows_the_bias_of_the_gyroscope():
    more = [*BIASES.values(), *FORCE_BIASES.values()]
    values = read_known(measure(CUSPS, more, has_mount=True, known={"bias_z": (0.0, 8.0)}))
    for name, truth in {**BIASES, **FORCE_BIASES, "Mgl/Ix": 300.0}.items():
        assert_near(values[name], truth)
    # without it a bias b of the deviation 8 rad/s is one of 16 rad/s of p_psi/Ix
    assert values["p_psi/Ix"].deviation < 1.0


def see(nearness):
    """Return a picture of the axis, in pixels."""
    camera = {name: np.array([value]) for name, value in {**CAMERA, "nearness": nearness}.items()}
    return project(find_axis(CUSPS.at(TIMES).orientation)[None], camera)[0]


@pytest.mark.slow
@pytest.mark.parametrize("more", [{"has_perspective": True}, {"camera": {"nearness": 0.25}}])
def test_a_near_camera_shows_its_distance_and_the_sign_of_p_psi(more):
    fit = fit_motion(make_noisy("pixels", see(0.25), 0.5, **more))
    report = Report("record", len(TIMES), fit, {})
    values = read_known(report)
    assert report.check.verdict == HOLDS
    for name, truth in {"Mgl/Ix": 300.0, "elevation": 0.5}.items():
        assert_near(values[name], truth)
    assert_near(values["p_psi/Ix"], 0.25 * CUSPS.start.angular_velocity[2])
    if "has_perspective" in more:
        assert_near(values["nearness"], 0.25)
    # left open are a film that is mirrored, a camera that is turned over, and where it looks
    assert {each.kind for each in report.unknown} == {
        *("moments", "spin", "mirrored", "upright", "aim")
    }


def test_a_pinhole_shows_a_point_where_its_ray_meets_the_picture():
    axis, distance = np.array([0.25, -0.5, 0.75]), 4.0
    el, roll = CAMERA["elevation"], CAMERA["roll"]
    toward = np.array([0.0, -np.cos(el), np.sin(el)])  # the camera, from the pivot
    up = np.array([0.0, np.sin(el), np.cos(el)])
    depth = distance - axis @ toward
    right, high = distance * axis[0] / depth, distance * (axis @ up) / depth
    size = np.exp(CAMERA["log_scale"])
    cos, sin = np.cos(roll), np.sin(roll)
    expected = [600 + size * (cos * right - sin * high), 400 + size * (sin * right + cos * high)]
    camera = {n: np.array([v]) for n, v in {**CAMERA, "nearness": 1 / distance}.items()}
    assert project(axis[None, None], camera)[0, 0] == pytest.approx(expected, rel=1e-13)


def test_noise_of_the_accelerometer_has_its_own_deviation():
    state = CUSPS.at(TIMES)
    forces = specific_force(CUSPS, state, POSITION)
    seen = np.concatenate([state.angular_velocity, forces], axis=1)
    size = np.repeat([0.125, 0.5], 3)
    noise = Numbers(4).normals(*seen.shape) * size
    fit = fit_motion(make_noisy("inertial", seen + noise, 0.0, position=POSITION))
    # five deviations of 240 numbers each
    assert fit.noise.sigma == pytest.approx(size, rel=5 / np.sqrt(2 * len(TIMES)))


def test_a_camera_beyond_any_picture_overflows_nothing():
    """Steps along a valley may lead there; warnings are errors in these tests."""
    camera = {n: np.array([v]) for n, v in {**CAMERA, "log_scale": 1e4}.items()}
    assert np.isfinite(project(np.eye(3)[None], camera)).all()
