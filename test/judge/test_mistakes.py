"""Mistakes of convention are named."""

from dataclasses import replace

import numpy as np
import pytest
from judge.cases import SECOND, make_estimates
from scipy.spatial.transform import Rotation

from symtop_ros.arrays import rotate
from symtop_ros.judge.judgement import judge
from symtop_ros.judge.truth import scene_truth

STAMPS = np.arange(0, 5 * SECOND, SECOND // 100)


def to_world(estimates):
    return rotate(*estimates.orientations.T, estimates.angular_velocities)


RATES = {
    "in deg/s": lambda e: np.degrees(e.angular_velocities),
    "in the world frame": to_world,
    "in deg/s, in the world frame": lambda e: np.degrees(to_world(e)),
}


@pytest.mark.parametrize("heading", [0.0, 1.0])
@pytest.mark.parametrize("mistake", RATES)
def test_a_mistake_of_the_rates_is_named(heading, mistake):
    truth = scene_truth("cusps")
    good = make_estimates(truth, STAMPS, Rotation.from_rotvec([0.0, 0.0, heading]))
    bad = replace(good, angular_velocities=RATES[mistake](good))
    (note,) = judge(bad, truth, "x").notes
    assert note.startswith("likely mistake: the angular ")
    assert note.endswith(mistake)


def test_good_estimates_and_plain_errors_are_no_mistakes():
    truth = scene_truth("cusps")
    good = make_estimates(truth, STAMPS)
    assert judge(good, truth, "x").notes == ()
    turned = make_estimates(truth, STAMPS, Rotation.from_rotvec([0.4, 0.0, 1.0]))
    assert judge(turned, truth, "x").notes == ()
