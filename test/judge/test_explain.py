"""Explanations of errors, and what a motion cannot show."""

import numpy as np
import pytest
from judge.cases import SECOND
from judge.made import Made
from physics.tops import ARTICLE
from scipy.spatial.transform import Rotation

from symtop_ros.judge.compare import compare
from symtop_ros.judge.explain import explain
from symtop_ros.judge.truth import Truth, scene_truth
from symtop_ros.physics import Motion, State, regular_precession_rates
from symtop_ros.simulation.events import start_event

STAMPS = np.arange(SECOND // 2, 9 * SECOND, SECOND // 200)


@pytest.mark.parametrize("scene", ["regular_precession", "conical_pendulum", "sleeping"])
@pytest.mark.parametrize(("delay", "rate"), [(0.007, 0.0), (0.007, 1e-4), (0.0, 0.01)])
def test_a_steady_motion_hides_the_delay_but_not_the_drift(scene, delay, rate):
    truth = scene_truth(scene)
    found = explain(Made(delay=delay, drift=rate).make(truth, STAMPS), truth)
    assert "delay" in found.hidden
    assert found.offset.delay == 0.0
    # angles are right to 1e-15; over 8 s that is this rate
    assert found.offset.drift == pytest.approx(rate, abs=1e-12)
    assert found.residual < 1e-9  # of stamps in whole ns: 1e-9 s times 0.2 rad/s


def test_the_sleeping_top_hides_which_of_the_frames_is_turned():
    truth = scene_truth("sleeping")
    assert explain(Made().make(truth, STAMPS), truth).hidden


@pytest.mark.parametrize("scene", ["cusps", "looping"])
@pytest.mark.parametrize("rate", [0.01, -0.2])
def test_offset_delay_and_drift_of_a_nutating_top_are_found_together(scene, rate):
    truth = scene_truth(scene)
    world, body = Rotation.from_rotvec([0.1, -0.4, 2.0]), Rotation.from_rotvec([0.3, 0.2, -1.0])
    estimates = Made(world, body, delay=0.0123, drift=rate).make(truth, STAMPS)
    found = explain(estimates, truth)
    assert found.hidden == ()
    # Stamps are whole nanoseconds, in which the top turns by 2e-7 rad, and rotations replace most
    # of a delay: 2e-7 rad in the middle of 2 rad/s.
    assert found.offset.delay == pytest.approx(0.0123, abs=1e-7)
    assert found.offset.drift == pytest.approx(rate, abs=1e-8)
    assert found.residual < 1e-5
    assert compare(estimates, truth, found.offset).total.max() < 3e-5


@pytest.mark.parametrize(
    ("scene", "rate", "delay"), [("hanging", -0.2, -0.05), ("spherical_pendulum", 1.0, 0.0123)]
)
def test_a_drift_that_turns_a_slow_top_far_within_the_run_is_found(scene, rate, delay):
    # The hanging top looks the same after a turn of 0.105 s: the smaller delay counts.
    truth = scene_truth(scene)
    found = explain(Made(delay=delay, drift=rate).make(truth, STAMPS), truth)
    # Stamps are whole nanoseconds; their errors of half of one cancel in the slope.
    assert found.offset.delay == pytest.approx(delay, abs=1e-9)
    assert found.offset.drift == pytest.approx(rate, abs=1e-11)


@pytest.mark.parametrize(("noise", "delay"), [(1e-9, 0.004), (1e-2, 0.0)])
def test_a_delay_that_noise_hides_is_not_removed(noise, delay):
    # 1e-3 rad/s off regular precession: a nutation of 1e-5 rad
    rate = regular_precession_rates(ARTICLE, 0.5, 200.0)[0] + 1e-3
    start = State.from_euler(theta=0.5, phi_dot=rate, psi_dot=200.0)
    truth = Truth([start_event(Motion(ARTICLE, start))])
    found = explain(Made(delay=0.004, noise=noise).make(truth, STAMPS), truth)
    assert found.offset.delay == pytest.approx(delay, abs=1e-4)
