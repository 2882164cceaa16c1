import time

import numpy as np
import pytest

from workshop.speed.peers.peer import Peer, Solution
from workshop.speed.reference import Reference, split_orientations
from workshop.speed.sweep import Curve, Measurement, sweep, sweep_motion

PROBLEM = Reference.read().article[0]


def make_peer(errors, seconds):
    """Return a peer with a given error (rad) and given seconds for each setting, from 1 down."""
    settings = [10.0**-k for k in range(len(errors))]
    high, low = split_orientations(PROBLEM._motion, [1.0])

    def prepare(task, setting):
        number = settings.index(setting)
        # turned about x by an angle: q times (1, angle/2, 0, 0)
        w, x, y, z = (high + low)[0]
        half = errors[number] / 2
        turned = np.array([[w - half * x, x + half * w, y + half * z, z - half * y]])
        return Solution(lambda t: time.sleep(seconds[number]), lambda t: (np.array([1.0]), turned))

    return Peer("a peer", tuple(settings), prepare)


def test_the_cheapest_point_is_the_fastest_that_is_good_enough():
    points = tuple(
        Measurement(setting, error, error, 9, seconds, 0.0)
        for setting, error, seconds in ((1.0, 1e-3, 1.0), (0.1, 1e-7, 3.0), (0.01, 1e-8, 2.0))
    )
    curve = Curve("a peer", "cusps", 10.0, points, "finest")
    assert curve.find_cheapest(1e-6).seconds == 2.0
    assert curve.find_cheapest(1e-9) is None
    assert curve.best.setting == 0.01


def test_a_sweep_ends_before_a_run_that_is_expected_to_exceed_the_limit():
    seconds = {1.0: 0.01, 0.1: 0.03, 0.01: 9.0}  # 0.09 s are expected for the third

    def measure(setting):
        return Measurement(setting, setting**2, setting**2, 9, seconds[setting], 0.0)

    points, end = sweep(tuple(seconds), measure, limit=0.06)
    assert ([point.setting for point in points], end) == ([1.0, 0.1], "time limit")


def test_a_point_has_the_time_and_the_error_of_its_run():
    curve = sweep_motion(make_peer([1e-2, 1e-4], [0.01, 0.03]), PROBLEM, 1.0, limit=60.0)
    assert curve.points[0].seconds >= 0.01
    assert curve.points[1].seconds >= 0.03
    # a product of doubles, and the error of the turn itself: angle^2/4
    assert [point.error for point in curve.points] == pytest.approx([1e-2, 1e-4], rel=1e-4)


def test_a_sweep_ends_when_two_settings_in_a_row_are_no_better():
    for errors, expected in (
        ([1e-2, 1e-6, 2e-6, 3e-6, 1e-9], (4, "turning point", 0.1)),
        ([1e-2, 1e-6, 2e-6], (3, "finest", 0.1)),  # through all settings
    ):
        curve = sweep_motion(make_peer(errors, [0.0] * 5), PROBLEM, 1.0, limit=1.0)
        assert (len(curve.points), curve.end, curve.best.setting) == expected
